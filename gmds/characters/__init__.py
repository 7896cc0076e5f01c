"""Characters: materials, skeleton and shapes to morph to of a glTF scene, carried along a map and written."""

from gmds.characters.carrying import Told, carry_scene
from gmds.characters.own_look import has_look

__all__ = ["Told", "carry_scene", "has_look"]
