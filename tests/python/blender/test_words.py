# ctest labels: unit
"""What the program says reaches the user in Blender's words: no option of the command line and no key of a scene file
is left in any line of it."""

import re

from support import *

# What the add-on's renders and views run.
SOURCES = ("core", "media", "camera", "render", "edit/document", "edit/session", "cli/render",
           "cli/info")
# Texts that are no messages: help, what is written into files, and names in them.
LITERAL = re.compile(r'(?:"(?:[^"\\\n]|\\.)*"\s*)+')
PART = re.compile(r'"((?:[^"\\\n]|\\.)*)"')
FILES = "vdb|nvdb|yaml|glb|gltf|csv|exr|png|jpg|tif|ies|txt|md|json|obj|ply|ocio|uni|tum|bin|usd|abc|dng|docs"


def words(**names):
    empty_scene()
    return sys.modules["uwvdb_blender.words"].Words("/tmp/scene", **names)


def keys():
    """All that a scene file can say, by the program's own readers."""
    found = set()
    for path in (ROOT / "core/scene").glob("*.cpp"):
        found |= set(re.findall(r'(?:find|required|has|at)\(\s*"([a-z][a-z_]*)"', path.read_text()))
        for block in re.findall(r"ConfigMap \w+\(\s*\w+,\s*\{(.*?)\}", path.read_text(), re.DOTALL):
            found |= set(re.findall(r'"([A-Za-z][a-z_A-Z]*)"', block))
    assert {"forward_scatter", "lamps", "voxel_size", "n_glass", "shutter"} <= found and len(found) > 150, sorted(found)
    return found


def messages():
    """Every literal of the sources that says something in words, as one line with its blanks filled in."""
    for folder in SOURCES:
        for path in sorted((ROOT / folder).rglob("*.cpp")):
            text = re.sub(r"^\s*(//.*|#include.*)$|'\\?\"'", "", path.read_text(), flags=re.MULTILINE)
            for match in LITERAL.finditer(text):
                said = "".join(PART.findall(match[0]))
                said = re.sub(r"\\(.)", lambda m: " " if m[1] == "n" else m[1], said)
                if said.count(" ") >= 3:
                    # What fmt fills in, and its doubled braces.
                    said = re.sub(r"(?<!\{)\{\d*(?::[^{}]*)?\}(?!\})", "7", said.replace("{{", "\1").replace("}}", "\2"))
                    said = said.replace("\1", "{").replace("\2", "}")
                    yield path.name, said if said[0] not in ";:," else "It is wrong" + said


def left(line, known):
    """What of the program's language is left in a line."""
    line = re.sub(rf"[\w/~.-]+\.(?:{FILES})\b|\b(?:grid|light|volume) '[^']*'", "NAME", line)
    found = re.findall(r"--[a-z][a-z-]*", line)
    found += [path for path in re.findall(r"(?<![\w/.])[a-z_]+(?:\[\w*\])?(?:\.[a-z_]+(?:\[\w*\])?)+", line)
              if set(re.findall(r"[a-z_]+", path)) & known]
    found += [key for key in re.findall(r"\b[a-z]+(?:_[a-z]+)+\b", line) if key in known]
    found += [key for key in re.findall(r"'([a-z_]+)'", line) if key in known]
    found += [f"{{{key}" for key in re.findall(r"\{([a-z_]+): ", line) if key in known]
    found += re.findall(r"`[a-z_]+`", line)
    return found


def test_no_line_of_the_program_keeps_keys_or_options():
    translate, known, count, changed = words(), keys(), 0, 0
    for file, said in messages():
        count += 1
        raw = left(said, known)
        line = f"uwvdb: /tmp/scene/scene.yaml:12:5: {said}"
        told = translate.of(line)
        assert not left(told, known), f"{file}: {said!r} becomes {told!r}, with {left(told, known)}"
        assert told.strip() and "\0" not in told, (file, said, told)
        changed += bool(raw)
    print(f"    {count} texts, {changed} of which name keys or options")
    assert count > 1000 and changed > 250, (count, changed)


