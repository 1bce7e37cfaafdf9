# ctest labels: unit
"""Each feature of Blender in the add-on's table of what a render leaves out is said once where it is used, and not
where it is not."""

import types

from support import *

PLUME = ROOT / "assets/grids/plume128_blosc_half_0030.vdb"


OF_SCENE = ("scene", "layer", "world", "camera")


def module():
    return sys.modules["uwvdb_blender.features"]


def plain_scene():
    """A scene of 8 x 6 pixels that uses none of them."""
    scene = empty_scene(8, 6)
    scene.uwvdb.quality = "DRAFT"
    box(location=(0, 3, 0))
    light("AREA", "Panel", location=(1, 1, 1))
    data = bpy.data.volumes.new("Plume")
    data.filepath = str(PLUME)
    grid = add("Plume", data, location=(-3, 7, -1)).uwvdb.grids.add()
    grid.name, grid.small = "density", 3
    return scene


def thing(name="Box"):
    return bpy.data.objects[name]


def on(owner, **settings):
    """Sets what is the owner's own, or the add-on Cycles' of it."""
    for name, value in settings.items():
        setattr(owner if hasattr(owner, name) else owner.cycles, name, value)


def in_collection(**settings):
    group = bpy.data.collections.new("Group")
    bpy.context.scene.collection.children.link(group)
    bpy.context.scene.collection.objects.unlink(thing())
    group.objects.link(thing())
    on(bpy.context.view_layer.layer_collection.children["Group"], **settings)


def change():
    modifier = thing().modifiers.new("Row", "ARRAY")
    for frame, count in ((0, 1), (2, 9)):
        modifier.count = count
        modifier.keyframe_insert("count", frame=frame)
    bpy.context.scene.render.use_motion_blur = True


def blurred_less():
    bpy.context.scene.render.use_motion_blur = True
    on(thing(), use_motion_blur=False)


def cull():
    bpy.context.scene.render.use_simplify = True
    on(bpy.context.scene, use_camera_cull=True)
    on(thing(), use_camera_cull=True)


def hair():
    thing().modifiers.new("Hair", "PARTICLE_SYSTEM")
    settings = thing().particle_systems[0].settings
    settings.type, settings.count = "HAIR", 3
    settings.render_type = "PATH"


def unknown():
    add("Curves", bpy.data.hair_curves.new("Curves"))


def fisheye(**settings):
    camera = thing("Camera").data
    camera.type = "PANO"
    on(camera, panorama_type="FISHEYE_EQUIDISTANT", fisheye_fov=2.0)
    on(camera.stereo, **{name: value for name, value in settings.items() if name == "use_spherical_stereo"})
    camera.dof.use_dof = settings.get("use_dof", False)


def stereo():
    bpy.context.scene.render.use_multiview = True
    fisheye(use_spherical_stereo=True)


def world_node(kind, socket):
    world = bpy.context.scene.world
    world.use_nodes = True
    nodes = world.node_tree.nodes
    nodes.clear()
    world.node_tree.links.new(nodes.new(kind).outputs[0], nodes.new("ShaderNodeOutputWorld").inputs[socket])


def shutter_curve():
    render_settings = bpy.context.scene.render
    render_settings.use_motion_blur = True
    render_settings.motion_blur_shutter_curve.curves[0].points[0].location.y = 0


def rolling():
    bpy.context.scene.render.use_motion_blur = True
    on(bpy.context.scene, rolling_shutter_type="TOP")


def far_away():
    bpy.context.view_layer.update()
    thing("Camera").data.clip_end = 3.2


def layer():
    return bpy.context.view_layer


# How each is provoked, by a part of what is said. Where a Blender has no such thing, what stands for it is returned.
PROVOKED = {
    "not visible to cameras": lambda: on(thing(), visible_camera=False),
    "Indirect Only": lambda: in_collection(indirect_only=True),
    "holdouts of volumes": lambda: on(thing("Plume"), is_holdout=True),
    "shadow catchers": lambda: on(thing(), is_shadow_catcher=True),
    "casts a shadow here, although": lambda: on(thing(), visible_shadow=False),
    "visible to all light": lambda: on(thing(), visible_glossy=False),
    "changes its vertices or faces in number": change,
    "its own Motion Blur is off": blurred_less,
    "not culled": cull,
    "Clip Start or End": far_away,
    "hair curves and point clouds": unknown,
    "hair of its particle systems": hair,
    "it has no file": lambda: add("Empty", bpy.data.volumes.new("Empty")) and None,
    "modifiers of volumes": lambda: thing("Plume").modifiers.new("Displaced", "VOLUME_DISPLACE") and None,
    "portals": lambda: on(thing("Panel").data, is_portal=True),
    "casts shadows here although": lambda: on(thing("Panel").data, **(
        {"cast_shadow": False} if hasattr(thing("Panel").data.cycles, "cast_shadow") else {"use_shadow": False})),
    "its Ray Visibility is left out": lambda: on(thing("Panel"), visible_volume_scatter=False),
    "whatever it is linked to": lambda: types.SimpleNamespace(
        light_linking=types.SimpleNamespace(receiver_collection=True, blocker_collection=None)),
    "blades and ratio": lambda: on(thing("Camera").data.dof, use_dof=True, aperture_blades=5),
    "a fisheye has none": lambda: fisheye(use_dof=True),
    "spherical stereo": stereo,
    "background gives no light": lambda: world_node("ShaderNodeBackground", "Surface"),
    "world's volume shader": lambda: world_node("ShaderNodeVolumeScatter", "Volume"),
    "View Layer > Filter": lambda: on(layer(), use_volumes=False),
    "some passes are not made": lambda: on(layer(), use_pass_mist=True),
    "light groups": lambda: bpy.ops.scene.view_layer_add_lightgroup(name="Group") and None,
    "World Override": lambda: types.SimpleNamespace(world_override=True),
    "Film > Exposure": lambda: on(bpy.context.scene, film_exposure=2),
    "Film > Transparent": lambda: on(bpy.context.scene.render, film_transparent=True),
    "its curve": shutter_curve,
    "rolling shutter": rolling,
    # Blender draws these with a window system's graphics, which tests do without.
    "Freestyle": lambda: types.SimpleNamespace(render=types.SimpleNamespace(use_freestyle=True)),
    "drawn by Blender over the picture, without water": lambda: types.SimpleNamespace(
        type="GPENCIL" if bpy.app.version < (4, 3, 0) else "GREASEPENCIL"),
}


