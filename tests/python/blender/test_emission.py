# ctest labels: metamorphic slow
"""Fluid domains and Volume objects whose material gives off light do so as Cycles shows them, pixel by pixel."""

from plumes import *
from support import *
from test_domains import CANNOT_RUN



def shining(thing, **inputs):
    """A Principled Volume that gives off light and neither absorbs nor scatters."""
    node = absorbing(thing, 0)
    node.inputs["Density Attribute"].default_value = ""
    for name, value in inputs.items():
        node.inputs[name.replace("_", " ")].default_value = value
    return node


def times_attribute(node, attribute, number):
    """Emission strength: an attribute times a number."""
    tree = next(m for m in bpy.data.materials if m.node_tree and node in m.node_tree.nodes[:]).node_tree
    read, product = tree.nodes.new("ShaderNodeAttribute"), tree.nodes.new("ShaderNodeMath")
    read.attribute_name = attribute
    product.operation, product.inputs[1].default_value = "MULTIPLY", number
    tree.links.new(read.outputs["Fac"], product.inputs[0])
    tree.links.new(product.outputs[0], node.inputs["Emission Strength"])


def fire(folder, frames=8, **settings):
    """A small flame in a domain that is turned."""
    bpy.context.scene.frame_start, bpy.context.scene.frame_end = 1, frames
    source = box("Source", size=(0.5, 0.5, 0.5), location=(0.3, 5, -0.5))
    source.data.materials.append(material("Skin")[0])
    source.hide_render = True
    flow = source.modifiers.new("Fluid", "FLUID")
    flow.fluid_type = "FLOW"
    flow.flow_settings.flow_type, flow.flow_settings.flow_behavior = "FIRE", "INFLOW"
    domain = box("Domain", location=(0.2, 5, 0.1), rotation=(0, 0, 0.5), scale=(2.2, 1.5, 2.0))
    bpy.context.view_layer.update()
    modifier = domain.modifiers.new("Fluid", "FLUID")
    modifier.fluid_type = "DOMAIN"
    cache = modifier.domain_settings
    cache.domain_type, cache.resolution_max, cache.cache_directory = "GAS", 24, str(folder)
    for key, value in settings.items():
        setattr(cache, key, value)
    cache.cache_frame_start, cache.cache_frame_end, cache.cache_data_format = 1, frames, "OPENVDB"
    cache.cache_type = "ALL"
    bpy.context.view_layer.objects.active = domain
    bpy.ops.fluid.bake_all()
    # No concentration: only what the material gives off.
    grid = domain.uwvdb.grids.add()
    grid.name, grid.small, grid.large = "density", 0, 0
    return domain


def light_agrees(what, of_mean, of_rms, frame=None):
    """The light of every pixel by both engines: how far off its mean is in each colour, and the RMS of the
    difference over that of the light, may be so much."""
    scene = bpy.context.scene
    scene.cycles.volume_step_rate, scene.cycles.volume_max_steps = 0.1, 4096
    ours = render(frame=frame)["Combined"][..., :3]
    theirs = render("CYCLES", frame=frame, samples=64)["Combined"][..., :3]
    assert theirs.max() > 0 and (theirs[..., 1] > 0.02 * theirs[..., 1].max()).sum() > 200, theirs.max()
    means = [ours[..., c].mean() / theirs[..., c].mean() - 1 for c in range(3) if theirs[..., c].max() > 0]
    rms = math.sqrt(((ours - theirs)**2).mean() / (theirs[theirs > 0.05 * theirs.max()]**2).mean())
    print(f"    {what}: means {', '.join(f'{m:+.2%}' for m in means)}, rms {rms:.2%}, brightest {theirs.max():.3g}")
    assert max(map(abs, means)) < of_mean and rms < of_rms, (what, means, rms)


def test_flame_as_a_blackbody():
    """Blender makes temperatures of the flame in each voxel, 0 where there is none and else at least that of
    ignition, and Cycles interpolates these; here the flame is interpolated, so that its outermost voxel is as hot
    as it burns. That is more light, mostly red, by the flame's surface for its volume: large in this small one."""
    with tempfile.TemporaryDirectory(prefix="uwvdb-test-") as folder:
        empty_scene(120, 90)
        domain = fire(folder)
        shining(domain, Blackbody_Intensity=0.8, Blackbody_Tint=(1, 0.7, 0.5, 1))
        light_agrees("blackbody", 0.2, 0.06, 8)


def test_flame_by_its_attribute():
    with tempfile.TemporaryDirectory(prefix="uwvdb-test-") as folder:
        scene = empty_scene(120, 90)
        scene.unit_settings.scale_length = 0.5
        domain = fire(folder, use_noise=True)
        node = shining(domain, Emission_Color=(0.9, 0.5, 0.1, 1))
        times_attribute(node, "flame", 3)
        light_agrees("flame", 0.005, 0.005, 8)
        assert not [note for note in notes() if "left out" in note], notes()


def test_volume_object_that_shines():
    """In a Volume object that is scaled down by half Cycles makes what is given off twice as bright per metre."""
    empty_scene(120, 90)
    thing = volume_object(ROOT / "assets/grids/plume128_blosc_half_0030.vdb", location=(-1.5, 3.5, -0.5),
                          scale=(0.5, 0.5, 0.5))
    thing.uwvdb.grids[0].small = 0
    node = shining(thing, Emission_Color=(0.2, 0.5, 1, 1))
    times_attribute(node, "density", 2)
    light_agrees("volume object", 0.005, 0.005)


def test_volume_object_as_a_blackbody():
    """The colours here are of Planck's law and a fit of the matching functions, some per cent from the fit that
    Cycles has of the colours themselves; where and how bright is the same."""
    empty_scene(120, 90)
    thing = volume_object(ROOT / "assets/grids/plume128_blosc_half_0030.vdb", location=(-3, 7, -1))
    thing.uwvdb.grids[0].small = 0
    shining(thing, Blackbody_Intensity=1, Temperature=20000)
    light_agrees("temperature", 0.02, 0.01)


def test_what_is_left_out_is_said():
    empty_scene()
    thing = volume_object(ROOT / "assets/grids/plume128_blosc_half_0030.vdb", location=(-3, 7, -1))
    shining(thing, Emission_Strength=1, Blackbody_Intensity=1, Temperature_Attribute="nothing")
    render()
    assert any("the same everywhere" in note for note in notes()), notes()
    assert any("no grid 'nothing'" in note for note in notes()), notes()