def test_what_can_be_set_in_blender_is_named_there():
    translate = words(lamps=["Left.001", "Right"], volumes=[("Plume", "/dive/plume_0030.vdb")])
    for said, wanted in (
            ("/tmp/scene/image/scene.yaml:1:1: there are no lamps, so all that does not emit light will be black; "
             "add 'lamps'", "there are no lamps, so all that does not emit light will be black; add a light"),
            ("/tmp/scene/scene.yaml:86:5: lamps[1].intensity[0]: 7.9e12 is larger than anything in a scene; give W/sr "
             "on the axis, per band", "light 'Right': Power: 7.9e12 is larger than anything in a scene; give W/sr on "
             "the axis, per band"),
            ("/tmp/scene/scene.yaml:86:5: lamps[0]: its radius of 1e+12 is beyond 1e+07; lengths are in metres",
             "light 'Left.001': its radius of 1e+12 is beyond 1e+07; lengths are in metres"),
            ("/tmp/scene/scene.yaml:3:1: volumes[0]: its transform of 1e+12 is beyond 1e+07; scale the scene to metres",
             "volume 'Plume': its transform of 1e+12 is beyond 1e+07; scale the scene to metres"),
            ("/tmp/scene/scene.yaml:15:16: camera.lens.f_number: must be greater than 0, found 0; give the f-number, "
             "such as 2.8", "Camera > Depth of Field > F-Stop: must be greater than 0, found 0; give the f-number, such "
             "as 2.8"),
            ("/tmp/scene/scene.yaml:1:1: camera.port: the camera is outside its dome",
             "Camera > Housing: the camera is outside its dome"),
            ("single scattering leaves out about 5 % of this image's light, which is scattered or reflected more than "
             "once; render.scattering: multiple renders it", "single scattering leaves out about 5 % of this image's "
             "light, which is scattered or reflected more than once; Render > uwvdb > Scattering: Multiple renders it"),
            ("multiple scattering: its standard error is 3 % of the image's mean; for less, use --quality exact, or "
             "--integrator path with --error 0.02", "multiple scattering: its standard error is 3 % of the image's mean; "
             "for less, use Render > uwvdb > Quality: Exact, or Render > uwvdb > Integrator: Path and Render > uwvdb > "
             "Until Error: 0.02"),
            ("/tmp/scene/scene.yaml:9:9: volumes[0]: grid 'vel_x': its densest voxels are 7 optical depths across: the "
             "light on the outside of such clouds may be 2 to 10 % off; give a finer grid or fewer particles, or "
             "compare with --integrator reference", "volume 'Plume': grid 'vel_x': its densest voxels are 7 optical "
             "depths across: the light on the outside of such clouds may be 2 to 10 % off; give a finer grid or fewer "
             "particles, or compare with Render > uwvdb > Integrator: Reference"),
            ("'volume0-0123abcd.vdb' is empty", "'/dive/plume_0030.vdb' is empty"),
            ("/tmp/scene/scene.yaml:4:4: water.forward_scatter: its blur stands for light that multiple scattering "
             "renders, which would count twice; set K: 0, or use integrator volume with render.scattering: single",
             "Render > Forward Scatter: its blur stands for light that multiple scattering renders, which would count "
             "twice; set Render > Forward Scatter > Strength K to 0, or Render > uwvdb > Scattering: Single"),
            ("/tmp/scene/scene-meshes.glb: the mesh has no triangles; check what was exported, or take the camera or "
             "lamps of a glTF file (camera: true, lamps: all)",
             "the meshes: the mesh has no triangles"),
            ("/tmp/scene/image/scene.yaml: camera: it lies above water.surface, but all that it sees counts as water; move "
             "it below", "the camera: it lies above World > Water > Surface, but all that it sees counts as water; move "
             "it below"),
            ("/dive/rig_two.yaml: has 2 cameras (cam0, cam1); choose one: calibration: {file: ..., camera: cam0} in a "
             "scene, --camera cam0 on the command line",
             "/dive/rig_two.yaml: has 2 cameras (cam0, cam1); keep one of them in the file"),
            ("--samples and --error: each says how long to go on; give one of them",
             "Render > uwvdb > Samples and Render > uwvdb > Until Error: each says how long to go on; give one of them")):
        told = translate.of("uwvdb: " + said)
        assert told == wanted, f"{told!r} instead of {wanted!r}"


def test_every_key_that_the_add_on_writes_has_a_place():
    """A scene with everything in it; each key is of one of the panels or of an object."""
    scene = empty_scene(6, 4)
    module = sys.modules["uwvdb_blender.words"]
    world, camera, scene.uwvdb.quality = scene.world.uwvdb, scene.camera.data, "DRAFT"
    camera.dof.use_dof = camera.uwvdb.use_sensor = True
    world.use_surface = world.use_snow = world.use_particles = scene.uwvdb.use_forward_scatter = True
    box(location=(0, 3, 0))
    for kind in ("POINT", "SPOT", "AREA", "SUN"):
        light(kind, kind.title(), location=(1, 1, 1))
    bpy.data.lights["Point"].shadow_soft_size = 0.1
    seen = set()

    def walk(value, path):
        if isinstance(value, dict):
            for key, inner in value.items():
                walk(inner, f"{path}.{key}" if path else key)
        elif isinstance(value, list) and any(isinstance(item, dict) for item in value):
            for item in value:
                walk(item, path + "[]")
        else:
            seen.add(path)

    with tempfile.TemporaryDirectory() as folder:
        scene.uwvdb.kept_in = folder
        for world.kind in ("PRESET", "CONSTITUENTS", "COEFFICIENTS"):
            for camera.uwvdb.housing in ("FLAT", "DOME"):
                render()
                walk(json.loads(pathlib.Path(folder, "0001_ViewLayer/scene.yaml").read_text()), "")
    for path in seen - {"uwvdb"}:
        best = max((key for key in module.PLACES if (path + ".").startswith(key + ".") or path.startswith(key + "[")),
                   key=len, default="")
        assert "." in best or best in ("lamps[]", "geometry"), (path, best)


def test_lines_about_other_files_stay():
    """Of a file that is the user's own, its own words are the right ones."""
    translate = words()
    for line in ("/dive/plume_0030.vdb: grid 'density_noise' is damaged", "'/dive/my_rig.yaml' cannot be read",
                 "bad_file.vdb: '/dive/bad_file.vdb' is not a VDB file (it does not start like one)",
                 "/dive/rig_two.yaml:1:1: is not in a known calibration format",
                 "no grid 'no_such' ('/dive/a_b.vdb' has velocity (half vec3s, staggered), color_r (half float))"):
        for before in ("", "uwvdb: "):
            assert translate.of(before + line) == line, translate.of(line)
    # Nor is what the add-on says itself translated.
    own = sys.modules["uwvdb_blender.notes"].Refusal("camera 'left_eye' is orthographic; choose a 'lens'")
    assert translate.why(own) == str(own)
