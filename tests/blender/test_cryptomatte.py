# ctest labels: metamorphic
"""Blender's Cryptomatte node reads what uwvdb writes."""

import math
import pathlib
import sys
import tempfile

import bpy
import numpy
from support import box, empty_scene, light, square, uwvdb


def test_cryptomatte_node_gives_the_coverage():
    scene = empty_scene(48, 32)
    scene.uwvdb.samples = 16
    light("POINT", location=(1, 0, 1))
    box("Near box", location=(0.3, 3, 0.1), rotation=(0.3, 0.2, 0.5))
    square("Wall", size=30, location=(0, 6, 0), rotation=(math.pi / 2, 0, 0))
    exr = sys.modules["uwvdb_blender.exr"]
    with tempfile.TemporaryDirectory() as folder:
        scene.uwvdb.kept_in = folder
        bpy.ops.render.render()
        place = next(pathlib.Path(folder).glob("*_ViewLayer"))
        uwvdb("render", "scene.yaml", "-o", "out.exr", "--layers", "default,crypto_object",
              "--compression", "none", "--samples", "16", folder=place)
        written = exr.read(f"{place}/out.exr")
        ids, shares = (numpy.concatenate([written.get(f"CryptoObject{k:02}", pair) for k in range(3)],
                                         axis=-1) for pair in ("RB", "GA"))
        scene.uwvdb.kept_in = ""
        scene.render.engine = "CYCLES"
        scene.cycles.samples, scene.cycles.device = 1, "CPU"
        scene.use_nodes = True
        tree = scene.node_tree
        tree.nodes.clear()
        node = tree.nodes.new("CompositorNodeCryptomatteV2")
        node.source = "IMAGE"
        node.image = bpy.data.images.load(f"{place}/out.exr")
        layers = node.bl_rna.properties["layer_name"].enum_items.keys()
        print(f"    layers: {layers}, {node.layer_name}")
        target = tree.nodes.new("CompositorNodeComposite")
        tree.links.new(node.outputs["Matte"], target.inputs["Image"])
        seen = []
        for name in ("Near box", "Wall"):
            node.matte_id = name
            settings = scene.render.image_settings
            settings.file_format, settings.color_depth = "OPEN_EXR_MULTILAYER", "32"
            settings.exr_codec = "NONE"
            scene.render.filepath = f"{folder}/matte.exr"
            bpy.ops.render.render(write_still=True)
            matte = exr.read(scene.render.filepath).channels["Composite.Combined.R"]
            # The identifier is that of the centre of the box, and of a corner.
            identifier = ids[16, 26, 0] if name == "Near box" else ids[0, 0, 0]
            wanted = numpy.where(ids == identifier, shares, 0).sum(axis=-1)
            off = numpy.abs(matte - wanted).max()
            partial = ((wanted > 0) & (wanted < 1)).sum()
            print(f"    {name}: {partial} pixels in part, off by {off:.1e} at most")
            assert partial > 20 and off <= 1 / 255, (name, partial, off)
            seen.append(matte)
        assert numpy.abs(seen[0] + seen[1] - 1).max() <= 1 / 255
