"""What the server of the page answers, and what it refuses."""

from __future__ import annotations

import http.client
import json
import socket
import threading
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from swapped import swapped_pair

from gmds import Correspondence
from gmds.viewer.asked import LARGEST
from gmds.viewer.server import PageServer
from gmds.viewer.workplace import Workplace

EMPTY = {"landmarks": [], "wrong": []}


@pytest.fixture(scope="module")
def server() -> Iterator[PageServer]:
    place = Workplace(swapped_pair(300).wrong, ("dog é.ply", "wolf.off"))
    with PageServer(place) as running:
        thread = threading.Thread(target=running.serve_forever, args=(0.02,))
        thread.start()
        yield running
        running.shutdown()
        thread.join()


def asked(server: PageServer, method: str, path: str, body: Any = None, **more: str) -> tuple[int, bytes, Any]:
    """Status, contents and headers of the reply to a request that has all it needs, but for what `more` says."""
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=20)
    headers = {"Host": f"127.0.0.1:{server.port}", "X-Gmds-Token": server.token, "Content-Type": "application/json"}
    headers |= {name.replace("_", "-"): value for name, value in more.items()}
    content = body if isinstance(body, bytes | None) else json.dumps(body).encode()
    connection.request(method, path, content, {name: value for name, value in headers.items() if value != "none"})
    reply = connection.getresponse()
    found = reply.status, reply.read(), reply.headers
    connection.close()
    return found


def test_it_listens_on_the_loopback_address_alone(server: PageServer) -> None:
    assert server.server_address[0] == "127.0.0.1" and server.port > 0
    others = [info[4][0] for info in socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)]
    for address in {one for one in others if not one.startswith("127.")}:
        with pytest.raises(OSError), socket.create_connection((address, server.port), timeout=1):
            pass


def test_the_page_is_served_to_the_link_only(server: PageServer) -> None:
    status, content, headers = asked(server, "GET", f"/?token={server.token}", X_Gmds_Token="none")
    assert status == 200 and b'id="tool-place"' in content and b"connect-src 'self'" in content
    assert headers["Cache-Control"] == "no-store" and headers["X-Frame-Options"] == "DENY"
    for path in ("/", "/?token=", "/?token=wrong", f"/?token={server.token}x", "/?token=%00"):
        status, content, _ = asked(server, "GET", path)
        assert status == 403 and b"token" in content and b"<html" not in content


@pytest.mark.parametrize("path", ["/state", "/map?number=0", "/nowhere"])
def test_nothing_is_told_without_the_token(server: PageServer, path: str) -> None:
    for token in ("none", "", "wrong", server.token[:-1]):
        assert asked(server, "GET", path, X_Gmds_Token=token)[0] == 403
    assert asked(server, "GET", f"{path.split('?')[0]}?token={server.token}", X_Gmds_Token="none")[0] == 403


@pytest.mark.parametrize("path", ["/work", "/match", "/stop", "/file"])
@pytest.mark.parametrize(
    "more",
    [
        {"X_Gmds_Token": "none"},
        {"X_Gmds_Token": "wrong"},
        {"Origin": "https://elsewhere.example"},
        {"Origin": "null"},
        {"Origin": "http://127.0.0.1:1"},
        {"Host": "elsewhere.example"},
        {"Host": "127.0.0.1"},
        {"Host": "none", "X_Other": "1"},
        {"Sec_Fetch_Site": "cross-site"},
        {"Sec_Fetch_Site": "same-site"},
    ],
)
def test_what_does_not_come_from_the_page_is_refused(server: PageServer, path: str, more: dict[str, str]) -> None:
    if more.get("Host") == "none":
        more = {"Host": "127.0.0.1.elsewhere.example"}
    assert asked(server, "POST", path, EMPTY, **more)[0] == 403
    assert server.workplace.job is None


def test_the_page_itself_is_answered(server: PageServer) -> None:
    for host in ("127.0.0.1", "localhost"):
        origin = {"Host": f"{host}:{server.port}", "Origin": f"http://{host}:{server.port}"}
        status, content, _ = asked(server, "POST", "/work", EMPTY, **origin, Sec_Fetch_Site="same-origin")
        assert (status, json.loads(content)) == (200, {"landmarks": 0, "complete": 0})


def test_bodies_that_are_huge_are_refused_before_they_are_read(server: PageServer) -> None:
    with socket.create_connection(("127.0.0.1", server.port), timeout=20) as line:
        head = f"POST /work HTTP/1.1\r\nHost: 127.0.0.1:{server.port}\r\nX-Gmds-Token: {server.token}\r\n"
        line.sendall(f"{head}Content-Type: application/json\r\nContent-Length: {LARGEST + 1}\r\n\r\n".encode())
        reply = line.makefile("rb").read()  # and the connection is closed
    assert reply.startswith(b"HTTP/1.1 413")


