"""From templates and maps to an atlas, round by round."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from geodesics import Mesh
from geodesics.arrays import Integers
from geodesics.caching import cached_property
from gmds.atlases.fusion import Fused, gap_of
from gmds.atlases.links import Link, Load, agreed
from gmds.atlases.neighbours import Job, common_points, linked, neighbours_of, settle
from gmds.atlases.registered import MIRROR, Atlas
from gmds.atlases.sides import is_mirror, mirror_image, moved
from gmds.atlases.template_maps import TemplateMaps
from gmds.atlases.templates import medoids, profiles
from gmds.batch.collection import Shape
from gmds.batch.records import WITHOUT_MAP, Batch, Failure, PairRecord, ShapeRecord
from gmds.batch.run import match_collection
from gmds.batch.store import Store
from gmds.batch.tasks import ShapeJob, measure_shape
from gmds.batch.workers import outcomes
from gmds.errors import NoAtlas
from gmds.morphometrics.procrustes import superimposed

Progress = Callable[[str, float], None]

PROFILES = 0.1  # share of the bar of progress; set by hand
MEAN = "mean-shape"


@dataclass(eq=False)
class Rounds:
    """An atlas on its way."""

    shapes: dict[str, Shape]
    folder: Path
    mirror: frozenset[str]
    matching: dict[str, Any]
    report: Progress
    rounds: int
    neighbours: int
    client: Any
    failures: dict[str, Failure] = field(default_factory=dict)
    sides_known: bool = False

    @cached_property
    def mean(self) -> str:
        """What the mean shape is called among specimens, one of which may have that name."""
        name = MEAN
        while name in self.shapes:
            name += "-"
        return name

    def done(self, template: str | None, count: int) -> Atlas:
        """The atlas after all rounds."""
        chosen = self._templates(template, count)
        found = self._registered(chosen, "maps", 1)
        changes: list[float] = []
        while len(changes) + 1 < self.rounds:
            number = len(changes) + 2
            before = found.mean
            self.shapes[self.mean] = Shape(self.mean, before)
            again = self._registered((self.mean,), f"maps-{number}", number)
            del self.shapes[self.mean]
            changes.append(moved(before.vertices, again.mean.vertices))
            found = again
        return Atlas(**{**vars(found), "templates": chosen, "changes": tuple(changes), "failures": self.failures})

    def _templates(self, template: str | None, count: int) -> tuple[str, ...]:
        if template is not None and count == 1:
            return (template,)
        shapes = [Shape(name, self._origin(shape)) for name, shape in self.shapes.items()]
        mirrored = self.matching.get("orientation") in ("reverse", "any")
        told = lambda s, x: self.report(s, PROFILES * x)  # noqa: E731
        known, self.failures = profiles(
            shapes, self.folder / "maps", self.folder / "profiles", mirrored, self.client, told
        )
        for name in self.failures:
            del self.shapes[name]
        if len(known) < 2:
            raise NoAtlas(f"fewer than two meshes can be measured; {_told(self.failures)}")
        first = () if template is None else (template,)
        return (*first, *(name for name in medoids(known, count) if name != template))[:count]

    def _registered(self, templates: tuple[str, ...], maps: str, number: int) -> Atlas:
        """All specimens on the triangulation of the first template, by maps in a folder of that name."""
        pairs = [(one, name) for one in templates for name in self.shapes if name != one]
        origins = {name: self._origin(shape) for name, shape in self.shapes.items()}
        share = (1 - PROFILES) / self.rounds
        told = lambda s, x: self.report(s, PROFILES + share * (number - 1 + x))  # noqa: E731
        batch = match_collection(
            origins, self.folder / maps, pairs=pairs, progress=told, client=self.client, **self.matching
        )
        done = {(pair.source, pair.target): pair for pair in batch.pairs if pair.status not in WITHOUT_MAP}
        for pair in batch.failed:
            if pair.source == templates[0]:
                self.failures[_culprit(pair)] = pair.failure or Failure("", "its turn never came")
        first, kept = templates[0], [name for name in self.shapes if (templates[0], name) in done]
        names = sorted([*kept, *([] if first == self.mean else [first])])
        if len(kept) < (2 if first == self.mean else 1):
            raise NoAtlas(f"no specimen can be matched with the template {first}; {_told(self.failures)}")
        given, meshes = self.mirror, {name: self._mesh(name) for name in templates}
        maps_of = TemplateMaps(self.folder / maps, done.keys(), meshes, lambda name: self._mesh(name, given))
        rows = {first: Fused.as_it_is(meshes[first])}
        rows |= {name: maps_of.said(name) for name in names if name != first}
        turned = self._turned(rows, meshes[first])
        links = maps_of.links(turned)
        links |= self._neighbours(rows, meshes[first].faces, first, self._records(batch, turned), told)
        if len(templates) > 1 or len(links) > len(done):
            rows = agreed(rows, links, first, self._mesh)
        gap = [gap_of(self._mesh(n), rows[n].places, meshes[first].faces, rows[n].valid) for n in names]
        status = tuple("TEMPLATE" if name == first else done[first, name].status for name in names)
        return self._atlas(names, meshes[first], [rows[name] for name in names], gap, status)

    def _neighbours(
        self, rows: dict[str, Fused], faces: Integers, first: str, batch: Batch, told: Progress
    ) -> dict[tuple[str, str], Load]:
        """Each specimen registered from some others as well: what loads that; none where sides are not known."""
        pairs = neighbours_of([name for name in rows if name in batch.shapes], self.neighbours, first)
        sides = self.matching.get("orientation", "preserve") == "preserve" or self.sides_known
        if not sides or self.matching.get("distance") is not None:
            pairs = []
        (batch.output / "settled").mkdir(exist_ok=True)
        store = Store(batch.output / "shapes")

        def job(source: str, target: str) -> Job:
            common = common_points(rows[source], rows[target], faces)
            path = batch.output / "settled" / f"{source}__{target}.npz"
            return Job(batch.shapes[source], batch.shapes[target], store, common, path)

        for number, _ in enumerate(outcomes(self.client, settle, (job(*pair) for pair in pairs)), start=1):
            told(f"{number} of {len(pairs)} specimens registered to others", number / len(pairs))
        start = dict(rows)

        def link(source: str, target: str) -> Link | None:
            return linked(job(source, target), start[source], start[target])

        return {pair: partial(link, *pair) for pair in pairs}

    def _turned(self, rows: dict[str, Fused], template: Mesh) -> frozenset[str]:
        """Specimens that turn out to be of the other side; from now on they are mirrored, and so are their rows."""
        if "auto" not in self.mirror:
            return frozenset()
        found = frozenset(n for n, row in rows.items() if is_mirror(template.vertices, row.places, row.valid))
        for name in found:
            rows[name] = rows[name]._replace(places=rows[name].places * MIRROR)
        self.mirror, self.sides_known = found, True
        return found

    def _records(self, batch: Batch, turned: frozenset[str]) -> Batch:
        """What was measured, with the mirror images of turned specimens in their place."""
        store = Store(batch.output / "shapes")
        jobs = (ShapeJob(Shape(name, self._mesh(name)), store) for name in sorted(turned))
        new = {job.shape.name: found for job, found in outcomes(self.client, measure_shape, jobs)}
        known = {name: one for name, one in {**batch.shapes, **new}.items() if isinstance(one, ShapeRecord)}
        return replace(batch, shapes={name: one for name, one in known.items() if one.failure is None})

    def _atlas(self, names: list[str], template: Mesh, rows: list[Fused], gap: list[float], status: Any) -> Atlas:
        places, valid = np.stack([row.places for row in rows]), np.stack([row.valid for row in rows])
        missing = ~valid.any(axis=0)
        valid = valid | missing  # what nobody has is where the maps say
        mirrored = np.array([name in self.mirror for name in names])
        laid = superimposed(places, valid)
        filled = np.stack([move.inverse(laid.mean) for move in laid.moves])
        places = np.where(valid[:, :, None], places, filled)
        places = np.where(mirrored[:, None, None], places * MIRROR, places)  # back to where the specimen lies
        spread = np.stack([row.spread for row in rows])
        return Atlas(tuple(names), template.faces, places, valid, mirrored, spread, np.array(gap), status, ())

    def _origin(self, shape: Shape) -> Any:
        return self._mesh(shape.name) if shape.name in self.mirror else shape.origin

    def _mesh(self, name: str, mirror: frozenset[str] | None = None) -> Mesh:
        mesh = self.shapes[name].mesh()
        return mirror_image(mesh) if name in (self.mirror if mirror is None else mirror) else mesh


def _culprit(pair: PairRecord) -> str:
    """Which of a pair could not be matched."""
    reason = pair.failure.reason if pair.failure else ""
    return pair.source if reason.startswith(f"{pair.source}:") else pair.target


def _told(failures: dict[str, Failure]) -> str:
    return "; ".join(f"{name}: {why.code}: {why.reason}" for name, why in list(failures.items())[:5]) or "none failed"
