"""The camera: its view, lens and housing."""

import math

import bpy
from mathutils import Matrix

from .notes import Refusal

PARALLEL = 1000  # heights of an orthographic view that its rays come from: 0.1 % from parallel
INDICES = ("n_air", "n_glass", "n_water")


def pose_rows(world_from_camera):
    """uwvdb's cameras have y down and look along z, Blender's y up and look along -z; size does not
    matter."""
    location, rotation, _ = world_from_camera.decompose()
    axes = rotation.to_matrix()
    return [[axes[row][0], -axes[row][1], -axes[row][2], location[row]] for row in range(3)] + [
        [0.0, 0.0, 0.0, 1.0]]


def describe(depsgraph, camera, size, to_metres, world_from_camera, shift_x, notes):
    """The scene's `camera`, but for its pose, of a camera object."""
    data, render = camera.data, depsgraph.scene.render
    result = {"resolution": list(size)}
    settings = data.uwvdb
    if settings.calibration:
        result = {"calibration": bpy.path.abspath(settings.calibration)}
    elif data.type == "PANO":
        result.update(_fisheye(data, size, notes))
    elif data.type == "PERSP":
        result["intrinsics"] = _intrinsics(depsgraph, camera, size, shift_x)
    else:
        kind = "is orthographic" if data.type == "ORTHO" else f"is of the type {data.type}"
        raise Refusal(f"camera '{camera.name}' {kind}: uwvdb has perspective cameras and fisheyes (Camera > Lens > "
                      "Type)")
    if settings.housing != "NONE":
        result["port"] = _port(settings, to_metres.median_scale)
    if data.dof.use_dof and data.type == "PERSP":
        result["lens"] = _lens(data, to_metres, world_from_camera, notes)
    elif settings.use_sensor:
        result["lens"] = {"f_number": data.dof.aperture_fstop, "focal_length": data.lens / 1000}
    return result


def _intrinsics(depsgraph, camera, size, shift_x):
    width, height = size
    render, data = depsgraph.scene.render, camera.data
    projection = camera.calc_matrix_camera(depsgraph, x=width, y=height,
                                           scale_x=render.pixel_aspect_x,
                                           scale_y=render.pixel_aspect_y)
    fx, fy = projection[0][0] * width / 2, projection[1][1] * height / 2
    # An eye of a stereo pair has its own shift, a fraction of the side that the sensor fits.
    sensor = data.sensor_height if data.sensor_fit == "VERTICAL" else data.sensor_width
    of_eye = (shift_x - data.shift_x) * fx * sensor / data.lens
    return {"fx": fx, "fy": fy, "cx": width / 2 * (1 - projection[0][2]) - of_eye,
            "cy": height / 2 * (1 + projection[1][2])}


def _fisheye(data, size, notes):
    """Cycles' equidistant fisheye: the circle of the whole angle has the image's sides as diameters.
    Cycles' settings belong to the camera itself since Blender 4.5, and to its add-on before."""
    source = data if hasattr(data, "panorama_type") else getattr(data, "cycles", None)
    kind = getattr(source, "panorama_type", "FISHEYE_EQUIDISTANT")
    if kind != "FISHEYE_EQUIDISTANT":
        raise Refusal(f"camera '{data.name}': of panoramas, uwvdb has the equidistant fisheye alone "
                      "(Camera > Lens > Panorama Type)")
    angle = float(getattr(source, "fisheye_fov", math.pi))
    width, height = size
    if width != height:
        notes.add("the fisheye's circle is an ellipse in an image that is not square, as in Cycles")
    return {"intrinsics": {"fx": width / angle, "fy": height / angle},
            "distortion": {"model": "fisheye"}}


def _port(settings, metres_per_unit):
    port = {"type": settings.housing.lower(), "fresnel": settings.fresnel,
            "radiance_in": settings.radiance_in.lower()}
    port["thickness"] = settings.thickness * metres_per_unit
    port.update({name: getattr(settings, name) for name in INDICES})
    for name in ("glass", "water"):
        if getattr(settings, name) != "NUMBER":
            port[f"n_{name}"] = getattr(settings, name).lower()
    if settings.housing == "FLAT":
        port["distance"] = settings.distance * metres_per_unit
        tilt, towards = settings.tilt, settings.tilt_towards
        port["normal"] = [math.sin(tilt) * math.cos(towards), -math.sin(tilt) * math.sin(towards),
                          math.cos(tilt)]
    else:
        port["radius"] = settings.radius * metres_per_unit
        x, y, z = (length * metres_per_unit for length in settings.center)
        port["center"] = [x, -y, z]
    return port


def _lens(data, to_metres, world_from_camera, notes):
    dof = data.dof
    if dof.focus_object is not None:
        place = to_metres @ dof.focus_object.matrix_world.translation
        axes = world_from_camera.to_3x3().normalized()
        distance = abs((place - world_from_camera.translation).dot(axes.col[2]))
    else:
        distance = dof.focus_distance * to_metres.median_scale
    focal_length = data.lens / 1000
    if not data.uwvdb.use_sensor:
        focal_length *= to_metres.median_scale  # Cycles takes a lens of 50 mm for 0.05 units.
    elif abs(to_metres.median_scale - 1) > 1e-6:
        notes.add("depth of field is that of the lens in millimetres, as the sensor needs it; without a sensor it is "
                  "as in Cycles, which takes 1000 mm for a unit")
    return {"f_number": dof.aperture_fstop, "focal_length": focal_length,
            "focus_distance": max(distance, focal_length * 1.001)}


def of_view(window_matrix, view_matrix, size, to_metres):
    """The scene's `camera` for a perspective or orthographic 3D view that has these matrices. uwvdb has no
    orthographic camera: the view is from so far away that its rays are parallel, and the water begins
    where Blender has the view's eye, behind a flat port of water's index."""
    width, height = size
    world_from_camera = to_metres @ view_matrix.inverted()
    if window_matrix[3][3] == 0:
        fx, fy = window_matrix[0][0] * width / 2, window_matrix[1][1] * height / 2
        return {"resolution": [width, height],
                "intrinsics": {"fx": fx, "fy": fy, "cx": width / 2 * (1 - window_matrix[0][2]),
                               "cy": height / 2 * (1 + window_matrix[1][2])},
                "pose": {"matrix": pose_rows(world_from_camera)}}
    scale = to_metres.median_scale
    distance = PARALLEL * 2 / window_matrix[1][1] * scale  # in heights of what is seen
    world_from_camera = world_from_camera @ Matrix.Translation((0, 0, distance / scale))
    # Pixels per metre, times the distance at which the plane of the eye is seen.
    fx = window_matrix[0][0] * width / 2 / scale * distance
    fy = window_matrix[1][1] * height / 2 / scale * distance
    return {"resolution": [width, height],
            "intrinsics": {"fx": fx, "fy": fy, "cx": width / 2 * (1 + window_matrix[0][3]),
                           "cy": height / 2 * (1 - window_matrix[1][3])},
            "port": {"type": "flat", "distance": distance, "n_air": 1.0, "n_glass": 1.0, "n_water": 1.0},
            "pose": {"matrix": pose_rows(world_from_camera)}}