@pytest.mark.parametrize(
    ("more", "status"),
    [
        ({"Content_Length": "none", "Transfer_Encoding": "chunked"}, 411),
        ({"Content_Length": "-5"}, 400),
        ({"Content_Length": "many"}, 400),
        ({"Content_Length": "9" * 400}, 413),
        ({"Content_Type": "text/plain"}, 415),
        ({"Content_Type": "none"}, 415),
    ],
)
def test_bodies_that_do_not_say_what_they_are_are_refused(
    server: PageServer, more: dict[str, str], status: int
) -> None:
    assert asked(server, "POST", "/work", b"{}", **more)[0] == status


BROKEN = [
    b"", b"{", b"[]", b"null", b"7", b"\xff\xfe", b'{"landmarks": NaN}', b"[" * 100_000, b'{"a":' * 50_000,
    {}, {"landmarks": []}, {"landmarks": {}, "wrong": []}, {"landmarks": [], "wrong": [300]},
    {"landmarks": [], "wrong": [-1]}, {"landmarks": [], "wrong": [0.5]}, {"landmarks": [], "wrong": [True]},
    {"landmarks": [None], "wrong": []}, {"landmarks": [{"name": "", "at": [None, None]}], "wrong": []},
    {"landmarks": [{"name": "a\nb", "at": [None, None]}], "wrong": []},
    {"landmarks": [{"name": "a" * 201, "at": [None, None]}], "wrong": []},
    {"landmarks": [{"name": "a", "at": [None]}], "wrong": []},
    {"landmarks": [{"name": "a", "at": [[0, 0], None]}], "wrong": []},
    {"landmarks": [{"name": "a", "at": [[0, 0, 1e30], None]}], "wrong": []},
    {"landmarks": [{"name": "a", "at": [["0", 0, 0], None]}], "wrong": []},
    {"landmarks": [{"name": "a", "at": [None, None]}] * 2001, "wrong": []},
]  # fmt: skip


@pytest.mark.parametrize("body", BROKEN, ids=lambda body: str(body)[:40])
def test_what_is_broken_is_refused_and_changes_nothing(server: PageServer, body: Any) -> None:
    before = server.workplace.edits
    status, content, _ = asked(server, "POST", "/work", body)
    assert status == 400 and json.loads(content)["error"] and server.workplace.edits is before
    assert asked(server, "GET", "/state")[0] == 200, "and it goes on"


@pytest.mark.parametrize(
    ("path", "body", "status"),
    [
        ("/match", {"tolerance": -1}, 400),
        ("/match", {"tolerance": "0"}, 400),
        ("/match", {"from": 7}, 400),
        ("/match", {"from": True}, 400),
        ("/file", {"kind": "../../etc/passwd", "side": 0}, 400),
        ("/file", {"kind": ".csv", "side": 2}, 400),
        ("/file", {"kind": ".csv", "side": 0}, 409),
        ("/file", {"kind": "map", "map": 0, "candidate": 1}, 400),
        ("/nowhere", {}, 404),
        ("/../gmds/errors.py", {}, 404),
    ],
)
def test_what_there_is_not_is_refused(server: PageServer, path: str, body: Any, status: int) -> None:
    assert asked(server, "POST", path, body)[0] == status
    assert server.workplace.job is None


def test_other_methods_are_unknown(server: PageServer) -> None:
    for method in ("PUT", "DELETE", "OPTIONS"):
        assert asked(server, method, "/work", {})[0] == 501


def test_files_hold_what_was_placed(server: PageServer, tmp_path: Any) -> None:
    source = server.workplace.maps[0].source
    places = server.workplace.drawn[0].placed(source.vertices[[5, 80]]).tolist()
    marks = [{"name": "päw", "at": [places[0], None]}, {"name": "tail", "at": [places[1], places[1]]}]
    assert asked(server, "POST", "/work", {"landmarks": marks, "wrong": [3, 3, 9]})[0] == 200
    status, content, headers = asked(server, "POST", "/file", {"kind": ".csv", "side": 0})
    assert status == 200 and bytes.fromhex(headers["X-Gmds-Name"]).decode() == "dog é.csv"
    lines = content.decode().splitlines()
    assert lines[1].startswith("päw,") and len(lines) == 3
    assert np.allclose(np.array(lines[2].split(",")[1:4], dtype=float), source.vertices[80], atol=1e-5)
    content = asked(server, "POST", "/file", {"kind": ".mrk.json", "side": 1})[1]
    points = json.loads(content)["markups"][0]["controlPoints"]
    assert [point["positionStatus"] for point in points] == ["undefined", "defined"]
    (tmp_path / "map.npz").write_bytes(asked(server, "POST", "/file", {"kind": "map", "map": 0})[1])
    kept = Correspondence.load(tmp_path / "map.npz", source, server.workplace.maps[0].target)
    assert kept.meta["marked_wrong"] == [3, 9]
    assert np.array_equal(kept.points.face, server.workplace.maps[0].points.face)
    again = Workplace(kept, ("a", "b"))
    assert again.edits.wrong == (3, 9), "marks come back with the map"
    server.workplace.keep(EMPTY)
