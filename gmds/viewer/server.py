"""The server of the page: the loopback address, a random port, a token in the link, nothing else."""

from __future__ import annotations

import json
import secrets
import signal
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any
from urllib.parse import parse_qs, urlsplit

from gmds.viewer.asked import TOKEN, Refused, body_length, check_origin, check_token, parsed
from gmds.viewer.workplace import Workplace

PATIENCE = 30  # seconds that a connection may say nothing
HEADERS = {
    "Cache-Control": "no-store",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "X-Frame-Options": "DENY",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
}


class PageServer(ThreadingHTTPServer):
    """Serves one workplace. `link` is what to open; `serve_forever` answers until it is interrupted or shut down."""

    daemon_threads = True

    def __init__(self, workplace: Workplace, port: int = 0) -> None:
        self.workplace, self.token = workplace, secrets.token_urlsafe(24)
        super().__init__(("127.0.0.1", port), Handler)

    @property
    def port(self) -> int:
        """The port that it listens on."""
        return int(self.server_address[1])

    @property
    def link(self) -> str:
        """What to open in a browser."""
        return f"http://127.0.0.1:{self.port}/?token={self.token}"

    def serve_until_interrupted(self) -> None:
        """Answers until Ctrl-C.

        The interrupt asks for the end and raises nothing: an exception would be lost in whatever it falls into, a
        finaliser for one.
        """
        previous = signal.signal(signal.SIGINT, lambda *_: threading.Thread(target=self.shutdown, daemon=True).start())
        try:
            self.serve_forever()
        except KeyboardInterrupt:  # of a SIGTERM
            pass
        finally:
            signal.signal(signal.SIGINT, previous)

    def handle_error(self, request: Any, client_address: Any) -> None:
        """A connection that broke is no matter of ours."""


class Handler(BaseHTTPRequestHandler):
    """One request."""

    server: PageServer
    protocol_version = "HTTP/1.1"
    server_version, sys_version = "gmds", ""
    timeout = PATIENCE

    def do_GET(self) -> None:
        """The page, the state, a map."""
        url = urlsplit(self.path)
        if url.path == "/favicon.ico":  # browsers ask, and complain when they get nothing
            return self._send(204, b"", "image/x-icon")
        self._answered(lambda: self._got(url.path, parse_qs(url.query)))

    def do_POST(self) -> None:
        """Something to keep, to begin, to stop or to save."""
        self._answered(self._posted)

    def _got(self, path: str, query: dict[str, list[str]]) -> None:
        if path == "/":
            check_token(query.get("token", [None])[-1], self.server.token)
            return self._send(200, self.server.workplace.page().encode("utf-8", "replace"), "text/html; charset=utf-8")
        check_token(self.headers.get(TOKEN), self.server.token)
        if path == "/state":
            return self._send_json(self.server.workplace.state())
        if path == "/map":
            number = query.get("number", [""])[-1]
            text = self.server.workplace.map_data(int(number) if number.isascii() and number.isdigit() else -1)
            return self._send(200, text.encode("ascii"), "text/plain")
        raise Refused(404, "there is no such page")

    def _posted(self) -> None:
        check_token(self.headers.get(TOKEN), self.server.token)
        length = body_length(self.headers)
        given = parsed(self.rfile.read(length))
        self._read = True
        workplace, path = self.server.workplace, urlsplit(self.path).path
        routes = {"/work": workplace.keep, "/match": workplace.match, "/stop": workplace.stop}
        if path in routes:
            return self._send_json(routes[path](given))
        if path == "/file":
            name, content = workplace.file(given)
            return self._send(200, content, "application/octet-stream", {"X-Gmds-Name": name.encode().hex()})
        raise Refused(404, "there is no such page")

    def _answered(self, answer: Any) -> None:
        self._read = self.command == "GET"
        try:
            check_origin(self.headers, self.server.port)
            answer()
        except Refused as refused:
            self._refuse(refused.status, refused.why)
        except ConnectionError:
            self.close_connection = True
        except Exception as error:  # a mistake of ours ends a request, not the page
            self._refuse(500, f"{type(error).__name__}: {error}")

    def _refuse(self, status: int, why: str) -> None:
        if not self._read:  # what was not read of a body would be taken for the next request
            self.close_connection = True
        self._send(status, json.dumps({"error": why}).encode(), "application/json")

    def _send_json(self, data: Any) -> None:
        self._send(200, json.dumps(data, allow_nan=False).encode(), "application/json")

    def _send(self, status: int, content: bytes, kind: str, more: dict[str, str] | None = None) -> None:
        self.send_response(status)
        about = {"Content-Type": kind, "Content-Length": str(len(content))}
        if self.close_connection:
            about["Connection"] = "close"
        for name, value in {**HEADERS, **about, **(more or {})}.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, *_: Any) -> None:
        """Requests are nobody's business."""
