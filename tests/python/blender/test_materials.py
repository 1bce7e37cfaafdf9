# ctest labels: metamorphic
"""Materials against Cycles: colours, textures and how they are placed, cut-outs, bumps, metal, light."""

from support import *


def facing_square(size=2.4):
    """A square that fills most of the image, and a lamp beside the camera."""
    scene = empty_scene(90, 90)
    scene.camera.data.angle = math.radians(60)
    light("POINT", watts=300, location=(-0.7, 0.3, 0.4))
    scene.view_layers[0].uwvdb.use_albedo = True
    scene.view_layers[0].use_pass_normal = True
    return scene, square(size=size, location=(0, 2, 0), rotation=(math.pi / 2, 0, 0))


def picture(name="Picture", size=(256, 128), alpha=False, data=False, packed=True):
    """Smooth in both directions, without symmetry; so fine that it does not matter whether texels are
    interpolated before or after they are decoded."""
    width, height = size
    y, x = numpy.mgrid[0:height, 0:width].astype(numpy.float32)
    values = numpy.ones((height, width, 4), numpy.float32)
    values[..., 0] = 0.2 + 0.6 * x / width
    values[..., 1] = 0.2 + 0.6 * y / height
    values[..., 2] = 0.5 + 0.4 * numpy.sin(x / width * 6) * numpy.cos(y / height * 6)
    if alpha:
        values[..., 3] = ((x - width * 0.4)**2 / width**2 + (y - height * 0.6)**2 / height**2) < 0.05
    image = bpy.data.images.new(name, width, height, alpha=True, is_data=data)
    image.pixels.foreach_set(values.ravel())
    image.update()
    if packed:
        image.pack()
    return image


def textured(thing, image, shader="ShaderNodeBsdfDiffuse", vector=None):
    made, nodes, links, node = material("Textured", shader=shader)
    texture = nodes.new("ShaderNodeTexImage")
    texture.image = image
    links.new(texture.outputs["Color"], node.inputs[0])
    if vector is not None:
        links.new(vector(nodes, links), texture.inputs["Vector"])
    thing.data.materials.append(made)
    return made, nodes, links, node, texture


def compare(what, tolerance=2e-3, where=0.03):
    ours, theirs = render()["Combined"], render("CYCLES", samples=128)["Combined"]
    for band in range(3):
        wanted = theirs[..., band]
        median_close(ours[..., band], wanted, tolerance, f"{what}, band {band}",
                     wanted > where * wanted.max())
    return ours, theirs


def test_texture():
    _, thing = facing_square()
    textured(thing, picture())
    compare("texture")


def test_painted_texture():
    """An image that was never saved."""
    _, thing = facing_square()
    textured(thing, picture(packed=False))
    compare("generated image")


def test_mapping():
    """Offset, turn and scale, where pictures repeat."""
    _, thing = facing_square()

    def vector(nodes, links):
        mapping, coordinates = nodes.new("ShaderNodeMapping"), nodes.new("ShaderNodeTexCoord")
        mapping.inputs["Location"].default_value = (0.13, 0.27, 0)
        mapping.inputs["Rotation"].default_value = (0, 0, 0.5)
        mapping.inputs["Scale"].default_value = (1.6, 0.7, 1)
        links.new(coordinates.outputs["UV"], mapping.inputs["Vector"])
        return mapping.outputs["Vector"]

    textured(thing, picture(), vector=vector)
    compare("mapping", 4e-3)


def test_second_uv_map():
    _, thing = facing_square()
    other = thing.data.uv_layers.new(name="Other")
    for loop, uv in zip(other.data, ((0.9, 0.1), (0.8, 0.9), (0.2, 0.8), (0.1, 0.2))):
        loop.uv = uv

    def vector(nodes, links):
        node = nodes.new("ShaderNodeUVMap")
        node.uv_map = "Other"
        return node.outputs["UV"]

    textured(thing, picture(), vector=vector)
    compare("second UV map")


