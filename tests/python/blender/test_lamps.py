# ctest labels: analytic
"""Lights of Blender: their watts against closed forms, and against Cycles."""

from support import *


def floor_scene(size=(96, 64)):
    """A large floor of albedo 0.8 under a camera that looks down from 5 m, a box on it that is turned; size in
    pixels."""
    scene = empty_scene(*size)
    scene.camera.location, scene.camera.rotation_euler = (0, 0, 5), (0, 0, 0)
    white = material("White")[0]
    floor = square(size=40)
    cube = box(size=(0.5, 0.7, 0.6), location=(0.6, -0.3, 0.3), rotation=(0, 0, 0.4))
    for thing in (floor, cube):
        thing.data.materials.append(white)
    scene.view_layers[0].use_pass_position = True
    scene.view_layers[0].uwvdb.use_irradiance = True
    return scene


def places(passes):
    """(positions on the floor, which pixels see it)."""
    position = passes["Position"].astype(float)
    return position, position[..., 2] < 1e-4


def test_point_light_is_watts_over_the_sphere():
    """Both are Blender's own, by its units of length, whatever their Unit Scale."""
    scene = floor_scene()
    light("POINT", watts=200, location=(-0.5, 0.4, 2.5), color=(1, 0.5, 0.25))
    bpy.data.objects.remove(bpy.data.objects["Box"])
    for scene.unit_settings.scale_length in (1, 0.01):
        passes = render()
        position, on_floor = places(passes)
        away = numpy.array([-0.5, 0.4, 2.5]) - position
        r = numpy.linalg.norm(away, axis=-1, keepdims=True)
        wanted = 200 / (4 * math.pi) * away[..., 2:] / r**3 * numpy.array([1, 0.5, 0.25])
        # The position is that of the pixel's centre, the light a mean over its samples.
        close(passes["irradiance"], wanted, 2e-4, "irradiance", on_floor)
        close(passes["Combined"][..., :3], wanted * 0.8 / math.pi, 2e-4, "radiance", on_floor)


def test_lights_that_would_take_light_away_are_left_out():
    """Blender lets a light's power, and its nodes' strength, be negative."""
    for kind in ("POINT", "SPOT", "AREA", "SUN"):
        for make in (lambda lamp, node: setattr(lamp.data, "energy", -5),
                     lambda lamp, node: setattr(node.inputs["Strength"], "default_value", -2)):
            scene = floor_scene()
            scene.world.uwvdb.use_surface = True
            scene.render.resolution_x, scene.render.resolution_y = 24, 16
            light("POINT", "Good", watts=200, location=(-1.5, 0.7, 2.0))
            wanted = render()["Combined"]
            bad = light(kind, "Bad", location=(0.5, 0, 2))
            bad.data.use_nodes = True
            make(bad, next(n for n in bad.data.node_tree.nodes if n.type == "EMISSION"))
            close(render()["Combined"], wanted, 0, f"{kind} beside another light")
            said = [note for note in notes() if "light 'Bad'" in note]
            assert len(said) == 1 and "negative" in said[0], notes()


def test_sizes_that_blender_permits():
    """The widest spot, and a panel of no size, which is left out with a word."""
    floor_scene()
    light("SPOT", watts=300, location=(-1.5, 0.7, 2.5), spot_size=math.pi, spot_blend=0.4)
    against_cycles("widest spot")
    for settings in ({"shape": "SQUARE", "size": 0}, {"shape": "ELLIPSE", "size": 1, "size_y": 0}):
        floor_scene()
        light("AREA", "Nothing", location=(0, 0, 2), **settings)
        render()
        assert any("light 'Nothing': is left out: its Size is 0" in note for note in notes()), notes()


