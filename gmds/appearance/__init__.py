"""How a surface looks: colours of its vertices, or an image laid on its faces; read, carried along maps, written."""

from gmds.appearance.names import FaceNames, carry_names
from gmds.appearance.polygons import Polygons, polygons_of
from gmds.appearance.reading import Look, read_look
from gmds.appearance.seams import carry_uv, charts
from gmds.appearance.writing import write_look

__all__ = [
    "FaceNames",
    "Look",
    "Polygons",
    "carry_names",
    "carry_uv",
    "charts",
    "polygons_of",
    "read_look",
    "write_look",
]
