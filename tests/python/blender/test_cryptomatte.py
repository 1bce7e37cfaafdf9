# ctest labels: metamorphic
"""Blender's Cryptomatte node reads what uwvdb writes, as a file and as passes."""

import math
import pathlib
import sys
import tempfile

import bpy
import numpy
from support import add, box, empty_scene, light, material, square, uwvdb


def box_before_a_wall():
    scene = empty_scene(48, 32)
    scene.uwvdb.samples = 16
    scene.cycles.device, scene.cycles.use_denoising = "CPU", False
    light("POINT", location=(1, 0, 1))
    near = box("Near box", location=(0.3, 3, 0.1), rotation=(0.3, 0.2, 0.5))
    wall = square("Wall", size=30, location=(0, 6, 0), rotation=(math.pi / 2, 0, 0))
    near.data.materials.append(material("Of the box")[0])
    wall.data.materials.append(material("Of the wall")[0])
    return scene


def matte_node(scene):
    """A Cryptomatte node whose matte is the composite, and what makes Blender 3.4 render at all."""
    scene.use_nodes = True
    tree = scene.node_tree
    tree.nodes.clear()
    tree.nodes.new("CompositorNodeRLayers")
    node = tree.nodes.new("CompositorNodeCryptomatteV2")
    tree.links.new(node.outputs["Matte"], tree.nodes.new("CompositorNodeComposite").inputs["Image"])
    return node


def render_file(scene, path):
    """Renders, and returns the file of all layers, the composite among them."""
    settings = scene.render.image_settings
    settings.file_format, settings.color_depth = "OPEN_EXR_MULTILAYER", "32"
    settings.exr_codec = "NONE"
    scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    return sys.modules["uwvdb_blender.exr"].read(path)


def pixels_of(image, layer, where):
    """The coverage of what a pixel shows most of."""
    ids, fractions = (numpy.concatenate([image.get(f"{layer}{k:02}", pair) for k in range(3)], axis=-1)
                   for pair in ("RB", "GA"))
    return numpy.where(ids == ids[where][0], fractions, 0).sum(axis=-1)


CENTRE, CORNER = (16, 26), (0, 0)  # of the box, and of the wall


def test_passes_give_the_coverage_by_name():
    """The node reads the render itself, its saved file, and that of another view layer beside it."""
    scene = box_before_a_wall()
    add("Again", bpy.data.objects["Near box"].data, (-0.8, 4, -0.2), (0.1, 0.6, 0.2))  # of the same mesh
    other = scene.view_layers.new("Other")
    for layer in scene.view_layers:
        layer.use_pass_cryptomatte_object = layer.use_pass_cryptomatte_material = True
    node = matte_node(scene)
    with tempfile.TemporaryDirectory() as folder:
        masks = {}
        for layer, name, where in (("CryptoObject", "Near box", CENTRE), ("CryptoObject", "Wall", CORNER),
                                   ("CryptoMaterial", "Of the box", CENTRE),
                                   ("CryptoMaterial", "Of the wall", CORNER)):
            for view_layer in (scene.view_layers[0], other):
                node.source, node.scene = "RENDER", scene
                node.layer_name = f"{view_layer.name}.{layer}"
                node.matte_id = name
                image = render_file(scene, f"{folder}/render.exr")
                matte = image.channels["Composite.Combined.R"]
                wanted = pixels_of(image, f"{view_layer.name}.{layer}", where)
                partial = ((wanted > 0) & (wanted < 1)).sum()
                off = numpy.abs(matte - wanted).max()
                print(f"    {node.layer_name}, {name}: {partial} pixels in part, off by {off:.1e} at most")
                assert partial > 20 and off <= 1 / 255, (name, partial, off)
                masks[view_layer.name, name] = matte
            # The file as it was saved, found by the fields in its header.
            texts = {text for field, text in image.texts.items() if field.endswith("/name")}
            assert texts == {f"{v}.{k}" for v in ("ViewLayer", "Other")
                             for k in ("CryptoObject", "CryptoMaterial")}, texts
            manifests = [text for field, text in image.texts.items() if field.endswith("/manifest")]
            assert len(manifests) == 4 and any(f'"{name}"' in text for text in manifests)
            node.source, node.image = "IMAGE", bpy.data.images.load(f"{folder}/render.exr")
            node.layer_name = f"Other.{layer}"
            node.matte_id = name
            matte = render_file(scene, f"{folder}/again.exr").channels["Composite.Combined.R"]
            assert numpy.abs(matte - masks["Other", name]).max() == 0, name
        # Two boxes of one material.
        both = masks["ViewLayer", "Of the box"] - masks["ViewLayer", "Near box"]
        assert both.min() > -1e-6 and (both > 0.99).sum() > 20
        assert numpy.abs(masks["ViewLayer", "Of the box"] + masks["ViewLayer", "Of the wall"] - 1).max() < 1e-5