def test_sun_is_watts_per_square_metre():
    scene = floor_scene()
    scene.world.uwvdb.use_surface, scene.world.uwvdb.surface_height = True, 8
    light("SUN", watts=3, rotation=(math.radians(40), 0, 0.3))
    bpy.data.objects.remove(bpy.data.objects["Box"])
    passes = render()
    wanted = numpy.full_like(passes["irradiance"], 3 * math.cos(math.radians(40)))
    close(passes["irradiance"], wanted, 1e-5, "irradiance")


def test_area_light_is_lambertian():
    """From far away a square of W watts gives W/pi cos(theta) W/sr as any panel does, in Blender 3 W/4."""
    floor_scene()
    bpy.data.objects.remove(bpy.data.objects["Box"])
    light("AREA", watts=500, location=(0, 0, 4.5), rotation=(0.3, 0.2, 0), shape="SQUARE", size=0.02)
    axis = -(Euler((0.3, 0.2, 0)).to_matrix().col[2])
    passes = render()
    position, on_floor = places(passes)
    away = numpy.array([0, 0, 4.5]) - position
    r = numpy.linalg.norm(away, axis=-1)
    emitted = numpy.clip(-(away @ numpy.array(axis)) / r, 0, None)
    found = passes["irradiance"][..., 0]
    wanted = 500 / (math.pi if bpy.app.version >= (4, 0, 0) else 4) * emitted * away[..., 2] / r**3
    close(found, wanted, 1e-3, "irradiance", on_floor)


# Where Cycles needs many samples for each of its pixels: what is compared is the median of these.
FEW_PIXELS = (48, 32)


def against_cycles(what, samples=64, tolerance=2e-3, sphere=None):
    """`sphere`: (location, radius) of a light that is one. Cycles has a disk across it instead, which shines
    from there with 1 / (d^2 + r^2): what the sphere does from d is brighter by 1 + (r / d)^2."""
    ours, theirs = render(), render("CYCLES", samples=samples)
    found, wanted = ours["Combined"][..., 0], theirs["Combined"][..., 0]
    if sphere is not None:
        location, radius = sphere
        away = numpy.array(location) - ours["Position"].astype(float)
        wanted = wanted * (1 + radius**2 / (away**2).sum(axis=-1))
    median_close(found, wanted, tolerance, what, wanted > 0.02 * wanted.max())
    dark = (found > 1e-3 * wanted.max()) != (wanted > 1e-3 * wanted.max())
    assert dark.mean() < 0.01, f"{what}: {dark.mean():.1%} of the pixels are lit by one of both alone"


def test_point_light_against_cycles():
    floor_scene()
    light("POINT", watts=200, location=(-1.5, 0.7, 2.0))
    against_cycles("point")


def test_spot_against_cycles():
    floor_scene()
    light("SPOT", watts=300, location=(-1.5, 0.7, 2.5), rotation=(0.1, -0.5, 0.8), spot_size=1.1,
          spot_blend=0.4)
    against_cycles("spot")


def test_point_with_a_radius_against_cycles():
    floor_scene(FEW_PIXELS)
    light("POINT", watts=200, location=(-1.5, 0.7, 2.0), shadow_soft_size=0.3)
    against_cycles("point with a radius", 512, 2e-3, ((-1.5, 0.7, 2.0), 0.3))


def test_spot_with_a_radius_against_cycles():
    floor_scene(FEW_PIXELS)
    light("SPOT", watts=300, location=(-1.5, 0.7, 2.5), rotation=(0.1, -0.5, 0.8), spot_size=1.1,
          spot_blend=0.4, shadow_soft_size=0.2)
    # Its beam has a soft edge, in which eight points are steps.
    against_cycles("spot with a radius", 512, 2e-2, ((-1.5, 0.7, 2.5), 0.2))


def test_sun_against_cycles():
    scene = floor_scene()
    scene.world.uwvdb.use_surface = True
    light("SUN", watts=3, rotation=(0.6, 0.2, 0.5))
    against_cycles("sun")


