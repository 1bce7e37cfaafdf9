# ctest labels: metamorphic
"""What is clear lets light through: domes around lamps and windows before the camera are glass, or as if they were not
there, as Transparent is in Cycles, and what is missing of them is said."""

from support import *


def room():
    """A wall, and a lamp at the side; the lamp's place and the camera's are free of anything else."""
    scene = empty_scene(48, 32)
    square("Wall", size=20, location=(0, 4, 0), rotation=(math.pi / 2, 0, 0)).data.materials.append(material("White")[0])
    box("Block", size=(0.6, 0.6, 0.6), location=(0.5, 3, 0), rotation=(0.2, 0.1, 0.3))
    light("POINT", watts=300, location=(-1, 1.5, 0.5))
    return scene


def dome(made):
    """A closed shell of two layers around the lamp."""
    for radius in (0.3, 0.28):
        bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, radius=radius, location=(-1, 1.5, 0.5))
        bpy.context.object.data.materials.append(made)


def window(made):
    square("Window", size=4, location=(0, 0.8, 0), rotation=(math.pi / 2, 0, 0)).data.materials.append(made)


def mixed(first, second, factor):
    """A material of two shaders: mixed by a number or by the output of a node, or added."""
    made, nodes, links, node = material("Clear", (1, 1, 1), first)
    mix = nodes.new("ShaderNodeAddShader" if factor is None else "ShaderNodeMixShader")
    links.new(node.outputs[0], mix.inputs[-2])
    links.new(nodes.new(second).outputs[0], mix.inputs[-1])
    if isinstance(factor, tuple):
        links.new(nodes.new(factor[0]).outputs[factor[1]], mix.inputs[0])
    elif factor is not None:
        mix.inputs[0].default_value = factor
    links.new(mix.outputs[0], next(n for n in nodes if n.type == "OUTPUT_MATERIAL").inputs["Surface"])
    return made


def principled(**inputs):
    made, _, _, node = material("Clear", (1, 1, 1), "ShaderNodeBsdfPrincipled")
    for name, value in inputs.items():
        socket = node.inputs.get(name) or node.inputs[f"{name} Weight"]
        socket.default_value = value
    return made


TRANSPARENT, GLASS, GLOSSY = "ShaderNodeBsdfTransparent", "ShaderNodeBsdfGlass", "ShaderNodeBsdfGlossy"
DIFFUSE, EMISSION = "ShaderNodeBsdfDiffuse", "ShaderNodeEmission"
# What they are made of, and whether they are all that Transparent is, so that nothing is missing.
CLEAR = {
    "Transparent": (lambda: material("Clear", (1, 1, 1), TRANSPARENT)[0], True),
    "Alpha": (lambda: principled(Alpha=0.0), True),
    "faint dirt": (lambda: mixed(DIFFUSE, TRANSPARENT, 0.9), False),
}
# Those that are glass, and the index.
REFRACTING = {
    "tinted Transparent": (lambda: material("Clear", (0.9, 1, 1), TRANSPARENT)[0], 1.334),
    "Glass": (lambda: smooth(material("Clear", (1, 1, 1), GLASS)), 1.45),
    "Refraction": (lambda: smooth(material("Clear", (1, 1, 1), "ShaderNodeBsdfRefraction")), 1.45),
    "Transmission": (lambda: principled(Transmission=1.0, Roughness=0.0), 1.45),
    "glass without shadow": (lambda: mixed(GLASS, TRANSPARENT, ("ShaderNodeLightPath", "Is Shadow Ray")), 1.45),
    "coated": (lambda: mixed(TRANSPARENT, GLOSSY, ("ShaderNodeFresnel", 0)), 1.45),
    "added": (lambda: mixed(GLASS, TRANSPARENT, None), 1.45),
}


def smooth(made):
    made[3].inputs["Roughness"].default_value = 0
    return made[0]
