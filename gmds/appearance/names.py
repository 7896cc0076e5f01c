"""What a file calls the faces of its mesh: objects, groups and materials, face by face, carried along a map."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from geodesics.arrays import Integers
from geodesics.io.contents import Contents
from geodesics.io.obj import statements
from geodesics.io.polygons import triangles_of
from geodesics.points import SurfacePoints
from gmds.maps.point_map import PointMap

NONE = {"o": "None", "g": "default", "usemtl": "None"}  # what faces without a name get behind those that have one


@dataclass(frozen=True, eq=False)
class FaceNames:
    """Names of the faces of a mesh of m faces.

    Parameters
    ----------
    called : tuple of tuples of str
        Object, group and material, each "" where there is none; all that occur.
    face : array of shape (m,)
        Which of them each face has.
    libraries : tuple of str
        Files of materials, as an OBJ names them. They are not opened.
    """

    called: tuple[tuple[str, str, str], ...]
    face: Integers
    libraries: tuple[str, ...] = ()

    @property
    def materials(self) -> tuple[str, ...]:
        """All that some face has."""
        there = (self.called[number][2] for number in np.unique(self.face))
        return tuple(dict.fromkeys(name for name in there if name))


def names_in_obj(data: bytes, path: Path, contents: Contents) -> FaceNames | None:
    """Names in an OBJ file that was read as `contents`; None where it has none."""
    now, libraries = {"o": "", "g": "", "usemtl": ""}, []
    called: dict[tuple[str, str, str], int] = {}
    number = []
    for row in statements(data, path, comment=None):  # "Material #25" is a name
        word = row.words[0]
        if word in now:
            now[word] = _text(row.words[1:])
        elif word == "mtllib":
            libraries.append(_text(row.words[1:]))
        elif word in ("f", "fo"):
            number.append(called.setdefault((now["o"], now["g"], now["usemtl"]), len(called)))
    if contents.polygons is None or not (any(map(any, called)) or libraries):
        return None
    face = np.repeat(np.array(number, dtype=np.int64), triangles_of(contents.polygons[0]))
    return FaceNames(tuple(called), face, tuple(dict.fromkeys(filter(None, libraries))))


def names_of_parts(contents: Contents) -> FaceNames | None:
    """Names and materials of the parts of a scene; None where it has none."""
    called = [("", " ".join(part.name.split()), " ".join(part.material.split())) for part in contents.parts]
    if not any(map(any, called)):
        return None
    return FaceNames(tuple(called), np.repeat(np.arange(len(called)), [len(part.faces) for part in contents.parts]))


def _text(words: list[str]) -> str:
    """A name of any characters; lines are read one byte a character."""
    name = " ".join(words)
    try:
        return name.encode("latin-1").decode("utf-8")
    except UnicodeError:
        return name


def faces_under(answer: PointMap) -> Integers:
    """The face (m,) of the target where the middle of each face of the source goes."""
    middle = answer.points.positions[answer.source.faces].mean(axis=1)
    return np.asarray(SurfacePoints.closest(answer.target, middle).face)


def carry_names(answer: PointMap, names: FaceNames) -> FaceNames:
    """Names of the faces of the target, on those of the source: each has that of where its middle goes."""
    return replace(names, face=names.face[faces_under(answer)])


def named_faces(names: FaceNames, first: Integers, lines: list[str]) -> Iterator[str]:
    """Lines of faces for an OBJ file, with names where they change; `first` is the triangle that each begins with."""
    now = ("", "", "")
    for number, line in zip(names.face[first].tolist(), lines, strict=True):
        wanted = names.called[number]
        for word, old, new in zip(NONE, now, wanted, strict=True):
            if old != new:
                yield f"{word} {new or NONE[word]}"
        now = wanted
        yield line
