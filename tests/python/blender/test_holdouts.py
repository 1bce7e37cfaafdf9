# ctest labels: metamorphic
"""Holdouts of objects and of collections against Cycles: their alpha, and what stays of the picture around them."""

from support import *


def scene_with_a_hole():
    scene = empty_scene(60, 40)
    scene.camera.data.clip_start = 1e-3  # where Cycles' rays begin
    hole = box("Hole", size=(0.6, 0.6, 0.6), location=(0.4, 3, 0), rotation=(0, 0, 0.5))
    box("Solid", size=(0.4, 0.4, 0.4), location=(-0.6, 2.5, 0.2))
    square("Wall", size=12, location=(0, 5, 0), rotation=(math.pi / 2, 0, 0))
    light("POINT", watts=300, location=(-1, 0, 1))
    return scene, hole


def compare(what):
    ours, theirs = render()["Combined"], render("CYCLES", samples=64)["Combined"]
    print(f"    {what}: holes of {(theirs[..., 3] < 0.5).mean():.1%}")
    assert 0.02 < (theirs[..., 3] < 0.9).mean() < 0.5
    # Cycles' samples of a pixel at an edge are random.
    assert numpy.median(numpy.abs(ours[..., 3] - theirs[..., 3])) < 1e-3
    assert (numpy.abs(ours[..., 3] - theirs[..., 3]) > 0.2).mean() < 0.01
    solid = theirs[..., 3] > 0.99
    median_close(ours[..., 0], theirs[..., 0], 3e-3, f"{what}: what is around it", solid & (theirs[..., 0] > 0.01))
    return ours, theirs


def test_an_object():
    _, hole = scene_with_a_hole()
    hole.is_holdout = True
    compare("object")


def test_a_collection():
    scene, hole = scene_with_a_hole()
    group = bpy.data.collections.new("Group")
    scene.collection.children.link(group)
    scene.collection.objects.unlink(hole)
    group.objects.link(hole)
    bpy.context.view_layer.layer_collection.children["Group"].holdout = True
    compare("collection")


def test_the_alpha_of_water_before_a_hole():
    """1 less the mean transmittance."""
    scene, hole = scene_with_a_hole()
    bpy.data.objects.remove(bpy.data.objects["Light"])
    hole.is_holdout = True
    scene.world.use_nodes = True
    nodes, links = scene.world.node_tree.nodes, scene.world.node_tree.links
    nodes.clear()
    node = nodes.new("ShaderNodeVolumeAbsorption")
    node.inputs["Color"].default_value, node.inputs["Density"].default_value = (0.2, 0.6, 0.9, 1), 0.4
    links.new(node.outputs[0], nodes.new("ShaderNodeOutputWorld").inputs["Volume"])
    bpy.ops.uwvdb.water_from_volume()
    ours, theirs = render()["Combined"][..., 3], render("CYCLES", samples=64)["Combined"][..., 3]
    where = theirs < 0.9
    off = numpy.abs(ours - theirs)[where]
    print(f"    alpha: {theirs[where].min():.3f} to {theirs[where].max():.3f}, median error {numpy.median(off):.1e}")
    assert numpy.median(off) < 1e-3


def test_no_hole_has_no_extra_layers():
    scene, _ = scene_with_a_hole()
    passes = sys.modules["uwvdb_blender.passes"]
    assert passes.layers_of(scene.view_layers[0], scene) == ["total"]
    assert render()["Combined"][..., 3].min() == 1
