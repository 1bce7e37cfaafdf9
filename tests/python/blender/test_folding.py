# ctest labels: unit analytic
"""The values of constant node trees, read through groups, against those that Cycles computes for the same."""

from node_materials import *

# Numbers that tell operations apart, some outside what they are defined for.
NUMBERS = ((0.3, 0.7, 0.2), (-1.7, 0.6, 1.3), (2.4, -0.9, 0.4), (0.0, 0.0, 0.0))
COLOURS = (((0.8, 0.3, 0.1, 1), (0.2, 0.5, 0.9, 1)), ((0.1, 0.6, 0.2, 1), (0.7, 0.7, 0.1, 1)),
           ((0.5, 0.5, 0.5, 1), (0.9, 0.2, 0.4, 1)))


def put(node, values):
    """Sets the inputs that a node's settings leave, in their order."""
    sockets = [socket for socket in node.inputs if socket.enabled and hasattr(socket, "default_value")]
    for socket, value in zip(sockets, values):
        width = len(socket.default_value) if hasattr(socket.default_value, "__len__") else 0
        if width == 0:
            socket.default_value = value[0] if isinstance(value, tuple) else value
        else:
            parts = (value,) * width if isinstance(value, (int, float)) else (*value, 1, 1)
            socket.default_value = parts[:width]


def cases():
    """(name, kind of node, its settings, values of its inputs, name of the output)"""
    for item in bpy.types.ShaderNodeMath.bl_rna.properties["operation"].enum_items:
        for values in NUMBERS:
            yield "Math", {"operation": item.identifier}, values, 0
    vectors = (((0.3, -1.25, 0.75), (1.1, 0.4, -0.6), (0.5, 0.2, 0.9)), ((2.0, 0.5, 1.5), (-0.3, 0.8, 0.7), (1, 1, 1)))
    for item in bpy.types.ShaderNodeVectorMath.bl_rna.properties["operation"].enum_items:
        for values in vectors:
            given = (values[0], 1.7) if item.identifier == "SCALE" else values
            output = 1 if item.identifier in ("DOT_PRODUCT", "LENGTH", "DISTANCE") else 0
            yield "VectorMath", {"operation": item.identifier}, given, output
    for item in bpy.types.ShaderNodeMixRGB.bl_rna.properties["blend_type"].enum_items:
        for colours in COLOURS:
            for factor in (1.0, 0.35):
                yield "MixRGB", {"blend_type": item.identifier}, (factor, *colours), 0
                yield "Mix", {"blend_type": item.identifier, "data_type": "RGBA"}, (factor, *colours), 2
    yield "Mix", {"data_type": "FLOAT"}, (0.3, 1.5, -0.5), 0
    yield "Mix", {"data_type": "VECTOR"}, (0.3, (1, 2, 3), (3, 2, 2)), 1
    for colours in COLOURS:
        yield "HueSaturation", {}, (0.8, 0.7, 1.3, 0.6, colours[0]), 0
        yield "BrightContrast", {}, (colours[0], 0.1, -0.4), 0
        yield "Gamma", {}, (colours[0], 2.2), 0
        yield "Invert", {}, (0.7, colours[0]), 0
        yield "RGBToBW", {}, (colours[0],), 0
        for mode in ("RGB", "HSV", "HSL"):
            yield "CombineColor", {"mode": mode}, colours[0][:3], 0
            for output in range(3):
                yield "SeparateColor", {"mode": mode}, (colours[0],), output
    yield "CombineXYZ", {}, (0.1, -0.2, 0.3), 0
    yield "SeparateXYZ", {}, ((0.1, 0.2, 0.3),), 2
    for kind in ("LINEAR", "SMOOTHSTEP", "SMOOTHERSTEP", "STEPPED"):
        for value in (0.4, 1.8):
            yield "MapRange", {"interpolation_type": kind}, (value, 0.2, 1.2, 3.0, 2.0), 0
    yield "MapRange", {"clamp": False}, (1.8, 0.2, 1.2, 3.0, 2.0), 0
    yield "Clamp", {}, (1.8, 0.2, 1.2), 0
    yield "Clamp", {"clamp_type": "RANGE"}, (0.1, 1.2, 0.3), 0
    for factor in (0.1, 0.37, 0.8):
        yield "ValToRGB", {}, (factor,), 0
    yield "RGBCurve", {}, (0.7, COLOURS[0][0]), 0
    yield "FloatCurve", {}, (0.7, 0.4), 0
    for kelvin in (1500, 3200, 6500, 11000):
        yield "Blackbody", {}, (kelvin,), 0


