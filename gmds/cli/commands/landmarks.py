"""gmds landmarks: landmarks of one mesh on another."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gmds.cli.group import Command
from gmds.cli.landmark_options import check_on, landmarks_of, space_option, specimen_option
from gmds.cli.matching_options import orientation_option
from gmds.cli.output import emit, json_option, known, note, progress_bar, seed_option
from gmds.cli.paths import OutputFile, OutputFolder
from gmds.cli.view_options import up_option

if TYPE_CHECKING:
    from geodesics import Mesh
    from gmds import Correspondence
    from gmds.landmarks.transfer import CarriedLandmarks
    from gmds.matching.attempts import Orientation

FILE = click.Path(path_type=Path)


class FileOrFolder(OutputFile):
    """A file that can be written, or a folder, which is made when it is needed."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The path; a file is checked as any other."""
        path = Path(value)
        is_folder = path.is_dir() or not path.suffix
        return OutputFolder().convert(value, param, ctx) if is_folder else super().convert(value, param, ctx)


@click.command(cls=Command, short_help="Carry landmarks from one mesh to another.")
@click.argument("source", type=FILE)
@click.argument("landmarks", type=FILE, required=False)
@click.argument("target", type=FILE, required=False)
@click.option("-o", "--output", required=True, type=FileOrFolder(), help="Where the landmarks go; see above.")
@click.option(
    "--template", type=FILE, help="The mesh that has landmarks, or its name in SOURCE, a folder of specimens."
)
@click.option("--landmarks", "template_landmarks", type=FILE, help="The landmarks of the template.")
@click.option("--workers", type=click.IntRange(min=1), help="Processes for a folder.  [default: one a processor]")
@click.option("--slide", type=click.Choice(["bending", "procrustes"]), help="Slide points of curves, in a folder.")
@up_option
@click.option("--map", "map_file", type=FILE, help="A map from SOURCE to TARGET; without it they are matched.")
@click.option("--known", type=FILE, help="Landmarks of TARGET that are known, to say how far off each is.")
@space_option
@specimen_option
@orientation_option
@seed_option
@json_option
def command(source: Path, landmarks: Path | None, target: Path | None, output: Path, **options: Any) -> None:
    """Match SOURCE to TARGET and find for every landmark of SOURCE its place on TARGET.

    \b
      gmds landmarks dog.ply dog.mrk.json wolf.off -o wolf.mrk.json
      gmds landmarks dog.ply dog.csv wolf.off -o wolf.csv --map map.npz
      gmds landmarks meshes --template dog.ply --landmarks dog.csv -o specimens --workers 1

    \b
    Landmark files, by their endings; the last line is read only:
      .csv             name,x,y,z or name,vertex (from 0) a line; written with the columns below
      .mrk.json .json  markups of 3D Slicer; the columns below go to the description
      .fcsv            fiducials of 3D Slicer, likewise
      .pp              picked points of MeshLab
      .tps .pts        coordinates alone (.pts: with names); .vts: a vertex a line, from 1
      .txt .xyz .particles .nts .dta .landmarkAscii, and tables of MorphoJ in a .csv or .txt

    Of a file with several specimens the one is taken that is named as SOURCE, or whose landmarks alone lie on it, or
    that --specimen names.

    \b
    For every landmark the table has
      moved       how far it was from the surface of SOURCE, in the units of the mesh
      confidence  The probability, from 0 to 1, that a point is sent to within 0.05 root areas of the target of where it
                  belongs; 0 where it has no counterpart. None for a map that was not rated, as one of an older release
      valid       whether it has a counterpart; where it has none the confidence is 0 and there is no place
      error       with --known: how far it is from the known place, along TARGET, over the square root of its area

    Landmarks without a counterpart, or without a place on SOURCE, keep their places in the list: missing or undefined
    in .mrk.json, NA in .csv, .tps, .pts and .vts, not active in .pp; a .fcsv cannot say so, they are left out.

    \b
    With --template and --landmarks, SOURCE is a folder of specimens, and -o a folder that gets
      landmarks.csv, landmarks_wide.csv  positions: a row a landmark, with its confidence; a row a specimen
      landmarks.tps                      the same, a block a specimen
      shapes.csv, shapes_wide.csv        superimposed (generalised Procrustes), sizes, distances from the mean shape
      to_look_at.csv                     who needs a look, and why
      sheet.png, pictures/               all specimens with their landmarks; doubtful ones are red
      maps/                              the maps, as `gmds batch` writes them: what is there is not made again
    With --slide the points of curves (.mrk.json) are semilandmarks: they slide along their curve, on the surface, until
    the bending energy or the Procrustes distance to the mean is least; the ends of an open curve stay.
    The template is the first in every table. A specimen that cannot be used is named and left out; the exit code is 3.
    """
    given, template, truth = (options.pop(name) for name in ("template_landmarks", "template", "known"))
    if template is not None:
        if given is None or landmarks is not None or options["map_file"] is not None or truth is not None:
            raise click.UsageError("a folder takes --template and --landmarks, and nothing else beside -o")
        from gmds.cli.landmark_collection import landmark_collection

        return landmark_collection(source, template, given, output, **options)
    if options.pop("slide") is not None:
        raise click.UsageError("--slide takes a folder of specimens, --template and --landmarks")
    if landmarks is None or target is None:
        raise click.UsageError("give SOURCE, LANDMARKS and TARGET; or a folder, --template and --landmarks")
    _one(source, landmarks, target, output, {**options, "truth": truth})


