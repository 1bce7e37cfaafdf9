# ctest labels: metamorphic slow
"""Blender's Unit Scale makes metres of units, in which water absorbs; without water no picture depends on it, as
Cycles, which has no such thing, shows."""

from plumes import *
from support import *
from test_emission import light_agrees, shining, times_attribute
from test_lamps import floor_scene, luminaire

SCALES = (0.01, 0.1, 1, 10)


def at_scales(what, tolerance, bright, cycles_samples=64, sphere=None):
    """Renders the scene with each scale: all as Cycles does, and the same to single precision. `sphere` is that of
    against_cycles() in tests/blender/test_lamps.py."""
    unit = bpy.context.scene.unit_settings
    unit.scale_length = 0.01
    theirs = render("CYCLES", samples=cycles_samples)
    wanted = theirs["Combined"][..., 0]
    if sphere is not None:
        location, radius = sphere
        away = numpy.array(location) - theirs["Position"].astype(float)
        wanted = wanted * (1 + radius**2 / (away**2).sum(axis=-1))
    first = None
    for unit.scale_length in SCALES:
        ours = render()["Combined"][..., 0]
        median_close(ours, wanted, tolerance, f"{what}, scale {unit.scale_length:g}", wanted > bright * wanted.max())
        first = ours if first is None else first
        off = numpy.abs(ours - first) > 1e-4 * first.max()
        assert off.mean() < 2e-3, f"{what}, scale {unit.scale_length:g}: {off.mean():.2%} of the pixels have changed"


def lit_floor(*arguments, **settings):
    scene = floor_scene()
    scene.render.resolution_x, scene.render.resolution_y = 48, 32
    scene.world.uwvdb.use_surface, scene.world.uwvdb.surface_height = True, 4
    scene.camera.location.z = 3.5
    return scene, light(*arguments, **settings)


# The tolerances are those of tests/blender/test_lamps.py at scale 1.
def test_points_and_spots():
    lit_floor("POINT", watts=200, location=(-1.5, 0.7, 2.0))
    at_scales("point", 2e-3, 0.02)
    _, lamp = lit_floor("SPOT", watts=300, location=(-1.5, 0.7, 2.5), rotation=(0.1, -0.5, 0.8), spot_size=1.1,
                        spot_blend=0.4)
    at_scales("spot", 2e-3, 0.02)
    lit_floor("POINT", watts=200, location=(-1.5, 0.7, 2.0), shadow_soft_size=0.3)
    at_scales("point with a radius", 2e-3, 0.02, 512, ((-1.5, 0.7, 2.0), 0.3))


def test_areas():
    for what, settings in (("rectangle", {"shape": "RECTANGLE", "size": 1.6, "size_y": 0.2}),
                           ("disk", {"shape": "DISK", "size": 0.6}),
                           ("spread", {"shape": "DISK", "size": 0.6, "spread": math.radians(90)})):
        lit_floor("AREA", watts=300, location=(-1.2, 0.6, 1.5), rotation=(0.2, -0.7, 0.9), **settings)
        at_scales(what, 5e-3, 0.05, 512)


def test_suns():
    lit_floor("SUN", watts=3, rotation=(0.6, 0.2, 0.5))
    at_scales("sun", 2e-3, 0.02)


def test_luminaires():
    with tempfile.TemporaryDirectory() as folder:
        _, lamp = lit_floor("POINT", watts=3, location=(-0.2, 0.1, 1.5), rotation=(0.2, 0.1, 0.6))
        bpy.data.objects.remove(bpy.data.objects["Box"])
        lamp.data.use_nodes = True
        nodes, links = lamp.data.node_tree.nodes, lamp.data.node_tree.links
        photometry = nodes.new("ShaderNodeTexIES")
        photometry.mode, photometry.filepath = "EXTERNAL", luminaire(folder)
        links.new(photometry.outputs[0], next(n for n in nodes if n.type == "EMISSION").inputs["Strength"])
        at_scales("IES", 2e-3, 0.05)


def test_lights_that_move():
    """What a light's trajectory has is in metres as well."""
    scene, lamp = lit_floor("POINT", watts=200, location=(-1.5, 0.7, 2.0))
    for frame, x in ((1, -1.51), (3, -1.49)):
        lamp.location.x = x
        lamp.keyframe_insert("location", frame=frame)
    scene.frame_set(2)
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 0.5
    at_scales("moving point", 5e-3, 0.05)


def test_surfaces_that_shine_and_depth_of_field():
    """A board out of focus: its brightness, and how wide its edge is blurred."""
    scene = empty_scene(96, 32)
    shining = material("Shining", (1, 1, 1), "ShaderNodeEmission")[0]
    square(size=4, location=(2, 2, 0), rotation=(math.pi / 2, 0, 0)).data.materials.append(shining)
    camera = scene.camera.data
    camera.dof.use_dof, camera.dof.focus_distance, camera.dof.aperture_fstop = True, 4, 0.25
    scene.uwvdb.samples = 256
    theirs = render("CYCLES", samples=256)["Combined"][..., 0].mean(axis=0)
    assert ((theirs > 0.05) & (theirs < 0.95)).sum() > 4
    for scene.unit_settings.scale_length in SCALES:
        ours = render()["Combined"][..., 0].mean(axis=0)
        close(ours, theirs, 0.02, f"blurred edge, scale {scene.unit_settings.scale_length:g}")


