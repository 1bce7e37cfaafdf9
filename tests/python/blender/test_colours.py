# ctest labels: analytic
"""What Blender makes of the floats that it is handed: its own view transform, and nothing else."""

from support import *

LIGHT = (0.02, 0.18, 1.0, 4.0)  # of four squares, in all bands


def squares():
    """Four squares that shine by themselves, side by side."""
    scene = empty_scene(64, 16)
    scene.camera.data.angle = math.radians(60)
    for at, strength in enumerate(LIGHT):
        shining, _, _, shader = material(f"Light {strength}", (1, 0.5, 0.25), "ShaderNodeEmission")
        shader.inputs["Strength"].default_value = strength
        panel = square(size=1, location=(at - 1.5, 3.2, 0), rotation=(math.pi / 2, 0, 0))
        panel.data.materials.append(shining)
    return scene


def saved(scene, folder, transform, exposure, source=None):
    """The PNG that Blender saves of its render result, or of floats of an image, as 16-bit values from the
    top."""
    scene.view_settings.view_transform = transform
    scene.view_settings.exposure, scene.view_settings.gamma = exposure, 1
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "PNG", "RGB", "16"
    path = f"{folder}/{transform}.png"
    (source or bpy.data.images["Render Result"]).save_render(path, scene=scene)
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Non-Color"
    values = numpy.empty(len(image.pixels), numpy.float32)
    image.pixels.foreach_get(values)
    return values.reshape(image.size[1], image.size[0], -1)[::-1, :, :3]


def test_view_transforms_are_blenders():
    """The picture of every transform is what Blender makes of an image with the same floats; Standard's and
    Raw's have closed forms; and the floats do not depend on it."""
    scene = squares()
    names = [name for name in ("Standard", "Filmic", "AgX", "Raw") if can_show(scene, name)]
    assert {"Standard", "Filmic", "Raw"} <= set(names), names
    assert bpy.app.version < (4, 0, 0) or "AgX" in names
    floats = {}
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            scene.view_settings.view_transform = name
            floats[name] = render()["Combined"][..., :3]
            shown = saved(scene, folder, name, 0.5)
            twin = bpy.data.images.new("Twin", 64, 16, float_buffer=True, is_data=False)
            twin.colorspace_settings.name = linear_space()
            rgba = numpy.ones((16, 64, 4), numpy.float32)
            rgba[..., :3] = floats[name][::-1]
            twin.pixels.foreach_set(rgba.reshape(-1))
            twin.update()
            os.mkdir(f"{folder}/twin-{name}")
            wanted = saved(scene, f"{folder}/twin-{name}", name, 0.5, twin)
            close(shown, wanted, 2e-4, f"{name} of the same floats")
            bpy.data.images.remove(twin)
            linear = numpy.clip(floats[name] * 2**0.5, 0, 1)
            if name == "Raw":
                close(shown, linear, 2e-4, "Raw is the floats")
            if name == "Standard":
                encoded = numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
                close(shown, encoded, 5e-4, "Standard is sRGB")
    lit = floats["Standard"][8, :, 0]
    for strength in LIGHT:
        assert (numpy.abs(lit / strength - 1) < 1e-5).sum() > 4, (strength, lit)
    for name in names:
        assert (floats[name] == floats["Standard"]).all(), name


def can_show(scene, name):
    try:
        scene.view_settings.view_transform = name
    except TypeError:
        return False
    return True


def linear_space():
    """Blender's linear sRGB, which has had two names."""
    image = bpy.data.images.new("Probe", 1, 1, float_buffer=True)
    try:
        for name in ("Linear Rec.709", "Linear"):
            try:
                image.colorspace_settings.name = name
            except TypeError:
                continue
            return name
        raise AssertionError("Blender has no linear colour space")
    finally:
        bpy.data.images.remove(image)
