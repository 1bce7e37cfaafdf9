"""Materials as artists make them, whose nodes uwvdb does not have; each a function of its object."""

from support import *

SIZE = 128  # of pictures


def shaded(thing, shader="ShaderNodeBsdfPrincipled"):
    """(nodes, links, shader's inputs) of a new material of a thing; as matt as materials are without gloss."""
    made, nodes, links, node = material(thing.name, shader=shader)
    if shader == "ShaderNodeBsdfPrincipled":
        node.inputs["Specular" if "Specular" in node.inputs else "Specular IOR Level"].default_value = 0
    thing.data.materials.append(made)
    return nodes, links, node.inputs


def connected(nodes, links, kind, output=0, **values):
    """The output of a new node; values are numbers or sockets by the names of inputs, _ for a space."""
    node = nodes.new(kind)
    for name, value in values.items():
        socket = next(s for s in node.inputs if s.name == name.replace("_", " ") and s.enabled)
        if isinstance(value, bpy.types.NodeSocket):
            links.new(value, socket)
        else:
            socket.default_value = value
    return node.outputs[output]


def mixed(nodes, links, first, second, factor, how="MIX"):
    node = nodes.new("ShaderNodeMix")
    node.data_type, node.blend_type = "RGBA", how
    sockets = [node.inputs[0], *(s for s in node.inputs if s.type == "RGBA")]
    for value, socket in zip((factor, first, second), sockets):
        if isinstance(value, bpy.types.NodeSocket):
            links.new(value, socket)
        else:
            socket.default_value = value
    return next(s for s in node.outputs if s.type == "RGBA")


def ramp(nodes, links, source, *stops):
    node = nodes.new("ShaderNodeValToRGB")
    elements = node.color_ramp.elements
    while len(elements) < len(stops):
        elements.new(0.5)
    for element, (place, colour) in zip(elements, stops):
        element.position, element.color = place, (*colour, 1)
    links.new(source, node.inputs[0])
    return node.outputs[0]


def picture(name, tint=(1, 1, 1), tiled=False):
    """Stripes and waves, packed."""
    y, x = numpy.mgrid[0:SIZE, 0:SIZE].astype(numpy.float32) / SIZE
    values = numpy.ones((SIZE, SIZE, 4), numpy.float32)
    for band, (part, wave) in enumerate(zip(tint, (x, y, x * y))):
        values[..., band] = part * (0.5 + 0.35 * numpy.sin(9 * wave + 3 * x))
    image = bpy.data.images.new(name, SIZE, SIZE, tiled=tiled)
    image.pixels.foreach_set(values.reshape(-1))
    image.update()
    if not tiled:
        image.pack()
    return image


def textured(nodes, image, **settings):
    node = nodes.new("ShaderNodeTexImage")
    node.image = image
    for name, value in settings.items():
        setattr(node, name, value)
    return node


def coordinates(nodes, output):
    return nodes.new("ShaderNodeTexCoord").outputs[output]


def noise_through_a_ramp(thing):
    nodes, links, inputs = shaded(thing)
    source = connected(nodes, links, "ShaderNodeTexNoise", 0, Scale=3.0)
    links.new(ramp(nodes, links, source, (0.3, (0.05, 0.2, 0.5)), (0.5, (0.8, 0.6, 0.2)), (0.7, (0.7, 0.1, 0.1))),
              inputs["Base Color"])


def voronoi_in_object_coordinates(thing):
    nodes, links, inputs = shaded(thing)
    links.new(connected(nodes, links, "ShaderNodeTexVoronoi", 1, Vector=coordinates(nodes, "Object"), Scale=2.0),
              inputs["Base Color"])


def bricks_in_generated_coordinates(thing):
    nodes, links, inputs = shaded(thing)
    links.new(connected(nodes, links, "ShaderNodeTexBrick", 0, Vector=coordinates(nodes, "Generated"), Scale=3.0,
                        Color1=(0.6, 0.2, 0.1, 1), Color2=(0.4, 0.1, 0.1, 1), Mortar=(0.7, 0.7, 0.6, 1)),
              inputs["Base Color"])


