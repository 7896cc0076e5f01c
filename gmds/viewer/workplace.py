"""The state of an open page: both surfaces, all maps so far, what was placed by hand, and work that goes on."""

from __future__ import annotations

import tempfile
import threading
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from geodesics.arrays import Floats
from gmds.correspondence import Correspondence
from gmds.landmarks.files import Landmarks, Space, write_landmarks
from gmds.maps.made_with import NamedPair, landmarks_of
from gmds.pictures.camera import Direction
from gmds.report.content import maps_content
from gmds.report.packing import packed_data
from gmds.report.page import Work, drawings, page_text
from gmds.viewer.again import matched_again
from gmds.viewer.asked import Refused
from gmds.viewer.assets import CONTROLS, SCRIPT, STYLE
from gmds.viewer.edits import Edits, Placed
from gmds.viewer.job import Job, Progress

ENDINGS = (".mrk.json", ".csv")  # of landmarks that are saved
LARGEST_TOLERANCE = 0.5  # root areas; a larger one says nothing
COLOURS = ("confidence", "distortion", "growth")  # of maps that `match` makes


class Workplace:
    """What requests ask of; one at a time changes it."""

    def __init__(
        self,
        answer: Correspondence,
        names: tuple[str, str],
        *,
        title: str = "Correspondence",
        up: Direction = (0, 0, 1),
        landmarks: tuple[NamedPair, ...] | None = None,
        errors: Floats | None = None,
        space: Space = "LPS",
    ) -> None:
        self.names, self.title, self.space, self.errors = names, title, space, errors
        self.drawn = drawings(answer, up)
        self.maps: list[Correspondence] = [answer]
        self.job: Job | None = None
        self._lock = threading.Lock()
        given = landmarks_of(answer) if landmarks is None else landmarks
        marks = tuple(Placed(name, (self._drawn(0, one), self._drawn(1, other))) for name, one, other in given)
        wrong = answer.meta.get("marked_wrong", ())
        n = answer.source.n_vertices
        known = tuple(i for i in wrong if type(i) is int and 0 <= i < n) if isinstance(wrong, list | tuple) else ()
        self.edits = Edits(marks, known)

    def _drawn(self, side: int, place: Any) -> tuple[float, float, float] | None:
        if place is None:
            return None
        x, y, z = self.drawn[side].placed(np.asarray(place)).tolist()
        return x, y, z

    def page(self) -> str:
        """The page as it is opened: with all maps so far and what was placed."""
        data = {**self.edits.as_data(), "maps": len(self.maps)}
        policy = " connect-src 'self';"
        work = Work(scripts=SCRIPT, style=STYLE, controls=CONTROLS, data=data, policy=policy, colours=COLOURS)
        return page_text(self.maps[0], self.errors, self.drawn, self.title, self.names, landmarks=(), work=work)

    def keep(self, given: dict[str, Any]) -> dict[str, Any]:
        """What the page has placed by now."""
        self.edits = Edits.of(given, self.maps[0].source.n_vertices)
        return {"landmarks": len(self.edits.landmarks), "complete": len(self.edits.complete)}

    def match(self, given: dict[str, Any]) -> dict[str, Any]:
        """Start matching again, with what was placed, from the map of that number."""
        tolerance, number = given.get("tolerance", 0.0), given.get("from", 0)
        if type(tolerance) not in (int, float) or not 0 <= tolerance <= LARGEST_TOLERANCE:
            raise Refused(400, f"tolerance must be a number from 0 to {LARGEST_TOLERANCE}")
        old, edits = self._map(number), self.edits
        with self._lock:
            if self.job is not None and self.job.running:
                raise Refused(409, "a match is going on; stop it first")
            self.job = Job(self._work(old, edits, float(tolerance)), self._done)
        return self.state()

    def _work(self, old: Correspondence, edits: Edits, tolerance: float) -> Callable[[Progress], Correspondence]:
        def work(progress: Progress) -> Correspondence:
            ours = edits.on(0, old.source, self.drawn[0])
            theirs = edits.on(1, old.target, self.drawn[1])
            pairs = None if ours is None or theirs is None else (ours, theirs)
            wrong = edits.wrong_vertices(old.source, self.drawn[0])
            answer = matched_again(old, pairs, wrong, tolerance=tolerance, progress=progress)
            return replace(answer, meta={**answer.meta, "landmark_names": [one.name for one in edits.complete]})

        return work

    def _done(self, answer: Correspondence) -> int:
        with self._lock:
            self.maps.append(answer)
            return len(self.maps) - 1

    def stop(self, _: dict[str, Any]) -> dict[str, Any]:
        """Stop matching."""
        if self.job is not None:
            self.job.stop()
        return self.state()

    def state(self) -> dict[str, Any]:
        """How far the matching is."""
        return {"maps": len(self.maps), "job": None if self.job is None else self.job.state}

    def map_data(self, number: int) -> str:
        """A map that was made here, with its candidates, as the page reads it."""
        answer = self._map(number)
        named = len(answer.meta.get("landmark_names", ()))
        title = f"Match {number + 1}, {named} landmarks" if number else ""
        return packed_data(maps_content(answer, None, self.drawn, title))

    def file(self, given: dict[str, Any]) -> tuple[str, bytes]:
        """A file to save, its name and contents: landmarks of a side, or a map."""
        kind, side = given.get("kind"), given.get("side")
        if kind == "map":
            return "map.npz", _written("map.npz", self._chosen(given.get("map", 0), given.get("candidate", 0)).save)
        if kind not in ENDINGS or side not in (0, 1):
            raise Refused(400, f"kind must be 'map' or one of {', '.join(ENDINGS)}, side 0 or 1")
        mesh = (self.maps[0].source, self.maps[0].target)[side]
        marks: Landmarks = self.edits.named(side, mesh, self.drawn[side])
        if not marks.defined.any():
            raise Refused(409, "there is no landmark on this surface yet")
        name = Path(self.names[side]).stem + kind
        return name, _written(name, lambda path: write_landmarks(path, marks, self.space))

    def _chosen(self, number: Any, candidate: Any) -> Correspondence:
        """A map, or its candidate of that number from 1; with what is marked as wrong."""
        answer = self._map(number)
        if type(candidate) is not int or not 0 <= candidate <= len(answer.candidates):
            raise Refused(400, f"map {number} has {len(answer.candidates)} candidates")
        if candidate:
            points = answer.candidates[candidate - 1].points
            answer = Correspondence.from_points(answer.source, points, valid=answer.valid, meta=answer.meta)
        return replace(answer, meta={**answer.meta, "marked_wrong": list(self.edits.wrong)})

    def _map(self, number: Any) -> Correspondence:
        if type(number) is not int or not 0 <= number < len(self.maps):
            raise Refused(400, f"there is no map {number!r:.20}; there are {len(self.maps)}, from 0")
        return self.maps[number]


def _written(name: str, write: Callable[[Path], None]) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"file{''.join(Path(name).suffixes[-2:])}"
        write(path)
        return path.read_bytes()
