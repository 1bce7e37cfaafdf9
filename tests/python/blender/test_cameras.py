# ctest labels: metamorphic
"""Cameras: where they see points, against Blender's own projection and against Cycles."""

from bpy_extras.object_utils import world_to_camera_view

from support import *


def room():
    """Something in every pixel, at different distances."""
    scene = empty_scene()
    box("Room", size=(9, 14, 8), location=(0.4, 1, 0.3))
    box("Near", size=(0.6, 0.5, 0.7), location=(-0.5, 4, 0.2), rotation=(0.3, 0.4, 0.5))
    scene.view_layers[0].use_pass_position = True
    scene.view_layers[0].use_pass_z = True
    camera = scene.camera
    camera.location, camera.rotation_euler = (0.3, -3.5, 0.4), (1.4, 0.1, 0.15)
    return scene, camera


def sees_what_blender_sees(scene, camera):
    """The point that each pixel sees lies at its centre by Blender's own projection."""
    passes = render()
    position, depth = passes["Position"], passes["Depth"][..., 0]
    rows, columns = position.shape[:2]
    worst = worst_depth = 0
    for row in range(0, rows, 3):
        for column in range(0, columns, 3):
            x, y, z = world_to_camera_view(scene, camera, Vector(position[row, column].tolist()))
            worst = max(worst, abs(x * columns - column - 0.5), abs((1 - y) * rows - row - 0.5))
            worst_depth = max(worst_depth, abs(z / depth[row, column] - 1))
    print(f"    at most {worst:.1e} pixels and {worst_depth:.1e} of the depth apart")
    assert worst < 2e-3, f"{worst} pixels from where Blender sees the point"
    assert worst_depth < 1e-5


def test_perspective():
    sees_what_blender_sees(*room())


def test_shift_and_portrait():
    scene, camera = room()
    scene.render.resolution_x, scene.render.resolution_y = 50, 80
    camera.data.shift_x, camera.data.shift_y, camera.data.lens = 0.13, -0.21, 28
    for fit in ("AUTO", "HORIZONTAL", "VERTICAL"):
        camera.data.sensor_fit = fit
        sees_what_blender_sees(scene, camera)


def test_scaled_parent_and_units():
    """A camera's size does not matter; a scene in centimetres gives the same passes in its own units."""
    scene, camera = room()
    parent = add("Parent", None, location=(0.1, 0.2, 0.3), rotation=(0.1, 0, 0.2), scale=(3, 3, 3))
    camera.parent = parent
    camera.location = (0.1, -1.2, 0.1)
    bpy.context.view_layer.update()
    scene.unit_settings.scale_length = 0.01
    sees_what_blender_sees(scene, camera)


def test_pixels_that_are_not_square():
    scene, camera = room()
    scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = 1, 1.5
    sees_what_blender_sees(scene, camera)


def test_border_is_part_of_the_image():
    scene, camera = room()
    light("POINT", watts=500, location=(1, 0, 2))
    whole = render()["Combined"]
    scene.render.use_border = scene.render.use_crop_to_border = True
    scene.render.border_min_x, scene.render.border_max_x = 0.3, 0.71
    scene.render.border_min_y, scene.render.border_max_y = 0.11, 0.6
    part = render()["Combined"]
    rows, columns = whole.shape[:2]
    top, left = rows - int(0.6 * rows), int(0.3 * columns)
    close(part, whole[top:top + part.shape[0], left:left + part.shape[1]], 0, "part")


def test_fisheye_against_cycles():
    for size in ((64, 64), (80, 60)):
        scene, camera = room()
        scene.render.resolution_x, scene.render.resolution_y = size
        camera.data.type = "PANO"
        owner = camera.data if hasattr(camera.data, "panorama_type") else camera.data.cycles
        owner.panorama_type, owner.fisheye_fov = "FISHEYE_EQUIDISTANT", math.radians(150)
        ours, theirs = render()["Position"], render("CYCLES", samples=1)["Position"]
        seen = numpy.any(ours != 0, axis=-1) & numpy.any(theirs != 0, axis=-1)
        apart = numpy.linalg.norm(ours - theirs, axis=-1)[seen]
        print(f"    {seen.mean():.0%} of the pixels, at most {apart.max():.1e} m apart")
        assert seen.mean() > 0.7 and numpy.quantile(apart, 0.95) < 0.1


def test_stereo_against_cycles():
    scene, camera = room()
    scene.render.use_multiview = True
    stereo = camera.data.stereo
    stereo.interocular_distance, stereo.convergence_distance = 0.3, 4
    for mode in ("OFFAXIS", "PARALLEL", "TOE"):
        stereo.convergence_mode = mode
        ours, theirs = render_views(), render_views("CYCLES")
        for view in ("left", "right"):
            close(ours[view], theirs[view], 2e-2, f"{mode} {view}")
        assert numpy.abs(ours["left"] - ours["right"]).max() > 0.01


