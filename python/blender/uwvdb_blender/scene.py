"""The scene as it stands in a frame, as a scene file of uwvdb in a folder of its own. Its world is
Blender's, z up, in metres."""

import json
import os

from . import bands as colours
from . import bakes, cameras, features, lamps, meshes, motion, units, volumes, water
from .notes import Refusal
from .words import Words

SCENE_FILE = "scene.yaml"  # JSON, which is YAML, too


class Written:
    """The scene's file and what is needed to read its images and messages."""

    def __init__(self, path, bands, mesh_file, metres_per_unit, lamp_names, words):
        self.path, self.bands, self.words = path, bands, words
        self.held_out = mesh_file.held_out
        self.pass_indices, self.material_indices = mesh_file.pass_indices, mesh_file.material_indices
        self.metres_per_unit, self.lamp_names = metres_per_unit, lamp_names


class View:
    """What one image sees: its camera and, for stereo, the eye's own matrix and shift."""

    def __init__(self, camera, matrix, shift_x):
        self.camera, self.matrix, self.shift_x = camera, matrix, shift_x


def write(depsgraph, path, program_path, view, size, moments, notes, is_cancelled, on_progress):
    """Writes the scene, and what belongs to it into the same folder. `moments` is a Motion with what
    moves, or None; the other arguments are those of program.run()."""
    scene = depsgraph.scene
    folder, name = os.path.split(path)
    to_metres = units.to_metres(scene)
    bands = colours.parse(scene.uwvdb.bands)
    world_from_camera = to_metres @ view.matrix
    content = {"uwvdb": 2}
    camera = cameras.describe(depsgraph, view.camera, size, to_metres, world_from_camera, view.shift_x,
                              notes)
    _place_camera(camera, view, world_from_camera, moments)
    content["camera"] = camera
    baked = bakes.Bakes(scene.uwvdb.bake_size, scene.uwvdb.threads, notes)
    baked.make(depsgraph, bakes.sight(camera, view.matrix, size), is_cancelled, on_progress)
    mesh_file = meshes.MeshFile(notes, bakes=baked)
    mesh_file.add_all(depsgraph, to_metres, moments)
    if not mesh_file.is_empty:
        glb_name = f"{os.path.splitext(name)[0]}-meshes.glb"
        mesh_file.glb.write(os.path.join(folder, glb_name))
        content["geometry"] = [geometry_entry(scene, glb_name)]
    plumes = volumes.Volumes(
        folder, notes, lambda source: volumes.advice(program_path, source, is_cancelled))
    features.note_all(depsgraph, notes, view.camera, moments)
    described, words = describe_water_and_lamps(depsgraph, folder, moments, plumes, notes)
    content.update(described)
    content["render"] = _render(scene, moments)
    _add_sensor(content, view.camera.data.uwvdb, bands, notes)
    with open(path, "w", encoding="utf-8") as file:
        json.dump(content, file, indent=1)
    return Written(path, bands, mesh_file, units.metres_per_unit(scene),
                   [lamp["name"] for lamp in content["lamps"]], words)


def geometry_entry(scene, mesh_file):
    return {"file": mesh_file, "material": "pbr" if scene.uwvdb.use_gloss else "diffuse"}


def describe_water_and_lamps(depsgraph, folder, moments, plumes, notes):
    """(the sections of the water, the lamps and the volumes, the Words for what is said of them). Files of lamps
    are written into the folder, and volumes linked."""
    scene = depsgraph.scene
    to_metres, bands = units.to_metres(scene), colours.parse(scene.uwvdb.bands)
    result = {"water": water.describe(scene, bands, to_metres)}
    lights = lamps.Lamps(folder, bands, notes)
    lights.add_all(depsgraph, to_metres, moments, result["water"].get("surface"))
    result["lamps"] = lights.entries
    plumes.add_all(depsgraph, to_metres)
    if plumes.entries:
        result["volumes"] = plumes.entries
    return result, Words(folder, lights.objects, plumes.objects)


def frame_rate(scene):
    return scene.render.fps / scene.render.fps_base


def shutter(scene):
    """Seconds that the shutter is open; 0 without motion blur."""
    return scene.render.motion_blur_shutter / frame_rate(scene) if scene.render.use_motion_blur else 0


def _place_camera(camera, view, world_from_camera, moments):
    matrices = moments.camera_matrices(motion.CAMERA) if moments is not None else None
    if matrices is None:
        camera["pose"] = {"matrix": cameras.pose_rows(world_from_camera)}
    else:
        camera["trajectory"] = {"interpolation": "linear", "keyframes": [
            {"time": time, "matrix": cameras.pose_rows(matrix)}
            for time, matrix in zip(moments.times, matrices)]}


def _render(scene, moments):
    settings = scene.uwvdb
    render = {"integrator": settings.integrator.lower(), "fps": frame_rate(scene)}
    if settings.integrator == "PATH":
        render["scattering"] = "multiple"
    elif settings.integrator == "VOLUME":
        render["scattering"] = settings.scattering.lower()
    if settings.samples > 0:
        render["samples"] = settings.samples
    if moments is not None and shutter(scene) > 0:
        render["shutter"] = shutter(scene)
    return render


def _add_sensor(content, settings, bands, notes):
    if not settings.use_sensor:
        return
    sensor = {"mosaic": settings.mosaic.lower(), "seed": settings.sensor_seed}
    sensor.update({name: getattr(settings, name) for name in (
        "exposure", "quantum_efficiency", "full_well", "read_noise", "dark_current", "bit_depth")})
    if settings.mosaic != "MONO" and len(bands) != 3:
        raise Refusal("a sensor of colours needs three bands (Render > uwvdb > Bands), or Mono")
    if settings.pixel_pitch > 0:
        sensor["pixel_pitch"] = settings.pixel_pitch * 1e-6
    content["camera"]["sensor"] = sensor