def checker_by_a_turned_mapping(thing):
    nodes, links, inputs = shaded(thing)
    mapping = nodes.new("ShaderNodeMapping")
    mapping.inputs["Rotation"].default_value, mapping.inputs["Scale"].default_value = (0.3, 0.5, 0.7), (2, 3, 1)
    links.new(coordinates(nodes, "UV"), mapping.inputs["Vector"])
    links.new(connected(nodes, links, "ShaderNodeTexChecker", 0, Vector=mapping.outputs[0], Scale=2.0,
                        Color1=(0.7, 0.7, 0.2, 1), Color2=(0.1, 0.3, 0.3, 1)), inputs["Base Color"])


def painted_and_turned_in_hue(thing):
    nodes, links, inputs = shaded(thing)
    colours = thing.data.color_attributes.new("Paint", "BYTE_COLOR", "CORNER")
    for number, item in enumerate(colours.data):
        item.color = (0.2 + 0.6 * (number % 3) / 2, 0.5, 0.7 - 0.5 * (number % 5) / 4, 1)
    paint = nodes.new("ShaderNodeVertexColor")
    paint.layer_name = "Paint"
    links.new(connected(nodes, links, "ShaderNodeHueSaturation", 0, Hue=0.7, Saturation=0.8, Color=paint.outputs[0]),
              inputs["Base Color"])


def packed_picture_with_contrast(thing):
    nodes, links, inputs = shaded(thing)
    source = textured(nodes, picture("Packed")).outputs[0]
    links.new(connected(nodes, links, "ShaderNodeBrightContrast", 0, Color=source, Bright=0.1, Contrast=0.3),
              inputs["Base Color"])


def two_uv_maps_overlaid(thing):
    nodes, links, inputs = shaded(thing)
    other = thing.data.uv_layers.new(name="Other")
    for item in other.data:
        item.uv = (1.7 * item.uv.y, 0.3 + item.uv.x)
    thing.data.uv_layers["UVMap" if "UVMap" in thing.data.uv_layers else 0].active_render = True
    second = textured(nodes, picture("Second", (1, 0.4, 0.6)))
    source = nodes.new("ShaderNodeUVMap")
    source.uv_map = "Other"
    links.new(source.outputs[0], second.inputs["Vector"])
    first = textured(nodes, picture("First"))
    links.new(mixed(nodes, links, first.outputs[0], second.outputs[0], 0.7, "OVERLAY"), inputs["Base Color"])


def udim_tiles(thing):
    nodes, links, inputs = shaded(thing)
    for item in thing.data.uv_layers[0].data:
        item.uv.x *= 2
    folder = tempfile.mkdtemp(prefix="uwvdb-test-")
    for number, tint in ((1001, (1, 0.5, 0.3)), (1002, (0.3, 0.6, 1))):
        tile = picture(f"tile{number}", tint)
        tile.filepath_raw, tile.file_format = f"{folder}/tile.{number}.png", "PNG"
        tile.save()
    image = bpy.data.images.load(f"{folder}/tile.1001.png")
    image.source = "TILED"
    image.filepath = f"{folder}/tile.<UDIM>.png"
    image.tiles.new(1002)
    links.new(textured(nodes, image).outputs[0], inputs["Base Color"])


def picture_projected_on_a_box(thing):
    nodes, links, inputs = shaded(thing)
    node = textured(nodes, picture("Boxed"), projection="BOX", projection_blend=0.2)
    links.new(coordinates(nodes, "Generated"), node.inputs["Vector"])
    links.new(node.outputs[0], inputs["Base Color"])


