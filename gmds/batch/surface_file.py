"""A measured surface on disk: everything about it that takes long to compute, readable with numpy alone.

Members: `original_*`, `mesh_*`: vertices and faces of the mesh, and of its largest part turned and resized;
`face_index`; of a mesh with faults `given_*`, of which the original is the clean copy, and `clean_*`, how they
correspond; for each view (`view0`, `view1`, `view2`) its mass, eigenvalues, eigenfunctions and cells of farthest
points; `curvature`; `outline_*`: vertices, faces and origin of the simplified mesh, unless it is the whole;
`reversing`, if there is such a self-map. Of a surface that is matched as a copy with fewer vertices all that comes
after the correspondence is that of the copy, with its meshes, as `copy_*`. Numbers keep all their bits: surfaces from
files are matched as the meshes are.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geodesics import Mesh, Spectrum
from geodesics.caching import keep
from geodesics.io import atomic_write
from geodesics.repair.cleaning import CleanCopy
from geodesics.sampling import Cells
from gmds.errors import SurfaceFileError
from gmds.files.npz import read_npz
from gmds.matching.large_surfaces import coarse
from gmds.matching.pair import reversing, simplified
from gmds.registration.deformable import DeformableMesh
from gmds.spectral.refinement import CARRIERS, GOALS
from gmds.spectral.sample_maps import TARGET_SAMPLES
from gmds.surface.measured import EXPONENTS, Surface
from gmds.surface.view import View

VERSION = 5  # of the layout; a file of another is measured again

COPY = "copy_"  # begins the names of what belongs to the copy

Arrays = dict[str, NDArray[Any]]


def write_surface(path: str | os.PathLike[str], surface: Surface, *, whole: bool = False) -> None:
    """Compute what `match` will want to know of the surface, and write it atomically; raises `OSError`.

    `whole`: of the surface itself, as `match` in a given distance does, also where it would else take a copy.
    """
    copy = surface if whole else coarse(surface)
    found = _base(surface)
    found |= _measured(surface) if copy is surface else {f"{COPY}{k}": a for k, a in _arrays(copy).items()}
    with atomic_write(path) as stream:
        np.savez(stream, **found)  # type: ignore[arg-type]


def read_surface(path: str | os.PathLike[str]) -> Surface:
    """The surface in a file. Raises `SurfaceFileError` (E215) when it is not whole, `OSError` when it is not there."""
    path = Path(path)
    try:
        return _surface(read_npz(path))
    except (ValueError, KeyError, IndexError, TypeError) as error:
        raise SurfaceFileError(f"{path} is not a readable surface ({error}); remove it") from error


def _arrays(surface: Surface) -> Arrays:
    return _base(surface) | _measured(surface)


def _base(surface: Surface) -> Arrays:
    """The meshes, and how they belong together."""
    found: Arrays = {"version": np.array(VERSION), "face_index": surface.face_index}
    for name, mesh in (("original", surface.original), ("mesh", surface.mesh)):
        found |= {f"{name}_vertices": mesh.vertices, f"{name}_faces": mesh.faces}
    return found if surface.clean is None else found | _clean_arrays(surface.clean)


def _measured(surface: Surface) -> Arrays:
    """What takes long to compute."""
    found: Arrays = {}
    surface.regular.samples(GOALS)
    surface.regular.cells(CARRIERS)
    for number, view in enumerate(surface.views):
        view.samples(TARGET_SAMPLES)
        found |= _view_arrays(f"view{number}", view)
    found["curvature"] = surface.squashed_curvature
    few = simplified(surface)
    if few.mesh is not surface.mesh:
        found |= {"outline_vertices": few.mesh.vertices, "outline_faces": few.mesh.faces, "outline_origin": few.origin}
    turned = reversing(surface)
    return found if turned is None else found | {"reversing": turned}


def _clean_arrays(clean: CleanCopy) -> Arrays:
    given = {"given_vertices": clean.given.vertices, "given_faces": clean.given.faces}
    changes = np.array(clean.changes, dtype=np.str_)
    found = {**given, "clean_vertex": clean.vertex, "clean_face": clean.face, "clean_changes": changes}
    return found if clean.corners is None else found | {"clean_corners": clean.corners}


def _clean(arrays: Arrays, mesh: Mesh) -> CleanCopy | None:
    if "given_vertices" not in arrays:
        return None
    given = Mesh(arrays["given_vertices"], arrays["given_faces"])
    changes = tuple(str(one) for one in arrays["clean_changes"])
    return CleanCopy(given, mesh, arrays["clean_vertex"], arrays["clean_face"], changes, arrays.get("clean_corners"))


def _view_arrays(name: str, view: View) -> Arrays:
    spectrum = view.spectrum
    found = {"mass": spectrum.mass, "values": spectrum.eigenvalues, "functions": spectrum.eigenfunctions}
    for count, cells in view.sampled.items():
        found |= {f"{part}_{count}": array for part, array in cells._asdict().items()}
    return {f"{name}_{part}": array for part, array in found.items()}


def _surface(arrays: Arrays) -> Surface:
    if arrays["version"] != VERSION:
        raise ValueError(f"version {arrays['version']}, not {VERSION}")
    original, mesh = (Mesh(arrays[f"{name}_vertices"], arrays[f"{name}_faces"]) for name in ("original", "mesh"))
    surface = Surface(original, mesh, arrays["face_index"], clean=_clean(arrays, original))
    if f"{COPY}version" in arrays:
        keep(coarse, surface, _surface({k.removeprefix(COPY): a for k, a in arrays.items() if k.startswith(COPY)}))
        return surface
    views = tuple(_view(arrays, f"view{i}", mesh) for i in range(sum(f"view{i}_mass" in arrays for i in range(9))))
    for exponent, view in zip(EXPONENTS, views[:-1], strict=True):
        keep(Surface.curved, surface, view, exponent)
    vars(surface)["regular"] = views[-1]
    vars(surface)["squashed_curvature"] = arrays["curvature"]
    keep(simplified, surface, _simplified(arrays, surface))
    keep(reversing, surface, arrays.get("reversing"))
    return surface


def _view(arrays: Arrays, name: str, mesh: Mesh) -> View:
    view = View(mesh, Spectrum(mesh, *(arrays[f"{name}_{part}"] for part in ("mass", "values", "functions"))))
    start = f"{name}_samples_"
    for count in sorted(int(key.removeprefix(start)) for key in arrays if key.startswith(start)):
        view.sampled[count] = Cells(*(arrays[f"{name}_{part}_{count}"] for part in Cells._fields))
    return view


def _simplified(arrays: Arrays, surface: Surface) -> DeformableMesh:
    if "outline_origin" not in arrays:
        return DeformableMesh.of(surface)
    origin = arrays["outline_origin"]
    mesh = Mesh(arrays["outline_vertices"], arrays["outline_faces"])
    return DeformableMesh(mesh, origin, surface.squashed_curvature[origin])
