"""Measured surfaces on disk, under a digest of all that goes into them: whoever asks second finds them there."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from geodesics import Mesh
from geodesics.arrays import Integers
from geodesics.threads import on_one_blas_thread
from gmds.batch import surface_file
from gmds.batch.collection import Shape
from gmds.batch.records import ShapeRecord
from gmds.batch.surface_file import COPY, read_surface, write_surface
from gmds.errors import SurfaceFileError
from gmds.maps.npz_format import fingerprint
from gmds.matching.large_surfaces import LARGE, WORKING, coarse
from gmds.provenance import versions
from gmds.spectral import refinement
from gmds.spectral import sample_maps as upsampling
from gmds.surface import measured as surface
from gmds.surface.measured import Surface, measure
from gmds.surface.view import SAMPLING_FUNCTIONS

# what a stored surface depends on besides the mesh
PARAMETERS = {
    "format": surface_file.VERSION,
    "versions": versions(),
    "functions": (surface.EIGENFUNCTIONS, surface.ROUGH_FUNCTIONS, SAMPLING_FUNCTIONS),
    "metrics": (surface.EXPONENTS, surface.SMOOTHING, surface.DETAIL),
    "copies": (LARGE, WORKING),
    "samples": (upsampling.TARGET_SAMPLES, refinement.CARRIERS, refinement.GOALS),
}


@dataclass(frozen=True)
class Store:
    """A folder with a file for every measured surface, or for its copy where that is matched, unless `whole`."""

    folder: Path
    whole: bool = False

    def keep(self, shape: Shape, mirrored: bool = False) -> ShapeRecord:
        """Measure a shape and write it, unless that was done before; with its mirror image where that is asked for.

        Raises `MeshError`, `FormatError`, `OSError`, `EigensolverFailed`.
        """
        mesh = shape.mesh()
        print_ = fingerprint(mesh)
        key = digest(print_["sha256"], self.whole)
        kept = [self._kept(mesh, key, reflected) for reflected in ((False, True) if mirrored else (False,))]
        usable = len(np.unique(read_surface(self._path(key, False)).mesh.faces))
        return ShapeRecord(
            shape.name, print_["vertices"], print_["faces"], usable, print_["sha256"], key, kept=all(kept)
        )

    def surface(self, record: ShapeRecord) -> Surface:
        """A stored surface. Raises `SurfaceFileError` (E215) when its file was damaged since; the next run mends it."""
        found = read_surface(self._path(record.key, False))
        if self._path(record.key, True).exists():
            vars(found if self.whole else coarse(found))["reflection"] = read_surface(self._path(record.key, True))
        return found

    def outside(self, record: ShapeRecord, count: int) -> tuple[Mesh, Integers]:
        """The mesh of a stored surface, and `count` of its vertices evenly spread, without all the rest."""
        with np.load(self._path(record.key, False), allow_pickle=False) as archive:
            copy = COPY if f"{COPY}version" in archive else ""
            most = max(
                (name for name in archive if name.startswith(f"{copy}view{len(surface.EXPONENTS)}_samples_")),
                key=lambda name: int(name.rpartition("_")[2]),
            )
            samples = archive[most][:count]
            if copy:  # which lies where the largest part does
                places = archive[f"{COPY}original_vertices"][samples]
                used = np.unique(archive["mesh_faces"])
                samples = used[cKDTree(archive["mesh_vertices"][used]).query(places)[1]]
            return Mesh(archive["original_vertices"], archive["original_faces"]), samples

    def _kept(self, mesh: Mesh, key: str, reflected: bool) -> bool:
        path = self._path(key, reflected)
        try:
            read_surface(path)
            return True
        except (SurfaceFileError, FileNotFoundError):
            _write(path, mesh, reflected, self.whole)
            return False

    def _path(self, key: str, reflected: bool) -> Path:
        return self.folder / f"{key}{'-mirrored' if reflected else ''}.npz"


def digest(sha256: str, whole: bool = False) -> str:
    """The name of a stored surface: a digest of its mesh, the parameters of measuring, and the versions of it all."""
    told = json.dumps({**PARAMETERS, "mesh": sha256, "whole": whole}, sort_keys=True)
    return hashlib.sha256(told.encode("utf-8")).hexdigest()[:32]


@on_one_blas_thread
def _write(path: Path, mesh: Mesh, reflected: bool, whole: bool) -> None:
    measured = measure(mesh)
    copy = measured if whole else coarse(measured)
    if not reflected:
        write_surface(path, measured, whole=whole)
    elif copy is measured:
        write_surface(path, measure(mesh, reflected=True), whole=True)
    else:
        write_surface(path, copy.reflection)