PLUME = ROOT / "assets/grids/plume128_blosc_half_0030.vdb"


def test_volumes_that_shine():
    """What a volume gives off is counted by units of length, too."""
    scene = empty_scene(120, 90)
    thing = volume_object(PLUME, location=(-1.5, 3.5, -0.5), scale=(0.5, 0.5, 0.5))
    thing.uwvdb.grids[0].small = 0
    times_attribute(shining(thing, Emission_Color=(0.2, 0.5, 1, 1)), "density", 2)
    for scene.unit_settings.scale_length in SCALES:
        light_agrees(f"scale {scene.unit_settings.scale_length:g}", 0.005, 0.005)


def test_volumes_that_absorb():
    """Concentrations are those of water: a plume whose box is a tenth as large has a tenth of the optical depth, and
    that with the concentrations that are advised for its size has the same."""
    scene = wall_scene(60, 45)
    thing = volume_object(PLUME, location=(-3, 7, -1))
    thing.uwvdb.grids[0].small = 0.1
    depths, advised = [], []
    for scene.unit_settings.scale_length in SCALES:
        depths.append(-numpy.log(render()["Combined"][..., 1].min()))
    thing.uwvdb.grids.clear()
    for scene.unit_settings.scale_length in SCALES:
        advised.append(-numpy.log(render()["Combined"][..., 1].min()))
    print(f"    depths {depths}, by advice {advised}")
    # A pixel is a mean of light, not of depths, which matters to the densest.
    close(numpy.array(depths) / SCALES, [depths[2]] * 4, 3e-3, "depth per scale")
    close(advised, [advised[2]] * len(SCALES), 1e-3, "depth by advice")


def test_housings():
    """Lengths of a port are in Blender's units like all others."""
    for kind in ("FLAT", "DOME"):
        scene = empty_scene(48, 32)
        square(size=40, location=(0, 2, 0), rotation=(math.pi / 2, 0, 0))
        scene.view_layers[0].use_pass_position = True
        housing = scene.camera.data.uwvdb
        housing.housing, housing.thickness, housing.distance = kind, 0.05, 0.1
        housing.radius, housing.center = 0.08, (0.01, 0.005, 0.02)
        at_one = render()["Position"]
        for scene.unit_settings.scale_length in SCALES:
            close(render()["Position"], at_one, 1e-5, f"{kind}, scale {scene.unit_settings.scale_length:g}")


def test_water_is_in_metres():
    """A board 2 units away is 2 metres times the scale away, in Blender's systems of units that have one."""
    scene = empty_scene(24, 16)
    square(size=40, location=(0, 2, 0), rotation=(math.pi / 2, 0, 0))
    scene.world.uwvdb.kind, scene.world.uwvdb.snow_drift = "COEFFICIENTS", (1, -2, 0.5)
    layer = scene.view_layers[0].uwvdb
    layer.use_range = layer.use_transmittance = True
    water, unit = sys.modules["uwvdb_blender.water"], scene.unit_settings
    scene.world.uwvdb.use_snow = True
    for system in ("METRIC", "IMPERIAL", "NONE"):
        for scale in SCALES[:3]:
            scene.world.uwvdb.use_snow = False
            unit.system, unit.scale_length = system, scale
            metres = scale if system != "NONE" else 1
            passes = render()
            middle = passes["range"][8, 12, 0]
            assert abs(middle / (2 * metres) - 1) < 2e-3, (system, scale, middle)
            close(passes["transmittance"], numpy.exp(-passes["range"] * [0.5, 0.27, 0.23]), 1e-4, "transmittance")
            scene.world.uwvdb.use_snow = True
            to_metres = sys.modules["uwvdb_blender.units"].to_metres(scene)
            drift = water.describe(scene, [620, 540, 450], to_metres)["snow"]["drift"]
            close(drift, [metres, -2 * metres, 0.5 * metres], 1e-6, "drift")


def test_every_length_of_the_panels_is_scaled():
    """Properties that Blender shows in units of length or speed are known to the tests above."""
    empty_scene()
    known = {"surface_height", "snow_drift", "distance", "thickness", "radius", "center"}
    properties = sys.modules["uwvdb_blender.properties"]
    found = {item.identifier for _, group in properties.PLACES for item in group.bl_rna.properties
             if getattr(item, "unit", "NONE") in ("LENGTH", "VELOCITY", "AREA", "VOLUME", "ACCELERATION", "POWER")}
    assert found == known, found ^ known