def test_colour_times_texture():
    _, thing = facing_square()
    made, nodes, links, node, texture = textured(thing, picture())
    mix = nodes.new("ShaderNodeMix")
    mix.data_type, mix.blend_type = "RGBA", "MULTIPLY"
    mix.inputs[0].default_value = 1
    colours = [s for s in mix.inputs if s.type == "RGBA"]
    colours[1].default_value = (0.4, 0.7, 0.9, 1)
    links.new(texture.outputs["Color"], colours[0])
    links.new(next(s for s in mix.outputs if s.type == "RGBA"), node.inputs[0])
    compare("tinted texture")
    assert not any("Textured" in note for note in notes()), notes()


def paint(thing):
    colours = thing.data.color_attributes.new("Paint", "FLOAT_COLOR", "POINT")
    for item, colour in zip(colours.data, ((0.1, 0.8, 0.3, 1), (0.7, 0.2, 0.3, 1), (0.2, 0.3, 0.9, 1),
                                           (0.6, 0.6, 0.1, 1))):
        item.color = colour


def test_colour_times_texture_times_vertex_colours():
    _, thing = facing_square()
    paint(thing)
    made, nodes, links, node, texture = textured(thing, picture())
    source = nodes.new("ShaderNodeVertexColor")
    source.layer_name = "Paint"
    factors = [texture.outputs["Color"], source.outputs["Color"]]
    for _ in range(2):
        mix = nodes.new("ShaderNodeMix")
        mix.data_type, mix.blend_type = "RGBA", "MULTIPLY"
        mix.inputs[0].default_value = 1
        first, second = (s for s in mix.inputs if s.type == "RGBA")
        links.new(factors.pop(), first)
        second.default_value = (0.9, 0.8, 0.7, 1)
        if factors:
            links.new(factors.pop(), second)
        factors.append(next(s for s in mix.outputs if s.type == "RGBA"))
    links.new(factors[0], node.inputs[0])
    compare("tinted, painted texture")
    assert not any("Textured" in note for note in notes()), notes()


def test_vertex_colours():
    _, thing = facing_square()
    paint(thing)
    made, nodes, links, node = material("Painted")
    source = nodes.new("ShaderNodeVertexColor")
    source.layer_name = "Paint"
    links.new(source.outputs["Color"], node.inputs[0])
    thing.data.materials.append(made)
    compare("vertex colours")


def test_several_materials_on_one_mesh():
    _, thing = facing_square()
    bpy.data.objects.remove(thing)
    thing = mesh("Two", [(-1, 2, -1), (0, 2, -1), (0, 2, 1), (-1, 2, 1), (1, 2, -1), (1, 2, 1)],
                 [(0, 1, 2, 3), (1, 4, 5, 2)])
    for name, colour in (("A", (0.8, 0.2, 0.4)), ("B", (0.1, 0.6, 0.5))):
        thing.data.materials.append(material(name, colour)[0])
    thing.data.polygons[1].material_index = 1
    compare("two materials")


def principled(name="Principled", **values):
    made, nodes, links, node = material(name, shader="ShaderNodeBsdfPrincipled")
    for key, value in values.items():
        socket = key.replace("_", " ")
        if socket == "Specular" and socket not in node.inputs:
            socket = "Specular IOR Level"
        node.inputs[socket].default_value = value
    return made, nodes, links, node


def test_cut_out():
    _, thing = facing_square()
    square(size=8, location=(0, 3, 0), rotation=(math.pi / 2, 0, 0)).data.materials.append(
        material("Behind", (0.3, 0.3, 0.3))[0])
    image = picture(alpha=True, size=(64, 64))
    made, nodes, links, node = principled(Specular=0.0, Roughness=1.0)
    texture = nodes.new("ShaderNodeTexImage")
    texture.image, texture.interpolation = image, "Closest"
    links.new(texture.outputs["Color"], node.inputs["Base Color"])
    links.new(texture.outputs["Alpha"], node.inputs["Alpha"])
    if hasattr(made, "blend_method"):
        made.blend_method = "CLIP"
    thing.data.materials.append(made)
    ours, theirs = render()["Combined"][..., 0], render("CYCLES", samples=128)["Combined"][..., 0]
    # Principled's diffuse part and Lambert's differ by a few per cent, hole and shadow by far more.
    off = numpy.abs(ours - theirs) > 0.15 * theirs.max()
    print(f"    {off.mean():.2%} of the pixels differ")
    assert off.mean() < 0.02 and not any("opaque" in note for note in notes())