def group_of_groups(thing):
    nodes, links, inputs = shaded(thing)
    inner = bpy.data.node_groups.new("Inner", "ShaderNodeTree")
    outer = bpy.data.node_groups.new("Outer", "ShaderNodeTree")
    for tree in (inner, outer):
        interface(tree, "Scale", "Colour")
    give, take = inner.nodes.new("NodeGroupInput"), inner.nodes.new("NodeGroupOutput")
    source = connected(inner.nodes, inner.links, "ShaderNodeTexMagic", 0, Scale=give.outputs[0])
    inner.links.new(source, take.inputs[0])
    give, take = outer.nodes.new("NodeGroupInput"), outer.nodes.new("NodeGroupOutput")
    node = outer.nodes.new("ShaderNodeGroup")
    node.node_tree = inner
    outer.links.new(give.outputs[0], node.inputs[0])
    outer.links.new(connected(outer.nodes, outer.links, "ShaderNodeGamma", 0, Color=node.outputs[0], Gamma=1.8),
                    take.inputs[0])
    node = nodes.new("ShaderNodeGroup")
    node.node_tree = outer
    node.inputs[0].default_value = 4
    links.new(node.outputs[0], inputs["Base Color"])


def interface(tree, number, colour):
    """A group takes a number and gives a colour."""
    if hasattr(tree, "interface"):
        tree.interface.new_socket(number, in_out="INPUT", socket_type="NodeSocketFloat")
        tree.interface.new_socket(colour, in_out="OUTPUT", socket_type="NodeSocketColor")
    else:
        tree.inputs.new("NodeSocketFloat", number)
        tree.outputs.new("NodeSocketColor", colour)


def random_by_object(thing):
    nodes, links, inputs = shaded(thing)
    info = nodes.new("ShaderNodeObjectInfo")
    colour = ramp(nodes, links, info.outputs["Random"], (0, (0.8, 0.1, 0.1)), (1, (0.1, 0.3, 0.8)))
    pattern = connected(nodes, links, "ShaderNodeTexChecker", 0, Scale=3.0)
    links.new(mixed(nodes, links, colour, pattern, 0.3), inputs["Base Color"])


def gradient_of_the_world(thing):
    nodes, links, inputs = shaded(thing)
    place = connected(nodes, links, "ShaderNodeVectorMath", 0, Vector=nodes.new("ShaderNodeNewGeometry").outputs[0])
    place.node.operation = "FRACTION"
    links.new(place, inputs["Base Color"])


def coordinates_of_an_empty(thing):
    nodes, links, inputs = shaded(thing)
    empty = add(f"Empty of {thing.name}", None, thing.location + Vector((0.4, 0, 0.2)), (0.3, 0.6, 0.2), (0.5,) * 3)
    node = nodes.new("ShaderNodeTexCoord")
    node.object = empty
    gradient = nodes.new("ShaderNodeTexGradient")
    gradient.gradient_type = "SPHERICAL"
    links.new(node.outputs["Object"], gradient.inputs["Vector"])
    links.new(ramp(nodes, links, gradient.outputs[1], (0, (0.2, 0.5, 0.2)), (1, (0.9, 0.8, 0.3))),
              inputs["Base Color"])


def two_shaders_by_a_wave(thing):
    nodes, links, inputs = shaded(thing, "ShaderNodeBsdfDiffuse")
    inputs["Color"].default_value = (0.7, 0.2, 0.1, 1)
    first = inputs["Color"].node
    second = nodes.new("ShaderNodeBsdfPrincipled")
    second.inputs["Base Color"].default_value = (0.1, 0.5, 0.6, 1)
    second.inputs["Specular" if "Specular" in second.inputs else "Specular IOR Level"].default_value = 0
    mix = nodes.new("ShaderNodeMixShader")
    links.new(connected(nodes, links, "ShaderNodeTexWave", 1, Scale=1.5), mix.inputs[0])
    links.new(first.outputs[0], mix.inputs[1])
    links.new(second.outputs[0], mix.inputs[2])
    links.new(mix.outputs[0], next(n for n in nodes if n.type == "OUTPUT_MATERIAL").inputs["Surface"])


