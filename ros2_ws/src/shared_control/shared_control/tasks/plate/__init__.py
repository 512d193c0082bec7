"""Two moments on a square plate: the ball to its centre."""

from .scene import PLATE_SCENE, plate_scene
from .task import Plate, PlateState

__all__ = ['PLATE_SCENE', 'Plate', 'PlateState', 'plate_scene']