def test_instances_of_one_name_are_one_matte():
    """As in Cycles: instances have the name of their object."""
    scene = box_before_a_wall()
    scene.view_layers[0].use_pass_cryptomatte_object = True
    parts = bpy.data.collections.new("Parts")
    parts.objects.link(bpy.data.objects["Near box"])
    for x in (-1.0, 1.2):
        place = bpy.data.objects.new("Place", None)
        scene.collection.objects.link(place)
        place.instance_type, place.instance_collection, place.location.x = "COLLECTION", parts, x
    node = matte_node(scene)
    node.source, node.scene, node.matte_id = "RENDER", scene, "Near box"
    with tempfile.TemporaryDirectory() as folder:
        seen = {}
        for engine in ("UWVDB", "CYCLES"):
            scene.render.engine = engine
            scene.cycles.samples, scene.cycles.pixel_filter_type, scene.cycles.filter_width = 256, "BOX", 1
            seen[engine] = render_file(scene, f"{folder}/{engine}.exr").channels["Composite.Combined.R"]
        off = numpy.abs(seen["UWVDB"] - seen["CYCLES"])
        print(f"    covered: {seen['UWVDB'].sum():.1f} and {seen['CYCLES'].sum():.1f} pixels, "
              f"off by {off.mean():.4f} in the mean, {off.max():.3f} at most")
        assert seen["CYCLES"].sum() > 150 and off.mean() < 0.005 and off.max() < 0.2


def test_cryptomatte_node_gives_the_coverage():
    scene = box_before_a_wall()
    exr = sys.modules["uwvdb_blender.exr"]
    with tempfile.TemporaryDirectory() as folder:
        scene.uwvdb.kept_in = folder
        bpy.ops.render.render()
        place = next(pathlib.Path(folder).glob("*_ViewLayer"))
        uwvdb("render", "scene.yaml", "-o", "out.exr", "--layers", "default,crypto_object",
              "--compression", "none", "--samples", "16", folder=place)
        written = exr.read(f"{place}/out.exr")
        scene.uwvdb.kept_in = ""
        scene.render.engine = "CYCLES"
        scene.cycles.samples = 1
        node = matte_node(scene)
        node.source = "IMAGE"
        node.image = bpy.data.images.load(f"{place}/out.exr")
        layers = node.bl_rna.properties["layer_name"].enum_items.keys()
        print(f"    layers: {layers}, {node.layer_name}")
        seen = []
        for name, where in (("Near box", CENTRE), ("Wall", CORNER)):
            node.matte_id = name
            matte = render_file(scene, f"{folder}/matte.exr").channels["Composite.Combined.R"]
            wanted = pixels_of(written, "CryptoObject", where)
            off = numpy.abs(matte - wanted).max()
            partial = ((wanted > 0) & (wanted < 1)).sum()
            print(f"    {name}: {partial} pixels in part, off by {off:.1e} at most")
            assert partial > 20 and off <= 1 / 255, (name, partial, off)
            seen.append(matte)
        assert numpy.abs(seen[0] + seen[1] - 1).max() <= 1 / 255