def test_rectangle_against_cycles():
    floor_scene(FEW_PIXELS)
    light("AREA", watts=300, location=(-1.2, 0.6, 1.2), rotation=(0.2, -0.7, 0.9), shape="RECTANGLE",
          size=1.6, size_y=0.2).scale = (1.2, 0.8, 1)
    against_cycles("rectangle", 512, 5e-3)


def test_disk_against_cycles():
    floor_scene(FEW_PIXELS)
    light("AREA", watts=300, location=(-1.2, 0.6, 1.5), rotation=(0.2, -0.7, 0.9), shape="DISK", size=0.6)
    against_cycles("disk", 512, 5e-3)


def test_spread_against_cycles():
    for degrees, samples, size in ((150, 512, FEW_PIXELS), (90, 512, FEW_PIXELS),
                                   (40, 2048, (72, 48))):  # Blender 4.3 needs more for narrow ones
        for shape in ("DISK", "RECTANGLE"):
            floor_scene(size)
            light("AREA", watts=300, location=(-0.9, 0.6, 1.7), rotation=(0.1, -0.5, 0.9), shape=shape,
                  size=0.6, size_y=0.3, spread=math.radians(degrees))
            against_cycles(f"{shape.lower()}, spread of {degrees} degrees", samples, 5e-3)


def test_spread_keeps_the_watts():
    lamps = sys.modules["uwvdb_blender.lamps"]
    for degrees in (179, 90, 10, 1):
        text, axis = lamps.spread_luminaire(math.radians(degrees))
        lines = text.splitlines()
        angles, values = (numpy.array(lines[at].split(), float) for at in (-3, -1))
        fine = numpy.linspace(0, math.radians(degrees / 2), 100001)
        intensity = axis * numpy.interp(numpy.degrees(fine), angles, values) / values[0]
        watts = 2 * math.pi * (intensity * numpy.sin(fine)).sum() * fine[1]
        assert abs(watts / math.pi - 1) < 2e-3, (degrees, watts)


def test_emission_node_multiplies():
    """A light's own nodes count as in Cycles."""
    floor_scene()
    lamp = light("POINT", watts=200, location=(-1.5, 0.7, 2.0), color=(0.5, 1, 1))
    lamp.data.use_nodes = True
    node = next(n for n in lamp.data.node_tree.nodes if n.type == "EMISSION")
    node.inputs["Strength"].default_value = 2.5
    node.inputs["Color"].default_value = (0.4, 0.6, 0.8, 1)
    ours, theirs = render()["Combined"], render("CYCLES")["Combined"]
    for band in range(3):
        wanted = theirs[..., band]
        median_close(ours[..., band], wanted, 2e-3, f"band {band}", wanted > 0.02 * wanted.max())


def luminaire(folder):
    """An IES file without any symmetry, in steps so fine that Cycles' cubic interpolation and a linear one
    agree."""
    vertical, horizontal = range(0, 91, 5), range(0, 361, 10)
    rows = [[100 + 4 * v * (1 + math.sin(math.radians(h))) / 2 + 150 * (1 + math.cos(math.radians(h)))
             * math.sin(math.radians(v)) for v in vertical] for h in horizontal]
    text = ("IESNA:LM-63-1995\n[TEST] none\nTILT=NONE\n"
            f"1 -1 1 {len(vertical)} {len(horizontal)} 1 2 0 0 0\n1 1 100\n"
            + " ".join(map(str, vertical)) + "\n" + " ".join(map(str, horizontal)) + "\n"
            + "\n".join(" ".join(f"{value:.2f}" for value in row) for row in rows) + "\n")
    path = os.path.join(folder, "luminaire.ies")
    with open(path, "w") as file:
        file.write(text)
    return path


