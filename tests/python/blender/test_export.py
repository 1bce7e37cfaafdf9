# ctest labels: metamorphic
"""File > Export > uwvdb Scene: the files render to what F12 shows."""

import shutil

from support import *

PLUME = ROOT / "assets/grids/plume128_blosc_half_0030.vdb"


def reef():
    """Water, a plume, a box that moves while the shutter is open, and a camera in a housing."""
    scene = empty_scene(60, 40)
    scene.world.uwvdb.kind, scene.world.uwvdb.preset = "PRESET", "jerlov-II"
    scene.camera.location, scene.camera.data.uwvdb.housing = (0, -3, 0.5), "FLAT"
    square("Floor", size=20, location=(0, 0, -0.5))
    block = box("Block", size=(0.4, 0.4, 0.4))
    # Renders see another shape than the viewport.
    block.modifiers.new("Round", "SUBSURF").render_levels = 2
    for frame, x in ((1, 0), (3, 0.5)):
        block.location.x = x
        block.keyframe_insert("location", frame=frame)
    scene.render.use_motion_blur = True
    light("POINT", "Left", 300, (-1, -2, 1))
    data = bpy.data.volumes.new("Plume")
    data.filepath = str(PLUME)
    grid = add("Plume", data, (-1, 0.5, 0), scale=(0.4, 0.4, 0.4)).uwvdb.grids.add()
    grid.name, grid.small, grid.large = "density", 2, 3
    scene.view_layers[0].use_pass_z = True
    scene.frame_set(2)
    return scene


def commands_of(**settings):
    """Exports, and returns the commands that the engine says."""
    engine, found = sys.modules["uwvdb_blender.engine"], []
    plain = engine.export
    engine.export = lambda path: found.extend(plain(path)) or found
    try:
        assert bpy.ops.export_scene.uwvdb(**settings) == {"FINISHED"}
    finally:
        engine.export = plain
    return found


def test_renders_to_the_same_bytes_as_f12_anywhere():
    reef()
    wanted = render()
    for copies in (False, True):
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder) / "here"
            place.mkdir()
            command, = commands_of(filepath=str(place / "dive.yaml"), copies=copies)
            assert sorted(p.suffix for p in place.iterdir()) == [".glb", ".vdb", ".yaml"]
            assert all(p.name.startswith("dive") or p.suffix == ".vdb" for p in place.iterdir())
            assert any(p.is_symlink() for p in place.iterdir()) != copies
            there = shutil.move(place, pathlib.Path(folder) / "there")
            command = [word.replace(str(place), str(there)) for word in command]
            done = subprocess.run(command, text=True, capture_output=True)
            assert done.returncode == 0, done.stderr
            image = sys.modules["uwvdb_blender.exr"].read(f"{there}/dive.exr")
        assert image.get("", "RGBA").tobytes() == wanted["Combined"].tobytes()
        depth = image.get("depth", "Z")
        close(depth, wanted["Depth"], 1e-6, "depth", depth > 0)


def test_each_eye_has_a_file():
    scene = reef()
    scene.render.use_multiview = True
    with tempfile.TemporaryDirectory() as folder:
        commands_of(filepath=f"{folder}/dive.yaml")
        made = {path.name for path in pathlib.Path(folder).iterdir() if path.suffix != ".vdb"}
    assert made == {f"dive_{eye}{end}" for eye in ("left", "right") for end in (".yaml", "-meshes.glb")}


def test_what_cannot_be_written_is_one_clear_line():
    scene = reef()
    for spoil, words in ((lambda: None, "/nowhere"), (lambda: setattr(scene, "camera", None), "no camera")):
        spoil()
        try:
            bpy.ops.export_scene.uwvdb(filepath="/nowhere/dive.yaml")
        except RuntimeError as error:
            assert words in str(error) and "Traceback" not in str(error), error
        else:
            raise AssertionError("it was written")
    scene.render.engine = "BLENDER_WORKBENCH"
    assert not bpy.ops.export_scene.uwvdb.poll()