def row_of(words):
    found = [feature for feature in module().TABLE if words in feature.says]
    assert len(found) == 1, (words, [feature.says for feature in found])
    return found[0]


def said():
    return [note for note in notes() if any(feature.says in note for feature in module().TABLE)]


def test_nothing_is_said_of_a_plain_scene():
    plain_scene()
    render()
    assert not said(), said()


def test_every_row_is_provoked_here():
    plain_scene()
    rows = [row_of(words) for words in PROVOKED]
    assert len(set(rows)) == len(rows) == len(module().TABLE)


def test_each_is_said_once():
    for words, provoke in PROVOKED.items():
        scene = plain_scene()
        feature, stand_in = row_of(words), provoke()
        if stand_in is not None:
            about = module().Scene(bpy.context.evaluated_depsgraph_get(), None, None)
            whom = (stand_in,) if feature.of in OF_SCENE else (stand_in, stand_in)
            assert feature.is_used(*whom, about), words
            continue
        render(suffix="_L" if scene.render.use_multiview else "")
        assert len(said()) == 1 and feature.says in said()[0], (words, said())
        if feature.of not in OF_SCENE:
            assert said()[0].removeprefix("light ").startswith("'"), said()


def test_names_are_gathered():
    """Many objects have one line."""
    plain_scene()
    for number in range(6):
        box(f"Box {number}", location=(number - 3, 5, 0)).visible_shadow = False
    render()
    line, = said()
    assert line.startswith("'Box 0', 'Box 1', 'Box 2' and 3 more: casts a shadow here"), line


def test_what_the_camera_does_not_see_is_left_out():
    """Surfaces and plumes, by their own settings, by their collections and by those of what shows them."""
    def seen():
        return render()["IndexOB"][..., 0].max()

    def shown(how):
        scene = empty_scene(12, 8)
        scene.view_layers[0].use_pass_object_index = True
        box(location=(0, 3, 0)).pass_index = 7
        assert seen() == 7
        how()
        return seen()

    def instanced():
        group = bpy.data.collections.new("Shown")
        bpy.context.scene.collection.objects.unlink(thing())
        group.objects.link(thing())
        holder = add("Holder", None)
        holder.instance_type, holder.instance_collection = "COLLECTION", group
        assert seen() == 7
        outer = bpy.data.collections.new("Outer")
        bpy.context.scene.collection.children.link(outer)
        bpy.context.scene.collection.objects.unlink(holder)
        outer.objects.link(holder)
        bpy.context.view_layer.layer_collection.children["Outer"].indirect_only = True

    assert shown(lambda: on(thing(), visible_camera=False)) == 0
    assert shown(lambda: in_collection(indirect_only=True)) == 0
    assert shown(instanced) == 0
    plain_scene()
    bpy.context.scene.world.uwvdb.kind = "NONE"
    thing("Plume").visible_camera = False
    wall = square("Wall", size=60, location=(0, 12, 0), rotation=(math.pi / 2, 0, 0))
    wall.data.materials.append(material("Shining", (1, 1, 1), "ShaderNodeEmission")[0])
    bpy.data.objects.remove(thing())
    lit = render()["Combined"][..., 0]
    assert lit.min() > 0.99, lit


def test_things_near_the_camera():
    """A pane before the camera within its Clip Start is named, a room around it is not."""
    for size, distance, is_near in ((0.2, 0.05, True), (0.2, 0.15, False)):
        plain_scene()
        square("Pane", size=size, location=(0, distance, 0), rotation=(math.pi / 2, 0, 0))
        render()
        assert any("Clip Start" in note for note in said()) == is_near, (distance, said())
    plain_scene()
    box("Room", size=(30, 30, 30))
    render()
    assert not said(), said()


def test_what_only_moves_or_deforms_needs_no_word():
    scene = plain_scene()
    thing().modifiers.new("Round", "SUBSURF")
    thing().shape_key_add(name="Basis")
    key = thing().shape_key_add(name="Bent")
    key.data[0].co.x += 1
    for frame, value in ((0, 0), (2, 1)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    for frame, x in ((0, 0), (2, 1)):
        thing().location.x = x
        thing().keyframe_insert("location", frame=frame)
    scene.render.use_motion_blur = True
    render(frame=1)
    assert not said(), said()
