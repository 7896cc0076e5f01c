"""gmds deform: a mesh bent, grown, torn or roughened, and where its vertices went."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gmds.cli.group import Command
from gmds.cli.output import emit, json_option, note, seed_option

if TYPE_CHECKING:
    from gmds.deformations import Deformation

from gmds.cli.paths import OutputFile

FILE = click.Path(path_type=Path)


@click.command(cls=Command, short_help="Deform a mesh and keep the truth.")
@click.argument("mesh", type=FILE)
@click.argument("kinds", metavar="KIND...", nargs=-1, required=True)
@click.option(
    "-o", "--output", required=True, type=OutputFile(), help="Where the new mesh goes; the ending says the format."
)
@click.option("--strength", default=3, show_default=True, type=click.IntRange(1, 5), help="Of kinds without their own.")
@click.option(
    "--remesh", type=click.IntRange(min=12), metavar="N", help="Triangulate anew in the end, about N vertices."
)
@click.option("--truth", type=OutputFile(), help="Write the true map from MESH to the new mesh, as gmds match does.")
@seed_option
@json_option
def command(
    mesh: Path,
    kinds: tuple[str, ...],
    output: Path,
    strength: int,
    remesh: int | None,
    truth: Path | None,
    seed: int,
    as_json: bool,
) -> None:
    """Deform MESH by one KIND after another, in the order given, and write the result.

    \b
    KIND is the name of a deformation, alone or with its strength or parameters:
      isometry        limbs are bent                      angle (degrees), count
      topology        parts that touch become one         count
      micro-holes     vertices and their faces are cut    count, radius
      scale           all grows or shrinks                factor
      local-scale     limbs grow and shrink in turn       factor, count
      noise           on every vertex                     strength (in edges)
      shot-noise      on few vertices, strong             strength (in edges), share
      caricature      what is curved grows                exponent
      similarity      turned, moved and resized           largest_scale
      cut             a share of the area is cut off      share, normal (x:y:z), centre (vertex), count
      scan            what is seen from one side is kept  direction (x:y:z)
      remesh          other triangles                     n_vertices

    \b
      gmds deform dog.ply isometry local-scale --strength 5 --remesh 4000 -o other.ply --truth truth.npz
      gmds deform dog.ply isometry:2 noise:4 -o other.ply
      gmds deform dog.ply local-scale:factor=2.5,count=1 -o other.ply
      gmds deform dog.ply isometry cut:share=0.4,normal=-1:0:0 -o half.ply --truth truth.npz
      gmds deform dog.ply cut:share=0.3,count=4 -o part.ply
      gmds deform dog.ply scan:direction=0:1:0 -o scan.ply

    Without a normal or a centre, cut removes balls around random vertices, as many as count says.
    The truth is a map that `gmds evaluate` and numpy can read: for every vertex of MESH its point on the new mesh;
    those that were cut off are not valid in it.
    Only a manifold surface can be remeshed: let remesh come before topology.
    Every step draws its random choices from the seed and its place in the order.
    """
    from geodesics import read_mesh, write_mesh
    from gmds.correspondence import Correspondence
    from gmds.deformations import compose

    wanted = [*kinds, *([] if remesh is None else [f"remesh:n_vertices={remesh}"])]
    steps = [_step(text, strength, seed + place) for place, text in enumerate(wanted)]
    source = read_mesh(mesh)
    done = compose(*(deformation for deformation, _ in steps))(source)
    result, points = done
    for told in write_mesh(result, output):
        note(str(told))
    if truth is not None:
        meta = {"parameters": {"steps": wanted, "seed": seed}}
        Correspondence.from_points(source, points, valid=~done.missing, meta=meta).save(truth)
    counts = {"file": str(output), "vertices": result.n_vertices, "faces": result.n_faces}
    emit({**counts, "steps": [said for _, said in steps]}, as_json)


def _step(text: str, strength: int, seed: int) -> tuple[Deformation, dict[str, Any]]:
    """The deformation that KIND[:STRENGTH | :NAME=VALUE,...] stands for, and a description of it."""
    from gmds.deformations import KINDS, Kind, caricature, cut, remeshing, scan, similarity

    known = {
        **KINDS,
        "caricature": Kind(caricature, {"exponent": (0.1, 0.2, 0.3, 0.4, 0.5)}),
        "similarity": Kind(similarity, {}),
        "remesh": Kind(remeshing, {}),
        "cut": Kind(cut, {"share": (0.1, 0.2, 0.3, 0.4, 0.5)}),
        "scan": Kind(scan, {}),
    }
    name, _, detail = text.partition(":")
    if name not in known:
        raise click.UsageError(f"{name!r} is no kind of deformation; there are {', '.join(known)}")
    kind = known[name]
    if "=" in detail:
        given = dict(_parameter(name, item, kind.types) for item in detail.split(","))
    elif detail and detail not in tuple("12345"):
        raise click.UsageError(f"{text!r}: after the colon goes a strength from 1 to 5, or parameter=value,...")
    else:
        given = kind.parameters(int(detail or strength))
    return lambda mesh: kind.apply(mesh, seed, **given), {"kind": name, **given}


def _parameter(kind: str, text: str, types: Mapping[str, Callable[[str], Any]]) -> tuple[str, Any]:
    """The name and the value of NAME=VALUE."""
    name, _, value = text.partition("=")
    if name not in types:
        raise click.UsageError(f"{kind} has no parameter {name!r}; it has {', '.join(types)}")
    try:
        return name, types[name](value)
    except ValueError:
        reader = types[name]
        wanted = "a whole number" if reader is int else "a number" if reader is float else "three numbers x:y:z"
        raise click.UsageError(f"{kind}: {name} must be {wanted}, not {value!r}") from None