class Case:
    def __init__(self, number, kind, settings, values, output):
        self.name = f"{kind} {settings} {values}"
        self.kind = kind
        made, nodes, links, emission = material(f"Case {number}", shader="ShaderNodeEmission")
        node = nodes.new(f"ShaderNode{kind}")
        for key, value in settings.items():
            setattr(node, key, value)
        put(node, values)
        self.node, self.material = node, made
        # Negative and great values become such that shine.
        half = connected(nodes, links, "ShaderNodeVectorMath", 0, Vector=node.outputs[output])
        half.node.operation = "MULTIPLY_ADD"
        half.node.inputs[1].default_value, half.node.inputs[2].default_value = (0.05,) * 3, (4,) * 3
        links.new(half, emission.inputs["Color"])
        if kind == "ValToRGB":
            node.color_ramp.elements[0].color, node.color_ramp.elements[1].color = (0.9, 0.2, 0.1, 1), (0.1, 0.4, 1, 1)
            node.color_ramp.elements.new(0.4).color = (0.2, 0.9, 0.2, 1)
        if kind in ("RGBCurve", "FloatCurve"):
            node.mapping.curves[-1].points.new(0.4, 0.7)
            node.mapping.update()


def test_values_of_nodes():
    """Each is a square of the picture. Those that are not folded, which have to be few, are baked."""
    scene = empty_scene(8, 8)
    nodes_of = sys.modules["uwvdb_blender.nodes"]
    made = [Case(number, *case) for number, case in enumerate(cases())]
    side = math.ceil(math.sqrt(len(made)))
    scene.render.resolution_x = scene.render.resolution_y = side
    scene.camera.data.angle = math.radians(60)
    step = 2 * 5 * math.tan(math.radians(30)) / side
    for number, case in enumerate(made):
        place = ((number % side + 0.5) * step - side * step / 2, 5, side * step / 2 - (number // side + 0.5) * step)
        square(f"Square {number}", size=step, location=place,
               rotation=(math.pi / 2, 0, 0)).data.materials.append(case.material)
    seen = render("CYCLES", samples=1)["Combined"].reshape(-1, 4)[:len(made), :3]
    seen = (seen.astype(float) - 4) / 0.05
    unfolded, wrong = [], []
    for case, wanted in zip(made, seen):
        value = nodes_of.source_of(nodes_of.output_of(case.material).inputs["Surface"])[0].inputs["Color"]
        if value.source is not None:
            unfolded.append(case.name)
            continue
        found = (numpy.array(value.default_value[:3]) - 4) / 0.05
        # Cycles has ramps and curves as tables of 256 values, blackbodies as polynomials.
        tolerance = {"ValToRGB": 5e-3, "RGBCurve": 5e-3, "FloatCurve": 5e-3, "Blackbody": 3e-2}.get(case.kind, 1e-4)
        off = numpy.abs(found - wanted).max() / max(1, numpy.abs(wanted).max())
        if not off < tolerance:
            wrong.append((case.name, found, wanted))
    print(f"    {len(made)} cases, not folded: {unfolded}")
    assert not wrong, wrong
    assert len(unfolded) < len(made) / 10


def test_groups_reroutes_and_muted_nodes():
    empty_scene()
    nodes_of = sys.modules["uwvdb_blender.nodes"]
    made, nodes, links, node = material("Tree", shader="ShaderNodeEmission")
    tree = bpy.data.node_groups.new("Twice", "ShaderNodeTree")
    interface(tree, "Number", "Colour")
    give, take = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    twice = tree.nodes.new("ShaderNodeMath")
    twice.operation = "MULTIPLY"
    twice.inputs[1].default_value = 2
    tree.links.new(give.outputs[0], twice.inputs[0])
    tree.links.new(twice.outputs[0], take.inputs[0])
    outer, inner, reroute = (nodes.new(kind) for kind in ("ShaderNodeGroup", "ShaderNodeGroup", "NodeReroute"))
    outer.node_tree = inner.node_tree = tree
    inner.inputs[0].default_value = 0.1
    links.new(inner.outputs[0], reroute.inputs[0])
    links.new(reroute.outputs[0], outer.inputs[0])
    links.new(outer.outputs[0], node.inputs["Color"])

    def colour():
        return nodes_of.source_of(nodes_of.output_of(made).inputs["Surface"])[0].inputs["Color"].default_value[:3]

    assert numpy.allclose(colour(), 0.4), colour()
    twice.mute = True
    assert numpy.allclose(colour(), 0.1), colour()


def test_mixtures_of_numbers_need_no_bake():
    """Two shaders by a number, one of which is in a group's tree, are the surface whose colours are their mean."""
    scene = empty_scene(60, 60)
    thing = square(size=3, location=(0, 2, 0), rotation=(math.pi / 2, 0, 0))
    light("POINT", watts=100, location=(-0.7, 0.3, 0.4))
    made, nodes, links, first = material("Mixed", (0.8, 0.2, 0.1))
    second, mix = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeMixShader")
    second.inputs["Color"].default_value, mix.inputs[0].default_value = (0.1, 0.4, 0.9, 1), 0.3
    links.new(first.outputs[0], mix.inputs[1])
    links.new(second.outputs[0], mix.inputs[2])
    links.new(mix.outputs[0], next(n for n in nodes if n.type == "OUTPUT_MATERIAL").inputs["Surface"])
    thing.data.materials.append(made)
    assert not sys.modules["uwvdb_blender.materials"].channels_to_bake(made)
    ours = render()["Combined"]
    assert not any("Mixed" in note for note in notes()), notes()
    close(ours[..., :3], render("CYCLES", samples=16)["Combined"][..., :3], 2e-3, "mixture")
