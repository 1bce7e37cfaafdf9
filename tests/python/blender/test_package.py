# ctest labels: unit
"""The add-on as it is given to users."""

import re

from support import *

FIRST_RENDER = """
import bpy, sys
archive, program = sys.argv[-2:]
if hasattr(bpy.ops, "extensions") and bpy.app.version >= (4, 2, 0):
    bpy.ops.extensions.package_install_files(filepath=archive, repo="user_default", enable_on_install=True)
    name = "bl_ext.user_default.uwvdb_blender"
else:
    bpy.ops.preferences.addon_install(filepath=archive)
    bpy.ops.preferences.addon_enable(module="uwvdb_blender")
    name = "uwvdb_blender"
bpy.context.preferences.addons[name].preferences.program = program
scene = bpy.context.scene
scene.render.engine = "UWVDB"
scene.render.resolution_x, scene.render.resolution_y = 64, 48
scene.render.filepath = "image.png"
bpy.ops.render.render(write_still=True)
"""


def test_installs_from_its_archive_and_renders():
    with tempfile.TemporaryDirectory() as folder:
        place = pathlib.Path(folder)
        subprocess.run([ROOT / "scripts/blender-addon", place / "one.zip"], check=True)
        subprocess.run([ROOT / "scripts/blender-addon", place / "two.zip"], check=True)
        assert (place / "one.zip").read_bytes() == (place / "two.zip").read_bytes()
        (place / "first.py").write_text(FIRST_RENDER)
        (place / "scripts").mkdir()
        environment = {**os.environ, "BLENDER_USER_SCRIPTS": str(place / "scripts"),
                       "BLENDER_USER_CONFIG": str(place / "config"),
                       "BLENDER_USER_EXTENSIONS": str(place / "extensions"), "HOME": folder}
        done = subprocess.run([bpy.app.binary_path, "--background", "--factory-startup",
                               "--python-exit-code", "1", "--python", place / "first.py", "--",
                               place / "one.zip", PROGRAM], cwd=folder, env=environment, text=True,
                              capture_output=True)
        assert done.returncode == 0, done.stdout + done.stderr
        assert (place / "image.png").stat().st_size > 500


def test_versions_agree():
    folder = ROOT / "python/blender/uwvdb_blender"
    project = re.search(r"project\(uwvdb VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
    manifest = re.search(r'^version = "(.*)"$', (folder / "blender_manifest.toml").read_text(), re.M)[1]
    empty_scene()
    own = sys.modules["uwvdb_blender"].bl_info["version"]
    assert manifest == project == ".".join(map(str, own)), (manifest, project, own)
