"""Physically exact underwater images, as arrays.

    import uwvdb
    scene = uwvdb.Scene.load("plume.yaml")
    image = uwvdb.Renderer().render(scene, layers=["total", "depth"])
    image["depth"]                                          # (height, width) [m]

docs/python.md explains it all.
"""

from . import calibration
from ._uwvdb import version as __version__
from .camera import Camera, Rays
from .errors import Error, InputError, Interrupted, IoError, SceneWarning, UsageError
from .files import Grid, inspect, read_vdb, write_vdb
from .image import Image
from .render import LightMatrix, Renderer
from .scene import Scene
from .validation import Validation, validate
from .water import Water

__all__ = [
    "Camera", "Error", "Grid", "Image", "InputError", "Interrupted", "IoError", "LightMatrix",
    "Rays", "Renderer", "Scene", "SceneWarning", "UsageError", "Validation", "Water", "__version__",
    "calibration", "inspect", "read_vdb", "write_vdb", "validate",
]
