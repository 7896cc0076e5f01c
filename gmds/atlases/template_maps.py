"""The maps from templates to all specimens, as files, and what they say of where the first template is on each."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from geodesics import Mesh, vertex_normals
from gmds.atlases.fusion import Fused, Said, fused
from gmds.atlases.links import Link, Load
from gmds.atlases.registered import MIRROR
from gmds.correspondence import Correspondence


@dataclass(frozen=True, eq=False)
class TemplateMaps:
    """Maps that are `done` (pairs of names), in a folder; meshes of templates, the first first, and of any specimen.

    Meshes are as they were matched: `turned` specimens, of the other side, are mirrored only after.
    """

    folder: Path
    done: Collection[tuple[str, str]]
    templates: Mapping[str, Mesh]
    mesh: Callable[[str], Mesh]

    def said(self, name: str) -> Fused:
        """Where the first template is on a specimen: what its own map says, and those through other templates."""
        first, *others = self.templates
        said = [self._map(first, name)]
        for one in others:
            if one != name and (first, one) in self.done and (one, name) in self.done:
                said.append(self._map(first, one).compose(self._map(one, name)))
        normals = vertex_normals(Mesh(said[0].points.positions, said[0].source.faces))
        return fused([Said.by(one) for one in said], self._mesh(name), normals)

    def links(self, turned: frozenset[str]) -> dict[tuple[str, str], Load]:
        """What loads the link that each map makes, once the turned specimens are mirrored."""
        return {pair: partial(self._link, *pair, turned) for pair in self.done}

    def _link(self, source: str, target: str, turned: frozenset[str]) -> Link:
        link = Link.by(self._map(source, target))
        here, there = (link.here * MIRROR if source in turned else link.here), link.there
        return replace(link, here=here, there=there * MIRROR if target in turned else there)

    def _map(self, source: str, target: str) -> Correspondence:
        path = self.folder / "pairs" / f"{source}__{target}.npz"
        return Correspondence.load(path, self.templates[source], self._mesh(target))

    def _mesh(self, name: str) -> Mesh:
        return self.templates[name] if name in self.templates else self.mesh(name)
