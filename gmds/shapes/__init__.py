"""Built-in shapes with exact truth: an animal and a person, posed, with parts scaled, triangulated on their own."""

from geodesics import Mesh, SurfacePoints
from gmds.shapes.figure import Figure, truth
from gmds.shapes.humanoid import POSES as humanoid_poses
from gmds.shapes.humanoid import humanoid
from gmds.shapes.quadruped import POSES as quadruped_poses
from gmds.shapes.quadruped import quadruped
from gmds.shapes.skeleton import Move

__all__ = ["Figure", "Move", "demo_pair", "humanoid", "humanoid_poses", "quadruped", "quadruped_poses", "truth"]


def demo_pair() -> tuple[Mesh, Mesh, SurfacePoints]:
    """The pair of `gmds demo`: an animal, and the same animal in another pose with its head twice as big.

    Returns
    -------
    source, target : Figure
        Two meshes with different triangulations.
    truth : SurfacePoints
        One point of the target per vertex of the source.
    """
    source = quadruped()
    target = quadruped("walk", head_scale=2.0, seed=1)
    return source, target, truth(source, target)
