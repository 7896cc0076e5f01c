"""gmds transfer: what is on the target of a map, carried to its source."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gmds.cli.carried_values import KINDS, METHODS, as_colours, carried_values, refuse_labels
from gmds.cli.directions import upwards
from gmds.cli.fields import FILE, picture_option, write_field
from gmds.cli.group import Command
from gmds.cli.looks import is_scene, look_carried, own_look_of, scene_carried, tell_what_is_lost, tell_what_is_rounded
from gmds.cli.looks_drawn import draw_looks, draw_values
from gmds.cli.output import emit, json_option, note, valid_count
from gmds.cli.paths import EndingIn
from gmds.cli.view_options import up_option

if TYPE_CHECKING:
    from gmds import Correspondence
    from gmds.appearance import Polygons


MESHES = (".obj", ".ply", ".glb", ".vtp")
VALUES = EndingIn(".npy", ".csv", ".txt", written=False)
IMAGE = EndingIn(".png", ".jpg", ".jpeg", written=False)


@click.command(cls=Command, short_help="Carry values, colours or a texture along a map.")
@click.argument("map_file", metavar="MAP", type=FILE)
@click.option("--source", required=True, type=FILE, help="Mesh the map starts on, which gets the values.")
@click.option("--target", required=True, type=FILE, help="Mesh the map ends on, which has them.")
@click.option("--values", type=VALUES, help="A row for every vertex of the target.")
@click.option("--kind", type=click.Choice(KINDS), help="What the values are.  [default: numbers]")
@click.option("--labels", is_flag=True, help="The same as --kind labels.")
@click.option("--most", type=click.IntRange(1), metavar="BONES", help="Keep the heaviest weights of a vertex.")
@click.option("--texture", type=IMAGE, help="Image that an OBJ has coordinates of.")
@click.option("--look", type=FILE, help="File with colours or texture, when that of the target has none; same faces.")
@click.option("--rig", is_flag=True, help="Carry skeleton, weights and shapes to morph to, .glb to .glb.")
@click.option(
    "--own-look/--carried-look",
    default=None,
    help="With --rig: keep materials and textures of a .glb SOURCE.  [default: where it has some]",
)
@click.option(
    "-o", "--output", required=True, type=EndingIn(".npy", ".csv", *MESHES), help="Where the carried values go."
)
@picture_option
@up_option
@json_option
def command(map_file: Path, source: Path, target: Path, output: Path, as_json: bool, **options: Any) -> None:
    """Carry what is on the target along the map in MAP, to the source.

    \b
      gmds transfer map.npz --source dog.ply --target wolf.off --values heights.csv -o carried.csv
      gmds transfer map.npz --source dog.ply --target wolf.off --values parts.txt --labels -o parts.vtp
      gmds transfer map.npz --source dog.ply --target wolf.off --values bones.npy --kind weights -o skin.npy
      gmds transfer map.npz --source dog.ply --target wolf.off --look wolf.glb -o dog.glb
      gmds transfer map.npz --source dog.ply --target wolf.obj --texture wolf.png -o dog.obj
      gmds transfer map.npz --source dog.ply --target wolf.off --look wolf.glb --rig -o dog-rigged.glb

    \b
    Values are
      numbers  interpolated on the triangle where a vertex goes
      labels   names, numbers or words: a vertex gets the one with the largest weight there, never a mean
      weights  of bones, a column each: interpolated, rows kept summing to 1; where no bone holds most of a place, 0
      vectors  three columns, directions in space: turned as the map turns the surface, lengths kept
      colours  three or four columns, 0 to 255

    A .npy holds an array with a row for every vertex; text has a line for every vertex, entries with commas (.csv) or
    blanks (.txt) between them, and perhaps a header, whose first column may be `vertex`, as in the files that gmds
    writes. Vertices without a counterpart (not valid in the map) get the values at the point that the map holds for
    them all the same. The picture shows colours and textures as they are, all bones by a colour each, mixed as their
    weights are, and else the first column.

    The output is an array (.npy), a table (.csv), or the source with the values on its vertices: .ply and .vtp keep
    all of them (words by number, which is told), .obj and .glb colours. Without --values the look of the target's file
    is carried: its vertex colours (.ply, .obj, .glb), or its texture, to an .obj with a .mtl and a .png, or to a .glb;
    to an .obj also the names of objects, groups and materials.
    From .glb to .glb parts and materials are carried with their names and images; with --rig so are the skeleton, moved
    into the source, weights (four to a vertex at most; --most) and shapes to morph to, and a source that has materials
    of its own keeps them (--carried-look takes those of the target). What is not carried is told.
    --kind weights carries weights of bones from a table.
    Polygons of the source's file stay what they were in .obj, .ply and .vtp.
    Where the texture is cut, faces whose corners go to different sides take all of it from one side, stretched up to
    the seam; their number is told.
    A .glb with a texture is cut open along its seams; `gmds match` welds a copy of it by itself.
    """
    from geodesics import read_mesh
    from gmds import Correspondence
    from gmds.appearance import polygons_of

    options["up"] = upwards(options["up"], str(source))
    kind = "labels" if options["labels"] else options["kind"] or "numbers"
    if options["labels"] and options["kind"] not in (None, "labels"):
        raise click.UsageError("--labels is --kind labels; give one of them")
    is_mesh = output.suffix.lower() in MESHES
    if options["values"] is None and not is_mesh:
        raise click.UsageError(f"give --values, or an output that ends in {', '.join(MESHES)}")
    meshes = read_mesh(source), read_mesh(target)
    answer = Correspondence.load(map_file, *meshes)
    polygons = polygons_of(source, meshes[0]) if is_mesh else None
    result = {"file": str(output), "vertices": len(answer.points)}
    look, kept = options["look"] or target, False
    if options["rig"] and (options["values"] or output.suffix.lower() != ".glb" or not is_scene(look)):
        raise click.UsageError("--rig carries what is in a .glb to a .glb, without --values")
    if options["own_look"] is not None and not options["rig"]:
        raise click.UsageError("--own-look and --carried-look are for --rig")
    own = own_look_of(source, options["own_look"]) if options["rig"] else None
    if options["values"] is None:
        if options["kind"] or options["labels"]:
            raise click.UsageError("--kind and --labels are for --values")
        kept = output.suffix.lower() == ".glb" and is_scene(look) and not options["texture"]
        if options["most"] and not (kept and options["rig"]):
            raise click.UsageError("--most is for --kind weights, and for --rig")
        result |= _carry_look(answer, look, output, polygons, {**options, "kept": kept, "own": own})
    else:
        if options["most"] and kind != "weights":
            raise click.UsageError("--most is for --kind weights, and for --rig")
        result |= _carry_values(answer, kind, output, polygons, options)
    if is_mesh:
        tell_what_is_lost(source, materials=own is not None, polygons=output.suffix.lower() != ".glb")
        named = output.suffix.lower() == ".obj" and options["values"] is None
        textured = result.get("carried") == "texture"
        tell_what_is_lost(look, materials=kept, names=named, rig=kept and options["rig"], texture=textured)
        tell_what_is_rounded(answer, output, centered=not kept)
    emit({**result, **valid_count(answer, as_json)}, as_json)


def _carry_look(
    answer: Correspondence, look: Path, output: Path, polygons: Polygons | None, options: dict[str, Any]
) -> dict[str, Any]:
    """What a file looks like, to a mesh; what was done."""
    from gmds.appearance import read_look

    picture, up = options["picture"], options["up"]
    if not options["kept"]:
        told, *looks = look_carried(answer, look, options["texture"], output, polygons)
        draw_looks(picture, answer, up, *looks)
        return told
    told = scene_carried(answer, look, output, options["rig"], options["most"], options["own"])
    if picture:
        draw_looks(picture, answer, up, read_look(look, answer.target), read_look(output, answer.source))
    return told


def _carry_values(
    answer: Correspondence, kind: str, output: Path, polygons: Polygons | None, options: dict[str, Any]
) -> dict[str, Any]:
    """Values in a file, to a file; what was done."""
    from gmds.files.values import read_values

    file = options["values"]
    given = read_values(file, answer.target.n_vertices, labels=kind == "labels")
    if given.dtype.kind in "bU" and kind != "labels":
        raise click.UsageError(f"{file} holds names ({given.dtype}), not numbers; give --labels to carry them")
    if given.dtype.kind in "iu" and given.ndim == 1 and kind == "numbers":
        note("values are whole numbers and get interpolated; --labels carries them as names")
    if kind == "weights":
        refuse_labels(given, file)
    if kind == "colours":
        given = as_colours(given, file)
    carried = carried_values(answer, given, kind, options["most"])
    table = carried.reshape(len(carried), -1)
    result: dict[str, Any] = {"columns": table.shape[1], "carried": METHODS[kind]}
    if kind == "weights" and (unheld := int((table.sum(axis=1) == 0).sum())):
        result["without_weights"] = unheld
    if output.suffix.lower() in MESHES:
        from gmds.appearance import Look, write_look

        if carried.dtype.kind == "U":  # meshes keep numbers
            import numpy as np

            words, number = np.unique(carried, return_inverse=True)
            carried, result["labels"] = number.reshape(carried.shape), words.tolist()
        look, values = (Look(colours=carried), {}) if kind == "colours" else (Look(), {"value": carried})
        write_look(output, answer.source, look, values, polygons)
    else:
        names = ["value"] if table.shape[1] == 1 else [f"value_{i}" for i in range(table.shape[1])]
        write_field(output, {"values": carried}, dict(zip(names, table.T, strict=True)))
    draw_values(options["picture"], answer, options["up"], kind, (given.reshape(len(given), -1), table))
    return result
