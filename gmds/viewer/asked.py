"""What a request must be to be answered: from this machine, from the page itself, with its token, small, and JSON."""

from __future__ import annotations

import json
import secrets
from email.message import Message
from typing import Any, NoReturn

HOSTS = ("127.0.0.1", "localhost")  # names of this machine that browsers do not look up elsewhere
LARGEST = 4_000_000  # bytes of a body: a mark on each of 500,000 vertices, written out
TOKEN = "X-Gmds-Token"


class Refused(Exception):
    """A request that is not answered: the status of HTTP, and why."""

    def __init__(self, status: int, why: str) -> None:
        super().__init__(why)
        self.status, self.why = status, why


def check_origin(headers: Message, port: int) -> None:
    """Refuse (403) what was sent to another name, as by a rebound one, or by a page of another origin."""
    allowed = {f"{host}:{port}" for host in HOSTS}
    if headers.get("Host", "") not in allowed:
        raise Refused(403, "this server answers to its own address only")
    origin = headers.get("Origin")
    if origin is not None and origin not in {f"http://{host}" for host in allowed}:
        raise Refused(403, "this server answers its own page only")
    if headers.get("Sec-Fetch-Site", "same-origin") not in ("same-origin", "none"):
        raise Refused(403, "this server answers its own page only")


def check_token(given: str | None, token: str) -> None:
    """Refuse (403) what does not carry the token of the link."""
    if given is None or not secrets.compare_digest(given.encode(), token.encode()):
        raise Refused(403, "the token is missing or wrong; open the link that gmds view printed")


def body_length(headers: Message) -> int:
    """How long the body is; refused (411, 413, 415) when that is not said, too much, or it is no JSON."""
    if headers.get("Transfer-Encoding") is not None or headers.get("Content-Length") is None:
        raise Refused(411, "say how long the body is")
    length = headers["Content-Length"].strip()
    if not (length.isascii() and length.isdigit()):
        raise Refused(400, "the length of the body is no number")
    if len(length) > 12 or int(length) > LARGEST:
        raise Refused(413, f"a body has at most {LARGEST} bytes")
    if headers.get("Content-Type", "").partition(";")[0].strip() != "application/json":
        raise Refused(415, "a body is application/json")
    return int(length)


def parsed(body: bytes) -> dict[str, Any]:
    """A JSON object; refused (400) when it is none, or holds what is no number."""
    try:
        found = json.loads(body.decode("utf-8"), parse_constant=_no_number)
    except (ValueError, RecursionError) as error:
        raise Refused(400, f"the body is no JSON: {str(error)[:80]}") from error
    if not isinstance(found, dict):
        raise Refused(400, "the body is no JSON object")
    return found


def _no_number(word: str) -> NoReturn:
    raise ValueError(f"{word} is no number")
