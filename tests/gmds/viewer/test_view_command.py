"""`gmds view` as a process of its own: it prints a link, answers, and ends with Ctrl-C."""

from __future__ import annotations

import signal
import subprocess
import sys
import urllib.request
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from pages import page_data
from places import ROOT
from swapped import swapped_pair

from geodesics import write_mesh
from gmds.cli import main
from gmds.landmarks.files import Landmarks, write_landmarks
from gmds.maps.point_map import Candidate
from gmds.viewer.server import PageServer


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("view")
    wrong = swapped_pair(300).wrong
    write_mesh(wrong.source, place / "a.off")
    write_mesh(wrong.target, place / "b.off")
    wrong.save(place / "map.npz")
    write_landmarks(place / "a.csv", Landmarks(("nose", "tail"), wrong.source.vertices[[3, 40]]))
    write_landmarks(place / "b.csv", Landmarks(("tail", "ear"), wrong.target.vertices[[5, 60]]))
    return place


@pytest.fixture
def servers(folder: Path, monkeypatch: pytest.MonkeyPatch) -> list[PageServer]:
    """In the folder, where servers end as soon as they serve: those that did."""
    seen: list[PageServer] = []

    def serve(server: PageServer) -> None:
        seen.append(server)
        raise KeyboardInterrupt

    monkeypatch.setattr(PageServer, "serve_forever", serve)
    monkeypatch.chdir(folder)
    return seen


def test_it_answers_until_it_is_interrupted(folder: Path) -> None:
    args = ["view", "map.npz", "--source", "a.off", "--target", "b.off", "--no-browser"]
    running = subprocess.Popen(
        [sys.executable, "-m", "gmds", *args],
        cwd=folder,
        env={"PYTHONPATH": str(ROOT), "PATH": "/usr/bin", "HOME": str(folder)},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert running.stdout is not None
    link = running.stdout.readline().strip()
    assert link.startswith("http://127.0.0.1:") and "?token=" in link
    with urllib.request.urlopen(link, timeout=60) as reply:
        assert "map.npz: a.off → b.off" in reply.read().decode()
    running.send_signal(signal.SIGINT)
    _, told = running.communicate(timeout=60)
    assert running.returncode == 0 and told.splitlines()[-1] == "ended"


def test_landmarks_of_two_files_are_paired_by_name(folder: Path, servers: list[PageServer]) -> None:
    files = ["map.npz", "--source", "a.off", "--target", "b.off", "--no-browser"]
    done = CliRunner().invoke(main, ["view", *files, "--landmarks", "a.csv", "--landmarks", "b.csv"])
    assert done.exit_code == 0, done.output
    place = servers[0].workplace
    assert [(mark.name, [one is not None for one in mark.at]) for mark in place.edits.landmarks] == [
        ("nose", [True, False]),
        ("tail", [True, True]),
        ("ear", [False, True]),
    ]
    there = place.edits.on(1, place.maps[0].target, place.drawn[1])
    assert np.allclose(there.positions, place.maps[0].target.vertices[[5]], atol=1e-5)
    assert CliRunner().invoke(main, ["view", *files, *(3 * ["--landmarks", "a.csv"])]).exit_code == 2


def test_candidates_of_the_file_are_shown_with_their_errors(folder: Path, servers: list[PageServer]) -> None:
    """All that the page tells of a candidate comes from the file of the map."""
    pair = swapped_pair(300)
    others = (Candidate(pair.true, 0.01, 0.9), Candidate(pair.wrong.points, 0.3, -0.9))
    replace(pair.wrong, candidates=others).save(folder / "several.npz")
    rows = np.arange(pair.wrong.source.n_vertices)
    np.savez(folder / "truth.npz", src=rows, gt=pair.true.nearest_vertices())
    files = ["several.npz", "--source", "a.off", "--target", "b.off", "--no-browser", "--truth", "truth.npz"]
    done = CliRunner().invoke(main, ["view", *files])
    assert done.exit_code == 0, done.output
    (folder / "page.html").write_text(servers[0].workplace.page())
    best, right, mirrored = page_data(folder / "page.html")["maps"]
    assert right["name"] == "Candidate 1, not mirrored" and mirrored["name"] == "Candidate 2, mirrored"
    assert right["told"]["cards"][0] == ["0.01", "stress (small is good)", "stress"]
    assert right["curve"][0] < 1 and right["curve"][-1] == 1 and best["curve"][-1] < 1
