# ctest labels: analytic
"""World > Water from a world's volume shader: what it does to light is what Cycles' does."""

from support import *


def volume_of(world, *shaders):
    """Gives a world the sum of volume shaders, each (kind, values of inputs by name)."""
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    nodes.clear()
    output, last = nodes.new("ShaderNodeOutputWorld"), None
    for kind, values in shaders:
        node = nodes.new(kind)
        for name, value in values.items():
            node.inputs[name].default_value = value
        if last is not None:
            both = nodes.new("ShaderNodeAddShader")
            links.new(last, both.inputs[0])
            links.new(node.outputs[0], both.inputs[1])
            node = both
        last = node.outputs[0]
    links.new(last, output.inputs["Volume"])
    return nodes, links


SHADERS = {
    "absorption": (("ShaderNodeVolumeAbsorption", {"Color": (0.2, 0.6, 0.9, 1), "Density": 0.4}),),
    "scatter": (("ShaderNodeVolumeScatter", {"Color": (0.3, 0.5, 0.7, 1), "Density": 0.5, "Anisotropy": 0.3}),),
    "principled": (("ShaderNodeVolumePrincipled", {"Color": (0.3, 0.4, 0.6, 1), "Density": 0.4, "Anisotropy": -0.2,
                                                   "Absorption Color": (0.25, 0.04, 0.09, 1)}),),
    "a sum": (("ShaderNodeVolumeAbsorption", {"Color": (0.2, 0.6, 0.9, 1), "Density": 0.2}),
              ("ShaderNodeVolumeScatter", {"Color": (0.8, 0.5, 0.7, 1), "Density": 0.2, "Anisotropy": 0.6})),
}


def test_transmittance_against_cycles():
    """Of a small lamp 3 units away, whose own light in the water between is faint."""
    for name, shaders in SHADERS.items():
        scene = empty_scene(9, 9)
        scene.camera.data.angle = math.radians(0.5)
        scene.camera.data.clip_start = 1e-3  # where Cycles' rays begin
        made, _, _, node = material("Lamp", (1, 1, 1), "ShaderNodeEmission")
        square("Lamp", size=0.03, location=(0, 3, 0), rotation=(math.pi / 2, 0, 0)).data.materials.append(made)
        volume_of(scene.world, *shaders)
        for scene.unit_settings.scale_length in (1, 0.1):
            assert bpy.ops.uwvdb.water_from_volume() == {"FINISHED"}
            ours = render()["Combined"][4, 4, :3]
            assert not any("volume shader" in note for note in notes()), notes()
            # Cycles has the light that the water scatters near the lamp, too: 1 % here.
            close(ours, render("CYCLES", samples=256)["Combined"][2:7, 2:7, :3].mean(axis=(0, 1)), 2e-2, name)


def test_scattering_and_anisotropy():
    """Closed forms: Volume Scatter takes Color times Density out of a ray and gives all of it to others."""
    scene = empty_scene()
    volume_of(scene.world, *SHADERS["a sum"])
    scene.unit_settings.scale_length = 0.5
    assert bpy.ops.uwvdb.water_from_volume() == {"FINISHED"}
    settings = scene.world.uwvdb
    assert settings.kind == "COEFFICIENTS"
    close(settings.absorption, [0.2 * 0.8 / 0.5, 0.2 * 0.4 / 0.5, 0.2 * 0.1 / 0.5], 1e-5, "absorption")
    close(settings.scattering, [0.2 * 0.8 / 0.5, 0.2 * 0.5 / 0.5, 0.2 * 0.7 / 0.5], 1e-5, "scattering")
    assert abs(settings.hg_g - 0.6) < 1e-6


def test_the_button_is_there_where_it_has_something_to_read():
    scene = empty_scene()
    assert not bpy.ops.uwvdb.water_from_volume.poll()
    nodes, links = volume_of(scene.world, *SHADERS["scatter"])
    assert bpy.ops.uwvdb.water_from_volume.poll()
    node = next(n for n in nodes if n.type == "VOLUME_SCATTER")
    links.new(nodes.new("ShaderNodeTexNoise").outputs[0], node.inputs["Density"])
    kind = scene.world.uwvdb.kind
    try:
        bpy.ops.uwvdb.water_from_volume()
        raise AssertionError("it was read")
    except RuntimeError as error:
        assert "Volume Scatter > Density has to be a number" in str(error), error
    assert scene.world.uwvdb.kind == kind