def _one(source: Path, landmarks: Path, target: Path, output: Path, options: dict[str, Any]) -> None:
    """The landmarks of one mesh on another."""
    from geodesics import read_mesh
    from gmds.landmarks.files import ending, paired, write_landmarks
    from gmds.landmarks.transfer import carry_landmarks, landmark_errors

    as_vertices = ending(output) == ".vts"  # before the matching: a wrong ending should not cost minutes
    meshes = read_mesh(source), read_mesh(target)
    space, as_json = options["space"], options["as_json"]
    marks = landmarks_of(landmarks, space, meshes[0], source, options["specimen"])
    check_on(marks, meshes[0], "source")  # likewise
    truth = options["truth"] and landmarks_of(options["truth"], space, meshes[1], target)
    if truth is not None:
        check_on(truth, meshes[1], "target")
        paired(marks, truth)
    answer = _map(*meshes, options["map_file"], options["orientation"], options["seed"])
    carried = carry_landmarks(answer, marks)
    moved = zip(carried.moved.tolist(), marks.defined, strict=True)
    columns: dict[str, list[object]] = {
        "moved": [float(f"{far:.4g}") if there else "NA" for far, there in moved],
        "confidence": ["NA" if value is None else round(value, 4) for value in known(carried.confidence)],
        "valid": carried.valid.astype(int).tolist(),
    }
    rows = _told(carried)
    errors = [] if truth is None else known(landmark_errors(carried, truth))
    if errors:
        columns["error"] = ["NA" if value is None else round(value, 5) for value in errors]
        rows = [row | {"error": value} for row, value in zip(rows, errors, strict=True)]
    write_landmarks(output, carried.landmarks(vertices=as_vertices), space, columns)
    if marks.missing:
        note(f"{len(marks.missing)} landmarks have no place on the source: {', '.join(marks.missing)}")
    summary: dict[str, Any] = {"landmarks": str(output), "status": answer.status.name, "meaning": answer.status.value}
    if found := [value for value in errors if value is not None]:
        summary["mean_error_x100"] = 100 * sum(found) / len(found)
    lines = {f"landmark {name}": row for name, row in zip(marks.distinct_names, rows, strict=True)}
    plain = {title: {key: row[key] for key in row if key != "name"} for title, row in lines.items()}
    emit(summary | ({"carried": rows} if as_json else plain), as_json)
    given = zip(marks.distinct_names, carried.valid, marks.defined, strict=True)
    lost = [name for name, valid, defined in given if defined and not valid]
    if lost:
        note(f"without a counterpart on the target: {', '.join(lost)}")
    if output.suffix.lower() == ".fcsv" and not carried.valid.all():
        note(f"{int((~carried.valid).sum())} landmarks without a place are left out, as .fcsv has no word for them")


def _map(source: Mesh, target: Mesh, map_file: Path | None, orientation: Orientation, seed: int) -> Correspondence:
    from gmds import Correspondence, match

    if map_file is not None:
        return Correspondence.load(map_file, source, target)
    with progress_bar("match") as progress:
        answer = match(source, target, orientation=orientation, rng=seed, progress=progress)
    for line in answer.meta.get("notes", ()):
        note(f"gmds: {line}")
    return answer


def _told(carried: CarriedLandmarks) -> list[dict[str, Any]]:
    """What is said of each landmark."""
    positions, vertices = carried.on_target.positions, carried.on_target.nearest_vertices()
    confidence = known(carried.confidence)
    return [
        {
            "name": name,
            "position": positions[i].tolist() if carried.valid[i] else None,
            "vertex": int(vertices[i]) if carried.valid[i] else None,
            "moved": float(carried.moved[i]) if carried.given.defined[i] else None,
            "confidence": confidence[i],
            "valid": bool(carried.valid[i]),
        }
        for i, name in enumerate(carried.names)
    ]