def render_views(engine="UWVDB"):
    """Depth of both eyes, up to Cycles' place within the pixel."""
    left, right = (render(engine, samples=1, suffix=suffix) for suffix in ("_L", "_R"))
    return {"left": left["Depth"][..., 0], "right": right["Depth"][..., 0]}


def test_housing_bends_rays():
    """A flat port before a plane at z metres: the ray through the pixel at tan(a) in air meets it where
    Snell's law says."""
    scene = empty_scene()
    square(size=40, location=(0, 2, 0), rotation=(math.pi / 2, 0, 0))
    scene.view_layers[0].use_pass_position = True
    settings = scene.camera.data.uwvdb
    settings.housing, settings.distance, settings.thickness = "FLAT", 0.1, 0.05
    position = render()["Position"]
    rows, columns = position.shape[:2]
    focal = scene.camera.data.lens / scene.camera.data.sensor_width * columns
    x = (numpy.arange(columns) + 0.5 - columns / 2) / focal
    y = -(numpy.arange(rows) + 0.5 - rows / 2) / focal
    tangent = numpy.hypot(x[None, :], y[:, None])
    sine = tangent / numpy.hypot(1, tangent)

    def tangent_in(index):
        s = sine / index
        return s / numpy.sqrt(1 - s**2)

    away = 0.1 * tangent + 0.05 * tangent_in(1.49) + 1.85 * tangent_in(1.334)
    close(numpy.hypot(position[..., 0], position[..., 2]), away, 1e-5, "refracted")


def test_housing_has_glass_and_water_by_name():
    """Ground truth is of the band nearest to 550 nm: a point as far away as BK7's and the sea's indices
    of 540 nm say, and the light of other bands lies elsewhere."""
    scene = empty_scene()
    square(size=40, location=(0, 2, 0), rotation=(math.pi / 2, 0, 0))
    scene.view_layers[0].use_pass_position = True
    scene.world.uwvdb.kind = "COEFFICIENTS"
    scene.world.uwvdb.absorption = scene.world.uwvdb.scattering = (0, 0, 0)
    scene.world.uwvdb.salinity, scene.world.uwvdb.temperature = 35, 10
    settings = scene.camera.data.uwvdb
    settings.housing, settings.distance, settings.thickness = "FLAT", 0.1, 0.05
    settings.glass, settings.water = "BK7", "SEAWATER"
    position = render()["Position"]
    rows, columns = position.shape[:2]
    focal = scene.camera.data.lens / scene.camera.data.sensor_width * columns
    tangent = numpy.hypot(*numpy.meshgrid((numpy.arange(columns) + 0.5 - columns / 2) / focal,
                                          (numpy.arange(rows) + 0.5 - rows / 2) / focal))
    sine = tangent / numpy.hypot(1, tangent)

    def tangent_in(index):
        s = sine / index
        return s / numpy.sqrt(1 - s**2)

    away = 0.1 * tangent + 0.05 * tangent_in(1.519039) + 1.85 * tangent_in(1.342066)
    close(numpy.hypot(position[..., 0], position[..., 2]), away, 1e-5, "refracted")


def test_tilt_leans_as_the_tooltip_says():
    """Glass that leans up bends the axis's ray down by the shift of a plane-parallel plate and, in the
    water, by refraction towards the normal: upwards."""
    scene = empty_scene()
    square(size=40, location=(0, 2, 0), rotation=(math.pi / 2, 0, 0))
    scene.view_layers[0].use_pass_position = True
    settings = scene.camera.data.uwvdb
    settings.housing, settings.tilt = "FLAT", math.radians(20)
    for towards, axis, sign in ((0, 0, 1), (90, 2, 1), (180, 0, -1), (270, 2, -1)):
        settings.tilt_towards = math.radians(towards)
        position = render()["Position"]
        middle = position[position.shape[0] // 2, position.shape[1] // 2]
        assert sign * middle[axis] > 0.1, (towards, middle)


def test_depth_of_field_blurs_what_is_not_in_focus():
    """Against Cycles: the edge of a bright board, 2 m away with the focus at 4 m."""
    scene = empty_scene(96, 32)
    shining, _, _, node = material("Shining", (1, 1, 1), "ShaderNodeEmission")
    square(size=4, location=(2, 2, 0), rotation=(math.pi / 2, 0, 0)).data.materials.append(shining)
    camera = scene.camera.data
    camera.dof.use_dof, camera.dof.focus_distance, camera.dof.aperture_fstop = True, 4, 0.25
    scene.uwvdb.samples = 256
    ours, theirs = (passes["Combined"][..., 0].mean(axis=0)
                    for passes in (render(), render("CYCLES", samples=256)))
    assert ((theirs > 0.05) & (theirs < 0.95)).sum() > 4
    close(ours, theirs, 0.02, "blurred edge")
