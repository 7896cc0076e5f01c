"""The seven classes of deformation of Table 1, each in five published strengths."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

from geodesics import Mesh, SurfacePoints
from geodesics.errors import BadArgument
from gmds.deformations.bending import bending
from gmds.deformations.global_scale import global_scale
from gmds.deformations.gluing import gluing
from gmds.deformations.holes import holes
from gmds.deformations.local_scaling import branch_log_scale, local_scaling
from gmds.deformations.noise import noise
from gmds.deformations.shot_noise import shot_noise

STRENGTHS = (1, 2, 3, 4, 5)  # as in Table 1


def three_numbers(text: str) -> tuple[float, ...]:
    """A direction from x:y:z; `ValueError` for another text."""
    x, y, z = map(float, text.split(":"))
    return x, y, z


# how a parameter is read from text, by its annotation, as the modules write it
_READERS: Mapping[str, Callable[[str], Any]] = {
    "int": int,
    "float": float,
    "int | None": int,
    "ArrayLike | None": three_numbers,
}


def local_scale(mesh: Mesh, factor: float = 1.6, *, count: int = 4, rng: int = 0) -> tuple[Mesh, SurfacePoints]:
    """Limbs grown and shrunk in turn: `local_scaling` by a `branch_log_scale`.

    Parameters
    ----------
    mesh : Mesh
        The mesh, of n vertices.
    factor : float
        Scale at the tips, or its inverse.
    count : int
        Limbs.
    rng : int
        Seed of the random choices.

    Returns
    -------
    mesh : Mesh
        The deformed mesh.
    truth : SurfacePoints
        n points of it, one per vertex of the old mesh.
    """
    mesh = Mesh.from_object(mesh)
    return local_scaling(mesh, branch_log_scale(mesh, factor, count=count, rng=rng))


@dataclass(frozen=True)
class Kind:
    """A class of deformations of Table 1.

    Parameters
    ----------
    function : callable
        (Mesh, **parameters) -> (Mesh, SurfacePoints).
    table : mapping
        The value of each parameter at the strengths 1 to 5.
    """

    function: Callable[..., tuple[Mesh, SurfacePoints]]
    table: Mapping[str, tuple[float, ...]]

    def parameters(self, strength: int) -> dict[str, float]:
        """The parameters at a strength from 1 to 5; `ValueError` for another."""
        if strength not in STRENGTHS:
            raise BadArgument(f"strength must be one of {', '.join(map(str, STRENGTHS))}, not {strength}")
        return {name: values[strength - 1] for name, values in self.table.items()}

    @property
    def types(self) -> dict[str, Callable[[str], Any]]:
        """How the parameters are read from text, by name: int, float, or `three_numbers` for a direction."""
        parameters = inspect.signature(self.function).parameters.values()
        return {p.name: _READERS[p.annotation] for p in parameters if p.name != "rng" and p.annotation in _READERS}

    def apply(self, mesh: Mesh, rng: int, **parameters: Any) -> tuple[Mesh, SurfacePoints]:
        """The deformed mesh and the truth; `rng` is left out where nothing is random."""
        seed = {"rng": rng} if "rng" in inspect.signature(self.function).parameters else {}
        return self.function(mesh, **parameters, **seed)


KINDS: Mapping[str, Kind] = MappingProxyType(
    {
        # degrees, limbs
        "isometry": Kind(bending, {"angle": (10, 20, 30, 40, 50), "count": (4, 4, 4, 4, 4)}),
        # pairs of vertices that become one
        "topology": Kind(gluing, {"count": (1, 2, 3, 4, 5)}),
        # vertices cut out, each with its ring of faces
        "micro-holes": Kind(holes, {"count": (8, 16, 24, 32, 40), "radius": (0, 0, 0, 0, 0)}),
        # farther and farther from 1, larger and smaller in turn
        "scale": Kind(global_scale, {"factor": (1.25, 0.65, 2.0, 0.35, 4.0)}),
        # ratio of lengths after and before at the tip of a limb, limbs
        "local-scale": Kind(local_scale, {"factor": (1.2, 1.4, 1.6, 1.8, 2.0), "count": (4, 4, 4, 4, 4)}),
        # standard deviation, in mean edge lengths
        "noise": Kind(noise, {"strength": (0.05, 0.1, 0.15, 0.2, 0.25)}),
        # mean edge lengths, share of the vertices
        "shot-noise": Kind(shot_noise, {"strength": (2, 2, 2, 2, 2), "share": (0.004, 0.008, 0.012, 0.016, 0.02)}),
    }
)


def deformed(mesh: Mesh, kind: str, strength: int, rng: int = 0) -> tuple[Mesh, SurfacePoints]:
    """The mesh under one class of deformations of Table 1, and its truth.

    Parameters
    ----------
    mesh : Mesh
        The mesh, of n vertices.
    kind : str
        One of isometry, topology, micro-holes, scale, local-scale, noise and shot-noise.
    strength : int
        From 1 to 5.
    rng : int
        Seed for limbs, places and noise; the same seed at another strength chooses the same ones.

    Returns
    -------
    mesh : Mesh
        The deformed mesh.
    truth : SurfacePoints
        n points of it, one per vertex of the old mesh.

    Raises
    ------
    ValueError
        For an unknown kind or strength.

    See Also
    --------
    gmds.deformations.compose : Several deformations as one.
    """
    mesh = Mesh.from_object(mesh)
    if kind not in KINDS:
        raise BadArgument(f"kind must be one of {', '.join(KINDS)}, not {kind!r}")
    return KINDS[kind].apply(mesh, rng, **KINDS[kind].parameters(strength))
