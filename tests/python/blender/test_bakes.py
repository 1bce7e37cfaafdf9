# ctest labels: unit slow
"""Bakes of materials leave the user's file alone, are made once, are as large as the picture needs, and are said
where they fail."""

import os
import tempfile

os.environ["XDG_CACHE_HOME"] = tempfile.mkdtemp(prefix="uwvdb-test-")  # nothing is known at first

from node_materials import *


def state(scene):
    """What of a user's file a bake could spoil."""
    kinds = ("objects", "meshes", "materials", "images", "node_groups", "scenes", "libraries", "worlds", "cameras")
    names = {kind: sorted(item.name_full for item in getattr(bpy.data, kind) if item.name != "Render Result")
             for kind in kinds}
    trees = {made.name: [(node.name, node.type, node.select, node.mute) for node in made.node_tree.nodes]
             + [(link.from_node.name, link.to_node.name) for link in made.node_tree.links]
             for made in bpy.data.materials if made.node_tree is not None}
    shown = {thing.name: (thing.select_get(), thing.hide_get(), thing.mode, [m.name for m in thing.data.uv_layers]
                          if thing.type == "MESH" else None, [tuple(row) for row in thing.matrix_world])
             for thing in scene.objects}
    return (names, trees, shown, scene.render.engine, scene.frame_current, scene.cycles.samples,
            bpy.context.view_layer.objects.active.name, bpy.data.is_dirty, bpy.data.filepath,
            [(made.name, made.users) for made in bpy.data.materials])


class Watched:
    """Counts the bakes, and may spoil them."""

    def __init__(self, spoil=None):
        self.program, self.spoil, self.count = sys.modules["uwvdb_blender.program"], spoil, 0

    def __enter__(self):
        self.as_it_is = self.program.run

        def run(arguments, folder, is_cancelled, on_progress):
            if "--background" not in arguments:
                return self.as_it_is(arguments, folder, is_cancelled, on_progress)
            self.count += 1
            if self.spoil is not None:
                return self.spoil(self, arguments, folder, is_cancelled, on_progress)
            return self.as_it_is(arguments, folder, is_cancelled, on_progress)

        self.program.run = run
        return self

    def __exit__(self, *_):
        self.program.run = self.as_it_is


def noisy(name="Rock", **place):
    scene = empty_scene(40, 40)
    light("POINT", watts=100, location=(-1, 0, 1))
    thing = ball(name, location=(0, 3, 0), **place)
    noise_through_a_ramp(thing)
    thing.select_set(True)
    add("Aside", None).select_set(True)
    return scene, thing


def test_the_users_file_stays_as_it_was():
    """After a bake, one that fails and one that is cancelled."""
    def fail(watched, arguments, *rest):
        with open(os.path.join(arguments[-1], "job.json"), "w") as file:
            file.write("{}")
        return watched.as_it_is(arguments, *rest)

    def cancel(watched, arguments, folder, is_cancelled, on_progress):
        return watched.as_it_is(arguments, folder, lambda: True, on_progress)

    for number, (spoil, said) in enumerate(((None, ""), (fail, "'Rock' could not be baked"), (cancel, ""))):
        scene, thing = noisy()
        thing.active_material.node_tree.nodes["Noise Texture"].inputs["Scale"].default_value = 1 + number
        bpy.context.view_layer.update()
        before = state(scene)
        with Watched(spoil) as watched:
            bpy.ops.render.render()
        assert watched.count == 1
        for was, now in zip(before, state(scene)):
            assert was == now, (was, now)
        told = " ".join(notes())
        assert said in told and ("baked" in told) == bool(said), told
        left = [name for name in os.listdir(tempfile.gettempdir()) if name.startswith("uwvdb-bake-")]
        assert not left, left


def test_a_bake_is_made_once():
    """Until the nodes, an image or the mesh change; what moves, or only looks different, is not baked again."""
    scene, thing = noisy()
    tree = thing.active_material.node_tree
    tree.nodes["Noise Texture"].inputs["Scale"].default_value = 7.5

    def bakes():
        with Watched() as watched:
            bpy.ops.render.render()
        return watched.count

    assert [bakes(), bakes()] == [1, 0]
    thing.location.x, thing.rotation_euler.z = 0.2, 1
    tree.nodes["Noise Texture"].location.x += 100
    assert bakes() == 0
    tree.nodes["Noise Texture"].inputs["Detail"].default_value = 3
    assert [bakes(), bakes()] == [1, 0]
    tree.nodes["ColorRamp"].color_ramp.elements[0].position = 0.2
    assert [bakes(), bakes()] == [1, 0]
    thing.data.vertices[0].co.x += 0.1
    assert [bakes(), bakes()] == [1, 0]
    image = picture("Changing")
    node = textured(tree.nodes, image)
    tree.links.new(node.outputs[0], next(n for n in tree.nodes if n.type == "BSDF_PRINCIPLED").inputs["Roughness"])
    tree.links.new(coordinates(tree.nodes, "Generated"), node.inputs["Vector"])
    assert [bakes(), bakes()] == [1, 0]
    image.pixels[0] = 0.9
    image.pack()
    assert [bakes(), bakes()] == [1, 0]


