"""uwvdb as a render engine of Blender: the scene is written to a temporary folder, the program `uwvdb`
renders it, and its layers come back as passes."""

bl_info = {
    "name": "uwvdb",
    "description": "Renders underwater scenes with lamps, plumes and camera housings",
    "author": "uwvdb maintainers",
    "version": (1, 0, 0),
    "blender": (3, 4, 0),
    "location": "Render > Render Engine > uwvdb",
    "category": "Render",
}

from . import engine, exporting, panels, preferences, properties

MODULES = (preferences, properties, engine, exporting, panels)


def register():
    for module in MODULES:
        module.register()


def unregister():
    for module in reversed(MODULES):
        module.unregister()
