"""What the tests of the Blender add-on share. They run inside Blender; run_inside.py calls them."""

import contextlib
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import bpy
import numpy
from mathutils import Euler, Matrix, Vector

ROOT = pathlib.Path(__file__).resolve().parents[3]
PROGRAM = os.environ["UWVDB_PROGRAM"]


def empty_scene(width=96, height=64):
    """A file with nothing in it but a camera that looks along y; uwvdb without water."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="uwvdb_blender")
    bpy.context.preferences.addons["uwvdb_blender"].preferences.program = PROGRAM
    scene = bpy.context.scene
    scene.render.engine = "UWVDB"
    scene.uwvdb.scattering = "SINGLE"  # it is quick; tests of all light ask for it
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.view_settings.view_transform = "Raw"
    scene.world = bpy.data.worlds.new("World")
    scene.world.color = (0, 0, 0)
    scene.world.uwvdb.kind = "NONE"
    scene.camera = add("Camera", bpy.data.cameras.new("Camera"), rotation=(math.pi / 2, 0, 0))
    return scene


def add(name, data, location=(0, 0, 0), rotation=(0, 0, 0), scale=(1, 1, 1)):
    thing = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(thing)
    thing.location, thing.rotation_euler, thing.scale = location, rotation, scale
    return thing


def mesh(name, vertices, faces, **place):
    data = bpy.data.meshes.new(name)
    data.from_pydata(vertices, [], faces)
    data.validate()
    return add(name, data, **place)


def box(name="Box", size=(1, 1, 1), **place):
    x, y, z = (side / 2 for side in size)
    corners = [(i, j, k) for i in (-x, x) for j in (-y, y) for k in (-z, z)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return mesh(name, corners, faces, **place)


def square(name="Square", size=2, **place):
    """In its own x and y, with texture coordinates from 0 to 1; its normal is z."""
    h = size / 2
    made = mesh(name, [(-h, -h, 0), (h, -h, 0), (h, h, 0), (-h, h, 0)], [(0, 1, 2, 3)], **place)
    layer = made.data.uv_layers.new(name="UVMap")
    for loop, uv in zip(layer.data, ((0, 0), (1, 0), (1, 1), (0, 1))):
        loop.uv = uv
    return made


def light(kind, name="Light", watts=100, location=(0, 0, 0), rotation=(0, 0, 0), **settings):
    data = bpy.data.lights.new(name, kind)
    data.energy = watts
    if kind in ("POINT", "SPOT"):
        data.shadow_soft_size = 0
    if kind == "SUN":
        data.angle = 0
    for key, value in settings.items():
        setattr(data, key, value)
    return add(name, data, location, rotation)


def material(name, colour=(0.8, 0.8, 0.8), shader="ShaderNodeBsdfDiffuse"):
    """A material of one shader with this colour; (material, nodes, links, shader)."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()
    node = nodes.new(shader)
    node.inputs[0].default_value = (*colour, 1)
    links.new(node.outputs[0], nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    return made, nodes, links, node


def render(engine="UWVDB", frame=None, samples=64, suffix=""):
    """Renders, and returns the passes of the first view layer by name, rows from the top; suffix is that
    of one eye's file."""
    scene = bpy.context.scene
    scene.render.engine = engine
    if engine == "CYCLES":
        cycles = scene.cycles
        cycles.device, cycles.samples, cycles.use_denoising = "CPU", samples, False
        cycles.use_adaptive_sampling, cycles.max_bounces = False, 0
        cycles.filter_width, cycles.pixel_filter_type = 0.01, "BOX"
    if frame is not None:
        scene.frame_set(frame)
    settings = scene.render.image_settings
    settings.file_format, settings.color_depth, settings.exr_codec = "OPEN_EXR_MULTILAYER", "32", "NONE"
    with tempfile.TemporaryDirectory(prefix="uwvdb-test-") as folder:
        scene.render.filepath = os.path.join(folder, "image.exr")
        bpy.ops.render.render(write_still=True)
        return read_passes(scene.render.filepath.replace(".exr", f"{suffix}.exr"))


def notes():
    """What the last render said that it could not show."""
    return sys.modules["uwvdb_blender.engine"]._said


def read_passes(path):
    image = sys.modules["uwvdb_blender.exr"].read(path)
    passes = {}
    for name in image.channels:
        layer = name.split(".", 1)[1].rsplit(".", 1)[0] if name.count(".") > 1 else ""
        passes.setdefault(layer, []).append(name)
    order = "RGBAXYZWV"
    return {layer: numpy.stack([image.channels[n] for n in sorted(names, key=lambda n: order.index(n[-1]))],
                               axis=-1)
            for layer, names in passes.items()}


def uwvdb(*arguments, folder):
    """Runs the program itself; it has to succeed."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=folder, text=True, capture_output=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def close(found, wanted, tolerance, what, where=None):
    """The greatest difference, over the greatest wanted value, is below the tolerance."""
    found, wanted = numpy.asarray(found, float), numpy.asarray(wanted, float)
    assert found.shape == wanted.shape, f"{what}: {found.shape} instead of {wanted.shape}"
    if where is not None:
        found, wanted = found[where], wanted[where]
    assert found.size > 0, f"{what}: nothing to compare"
    scale = numpy.abs(wanted).max()
    assert scale > 0, f"{what}: all that is wanted is 0"
    worst = numpy.abs(found - wanted).max() / scale
    print(f"    {what}: {worst:.2e} (allowed {tolerance:g})")
    assert worst <= tolerance, f"{what}: differs by {worst:.3e} of the greatest, more than {tolerance:g}"


def median_close(found, wanted, tolerance, what, where):
    """Half of the values where asked for are as close as that, each relative to the wanted one."""
    relative = numpy.abs(found[where] / wanted[where] - 1)
    assert relative.size > 100, f"{what}: only {relative.size} values to compare"
    median = numpy.median(relative)
    print(f"    {what}: median {median:.2e} (allowed {tolerance:g}), mean of all "
          f"{found[where].mean() / wanted[where].mean() - 1:+.2e}")
    assert median <= tolerance, f"{what}: the median pixel differs by {median:.3e}"
    mean = abs(found[where].mean() / wanted[where].mean() - 1)
    assert mean <= tolerance * 3, f"{what}: the mean differs by {mean:.3e}"
