"""Metres of Blender's units."""

from mathutils import Matrix


def metres_per_unit(scene):
    """A scene's Unit Scale; Blender does not apply it where the Unit System is None."""
    settings = scene.unit_settings
    return settings.scale_length if settings.system != "NONE" else 1.0


def to_metres(scene):
    """The matrix that makes metres of Blender's units."""
    return Matrix.Scale(metres_per_unit(scene), 4)
