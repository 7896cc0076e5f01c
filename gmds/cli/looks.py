"""Looks and scenes of files, carried for the command line, and what is told of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from gmds.cli.output import note

if TYPE_CHECKING:
    from gmds import Correspondence
    from gmds.appearance import Look, Polygons

COLOURS = "by interpolation, as colours"


def is_scene(file: Path) -> bool:
    """Whether a file is a GLB or a glTF."""
    from geodesics.io.opening import read_bytes
    from geodesics.io.sniffing import sniff

    return sniff(read_bytes(file), file) in ("glb", "gltf")


def tell_what_is_lost(file: Path, *, polygons: bool = True, **carried: bool) -> None:
    """What of a file is not carried, where these of `not_kept` are."""
    from gmds.appearance.keeping import lost_note, not_kept

    if lost := not_kept(file, polygons=polygons, **carried):
        rigged = carried.get("materials") and not carried.get("rig") and "bones and their weights" in lost
        hint = "; --rig carries bones and shapes" if rigged else ""
        note(str(lost_note(file, lost, hint)))


def tell_what_is_rounded(answer: Correspondence, output: Path, *, centered: bool) -> None:
    """What single precision does to the source; `centered` as in `rounding_notes`."""
    from geodesics.io.precision import rounding_notes

    for told in rounding_notes(answer.source, output.suffix.lower(), centered=centered):
        note(str(told))


def own_look_of(source: Path, asked: bool | None) -> Path | None:
    """The file of the source where it keeps its own materials: as asked for, or else where it has some."""
    from gmds.characters import has_look

    if asked is False or not (has := has_look(source)):
        if asked and not has:
            raise click.UsageError(f"{source} has no materials of its own; --own-look is for a .glb that does")
        return None
    if asked is None:
        note(f"{source} keeps its own materials; --carried-look takes those of the target")
    return source


def scene_carried(
    answer: Correspondence, file: Path, output: Path, rig: bool, most: int | None, own: Path | None = None
) -> dict[str, Any]:
    """Parts and materials of a scene, or of the file `own`, with `rig` bones and shapes, to a .glb; what was done."""
    from geodesics.io import atomic_write
    from gmds.characters import carry_scene

    content, told = carry_scene(answer, file, rig=rig, most=most or 4, own=own)
    if not (told.materials or told.coordinates or told.coloured or told.bones or told.shapes):
        raise click.UsageError(f"{file} has neither colours nor texture coordinates; give --values")
    with atomic_write(output) as stream:
        stream.write(content)
    result: dict[str, Any] = {"carried": "scene", "parts": told.parts, "materials": told.materials}
    if rig:
        result |= {"bones": told.bones, "shapes": told.shapes}
    return result | {"faces_on_seams": told.faces_on_seams}


def look_carried(
    answer: Correspondence, file: Path, texture: Path | None, output: Path, polygons: Polygons | None
) -> tuple[dict[str, Any], Look, Look]:
    """Colours or texture of a file of the target, to a mesh with these faces; what was done, and both looks."""
    from gmds.appearance import Look, carry_names, carry_uv, read_look, write_look

    look = read_look(file, answer.target, texture)
    for told in look.notes if look.image is not None or output.suffix.lower() != ".obj" else ():
        note(told)
    names = carry_names(answer, look.names) if look.names is not None and output.suffix.lower() == ".obj" else None
    result: dict[str, Any] = {} if names is None else {"materials": list(names.materials)}
    if names is not None and names.libraries and look.image is None:
        note(f"{', '.join(names.libraries)} is named in {output.name} and not copied; lay it beside")
    if look.uv is not None:
        uv, across = carry_uv(answer, look.uv)
        carried = Look(uv=uv, image=look.image, names=names)
        files = write_look(output, answer.source, carried, polygons=polygons)
        if look.image is None:
            note(f"{file} has no image inside; give it with --texture")
        result |= {"carried": "texture", "files": [str(file) for file in files]}
        return result | {"faces_on_seams": int(across.sum())}, look, carried
    if look.colours is None and names is None:
        raise click.UsageError(f"{file} has neither colours nor texture coordinates; give --values")
    colours = None if look.colours is None else answer.transfer(look.colours)
    carried = Look(colours=colours, names=names)
    write_look(output, answer.source, carried, polygons=polygons)
    return result | {"carried": "names" if colours is None else COLOURS}, look, carried
