"""A person: nose, chest and seat, arms away from the sides, hands with thumbs, feet that point forward."""

from __future__ import annotations

from collections.abc import Mapping

from gmds.shapes.figure import Figure, figure
from gmds.shapes.implicit import Cone, Ellipsoid, Part
from gmds.shapes.skeleton import Body, Joint, Move, scaled

_TRUNK = (
    Joint("pelvis", "", (0.0, 0.0, 0.95)),
    Joint("waist", "pelvis", (0.0, 0.0, 1.08)),
    Joint("neck", "waist", (-0.01, 0.0, 1.47)),
    Joint("head", "neck", (0.0, 0.0, 1.55)),
)


def _limbs(side: str, s: float) -> tuple[Joint, ...]:
    return (
        Joint(f"shoulder_{side}", "waist", (-0.01, 0.17 * s, 1.40)),
        Joint(f"elbow_{side}", f"shoulder_{side}", (-0.02, 0.38 * s, 1.21)),
        Joint(f"wrist_{side}", f"elbow_{side}", (0.01, 0.57 * s, 1.04)),
        Joint(f"hip_{side}", "pelvis", (0.0, 0.10 * s, 0.90)),
        Joint(f"knee_{side}", f"hip_{side}", (0.01, 0.13 * s, 0.50)),
        Joint(f"ankle_{side}", f"knee_{side}", (-0.02, 0.14 * s, 0.09)),
    )


def _limb_parts(side: str, s: float) -> tuple[Part, ...]:
    return (
        Ellipsoid("waist", (0.045, 0.075 * s, 1.32), (0.062, 0.085, 0.065)),
        Ellipsoid("pelvis", (-0.060, 0.075 * s, 0.91), (0.080, 0.090, 0.100)),
        Cone(f"shoulder_{side}", (-0.01, 0.18 * s, 1.385), (-0.02, 0.38 * s, 1.21), 0.066, 0.042),
        Cone(f"elbow_{side}", (-0.02, 0.38 * s, 1.21), (0.01, 0.57 * s, 1.04), 0.042, 0.028),
        Ellipsoid(
            f"wrist_{side}",
            (0.025, 0.635 * s, 0.985),
            (0.095, 0.046, 0.023),
            (0.1, 0.75 * s, -0.65),
            (0, 0.65 * s, 0.75),
        ),
        Cone(f"wrist_{side}", (0.035, 0.60 * s, 1.01), (0.095, 0.645 * s, 0.985), 0.022, 0.017),
        Cone(f"hip_{side}", (0.0, 0.10 * s, 0.90), (0.01, 0.13 * s, 0.50), 0.092, 0.056),
        Cone(f"knee_{side}", (0.01, 0.13 * s, 0.50), (-0.02, 0.14 * s, 0.09), 0.054, 0.036),
        Ellipsoid(f"knee_{side}", (-0.03, 0.135 * s, 0.36), (0.050, 0.050, 0.11)),
        Ellipsoid(f"ankle_{side}", (0.055, 0.15 * s, 0.042), (0.125, 0.047, 0.038)),
        Ellipsoid("head", (-0.005, 0.085 * s, 1.65), (0.032, 0.020, 0.036)),
    )


_TRUNK_PARTS: tuple[Part, ...] = (
    Ellipsoid("pelvis", (0.0, 0, 0.95), (0.115, 0.165, 0.11)),
    Ellipsoid("waist", (0.030, 0, 1.09), (0.100, 0.14, 0.15)),
    Ellipsoid("waist", (-0.01, 0, 1.28), (0.11, 0.165, 0.17)),
    Cone("neck", (-0.01, 0, 1.42), (0.005, 0, 1.57), 0.060, 0.050),
    Ellipsoid("head", (0.01, 0, 1.675), (0.098, 0.078, 0.105)),
    Ellipsoid("head", (0.045, 0, 1.60), (0.055, 0.052, 0.05)),
    Cone("head", (0.095, 0, 1.672), (0.125, 0, 1.640), 0.016, 0.020),
)

BODY = Body(
    joints=_TRUNK + _limbs("left", 1) + _limbs("right", -1),
    parts=_TRUNK_PARTS + _limb_parts("left", 1) + _limb_parts("right", -1),
    blend_width=0.016,
    skin_width=0.035,
)

POSES: Mapping[str, Mapping[str, Move]] = {
    "stand": {},
    "walk": {
        "hip_left": Move((0, -28, 0)),
        "hip_right": Move((0, 20, 0)),
        "knee_left": Move((0, 12, 0)),
        "knee_right": Move((0, 30, 0)),
        "shoulder_left": Move((-20, 35, 0)),
        "shoulder_right": Move((20, -35, 0)),
        "elbow_right": Move((0, -40, 30)),
        "elbow_left": Move((0, -25, -20)),
    },
    "wave": {
        "shoulder_left": Move((50, 0, 0)),
        "elbow_left": Move((65, 0, 0)),
        "shoulder_right": Move((25, -20, 0)),
        "neck": Move((0, 0, 25)),
        "waist": Move((-8, 10, 12)),
        "knee_right": Move((0, 20, 0)),
    },
    "kick": {
        "hip_right": Move((0, -55, 0)),
        "knee_right": Move((0, 25, 0)),
        "shoulder_left": Move((0, -40, 0)),
        "shoulder_right": Move((-15, 40, 0)),
        "waist": Move((0, 12, 0)),
        "elbow_left": Move((0, -30, 0)),
    },
}


def humanoid(
    pose: str | Mapping[str, Move] = "stand",
    *,
    head_scale: float = 1.0,
    hand_scale: float = 1.0,
    leg_scale: float = 1.0,
    n_vertices: int = 5000,
    seed: int = 0,
) -> Figure:
    """A person of height 1.8 that faces +x, with z up.

    Parameters
    ----------
    pose : str or mapping
        A name in `humanoid_poses`, or the moves of joints by their names.
    head_scale, hand_scale, leg_scale : float
        Scales of whole branches of the body; 1 leaves them as they are.
    n_vertices : int
        Number of vertices n.
    seed : int
        Chooses the triangulation.

    Returns
    -------
    Figure
        Closed and of genus 0.

    Raises
    ------
    ValueError
        For an unknown pose or joint, a scale that is not positive, or too few or too many vertices.

    See Also
    --------
    truth : The correspondence of two of them.

    Notes
    -----
    In moves of your own by which parts touch or cross each other, vertices there may be taken for those of the other
    part, and `truth` is wrong at them: with both shoulders lowered by 50 degrees 2 % of the edges join arm and side.
    No pose with a name does that.
    """
    moves = scaled(POSES, pose, {"head": head_scale, "wrist_": hand_scale, "hip_": leg_scale})
    return figure(BODY, moves, spacing=0.0145, n_vertices=n_vertices, seed=seed)
