"""Run by `gmds.pictures.offscreen` in a process of its own: draws what it finds in a folder with pyvista."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray


def draw(shot: Any) -> NDArray[np.uint8]:
    """The image (height, width, 3) of polygons given in pixels, x to the right, y up, z towards the viewer."""
    import pyvista

    width, height = shot["size"].tolist()
    faces = shot["faces"]
    cells = np.column_stack([np.full(len(faces), faces.shape[1]), faces]).ravel()
    surface = pyvista.PolyData(shot["points"], cells)
    surface.point_data["Normals"] = shot["normals"]
    surface.point_data.active_normals_name = "Normals"
    data = surface.cell_data if len(shot["colours"]) == len(faces) else surface.point_data
    data["colours"] = shot["colours"]
    plotter: Any = pyvista.Plotter(off_screen=True, window_size=[width, height], lighting="none")
    plotter.set_background("white")
    actor = plotter.add_mesh(surface, scalars="colours", rgb=True, ambient=0.40, diffuse=0.68)
    actor.prop.interpolation = "Phong"
    for direction, strength in (((-0.35, 0.45, 0.82), 0.85), ((0.9, 0.1, 0.3), 0.25), ((0, -0.9, 0.4), 0.12)):
        plotter.add_light(pyvista.Light(position=direction, light_type="camera light", intensity=strength))
    far = float(np.abs(shot["points"]).max()) * 4
    plotter.camera.parallel_projection = True
    plotter.camera.position = (width / 2, -height / 2, far)
    plotter.camera.focal_point = (width / 2, -height / 2, 0)
    plotter.camera.up = (0, 1, 0)
    plotter.camera.parallel_scale = height / 2
    plotter.camera.clipping_range = (far / 2, 2 * far)
    image = plotter.screenshot(return_img=True)
    plotter.close()
    return np.asarray(image)[:, :, :3]


def main(folder: Path, count: int) -> None:
    """Draw 0.npz, 1.npz ... to 0.npy, 1.npy ..."""
    for i in range(count):
        with np.load(folder / f"{i}.npz", allow_pickle=False) as shot:
            np.save(folder / f"{i}.npy", draw(shot), allow_pickle=False)


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]))
