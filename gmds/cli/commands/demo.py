"""gmds demo: the main job on built-in shapes with known truth."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gmds.cli.choices import chosen_distance
from gmds.cli.commands.match import map_summary
from gmds.cli.group import Command
from gmds.cli.output import emit, json_option, note, progress_bar, seed_option
from gmds.cli.view_options import write_views

if TYPE_CHECKING:
    from geodesics import SurfacePoints
    from gmds import Correspondence


@click.command(cls=Command, short_help="Match two built-in shapes and judge the map.")
@click.option("-o", "--output", default="gmds-demo", show_default=True, type=click.Path(path_type=Path), help="Folder.")
@click.option("--files", type=click.Path(path_type=Path), metavar="DIR", help="Write the files of the documentation.")
@seed_option
@json_option
def command(output: Path, files: Path | None, seed: int, as_json: bool) -> None:
    """Match two built-in shapes and judge the map against the truth.

    \b
      gmds demo
      gmds demo -o somewhere --json
      gmds demo --files .

    The shapes are an animal, and the same animal in another pose, with its head twice as big and triangulated anew.
    The error is the mean geodesic distance from the truth over the square root of the area, times 100. It is printed
    for maps that preserve diffusion distances in the metric of space ("regular") and in the scale-invariant metric,
    and for what `match` does unless told otherwise: try both, and end in a metric of its own. The folder then holds
    the meshes, the truth, this last map, a page to turn it in a browser, and a picture.

    With --files nothing is matched: DIR gets dog.ply, wolf.off, landmarks, values, textures and all else that the pages
    of the documentation speak of, so that what they show can be pasted. Files of these names are overwritten.
    """
    if files is not None:
        return _write_files(files, as_json)
    import time

    from geodesics import write_mesh
    from gmds import Correspondence, match
    from gmds.evaluation import errors_of_maps, protocol_subset
    from gmds.shapes import demo_pair

    output.mkdir(parents=True, exist_ok=True)
    note("making the shapes")
    source, target, truth = demo_pair()
    answers, seconds = {}, {}
    metrics = {"regular": "embedded", "scale_invariant": "scale-invariant", "match": None}
    for name, metric in metrics.items():
        distance = chosen_distance(metric, None)
        started = time.process_time()
        with progress_bar(f"matching ({name.replace('_', '-')})") as progress:
            answers[name] = match(source, target, distance=distance, rng=seed, progress=progress)
        seconds[name] = time.process_time() - started
    answer = answers["match"]
    write_mesh(source, output / "source.ply")
    write_mesh(target, output / "target.ply")
    Correspondence.from_points(source, truth).save(output / "truth.npz")
    answer.save(output / "map.npz")
    result = {name: {**_judged(answers[name], truth), "cpu_seconds": seconds[name]} for name in answers}
    counts = {"source": source.n_vertices, "target": target.n_vertices}
    pair = counts if as_json else f"{source.n_vertices} -> {target.n_vertices} vertices"
    emit({"pair": pair, **result, **map_summary(answer, as_json)}, as_json)
    chosen = protocol_subset(len(truth))
    errors = errors_of_maps(answer, truth[chosen], chosen)
    title, names = "An animal, and itself in another pose with a bigger head", ("source.ply", "target.ply")
    write_views(answer, output / "report.html", output / "picture.png", errors, title=title, names=names)
    note(f"map, meshes and truth are in {output}")


def _write_files(folder: Path, as_json: bool) -> None:
    from gmds.demo.files import write_files

    names = write_files(folder)
    emit({"folder": str(folder), "files": names if as_json else len(names)}, as_json)


def _judged(answer: Correspondence, truth: SurfacePoints) -> dict[str, Any]:
    from gmds.evaluation import geodesic_error, protocol_subset, summary

    chosen = protocol_subset(len(truth))
    errors = summary(geodesic_error(answer, truth[chosen], chosen))
    return {"error_x100": errors.mean, "within_0.05": errors.within_005, "within_0.10": errors.within_010}