def generated_on_a_bent_mesh(thing):
    nodes, links, inputs = shaded(thing)
    thing.shape_key_add(name="Basis")
    key = thing.shape_key_add(name="Bent")
    for point in key.data:
        point.co.x += 0.5 * point.co.z
    key.value = 1
    links.new(connected(nodes, links, "ShaderNodeTexWave", 0, Scale=2.0, Distortion=2.0), inputs["Base Color"])


def curves_and_separated_channels(thing):
    nodes, links, inputs = shaded(thing)
    curves = nodes.new("ShaderNodeRGBCurve")
    curves.mapping.curves[3].points.new(0.4, 0.65)
    links.new(textured(nodes, picture("Curved")).outputs[0], curves.inputs["Color"])
    parts = nodes.new("ShaderNodeSeparateColor")
    links.new(curves.outputs[0], parts.inputs[0])
    math_node = nodes.new("ShaderNodeMath")
    math_node.operation = "MULTIPLY"
    links.new(parts.outputs[0], math_node.inputs[0])
    links.new(parts.outputs[1], math_node.inputs[1])
    whole = nodes.new("ShaderNodeCombineColor")
    for source, at in ((parts.outputs[2], 0), (math_node.outputs[0], 1), (parts.outputs[0], 2)):
        links.new(source, whole.inputs[at])
    links.new(whole.outputs[0], inputs["Base Color"])


MATERIALS = (noise_through_a_ramp, voronoi_in_object_coordinates, bricks_in_generated_coordinates,
             checker_by_a_turned_mapping, painted_and_turned_in_hue, packed_picture_with_contrast,
             two_uv_maps_overlaid, udim_tiles, picture_projected_on_a_box, group_of_groups, random_by_object,
             gradient_of_the_world, coordinates_of_an_empty, two_shaders_by_a_wave, generated_on_a_bent_mesh,
             curves_and_separated_channels)


