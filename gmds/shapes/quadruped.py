"""A four-legged animal: snout, upright ears, sagging belly, elbows and hocks that bend opposite ways, a tail."""

from __future__ import annotations

from collections.abc import Mapping

from gmds.shapes.figure import Figure, figure
from gmds.shapes.implicit import Cone, Ellipsoid, Part
from gmds.shapes.skeleton import Body, Joint, Move, scaled

_TRUNK = (
    Joint("root", "", (0.0, 0.0, 1.0)),
    Joint("hind", "root", (-0.25, 0.0, 1.02)),
    Joint("chest", "root", (0.25, 0.0, 1.0)),
    Joint("neck", "chest", (0.60, 0.0, 1.12)),
    Joint("head", "neck", (0.90, 0.0, 1.50)),
    Joint("tail", "hind", (-0.74, 0.0, 1.08)),
    Joint("tail_tip", "tail", (-1.12, 0.0, 1.12)),
)


def _limbs(side: str, s: float) -> tuple[Joint, ...]:
    return (
        Joint(f"ear_{side}", "head", (0.96, 0.10 * s, 1.64)),
        Joint(f"shoulder_{side}", "chest", (0.48, 0.15 * s, 0.92)),
        Joint(f"elbow_{side}", f"shoulder_{side}", (0.40, 0.20 * s, 0.58)),
        Joint(f"wrist_{side}", f"elbow_{side}", (0.47, 0.20 * s, 0.22)),
        Joint(f"hip_{side}", "hind", (-0.55, 0.15 * s, 0.95)),
        Joint(f"knee_{side}", f"hip_{side}", (-0.40, 0.21 * s, 0.64)),
        Joint(f"hock_{side}", f"knee_{side}", (-0.68, 0.21 * s, 0.34)),
    )


def _limb_parts(side: str, s: float) -> tuple[Part, ...]:
    return (
        Ellipsoid(f"ear_{side}", (0.93, 0.17 * s, 1.80), (0.20, 0.10, 0.050), (-0.12, 0.28 * s, 1), (1, 0.45 * s, 0)),
        Cone(f"shoulder_{side}", (0.48, 0.15 * s, 0.92), (0.40, 0.20 * s, 0.58), 0.17, 0.085),
        Cone(f"elbow_{side}", (0.40, 0.20 * s, 0.58), (0.47, 0.20 * s, 0.22), 0.085, 0.050),
        Cone(f"wrist_{side}", (0.47, 0.20 * s, 0.22), (0.49, 0.20 * s, 0.09), 0.050, 0.050),
        Cone(f"wrist_{side}", (0.49, 0.20 * s, 0.08), (0.60, 0.20 * s, 0.06), 0.065, 0.050),
        Cone(f"hip_{side}", (-0.55, 0.15 * s, 0.95), (-0.42, 0.20 * s, 0.64), 0.20, 0.11),
        Cone(f"knee_{side}", (-0.42, 0.20 * s, 0.64), (-0.68, 0.21 * s, 0.34), 0.10, 0.050),
        Cone(f"hock_{side}", (-0.68, 0.21 * s, 0.34), (-0.62, 0.21 * s, 0.09), 0.050, 0.045),
        Cone(f"hock_{side}", (-0.62, 0.21 * s, 0.08), (-0.50, 0.21 * s, 0.06), 0.060, 0.048),
    )


_TRUNK_PARTS: tuple[Part, ...] = (
    Cone("hind", (-0.55, 0, 1.02), (0.0, 0, 1.02), 0.22, 0.21),
    Cone("chest", (0.0, 0, 1.02), (0.45, 0, 1.0), 0.21, 0.25),
    Ellipsoid("root", (0.08, 0, 0.90), (0.38, 0.19, 0.19)),
    Cone("chest", (0.45, 0, 1.0), (0.62, 0, 1.06), 0.25, 0.19),
    Cone("neck", (0.60, 0, 1.12), (0.90, 0, 1.50), 0.17, 0.12),
    Cone("head", (0.94, 0, 1.54), (1.06, 0, 1.54), 0.15, 0.14),
    Cone("head", (1.06, 0, 1.51), (1.36, 0, 1.43), 0.13, 0.08),
    Ellipsoid("head", (1.375, 0, 1.46), (0.05, 0.05, 0.045)),
    Cone("tail", (-0.72, 0, 1.08), (-1.12, 0, 1.12), 0.080, 0.050),
    Cone("tail_tip", (-1.12, 0, 1.12), (-1.50, 0, 1.30), 0.046, 0.035),
)

BODY = Body(
    joints=_TRUNK + _limbs("left", 1) + _limbs("right", -1),
    parts=_TRUNK_PARTS + _limb_parts("left", 1) + _limb_parts("right", -1),
    blend_width=0.022,
    skin_width=0.06,
)

POSES: Mapping[str, Mapping[str, Move]] = {
    "stand": {},
    "walk": {
        "neck": Move((0, -8, 10)),
        "head": Move((0, 0, 22)),
        "shoulder_left": Move((0, -24, 0)),
        "elbow_left": Move((0, 22, 0)),
        "shoulder_right": Move((0, 20, 0)),
        "hip_left": Move((0, 20, 0)),
        "hip_right": Move((0, -20, 0)),
        "hock_left": Move((0, 15, 0)),
        "tail": Move((0, 35, 25)),
        "tail_tip": Move((0, 0, 30)),
    },
    "graze": {
        "neck": Move((0, 55, 10)),
        "head": Move((0, 35, 0)),
        "chest": Move((0, 8, 0)),
        "shoulder_left": Move((0, -15, 0)),
        "tail": Move((0, -40, -20)),
    },
    "turn": {
        "chest": Move((0, 0, 18)),
        "hind": Move((0, 0, -15)),
        "neck": Move((0, -10, 30)),
        "head": Move((15, 10, 25)),
        "shoulder_right": Move((0, -30, 0)),
        "elbow_right": Move((0, 45, 0)),
        "tail": Move((0, 10, -45)),
    },
}


def quadruped(
    pose: str | Mapping[str, Move] = "stand",
    *,
    head_scale: float = 1.0,
    ear_scale: float = 1.0,
    leg_scale: float = 1.0,
    tail_scale: float = 1.0,
    n_vertices: int = 5000,
    seed: int = 0,
) -> Figure:
    """A four-legged animal of shoulder height 1.2 that looks along +x, with z up.

    Parameters
    ----------
    pose : str or mapping
        A name in `quadruped_poses`, or the moves of joints by their names.
    head_scale, ear_scale, leg_scale, tail_scale : float
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
    """
    scales = {"head": head_scale, "ear_": ear_scale, "shoulder_": leg_scale, "hip_": leg_scale, "tail": tail_scale}
    return figure(BODY, scaled(POSES, pose, scales), spacing=0.025, n_vertices=n_vertices, seed=seed)
