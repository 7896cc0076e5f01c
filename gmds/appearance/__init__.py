"""How a surface looks: colours of its vertices, or an image laid on its faces; read, carried along maps, written."""

from gmds.appearance.reading import Look, read_look
from gmds.appearance.seams import carry_uv, charts
from gmds.appearance.writing import write_look

__all__ = ["Look", "carry_uv", "charts", "read_look", "write_look"]