OPAQUE = {
    "Diffuse": lambda: material("Opaque")[0],
    "metal": lambda: principled(Transmission=1.0, Metallic=1.0),
    "mostly paint": lambda: mixed(DIFFUSE, TRANSPARENT, 0.1),
    "added light": lambda: mixed(TRANSPARENT, EMISSION, None),
}


def test_clear_shells_are_as_if_they_were_not_there():
    room()
    bare = render()["Combined"]
    for name, (make, is_exact) in CLEAR.items():
        room()
        made = make()
        dome(made)
        window(made)
        close(render()["Combined"], bare, 0, name)
        said = [note for note in notes() if "Clear" in note]
        assert len(said) == (0 if is_exact else 1), (name, said)
        assert is_exact or "lets all light through" in said[0] and "left out" in said[0], said


def test_glass_dims_what_is_behind_it():
    """A window of one face is a pane, which reflects from both; light from a lamp in a dome of two shells passes four."""
    room()
    bare = render()["Combined"]
    for name, (make, n) in REFRACTING.items():
        room()
        window(make())
        seen = render()["Combined"]
        # Of unpolarised light on the normal; up to 17 degrees away it is the same within 1e-4.
        r = ((n - 1.334) / (n + 1.334)) ** 2
        expected = (1 - r) / (1 + r) * numpy.array([0.9 if name == "tinted Transparent" else 1, 1, 1])
        wall = bare[..., 0] > 0.05 * bare[..., 0].max()
        for band in range(3):
            # What a tint takes grows with the way through the pane, 0.3 % in the median pixel.
            tolerance = 5e-3 if name == "tinted Transparent" else 2e-3
            median_close(seen[..., band], expected[band] * bare[..., band], tolerance, name, wall)
        assert not [note for note in notes() if "left out" in note and "Clear" in note], notes()
        room()
        dome(make())
        seen = render()["Combined"][..., 1]
        assert 0.9 < numpy.median(seen[wall] / bare[..., 1][wall]) < 0.9999 or n == 1.334, name


def test_solid_glass_has_its_colour_by_its_thickness():
    """A ball of Glass: what goes through its middle crosses two surfaces of its colour in Cycles."""
    scene = empty_scene(32, 32)
    square("Wall", size=20, location=(0, 4, 0), rotation=(math.pi / 2, 0, 0)).data.materials.append(material("White")[0])
    light("POINT", watts=300, location=(0, -0.5, 0))
    bare = render()["Combined"]
    box("Slab", size=(1.5, 0.3, 1.5), location=(0, 2, 0)).data.materials.append(
        smooth(material("Clear", (0.5, 0.8, 1), GLASS)))
    seen = render()["Combined"]
    for band, colour in enumerate((0.5, 0.8, 1)):
        chord = 4 * 1.5 * 1.5 * 0.3 / (2 * 1.5 * 1.5 + 4 * 1.5 * 0.3)
        r = ((1.45 - 1.334) / (1.45 + 1.334)) ** 2
        # The light's way to the wall leads through it, too.
        expected = ((1 - r) ** 2 * colour ** (2 * 0.3 / chord)) ** 2
        found = numpy.median(seen[14:18, 14:18, band] / bare[14:18, 14:18, band])
        assert abs(found / expected - 1) < 0.01, (band, found, expected)


def test_others_stay_opaque():
    for name, make in OPAQUE.items():
        room()
        dome(make())
        seen = render()["Combined"][..., 0]
        room()
        bpy.data.objects.remove(bpy.data.objects["Light"])
        dark = render()["Combined"][..., 0]
        # What is lit from within a closed shell is the shell's inside alone.
        wall = numpy.s_[:, 30:]
        assert numpy.abs(seen[wall] - dark[wall]).max() < 1e-6, (name, seen[wall].max())


def test_transparent_is_as_in_cycles():
    room()
    dome(CLEAR["Transparent"][0]())
    window(CLEAR["Alpha"][0]())
    ours, theirs = render()["Combined"][..., 0], render("CYCLES")["Combined"][..., 0]
    median_close(ours, theirs, 2e-3, "through a dome and a window", theirs > 0.02 * theirs.max())
