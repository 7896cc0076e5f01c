"""One kind of start a file: functions SampledPair -> list of sample maps."""

from gmds.initialization.eigenfunction_signs import eigenfunction_signs
from gmds.initialization.extremities import extremities

ALL = (eigenfunction_signs, extremities)
"""The starts that need nothing but the two surfaces."""

__all__ = ["ALL", "eigenfunction_signs", "extremities"]