def unwrapped_box(name, **place):
    """Its six faces lie side by side on its UV map, apart from each other."""
    made = box(name, **place)
    layer = made.data.uv_layers.new(name="UVMap")
    for face in range(6):
        for corner, (u, v) in enumerate(((0.02, 0.02), (0.31, 0.02), (0.31, 0.47), (0.02, 0.47))):
            layer.data[4 * face + corner].uv = (u + face % 3 / 3, v + face // 3 / 2)
    return made


def ball(name, **place):
    """Without texture coordinates."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4, radius=0.62)
    made = bpy.context.object
    made.name = made.data.name = name
    for layer in list(made.data.uv_layers):
        made.data.uv_layers.remove(layer)
    made.data.polygons.foreach_set("use_smooth", numpy.ones(len(made.data.polygons), bool))
    for key, value in place.items():
        setattr(made, {"rotation": "rotation_euler"}.get(key, key), value)
    return made


# They look at UV maps, or at the corners of a box.
ON_BOXES = {checker_by_a_turned_mapping, painted_and_turned_in_hue, packed_picture_with_contrast,
            two_uv_maps_overlaid, udim_tiles, curves_and_separated_channels, bricks_in_generated_coordinates,
            "normal_map_in_a_group"}


def shelf(makers, width=360):
    """A scene of rows of things of these materials before the camera, lit from beside it."""
    columns = math.ceil(math.sqrt(len(makers)))
    rows = math.ceil(len(makers) / columns)
    scene = empty_scene(width, round(width * rows / columns))
    scene.camera.data.type, scene.camera.data.angle = "PERSP", math.radians(30)
    distance = columns * 1.6 / 2 / math.tan(math.radians(15))
    light("POINT", watts=60 * distance**2, location=(-2, -1, 3))
    scene.view_layers[0].uwvdb.use_albedo = True
    scene.view_layers[0].use_pass_diffuse_color = True
    scene.view_layers[0].use_pass_object_index = True
    scene.view_layers[0].use_pass_normal = True
    for number, make in enumerate(makers):
        x, z = number % columns - (columns - 1) / 2, (rows - 1) / 2 - number // columns
        place = {"location": Vector((1.6 * x, distance, 1.6 * z)), "rotation": (0.4, 0.2, 0.6 + 0.1 * number)}
        name = make.__name__.replace("_", " ")
        thing = unwrapped_box(name, **place) if {make, make.__name__} & ON_BOXES else ball(name, **place)
        thing.pass_index = number + 1
        make(thing)
    return scene


def bumps_by_noise(thing):
    nodes, links, inputs = shaded(thing)
    source = connected(nodes, links, "ShaderNodeTexNoise", 0, Scale=4.0)
    links.new(connected(nodes, links, "ShaderNodeBump", 0, Strength=0.6, Distance=0.3, Height=source),
              inputs["Normal"])


def normal_map_in_a_group(thing):
    nodes, links, inputs = shaded(thing)
    image = bpy.data.images.new("Bumps", 64, 64, is_data=True)
    y, x = numpy.mgrid[0:64, 0:64].astype(numpy.float32) / 64 * 2 * math.pi
    normal = numpy.stack([0.4 * numpy.sin(3 * x), 0.3 * numpy.cos(2 * y), numpy.ones_like(x)], axis=-1)
    normal /= numpy.linalg.norm(normal, axis=-1, keepdims=True)
    values = numpy.ones((64, 64, 4), numpy.float32)
    values[..., :3] = normal / 2 + 0.5
    image.pixels.foreach_set(values.reshape(-1))
    image.pack()
    tree = bpy.data.node_groups.new("Detail", "ShaderNodeTree")
    interface(tree, "Strength", "Normal")
    give, take = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
    invert = connected(tree.nodes, tree.links, "ShaderNodeInvert", 0, Color=textured(tree.nodes, image).outputs[0])
    flat = mixed(tree.nodes, tree.links, textured(tree.nodes, image).outputs[0], invert, 0.1)
    bend = tree.nodes.new("ShaderNodeNormalMap")
    tree.links.new(flat, bend.inputs["Color"])
    tree.links.new(give.outputs[0], bend.inputs["Strength"])
    tree.links.new(bend.outputs[0], take.inputs[0])
    group = nodes.new("ShaderNodeGroup")
    group.node_tree = tree
    group.inputs[0].default_value = 0.8
    links.new(group.outputs[0], inputs["Normal"])


def metal_and_roughness_by_noise(thing):
    nodes, links, inputs = shaded(thing)
    inputs["Base Color"].default_value = (0.9, 0.6, 0.3, 1)
    noise = connected(nodes, links, "ShaderNodeTexNoise", 0, Scale=1.5)
    links.new(ramp(nodes, links, noise, (0.4, (0.35,) * 3), (0.6, (0.7,) * 3)), inputs["Roughness"])
    inputs["Metallic"].default_value = 1


def glow_by_a_wave(thing):
    nodes, links, inputs = shaded(thing)
    inputs["Base Color"].default_value = (0, 0, 0, 1)
    name = "Emission" if "Emission" in inputs else "Emission Color"
    wave = connected(nodes, links, "ShaderNodeTexWave", 1, Scale=1.0)
    links.new(ramp(nodes, links, wave, (0, (0.1, 0.2, 1)), (1, (1, 0.6, 0.1))), inputs[name])
    inputs["Emission Strength"].default_value = 3


def holes_by_a_checker(thing):
    nodes, links, inputs = shaded(thing)
    inputs["Base Color"].default_value = (0.2, 0.7, 0.4, 1)
    links.new(connected(nodes, links, "ShaderNodeTexChecker", 1, Scale=2.5), inputs["Alpha"])


OTHER_MATERIALS = (bumps_by_noise, normal_map_in_a_group, metal_and_roughness_by_noise, glow_by_a_wave,
                   holes_by_a_checker)


def inner(indices, number):
    """Pixels of an object all of whose neighbours are of it, too."""
    own = indices == number
    result = own.copy()
    for axis in (0, 1):
        for step in (-1, 1):
            result &= numpy.roll(own, step, axis)
    return result