def test_normal_map():
    """Bent normals as the pass has them, and the light that they reflect."""
    scene, thing = facing_square()
    image = bpy.data.images.new("Bumps", 32, 32, is_data=True)
    y, x = numpy.mgrid[0:32, 0:32].astype(numpy.float32) / 32 * 2 * math.pi
    normal = numpy.stack([0.4 * numpy.sin(x), 0.3 * numpy.cos(2 * y), numpy.ones_like(x)], axis=-1)
    normal /= numpy.linalg.norm(normal, axis=-1, keepdims=True)
    values = numpy.ones((32, 32, 4), numpy.float32)
    values[..., :3] = normal / 2 + 0.5
    image.pixels.foreach_set(values.ravel())
    image.pack()
    made, nodes, links, node = material("Bumpy")
    texture, bend = nodes.new("ShaderNodeTexImage"), nodes.new("ShaderNodeNormalMap")
    texture.image, bend.uv_map = image, "UVMap"
    bend.inputs["Strength"].default_value = 1
    links.new(texture.outputs["Color"], bend.inputs["Color"])
    links.new(bend.outputs["Normal"], node.inputs["Normal"])
    thing.data.materials.append(made)
    ours, theirs = render(), render("CYCLES", samples=128)
    seen = numpy.linalg.norm(theirs["Normal"], axis=-1) > 0.5
    off = numpy.abs(ours["Normal"] - theirs["Normal"]).max(axis=-1)[seen]
    print(f"    normals: median {numpy.median(off):.1e}, greatest {off.max():.1e}")
    assert numpy.median(off) < 0.01 and off.max() < 0.06
    assert numpy.abs(theirs["Normal"][..., 0]).max() > 0.3
    wanted = theirs["Combined"][..., 0]
    median_close(ours["Combined"][..., 0], wanted, 0.01, "bumps", wanted > 0.03 * wanted.max())


def test_metal():
    """GGX over roughness from a texture, metal throughout."""
    scene, thing = facing_square()
    bpy.data.objects.remove(thing)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, radius=0.9, location=(0, 2.4, 0))
    ball = bpy.context.object
    bpy.ops.object.shade_smooth()
    made, nodes, links, node = principled(Metallic=1.0, Roughness=0.4, Base_Color=(0.9, 0.6, 0.3, 1))
    node.distribution = "GGX"
    ball.data.materials.append(made)
    compare("metal", 0.02, 0.05)


def test_emission():
    """Strength 1 of a colour c is c W/(m² sr)."""
    _, thing = facing_square()
    bpy.data.objects.remove(bpy.data.objects["Light"])
    made, _, _, node = material("Lamp", (0.7, 0.4, 0.2), "ShaderNodeEmission")
    node.inputs["Strength"].default_value = 2.5
    thing.data.materials.append(made)
    passes = render()
    middle = passes["Combined"][45, 45, :3]
    close(middle, [1.75, 1.0, 0.5], 1e-4, "emission")


def test_negative_emission_is_named():
    _, thing = facing_square()
    bpy.data.objects.remove(bpy.data.objects["Light"])
    made, _, _, node = material("Dark Lamp", (0.7, 0.4, 0.2), "ShaderNodeEmission")
    node.inputs["Strength"].default_value = -1
    thing.data.materials.append(made)
    assert render()["Combined"][45, 45, :3].max() == 0
    assert any("'Dark Lamp': takes no light away" in note for note in notes()), notes()


def test_unknown_nodes_are_named_where_nothing_is_baked():
    scene, thing = facing_square()
    scene.uwvdb.bake_size = 0
    made, nodes, links, node = principled()
    links.new(nodes.new("ShaderNodeTexNoise").outputs["Color"], node.inputs["Base Color"])
    links.new(nodes.new("ShaderNodeBump").outputs["Normal"], node.inputs["Normal"])
    thing.data.materials.append(made)
    render()
    told = " | ".join(notes())
    assert "'Base Color' are left out" in told and "Bump node is left out" in told, told
