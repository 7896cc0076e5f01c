"""What docs/gallery.py draws of each example: from the names that its script has given, one picture."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from drawn_matrices import Names, bounds, matrices

import geodesics
from gmds.deformations import achieved_log_scale
from gmds.pictures import write_picture, write_values

PIXELS = 300  # of the longer side of a surface


def called(metric: Callable[..., Any]) -> str:
    """A metric in words."""
    return {"embedded": "metric of space"}.get(metric.__name__, f"{metric.__name__.replace('_', '-')} metric")


def distances(path: Path, example: Names) -> None:
    """01: distances from the nose, in two metrics, as shares of the largest."""
    mesh, panels = example["mesh"], []
    for metric in (geodesics.embedded, geodesics.scale_invariant):
        field = geodesics.GeodesicDistance(metric(mesh)).field(example["start"])[0]
        panels.append((called(metric), mesh, field / field.max()))
    write_values(path, panels, pixels=PIXELS, isolines=True, label="distance / the largest")


def a_map(path: Path, example: Names) -> None:
    """02: a map, and how much in doubt it is."""
    write_picture(path, example["answer"], pixels=PIXELS)
    write_picture(path.with_name("demo.png"), example["answer"], names=("dog.ply", "wolf.off"))


def before_and_after(path: Path, example: Names) -> None:
    """03: geodesic distances from one sample, before and after limbs grew and shrank, in two metrics."""
    panels = []
    for metric in (geodesics.embedded, geodesics.scale_invariant):
        for when in ("before", "after"):
            mesh = example[when]
            sample = geodesics.SurfacePoints.at_vertices(mesh, example["samples"][:1])
            field = example["distances"]["geodesic"](metric(mesh)).field(sample)[0]
            panels.append((f"{called(metric)}, {when}", mesh, field / field.mean()))
    write_values(path, panels, pixels=PIXELS, columns=2, isolines=True, label="distance / the mean")


def cells(path: Path, example: Names) -> None:
    """04: Voronoi cells, in the metric that the script looked at last."""
    meshes = [(when, example[when], found) for when, found in zip(("before", "after"), example["cells"], strict=True)]
    write_values(path, meshes, labels=True, title=called(example["metric"]), pixels=PIXELS)


def signatures(path: Path, example: Names) -> None:
    """05: logarithms of heat kernel signatures at one time, in the metric that the script looked at last."""
    signature = example["signatures"]["heat kernel"]
    found = [np.log(signature(spectrum)[:, 4]) for spectrum in example["spectra"]]
    panels = [(when, example[when], values) for when, values in zip(("before", "after"), found, strict=True)]
    write_values(path, panels, title="scale-invariant metric", pixels=PIXELS, label="log of the heat kernel signature")


def map_and_errors(path: Path, example: Names) -> None:
    """06: the map with landmarks, and its errors."""
    write_picture(path, example["answer"], example["errors"], pixels=PIXELS)


def embedded_samples(path: Path, example: Names) -> None:
    """07: cells of the samples, and of the points of the target where they were placed."""
    ours = example["d_source"].field(example["problem"].source_points).argmin(axis=0)
    theirs = example["d_target"].field(example["start"]).argmin(axis=0)
    panels = [("samples", example["source"], ours), ("their places", example["target"], theirs)]
    write_values(path, panels, labels=True, pixels=PIXELS)


def arc_lengths(path: Path, example: Names) -> None:
    """08: distances by the arc length of Gaussian curvature, which neither size nor bending changes."""
    panels = []
    for name, mesh in example["surfaces"].items():
        middle = geodesics.SurfacePoints.at_vertices(mesh, [60 * 30 + 30])
        field = geodesics.GeodesicDistance(example["lengths"]["gaussian_curvature"](mesh)).field(middle)[0]
        panels.append((name, mesh, field))
    write_values(path, panels, pixels=PIXELS * 2 // 3, isolines=True, label="arc length of K")


def labels(path: Path, example: Names) -> None:
    """09: labels of the target, carried to the source."""
    names = np.unique(example["parts"])
    panels = [("target", example["target"], example["parts"]), ("source", example["source"], example["labels"])]
    numbered = [(which, mesh, np.searchsorted(names, values)) for which, mesh, values in panels]
    write_values(path, numbered, labels=True, pixels=PIXELS)


def eigenfunctions(path: Path, example: Names) -> None:
    """10: the first eigenfunction, in the metric that the script looked at last."""
    title = called(example["metric"])
    write_values(path, example["panels"], title=title, pixels=PIXELS, signed=True, label="first eigenfunction")


def part_and_whole(path: Path, example: Names) -> None:
    """11: the map of the whole to the part; that of the part to the whole is the picture of README."""
    write_picture(path, example["back"], names=("whole", "part"), pixels=PIXELS)
    shutil.copy("parts.png", path.with_name("parts.png"))


def canonical_forms(path: Path, example: Names) -> None:
    """12: both poses, and their forms in the metric of space and in that of (2.1)."""
    panels = [(pose, mesh, mesh.vertices[:, 0]) for pose, mesh in example["poses"].items()]
    for (exponent, method), pair in example["forms"].items():
        if method == "least squares":
            name = "space" if exponent == 0 else "|K| g"
            first = pair[0].positions @ np.linalg.svd(pair[0].positions, full_matrices=False)[2].T
            second = pair[1].positions
            u, _, vt = np.linalg.svd(second[example["partner"]].T @ first)
            for (pose, mesh), positions in zip(example["poses"].items(), (first, second @ u @ vt), strict=True):
                panels.append((f"{name}, {pose}", outside_out(positions, mesh), mesh.vertices[:, 0]))
    write_values(path, panels, pixels=PIXELS, columns=2, label="x of the animal")


def outside_out(positions: Any, mesh: geodesics.Mesh) -> geodesics.Mesh:
    """The mesh with its vertices elsewhere, its faces turned where that left them inside out."""
    volume = np.linalg.det(positions[mesh.faces]).sum()
    return geodesics.Mesh(positions, mesh.faces if volume > 0 else mesh.faces[:, ::-1])


def rough_and_improved(path: Path, example: Names) -> None:
    """14: how far the target reaches, carried by the rough map and by the improved one."""
    height = example["target"].vertices[:, 0]
    carried = [("rough", example["rough"]), ("spectral GMDS", example["placed"].points), ("truth", example["true"])]
    panels = [(name, example["source"], points.interpolate(height)) for name, points in carried]
    write_values(path, panels, pixels=PIXELS, isolines=True, label="x of the target")


def caricatures(path: Path, example: Names) -> None:
    """16: the animal and its caricatures, coloured by the logarithm of the growth of lengths."""
    drawn = example["caricatures"].items()
    panels = [(f"gamma {exponent:g}", one, achieved_log_scale(example["mesh"], one)) for exponent, one in drawn]
    write_values(path, panels, pixels=PIXELS, signed=True, label="log of the growth of lengths")


def weighted_samples(path: Path, example: Names) -> None:
    """17: the weight of the nearest sample, and the surface that lacks a part."""
    target = example["target"]
    panels = [("weights", example["source"], example["weights"]), ("target", target, np.ones(target.n_vertices))]
    write_values(path, panels, pixels=PIXELS, label="weight")


def specimen(path: Path, _: Names) -> None:
    """The morphometrics script has drawn its specimens itself; one of them, in fewer colours."""
    shutil.copy(Path("morphometrics") / "pictures" / "long_legs.png", path)
    in_fewer_colours(path)


def in_fewer_colours(path: Path) -> None:
    """A picture with 128 colours, a third as large."""
    from PIL import Image

    image = Image.open(path).convert("RGB")
    image.quantize(128).save(path, optimize=True)


DRAWN: dict[str, Callable[[Path, Names], None]] = {
    "01_read_and_measure": distances,
    "02_match_two_shapes": a_map,
    "03_regular_and_scale_invariant": before_and_after,
    "04_distances_and_voronoi": cells,
    "05_signatures": signatures,
    "06_landmarks": map_and_errors,
    "07_gmds_by_hand": embedded_samples,
    "08_arc_lengths": arc_lengths,
    "09_transfer": labels,
    "10_eigenfunctions": eigenfunctions,
    "11_parts": part_and_whole,
    "12_canonical_forms": canonical_forms,
    "13_functional_maps": matrices,
    "14_spectral_gmds": rough_and_improved,
    "15_how_far_apart": bounds,
    "16_caricature": caricatures,
    "17_partial_gmds": weighted_samples,
    "morphometrics/landmark_specimens": specimen,
}