def test_sizes_follow_the_picture():
    """About a texel for a pixel, within the limit that the panel has."""
    scene, thing = noisy()
    folder, known = sys.modules["uwvdb_blender.bakes"].cache_folder(), set()

    def size(distance, limit=2048, pixels=512):
        thing.location.y, scene.uwvdb.bake_size = distance, limit
        thing.active_material.node_tree.nodes["Noise Texture"].inputs["Scale"].default_value += 0.01
        scene.render.resolution_x = scene.render.resolution_y = pixels
        scene.uwvdb.quality = "DRAFT"
        known.update(folder.iterdir())
        bpy.ops.render.render()
        made, = set(folder.iterdir()) - known
        return int(made.stem.rpartition("-")[2])

    # A ball of radius r has 4 pi r^2 of surface, seen with (f / d)^2 pixels for each; half the texture is used.
    focal, near = 512 / 2 / math.tan(scene.camera.data.angle / 2), 3 - 0.62
    wanted = focal / near * 0.62 * math.sqrt(4 * math.pi / 0.5)
    assert 0.5 < size(3) / wanted < 1.5, wanted
    assert size(3, limit=128) == 128
    assert size(12) < size(3) and size(300) == 64


def test_what_differs_with_the_view_is_named_once():
    scene, thing = noisy()
    tree = thing.active_material.node_tree
    shader = next(n for n in tree.nodes if n.type == "BSDF_PRINCIPLED")
    facing = tree.nodes.new("ShaderNodeLayerWeight")
    mix = mixed(tree.nodes, tree.links, tree.nodes["ColorRamp"].outputs[0], (1, 1, 1, 1), facing.outputs["Facing"])
    tree.links.new(mix, shader.inputs["Base Color"])
    copy = ball("Copy", location=(0.5, 5, 0))
    copy.data.materials.append(thing.active_material)
    bpy.ops.render.render()
    told = [note for note in notes() if "Layer Weight" in note]
    assert len(told) == 1 and "'Rock'" in told[0] and "at right angles" in told[0], notes()


def test_copies_that_differ_by_the_object():
    """Random colours of objects that share a mesh."""
    scene = empty_scene(120, 60)
    light("POINT", watts=200, location=(-1, 0, 1))
    first = ball("One", location=(-0.8, 4, 0))
    random_by_object(first)
    second = add("Two", first.data, (0.8, 4, 0))
    for number, thing in enumerate((first, second), 1):
        thing.pass_index = number
    layer = scene.view_layers[0]
    layer.use_pass_object_index, layer.use_pass_diffuse_color, layer.uwvdb.use_albedo = True, True, True
    ours, theirs = render(), render("CYCLES", samples=16)
    means = []
    for number in (1, 2):
        where = inner(ours["IndexOB"][..., 0], number) & (theirs["IndexOB"][..., 0] == number)
        means.append(ours["albedo"][where].mean(0))
        close(means[-1], theirs["DiffCol"][where].mean(0), 5e-3, f"mean of copy {number}")
    assert numpy.abs(means[0] - means[1]).max() > 0.05, means


def test_what_deforms_is_baked_once():
    """Its looks depend on its shape at rest."""
    scene = empty_scene(40, 40)
    light("POINT", watts=100, location=(-1, 0, 1))
    thing = ball("Fish", location=(0, 3, 0))
    generated_on_a_bent_mesh(thing)
    counts = []
    for value in (1, 0.5, 0.2):
        thing.data.shape_keys.key_blocks["Bent"].value = value
        with Watched() as watched:
            bpy.ops.render.render()
        counts.append(watched.count)
    assert counts == [1, 0, 0], counts


def test_images_that_are_in_no_file():
    """Two meshes with a material, whose image was painted and never saved."""
    scene = empty_scene(120, 60)
    light("POINT", watts=200, location=(-1, 0, 1))
    image = bpy.data.images.new("Painted", 32, 32)
    image.pixels.foreach_set(numpy.tile(numpy.array([0.8, 0.3, 0.1, 1], numpy.float32), 32 * 32))
    image.update()
    things = [unwrapped_box(name, location=(x, 4, 0)) for name, x in (("One", -0.8), ("Two", 0.8))]
    things[1].data.vertices[0].co.x -= 0.1
    nodes, links, inputs = shaded(things[0])
    source = textured(nodes, image).outputs[0]
    pattern = connected(nodes, links, "ShaderNodeTexChecker", 0, Scale=2.0)
    links.new(mixed(nodes, links, source, pattern, 0.2), inputs["Base Color"])
    things[1].data.materials.append(things[0].active_material)
    layer = scene.view_layers[0]
    layer.use_pass_object_index, layer.use_pass_diffuse_color, layer.uwvdb.use_albedo = True, True, True
    for number, thing in enumerate(things, 1):
        thing.pass_index = number
    ours, theirs = render(), render("CYCLES", samples=16)
    for number in (1, 2):
        where = inner(ours["IndexOB"][..., 0], number) & (theirs["IndexOB"][..., 0] == number)
        close(ours["albedo"][where].mean(0), theirs["DiffCol"][where].mean(0), 1e-2, f"mean of box {number}")
