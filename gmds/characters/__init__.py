"""Characters: materials, skeleton and shapes to morph to of a glTF scene, carried along a map and written."""

from gmds.characters.carrying import Told, carry_scene

__all__ = ["Told", "carry_scene"]
