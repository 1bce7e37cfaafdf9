# ctest labels: unit
"""The add-on's own face: panels draw, settings are stored, and it can be switched off and on."""

import inspect

from support import *

PLUME = ROOT / "assets/grids/plume128_blosc_half_0030.vdb"


class Pen:
    """Stands for a layout: notes which properties are drawn, and refuses those that do not exist."""

    def __init__(self, drawn):
        self.drawn = drawn

    def prop(self, owner, name, **_):
        assert hasattr(owner, name), f"{owner} has no {name}"
        self.drawn.add((type(owner).__name__, name))

    def operator(self, name, **_):
        assert hasattr(getattr(bpy.ops, name.split(".")[0]), name.split(".")[1])

    def label(self, **_):
        pass

    def separator(self):
        pass

    def row(self, **_):
        return self

    column = row


def draw_all(context_of):
    """Draws every panel that applies, and returns the properties drawn."""
    drawn = set()
    panels = sys.modules["uwvdb_blender.panels"]
    for panel in panels.CLASSES:
        if not issubclass(panel, bpy.types.Panel) or not panel.poll(context_of):
            continue
        stand_in = type("StandIn", (), {"layout": Pen(drawn)})()
        stand_in.begin = panel.begin.__get__(stand_in)
        for name in ("draw_header", "draw"):
            if name in vars(panel) or name == "draw":
                function = getattr(panel, name)
                inspect.unwrap(function)(stand_in, context_of)
    return drawn


class Context:
    def __init__(self, scene, shown):
        self.engine, self.scene, self.object, self.world = "UWVDB", scene, shown, scene.world
        self.view_layer = scene.view_layers[0]
        self.camera = shown.data if shown.type == "CAMERA" else None
        self.light = shown.data if shown.type == "LIGHT" else None


def test_every_setting_is_in_a_panel():
    scene = empty_scene()
    properties = sys.modules["uwvdb_blender.properties"]
    volume = add("Volume", bpy.data.volumes.new("Volume"))
    volume.uwvdb.grids.add()
    drawn = set()
    for kind in ("PRESET", "CONSTITUENTS", "COEFFICIENTS", "NONE"):
        scene.world.uwvdb.kind = kind
        for housing in ("NONE", "FLAT", "DOME"):
            scene.camera.data.uwvdb.housing = housing
            for integrator in ("VOLUME", "PATH"):
                scene.uwvdb.integrator = integrator
                for shown in (scene.camera, volume, *(light(k) for k in ("POINT", "SUN", "SPOT", "AREA"))):
                    drawn |= draw_all(Context(scene, shown))
    for group in ("Scene", "ViewLayer", "World", "Camera", "Grid"):
        for name in getattr(properties, f"Uwvdb{group}").__annotations__:
            assert (f"Uwvdb{group}", name) in drawn, f"no panel draws Uwvdb{group}.{name}"
    assert ("RenderSettings", "preview_pixel_size") in drawn
    for name in ("energy", "color", "angle", "spot_size", "spot_blend", "size", "shape"):
        assert any(n == name for _, n in drawn), name


def test_settings_are_stored_in_the_file():
    scene = empty_scene()
    scene.world.uwvdb.preset, scene.world.uwvdb.large = "jerlov-3C", 0.7
    scene.camera.data.uwvdb.housing = "DOME"
    scene.view_layers[0].uwvdb.use_clean = True
    with tempfile.TemporaryDirectory() as folder:
        bpy.ops.wm.save_as_mainfile(filepath=f"{folder}/stored.blend")
        empty_scene()
        bpy.ops.wm.open_mainfile(filepath=f"{folder}/stored.blend")
    scene = bpy.context.scene
    assert scene.world.uwvdb.preset == "jerlov-3C" and abs(scene.world.uwvdb.large - 0.7) < 1e-6
    assert scene.camera.data.uwvdb.housing == "DOME" and scene.view_layers[0].uwvdb.use_clean


def test_read_grids_fills_the_panel():
    empty_scene()
    data = bpy.data.volumes.new("Plume")
    data.filepath = str(PLUME)
    thing = add("Plume", data)
    bpy.context.view_layer.objects.active = thing
    assert bpy.ops.uwvdb.read_grids() == {"FINISHED"}
    grids = {grid.name: (grid.small, grid.large) for grid in thing.uwvdb.grids}
    assert thing.uwvdb.grids[0].name == "density" and "temperature" in grids and "velocity" not in grids
    assert 0.5 < grids["density"][0] < 1 and abs(grids["density"][1] / grids["density"][0] - 5) < 0.1
    assert grids["temperature"] == (0, 0)
    bpy.ops.uwvdb.forget_grids()
    assert len(thing.uwvdb.grids) == 0


def test_off_and_on_again():
    empty_scene()
    for panel in (bpy.types.RENDER_PT_output, bpy.types.DATA_PT_camera_dof,
                  bpy.types.EEVEE_MATERIAL_PT_surface):
        assert "UWVDB" in panel.COMPAT_ENGINES, panel
    left_out = [name for name in sys.modules["uwvdb_blender.panels"].WITHOUT if hasattr(bpy.types, name)]
    assert "DATA_PT_light" in left_out and "DATA_PT_preview" in left_out
    for name in left_out:
        assert "UWVDB" not in getattr(bpy.types, name).COMPAT_ENGINES, name
    bpy.ops.preferences.addon_disable(module="uwvdb_blender")
    assert not hasattr(bpy.types.Scene, "uwvdb")
    assert "UWVDB" not in bpy.types.RENDER_PT_output.COMPAT_ENGINES
    bpy.ops.preferences.addon_enable(module="uwvdb_blender")
    assert hasattr(bpy.types.Scene, "uwvdb")


def test_a_missing_program_is_one_clear_line():
    scene = empty_scene()
    bpy.context.preferences.addons["uwvdb_blender"].preferences.program = "/nowhere/uwvdb"
    find = sys.modules["uwvdb_blender.program"].find
    refusal = sys.modules["uwvdb_blender.notes"].Refusal
    for chosen, words in (("/nowhere/uwvdb", ("'/nowhere/uwvdb'", "Preferences > Add-ons")),
                          ("", ("PATH", "Preferences > Add-ons"))):
        kept, os.environ["PATH"] = os.environ["PATH"], "/nowhere"
        try:
            find(chosen)
            raise AssertionError("found")
        except refusal as missing:
            assert all(word in str(missing) for word in words) and "\n" not in str(missing)
        finally:
            os.environ["PATH"] = kept
    try:
        bpy.ops.render.render()
    except RuntimeError as error:
        assert "/nowhere/uwvdb" in str(error), error
    else:
        raise AssertionError("a render without the program succeeded")


def test_a_wrong_scene_is_told_by_the_program():
    scene = empty_scene()
    scene.world.uwvdb.kind = "PRESET"
    scene.uwvdb.use_forward_scatter, scene.uwvdb.scattering = True, "MULTIPLE"
    try:
        bpy.ops.render.render()
    except RuntimeError as error:
        assert "forward" in str(error).lower(), error
    else:
        raise AssertionError("forward scatter and multiple scattering were taken together")
