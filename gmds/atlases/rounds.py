"""From templates and maps to an atlas, round by round."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from geodesics import Mesh
from geodesics.arrays import Integers
from geodesics.caching import cached_property
from gmds.atlases.fusion import Fused, Said, fused, gap_of
from gmds.atlases.neighbours import Job, neighbours_of, with_neighbours
from gmds.atlases.registered import MIRROR, Atlas
from gmds.atlases.sides import is_mirror, moved
from gmds.atlases.templates import medoids, profiles
from gmds.batch.collection import Shape
from gmds.batch.records import WITHOUT_MAP, Batch, Failure, PairRecord
from gmds.batch.run import match_collection
from gmds.batch.store import Store
from gmds.correspondence import Correspondence
from gmds.errors import NoAtlas
from gmds.matching.settling import CommonPoints
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
        known, self.failures = profiles(
            self.shapes, self.folder / "profiles", lambda s, x: self.report(s, PROFILES * x)
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
        meshes = {name: self._mesh(name) for name in (*templates,)}
        rows = {}
        for name in names:
            rows[name] = self._said(name, meshes.get(name) or self._mesh(name), meshes, list(done), self.folder / maps)
        rows = self._settled(rows, meshes[first].faces, first, batch, told)
        gap = [gap_of(self._mesh(n), row.places, meshes[first].faces, row.valid) for n, row in rows.items()]
        status = tuple("TEMPLATE" if name == first else done[first, name].status for name in names)
        return self._atlas(names, meshes[first], list(rows.values()), gap, status)

    def _settled(
        self, rows: dict[str, Fused], faces: Integers, first: str, batch: Batch, told: Progress
    ) -> dict[str, Fused]:
        """The rows, each specimen registered from some others as well; as they are where sides are to be found out."""
        pairs = neighbours_of(list(rows), self.neighbours, first)
        if not pairs or "auto" in self.mirror or self.matching.get("distance") is not None:
            return rows
        folder = batch.output / "settled"
        folder.mkdir(exist_ok=True)
        store = Store(batch.output / "shapes")

        def job(source: str, target: str) -> Job:
            common = CommonPoints(rows[source].places, rows[target].places, faces)
            there = rows[source].valid & rows[target].valid
            common = replace(common, faces=faces[there[faces].all(axis=1)])
            path = folder / f"{source}__{target}.npz"
            return Job(batch.shapes[source], batch.shapes[target], store, common, path)

        if first in rows:  # of which nobody says anything else
            rows[first] = rows[first]._replace(spread=np.zeros(len(rows[first].places)))
        return with_neighbours(rows, [job(*pair) for pair in pairs], self._mesh, self.client, told)

    def _said(self, name: str, mesh: Mesh, meshes: dict[str, Mesh], done: list[tuple[str, str]], folder: Path) -> Fused:
        """Where the first template is on a specimen, by all templates."""
        first, *others = meshes

        def load(source: str, target: str) -> Correspondence:
            path = folder / "pairs" / f"{source}__{target}.npz"
            return Correspondence.load(path, meshes[source], meshes.get(target) or mesh)

        if name == first:
            there = np.isin(np.arange(mesh.n_vertices), mesh.faces)
            none = np.full(mesh.n_vertices, 0.0 if others else np.nan)
            return Fused(mesh.vertices, there, none, np.ones(mesh.n_vertices))
        said = [load(first, name)]
        through = [one for one in others if one != name and (first, one) in done and (one, name) in done]
        said += [load(first, one).compose(load(one, name)) for one in through]
        return fused([Said.by(one) for one in said], mesh)

    def _atlas(self, names: list[str], template: Mesh, rows: list[Fused], gap: list[float], status: Any) -> Atlas:
        places, valid = np.stack([row.places for row in rows]), np.stack([row.valid for row in rows])
        missing = ~valid.any(axis=0)
        valid = valid | missing  # what nobody has is where the maps say
        mirrored = np.array([name in self.mirror for name in names])
        if "auto" in self.mirror:
            mirrored = np.array([is_mirror(template.vertices, p, v) for p, v in zip(places, valid, strict=True)])
        turned = np.where((mirrored & ("auto" in self.mirror))[:, None, None], places * MIRROR, places)
        laid = superimposed(turned, valid)
        filled = np.stack([move.inverse(laid.mean) for move in laid.moves])
        places = np.where(valid[:, :, None], turned, filled)
        places = np.where(mirrored[:, None, None], places * MIRROR, places)  # back to where the specimen lies
        spread = np.stack([row.spread for row in rows])
        return Atlas(tuple(names), template.faces, places, valid, mirrored, spread, np.array(gap), status, ())

    def _origin(self, shape: Shape) -> Any:
        return self._mesh(shape.name) if shape.name in self.mirror else shape.origin

    def _mesh(self, name: str) -> Mesh:
        mesh = self.shapes[name].mesh()
        return Mesh(mesh.vertices * MIRROR, mesh.faces[:, [0, 2, 1]]) if name in self.mirror else mesh


def _culprit(pair: PairRecord) -> str:
    """Which of a pair could not be matched."""
    reason = pair.failure.reason if pair.failure else ""
    return pair.source if reason.startswith(f"{pair.source}:") else pair.target


def _told(failures: dict[str, Failure]) -> str:
    return "; ".join(f"{name}: {why.code}: {why.reason}" for name, why in list(failures.items())[:5]) or "none failed"
