"""Statistics of corresponding points: superposition, shape models, symmetry, tests, points to measure"""

from gmds.morphometrics.fitted_shape import FittedShape
from gmds.morphometrics.procrustes import Superposition, superimposed
from gmds.morphometrics.shape_model import ShapeModel

__all__ = ["FittedShape", "ShapeModel", "Superposition", "superimposed"]
