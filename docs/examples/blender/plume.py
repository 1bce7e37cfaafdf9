"""The scene of assets/scenes/plume.yaml, built in Blender and rendered by uwvdb. With the add-on installed
(docs/blender.md):

    blender --background --python docs/examples/blender/plume.py -- out/plume.png
    blender --python docs/examples/blender/plume.py        # to look at it and change it
"""

import math
import pathlib
import sys

import addon_utils
import bpy
import numpy
from mathutils import Vector

ASSETS = pathlib.Path(__file__).resolve().parents[3] / "assets"


def enable_addon():
    """As an extension it has another name than as an add-on of Blender before 4.2."""
    names = [module.__name__ for module in addon_utils.modules()]
    name = next((n for n in names if n.split(".")[-1] == "uwvdb_blender"), None)
    if name is None:
        sys.exit("The add-on uwvdb is not installed: docs/blender.md says how.")
    bpy.ops.preferences.addon_enable(module=name)


def add(name, data, location, look_at=None):
    thing = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(thing)
    thing.location = location
    if look_at is not None:
        thing.rotation_euler = (Vector(look_at) - Vector(location)).to_track_quat("-Z", "Y").to_euler()
    return thing


def spot(name, watts, location, look_at):
    lamp = bpy.data.lights.new(name, "SPOT")
    lamp.energy, lamp.spot_size, lamp.spot_blend = watts, math.radians(70), 0.29
    lamp.shadow_soft_size = 0.0
    add(name, lamp, location, look_at)


def build():
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    if not hasattr(numpy, "bool"):
        numpy.bool = bool  # which the importer of Debian 12's Blender wants of an older NumPy
    bpy.ops.import_scene.gltf(filepath=str(ASSETS / "meshes/seabed.glb"))
    for thing in [o for o in bpy.data.objects if o.type in ("LIGHT", "CAMERA")]:
        bpy.data.objects.remove(thing)

    # The domain of this cache had its lowest corner here.
    plume = bpy.data.volumes.new("Plume")
    plume.filepath = str(ASSETS / "grids/plume128_blosc_half_0030.vdb")
    grid = add("Plume", plume, (-2.5, -1.5, 0)).uwvdb.grids.add()
    grid.name, grid.small, grid.large = "density", 2.0, 0.8

    camera = bpy.data.cameras.new("Camera")
    camera.angle = 2 * math.atan(480 / 700)
    camera.uwvdb.housing, camera.uwvdb.distance, camera.uwvdb.thickness = "FLAT", 0.02, 0.04
    scene = bpy.context.scene
    scene.camera = add("Camera", camera, (0.6, -3.2, 1.1), (-0.15, 0, 0.5))
    spot("Left", 500, (-0.08, -3.1, 1.55), (0.2, -0.4, 0.35))
    spot("Far", 1760, (-2.3, 0.6, 1.9), (0.3, 0.2, 0.5))

    world = scene.world or bpy.data.worlds.new("World")
    scene.world = world
    world.color = (0, 0, 0)
    world.use_nodes = False
    world.uwvdb.kind, world.uwvdb.preset = "PRESET", "jerlov-II"
    scene.render.engine = "UWVDB"
    scene.render.resolution_x, scene.render.resolution_y = 960, 540
    scene.render.resolution_percentage = 100
    scene.view_settings.view_transform, scene.view_settings.exposure = "Standard", 1.5


enable_addon()
build()
if bpy.app.background:
    out = sys.argv[sys.argv.index("--") + 1] if "--" in sys.argv else "plume.png"
    bpy.context.scene.render.filepath = str(pathlib.Path(out).resolve())
    bpy.ops.render.render(write_still=True)
