"""The pictures of docs/gallery.md: each example is run, and what it computed is drawn; some minutes for all of them.

Those at the head of README and of other pages are among them: demo.png and parts.png.

python docs/gallery.py                  # all, into docs/gallery
python docs/gallery.py 04 10            # some
python docs/gallery.py 04 -o FOLDER     # elsewhere
"""

from __future__ import annotations

import argparse
import contextlib
import io
import os
import runpy
import shutil
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import geodesics
from gmds.deformations import achieved_log_scale
from gmds.pictures import write_picture, write_values

ROOT = Path(__file__).resolve().parents[1]
PICTURES = ROOT / "docs" / "gallery"
LARGE = 130_000  # bytes of a picture that is drawn in fewer colours; set by hand
PIXELS = 300  # of the longer side of a surface

Names = dict[str, Any]  # what a script has computed, by the names it gave


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


def matrices(path: Path, example: Names) -> None:
    """13: functional maps and self functional maps as images."""
    shown = {f"{name}\nC": found.matrix for name, found in example["maps"].items()}
    names = ("self, standing", "self, walking")
    shown |= {f"{name}\n|C|": np.abs(c) for name, c in zip(names, example["signatures"], strict=True)}
    figure = Figure(figsize=(11, 2.3), dpi=80, layout="constrained")
    for axis, (name, matrix) in zip(figure.subplots(1, len(shown)), shown.items(), strict=True):
        limit = np.abs(matrix).max()
        colours = {"cmap": "RdBu_r", "vmin": -limit} if name.endswith("\nC") else {"cmap": "cividis", "vmin": 0}
        axis.imshow(matrix, vmax=limit, interpolation="nearest", **colours)
        axis.set_title(name, fontsize=10)
        axis.set_xticks([])
        axis.set_yticks([])
    figure.savefig(path)


def rough_and_improved(path: Path, example: Names) -> None:
    """14: how far the target reaches, carried by the rough map and by the improved one."""
    height = example["target"].vertices[:, 0]
    carried = [("rough", example["rough"]), ("spectral GMDS", example["placed"].points), ("truth", example["true"])]
    panels = [(name, example["source"], points.interpolate(height)) for name, points in carried]
    write_values(path, panels, pixels=PIXELS, isolines=True, label="x of the target")


def bounds(path: Path, example: Names) -> None:
    """15: upper bounds of the Gromov-Wasserstein distance as matrices."""
    names, most = list(example["shapes"]), max(matrix.max() for matrix in example["apart"].values())
    figure = Figure(figsize=(8.5, 3.2), dpi=80, layout="constrained")
    for (metric, matrix), axis in zip(example["apart"].items(), figure.subplots(1, 2), strict=True):
        axis.imshow(matrix, cmap="cividis", vmin=0, vmax=most)
        axis.set_title(f"Gromov-Wasserstein at most, {metric}", fontsize=10)
        axis.set_xticks([])
        axis.set_yticks(range(len(names)), names, fontsize=10)
        for (i, j), value in np.ndenumerate(matrix):
            axis.text(j, i, f"{value:.3f}", ha="center", va="center", color="black" if value > most / 2 else "white")
    figure.savefig(path)


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


def draw(name: str, folder: Path) -> Path:
    """Run an example in an empty folder, and draw what it computed."""
    script = ROOT / "examples" / f"{name}.py"
    picture = folder.resolve() / f"{script.stem}.png"
    with tempfile.TemporaryDirectory() as empty, contextlib.chdir(empty), contextlib.redirect_stdout(io.StringIO()):
        sys.argv, path = [script.name, "morphometrics"], list(sys.path)
        sys.path.insert(0, str(script.parent))
        try:
            DRAWN[name](picture, runpy.run_path(str(script), run_name="__main__"))
        finally:
            sys.path[:] = path
    if picture.stat().st_size > LARGE:
        in_fewer_colours(picture)
    return picture


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help="how the names of examples begin; all, if none is given")
    parser.add_argument("-o", "--output", type=Path, default=PICTURES)
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    for name in DRAWN:
        if not options.names or name.startswith(tuple(options.names)):
            print(os.path.relpath(draw(name, options.output)))


if __name__ == "__main__":
    main()
