"""Specimens brought to agree: what all maps between them say of where the common points are, carried both ways.

A map through a template carries its errors, and a map from one specimen to another is off in other places than one of
the way back. Each specimen is told by all others with which it has a link, along it or against it, where its points
are; the middle of that is taken, all at once, and once more from there. As the points of a specimen are one list of
places, whatever way they were found, maps between specimens close around every circle.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from geodesics import Mesh, vertex_normals
from geodesics.arrays import Bools, Floats, Integers
from geodesics.barycentric import combination
from gmds.atlases.fusion import Fused, Said, fused
from gmds.atlases.sheets import closest_facing
from gmds.correspondence import Correspondence

# The first brings nearly all there is (`benchmarks/results/notes.md`, "Atlas").
ROUNDS = 2
MOST = 12  # accounts that are heard of a specimen, evenly chosen: a template has links with all; set by hand


@dataclass(frozen=True, eq=False)
class Link:
    """A map between two specimens: where p places are on both (p, 3), with the faces (m, 3) that join them.

    `valid` (p,): those that are on both; `trust` (p,): as of `Said`.
    """

    here: Floats
    there: Floats
    faces: Integers
    valid: Bools
    trust: Floats

    @classmethod
    def by(cls, answer: Correspondence) -> Link:
        """The link of a map."""
        said = Said.by(answer)
        return cls(answer.source.vertices, said.places, answer.source.faces, said.valid, said.trust)

    def onward(self, places: Floats, normals: Floats | None = None) -> Said:
        """Where places (q, 3) on the one specimen are on the other; normals (q, 3) tell parts that touch apart."""
        return self._carried(places, normals, self.here, self.there)

    def back(self, places: Floats, normals: Floats | None = None) -> Said:
        """Where places (q, 3) on the other are on the one."""
        return self._carried(places, normals, self.there, self.here)

    def _carried(self, places: Floats, normals: Floats | None, start: Floats, end: Floats) -> Said:
        known = self.faces[self.valid[self.faces].all(axis=1)]
        if not len(known):
            return Said(places, np.zeros(len(places), dtype=bool), np.ones(len(places)))
        face, weights = closest_facing(places, normals, start, known)
        corners = known[face]
        trust = (weights * self.trust[corners]).sum(axis=1)
        return Said(combination(weights, end[corners]), np.ones(len(places), dtype=bool), trust)


Load = Callable[[], Link | None]


def agreed(
    rows: Mapping[str, Fused], links: Mapping[tuple[str, str], Load], first: str, mesh: Callable[[str], Mesh]
) -> dict[str, Fused]:
    """Where the common points are on each specimen, once all that is linked with it was heard.

    Parameters
    ----------
    rows : mapping of str to Fused
        Where they are to begin with, also on `first`, from which the common points come: there they stay.
    links : mapping of (str, str) to function
        Of two specimens, what loads the link from the one to the other; None where that could not be made.
    first : str
        The first template.
    mesh : function
        From a name to the mesh of that specimen.

    Returns
    -------
    dict of str to Fused
        Which points there are, stays as it is; so do specimens without a link.
    """
    heard: dict[str, list[tuple[str, str]]] = {name: [] for name in rows if name != first}
    for pair in links:
        for name in pair:
            if name in heard and all(one in rows for one in pair):
                heard[name].append(pair)
    found = {**rows, first: rows[first]._replace(spread=np.zeros(len(rows[first].places)))}
    faces = mesh(first).faces
    for _ in range(ROUNDS):
        before = dict(found)
        normals = {name: vertex_normals(Mesh(one.places, faces)) for name, one in before.items()}
        for name, pairs in heard.items():
            said = [_account(name, pair, before, normals, links[pair]) for pair in _some(pairs)]
            known = [one for one in said if one is not None]
            if known:
                found[name] = fused(known, mesh(name), normals[name])._replace(valid=rows[name].valid)
    return found


def _account(
    name: str, pair: tuple[str, str], rows: Mapping[str, Fused], normals: Mapping[str, Floats], load: Load
) -> Said | None:
    """What one link says of where the points are on a specimen, from where they are on the other."""
    link = load()
    if link is None:
        return None
    other = pair[0] if name == pair[1] else pair[1]
    carry = link.onward if name == pair[1] else link.back
    said = carry(rows[other].places, normals[other])
    return said._replace(valid=said.valid & rows[other].valid)


def _some(pairs: list[tuple[str, str]]) -> list[tuple[str, str]]:
    if len(pairs) <= MOST:
        return pairs
    return [pairs[i] for i in np.linspace(0, len(pairs) - 1, MOST).round().astype(int).tolist()]
