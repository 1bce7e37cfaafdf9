# ctest labels: metamorphic
"""What is clear lets light through: domes around lamps and windows before the camera are as if they were not there, as
Transparent is in Cycles, and what is missing of them is said."""

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
    "tinted Transparent": (lambda: material("Clear", (0.9, 1, 1), TRANSPARENT)[0], False),
    "Glass": (lambda: material("Clear", (1, 1, 1), GLASS)[0], False),
    "Refraction": (lambda: material("Clear", (1, 1, 1), "ShaderNodeBsdfRefraction")[0], False),
    "Transmission": (lambda: principled(Transmission=1.0), False),
    "Alpha": (lambda: principled(Alpha=0.0), True),
    "glass without shadow": (lambda: mixed(GLASS, TRANSPARENT, ("ShaderNodeLightPath", "Is Shadow Ray")), False),
    "coated": (lambda: mixed(TRANSPARENT, GLOSSY, ("ShaderNodeFresnel", 0)), False),
    "faint dirt": (lambda: mixed(DIFFUSE, TRANSPARENT, 0.9), False),
    "added": (lambda: mixed(GLASS, TRANSPARENT, None), False),
}
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
