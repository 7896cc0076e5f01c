"""Remeshed FAUST and TOSCA: `*.off`, `corres/*.vts` with canonical points, `test_pairs.txt`."""

from __future__ import annotations

from pathlib import Path

from geodesics.mesh import Mesh
from geodesics.points import SurfacePoints
from gmds.benchmarking.pairs import Pair, Truth, listed
from gmds.benchmarking.truth_files import BadTruth, points_at, read_vts


def remeshed(folder: Path, listing: Path | None = None) -> list[Pair] | None:
    """The pairs of a folder with `corres/`; None for another."""
    if not (folder / "corres").is_dir():
        return None
    return [_pair(folder, *names) for names in listed(listing or folder / "test_pairs.txt", 2)]


def _pair(folder: Path, source: str, target: str) -> Pair:
    def truth(source_mesh: Mesh, target_mesh: Mesh) -> Truth:
        paths = [folder / "corres" / f"{name}.vts" for name in (source, target, f"{target}.sym")]
        from_, to = read_vts(paths[0]), read_vts(paths[1])
        flipped = read_vts(paths[2]) if paths[2].exists() else None
        if len(from_) != len(to) or (flipped is not None and len(flipped) != len(to)):
            raise BadTruth(
                f"{paths[0]} and {paths[1]} (or its .sym) differ in length: they must share canonical points"
            )
        return from_, SurfacePoints.at_vertices(target_mesh, to), points_at(target_mesh, flipped)

    return Pair(f"{source}-{target}", folder / f"{source}.off", folder / f"{target}.off", truth)
