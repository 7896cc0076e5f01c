"""Meshes with faults: matched as clean copies, and the map carried to what was given."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geodesics import SurfacePoints
from geodesics.arrays import Integers
from geodesics.errors import Note
from geodesics.io.precision import precision_notes
from geodesics.topology.components import component_areas
from gmds.correspondence import Correspondence
from gmds.landmarks.constraints import LandmarkConstraints, WeightedCorners
from gmds.matching.bodies import BODY
from gmds.surface.measured import Surface


def on_clean(landmarks: LandmarkConstraints, source: Surface, target: Surface) -> LandmarkConstraints | None:
    """Landmarks of the given meshes as those of the surfaces that are matched; None where none lies on both."""
    ours, theirs = (
        side if surface.clean is None else WeightedCorners(surface.clean.vertex[side.corners], side.weights)
        for side, surface in ((landmarks.source, source), (landmarks.target, target))
    )
    return replace(landmarks, source=ours, target=theirs).within(source.mesh.faces, target.mesh.faces)


def on_given(answer: Correspondence, source: Surface, target: Surface) -> Correspondence:
    """A map between the originals of two surfaces as one between the meshes that were given.

    A vertex goes where the clean one that it became went. One that became none goes with the nearest, and is not valid.
    """
    if source.clean is None and target.clean is None:
        return answer
    row, kept = np.arange(len(answer.points)), np.ones(len(answer.points), dtype=bool)
    if source.clean is not None:
        row, kept = source.clean.nearest, source.clean.kept
    return replace(
        answer,
        source=source.given,
        target=target.given,
        points=_carried(answer.points, row, target),
        valid=answer.valid[row] & kept,
        distortion=np.where(kept, answer.distortion[row], 1.0),
        confidence=answer.confidence[row],
        candidates=tuple(replace(one, points=_carried(one.points, row, target)) for one in answer.candidates),
    )


def _carried(points: SurfacePoints, row: Integers, target: Surface) -> SurfacePoints:
    """Points of the original of the target, in these rows, as points of the mesh that was given."""
    if target.clean is None:
        return SurfacePoints(target.given, points.face[row], points.barycentric[row])
    return target.clean.on_given(points[row])


def cleaning_notes(source: Surface, target: Surface) -> list[Note]:
    """What is wrong with meshes (W208), what was done about it (W303), and small parts that were left out (W304)."""
    notes = []
    for name, surface in (("source", source), ("target", target)):
        if surface.clean is not None:
            done = "; ".join(surface.clean.changes)
            notes.append(Note("W303", "info", f"the {name} was matched as a clean copy: {done}"))
        notes += [replace(note, message=f"the {name}: {note.message}") for note in precision_notes(surface.given)]
        area = component_areas(surface.original)
        small = area < BODY * area.max()
        if small.any():
            count, share = int(small.sum()), area[small].sum() / area.sum()
            message = (
                f"{count} small parts of the {name} ({share:.2%} of its area) hang together with nothing: where they "
                "go is where the nearest vertex goes, and they are not valid"
            )
            notes.append(Note("W304", "info", message, (), count))
    return notes
