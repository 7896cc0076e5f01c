"""Bodies with joints: smooth membership of the surface in each joint's branch, and posing by it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from geodesics.arrays import Bools, Floats
from geodesics.errors import BadArgument
from gmds.shapes.implicit import Part, Point, distances, project


@dataclass(frozen=True)
class Joint:
    """A named joint at `position` of the undeformed body; `parent` is "" for the root."""

    name: str
    parent: str
    position: Point


@dataclass(frozen=True)
class Move:
    """What a joint does to its branch of the body.

    Parameters
    ----------
    turn : tuple of three floats
        Rotation vector in degrees.
    scale : float
        Growth about the joint.
    """

    turn: Point = (0, 0, 0)
    scale: float = 1.0


@dataclass(frozen=True)
class Body:
    """Joints (parents first), parts, and the widths of blending and of skinning in the body's own length unit."""

    joints: tuple[Joint, ...]
    parts: tuple[Part, ...]
    blend_width: float
    skin_width: float

    @cached_property
    def branches(self) -> Bools:
        """Whether part j belongs to joint i or to one below it, shape (joints, parts)."""
        index = {joint.name: i for i, joint in enumerate(self.joints)}
        member = np.zeros((len(self.joints), len(self.parts)), dtype=bool)
        for j, part in enumerate(self.parts):
            name = part.joint
            while name:
                member[index[name], j] = True
                name = self.joints[index[name]].parent
        return member

    def project(self, x: Floats) -> Floats:
        """Points (p, 3) near the undeformed surface moved onto it."""
        return project(self.parts, x, self.blend_width)

    def membership(self, x: Floats) -> Floats:
        """The weight, in [0, 1], with which points (p, 3) belong to each joint's branch, shape (joints, p)."""
        d = distances(self.parts, x)
        weight = np.exp((d.min(axis=0) - d) / self.skin_width)
        return self.branches @ (weight / weight.sum(axis=0))

    def pose(self, x: Floats, moves: Mapping[str, Move]) -> Floats:
        """Points (p, 3) of the undeformed body after the moves, outermost joints first.

        With membership w in a joint's branch a point turns by w times the joint's rotation vector and grows by
        scale^w about the joint, so rotations and log-scales fade smoothly and tubes keep their volume.
        """
        unknown = set(moves) - {joint.name for joint in self.joints}
        if unknown:
            raise BadArgument(f"no joint {sorted(unknown)[0]!r}; there are {', '.join(j.name for j in self.joints)}")
        weights = self.membership(x)
        for joint, w in zip(self.joints[::-1], weights[::-1], strict=True):
            if moves.get(joint.name, Move()) == Move():
                continue
            move, pivot = moves[joint.name], np.array(joint.position)
            turn = Rotation.from_rotvec(w[:, None] * np.radians(move.turn))
            x = pivot + move.scale ** w[:, None] * turn.apply(x - pivot)
        return x


def scaled(
    poses: Mapping[str, Mapping[str, Move]], pose: str | Mapping[str, Move], scales: Mapping[str, float]
) -> dict[str, Move]:
    """The moves of a pose, given by name or as they are, with joints enlarged; a name ending in _ is left and right."""
    if isinstance(pose, str):
        if pose not in poses:
            raise BadArgument(f"no pose {pose!r}; there are {', '.join(poses)}")
        pose = poses[pose]
    moves = dict(pose)
    for name, scale in scales.items():
        if not scale > 0:
            raise BadArgument(f"the scale of {name.rstrip('_')} must be positive, not {scale}")
        for joint in (name + "left", name + "right") if name.endswith("_") else (name,):
            move = moves.get(joint, Move())
            moves[joint] = Move(move.turn, move.scale * scale)
    return moves