def test_ies_against_cycles():
    with tempfile.TemporaryDirectory() as folder:
        path = luminaire(folder)
        for mode in ("EXTERNAL", "INTERNAL"):
            floor_scene()
            bpy.data.objects.remove(bpy.data.objects["Box"])
            lamp = light("POINT", watts=3, location=(-0.2, 0.1, 1.5), rotation=(0.2, 0.1, 0.6))
            lamp.data.use_nodes = True
            nodes, links = lamp.data.node_tree.nodes, lamp.data.node_tree.links
            emission = next(n for n in nodes if n.type == "EMISSION")
            photometry = nodes.new("ShaderNodeTexIES")
            photometry.mode = mode
            photometry.inputs["Strength"].default_value = 1.5
            if mode == "EXTERNAL":
                photometry.filepath = path
            else:
                photometry.ies = bpy.data.texts.load(path)
            links.new(photometry.outputs[0], emission.inputs["Strength"])
            against_cycles(f"IES, {mode.lower()}")


def test_nodes_of_lights_against_cycles():
    """Numbers and colours that a light's nodes compute."""
    def tree(lamp):
        lamp.data.use_nodes = True
        nodes, links = lamp.data.node_tree.nodes, lamp.data.node_tree.links
        return nodes, links, next(n for n in nodes if n.type == "EMISSION").inputs

    def blackbody(nodes, links, inputs):
        node = nodes.new("ShaderNodeBlackbody")
        node.inputs[0].default_value = 3200
        links.new(node.outputs[0], inputs["Color"])

    def numbers(nodes, links, inputs):
        value, node = nodes.new("ShaderNodeValue"), nodes.new("ShaderNodeMath")
        value.outputs[0].default_value, node.operation = 1.5, "POWER"
        links.new(value.outputs[0], node.inputs[0])
        node.inputs[1].default_value = 2
        links.new(node.outputs[0], inputs["Strength"])

    def colours(nodes, links, inputs):
        rgb, turned = nodes.new("ShaderNodeRGB"), nodes.new("ShaderNodeHueSaturation")
        rgb.outputs[0].default_value, turned.inputs["Hue"].default_value = (0.8, 0.4, 0.1, 1), 0.6
        links.new(rgb.outputs[0], turned.inputs["Color"])
        links.new(turned.outputs[0], inputs["Color"])

    def as_camera_sees(nodes, links, inputs):
        path, mix = nodes.new("ShaderNodeLightPath"), nodes.new("ShaderNodeMath")
        mix.operation = "ADD"
        mix.inputs[1].default_value = 0.5
        links.new(path.outputs["Is Singular Ray"], mix.inputs[0])
        links.new(mix.outputs[0], inputs["Strength"])

    # Cycles has a blackbody as polynomials, 1 % from Planck's law in the colour that matters least.
    for make, tolerance in ((blackbody, 0.02), (numbers, 2e-3), (colours, 2e-3), (as_camera_sees, 2e-3)):
        floor_scene(FEW_PIXELS)
        lamp = light("POINT", watts=200, location=(-1.5, 0.7, 2.0), color=(0.9, 1, 0.8))
        make(*tree(lamp))
        ours = render()["Combined"]
        assert not any("light 'Light'" in note for note in notes()), notes()
        theirs = render("CYCLES")["Combined"]
        for band in range(3):
            wanted = theirs[..., band]
            median_close(ours[..., band], wanted, tolerance, f"{make.__name__}, band {band}",
                         wanted > 0.02 * wanted.max())


def test_nodes_that_take_light_away():
    """A light whose nodes compute a negative strength is refused as one whose Power is negative."""
    floor_scene((24, 16))
    lamp = light("POINT", "Bad", watts=200, location=(0.5, 0, 2))
    light("POINT", "Good", watts=200, location=(-1.5, 0.7, 2.0))
    lamp.data.use_nodes = True
    nodes, links = lamp.data.node_tree.nodes, lamp.data.node_tree.links
    node = nodes.new("ShaderNodeMath")
    node.operation = "SUBTRACT"
    node.inputs[0].default_value, node.inputs[1].default_value = 1, 3
    links.new(node.outputs[0], next(n for n in nodes if n.type == "EMISSION").inputs["Strength"])
    render()
    assert any("light 'Bad': is left out" in note and "Strength is negative" in note for note in notes()), notes()
