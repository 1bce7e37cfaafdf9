"""Materials of Blender as those of glTF: of its nodes what uwvdb has, and notes about the rest."""

import math

import numpy

from . import images

# A dielectric of the index of water does not shine in it: what has no gloss gets this one.
WATER_INDEX = 1.334
DEFAULT = {"name": "default", "pbrMetallicRoughness": {
    "baseColorFactor": [0.8, 0.8, 0.8, 1], "metallicFactor": 0, "roughnessFactor": 1},
    "extensions": {"KHR_materials_ior": {"ior": WATER_INDEX}}}
WRAPS = {"REPEAT": 10497, "EXTEND": 33071, "CLIP": 33071, "MIRROR": 33648}


class Exported:
    """A glTF material, and which maps of coordinates and colours of the mesh it needs."""

    def __init__(self, content):
        self.content, self.uv_maps, self.colours = content, [], None


def shows_surface(material):
    """False for materials of volumes alone, and for those that only let through."""
    if material is None or not material.use_nodes or material.node_tree is None:
        return True
    output = output_of(material)
    if output is None:
        return True
    return output.inputs["Surface"].is_linked or not output.inputs["Volume"].is_linked


def is_clear(material):
    """Whether light goes through most of a surface: uwvdb has no refraction, and opaque glass would be black."""
    if material is None or not material.use_nodes or material.node_tree is None:
        return False
    output = output_of(material)
    found = source_of(output.inputs["Surface"]) if output is not None else None
    return found is not None and _is_clear(found[0])


def _is_clear(node):
    if node.type in ("BSDF_TRANSPARENT", "BSDF_GLASS", "BSDF_REFRACTION"):
        return True
    if node.type == "BSDF_PRINCIPLED":
        return _is_clear_principled(node.inputs)
    if node.type not in ("MIX_SHADER", "ADD_SHADER"):
        return False
    sources = [source_of(socket) for socket in node.inputs if socket.type == "SHADER"]
    clear = [source is not None and _is_clear(source[0]) for source in sources]
    if node.type == "ADD_SHADER" or all(clear):
        return all(clear)
    factor = source_of(node.inputs[0])
    if factor is not None:  # a coat, which reflects little but at grazing angles
        return any(clear) and factor[0].type in ("FRESNEL", "LAYER_WEIGHT")
    second = node.inputs[0].default_value
    return clear[0] and second < 0.5 or clear[1] and second > 0.5


def _is_clear_principled(inputs):
    def value(*names):
        socket = next((inputs[name] for name in names if name in inputs), None)
        return None if socket is None or socket.is_linked else socket.default_value

    emission = value("Emission Color", "Emission")
    if value("Emission Strength") != 0 and (emission is None or max(emission[:3]) > 0):
        return False
    transmission, metallic = value("Transmission", "Transmission Weight"), value("Metallic")
    return value("Alpha") == 0 or (transmission is not None and transmission > 0.5
                                   and metallic is not None and metallic < 0.5)


def is_exactly_clear(material):
    """Whether nothing happens to light at a surface that is clear."""
    node = source_of(output_of(material).inputs["Surface"])[0]
    if node.type == "BSDF_PRINCIPLED":
        return not node.inputs["Alpha"].is_linked and node.inputs["Alpha"].default_value == 0
    colour = node.inputs["Color"] if node.type == "BSDF_TRANSPARENT" else None
    return colour is not None and not colour.is_linked and min(colour.default_value[:3]) == 1


def output_of(material):
    return material.node_tree.get_output_node("CYCLES") or material.node_tree.get_output_node("ALL")


def source_of(socket):
    """The (node, socket) that feeds a socket, through reroutes; None if nothing does."""
    while socket.is_linked:
        link = next((link for link in socket.links if link.is_valid and not link.is_muted), None)
        if link is None:
            return None
        if link.from_node.type != "REROUTE":
            return link.from_node, link.from_socket
        socket = link.from_node.inputs[0]
    return None


def _multiplied(node):
    """The two sockets of colours that a node multiplies with full effect; None if it does something
    else."""
    if node.type == "MIX_RGB":
        sockets = [node.inputs[1], node.inputs[2]]
    elif node.type == "MIX" and node.data_type == "RGBA":
        sockets = [socket for socket in node.inputs if socket.type == "RGBA"]
    else:
        return None
    factor = node.inputs[0]
    full = not factor.is_linked and factor.default_value == 1
    return sockets if full and node.blend_type == "MULTIPLY" else None


class Exporter:
    def __init__(self, glb, notes):
        self._glb, self._notes = glb, notes
        self._known, self._textures = {}, {}
        self.pass_indices = []  # of the materials in the file's order

    def export(self, material):
        """(index in the file, Exported) of a material, or of none."""
        key = material.name_full if material is not None else None
        if key not in self._known:
            done = Exported(dict(DEFAULT)) if material is None else self._convert(material)
            self._known[key] = (self._glb.add_material(done.content), done)
            self.pass_indices.append(material.pass_index if material is not None else 0)
        return self._known[key]

    def _note(self, material, text):
        self._notes.add(f"Material '{material.name}': {text}")

    def note_clear(self, material):
        """Says what is missing of a material that is clear."""
        if not is_exactly_clear(material):
            self._note(material, "lets all light through, as if it were not there: its refraction, reflection and "
                                 "colour are left out")

    def _convert(self, material):
        done = Exported({"name": material.name, "pbrMetallicRoughness": {}, "extensions": {}})
        if not material.use_nodes or material.node_tree is None:
            self._set_plain(done, material.diffuse_color, material.metallic, material.roughness,
                            1.5 if material.specular_intensity > 0 else WATER_INDEX)
            return done
        output = output_of(material)
        found = source_of(output.inputs["Surface"]) if output is not None else None
        if found is None:
            self._note(material, "has no surface shader and is black")
            self._set_plain(done, (0, 0, 0, 1), 0, 1, WATER_INDEX)
            return done
        if output.inputs["Displacement"].is_linked:
            self._note(material, "displacement by its shader is left out")
        if output.inputs["Volume"].is_linked:
            self._note(material, "its volume shader is left out")
        self._convert_shader(material, done, found[0])
        return done

    def _set_plain(self, done, colour, metallic, roughness, ior):
        done.content["pbrMetallicRoughness"].update(
            baseColorFactor=[min(max(float(c), 0), 1) for c in colour[:3]] + [1],
            metallicFactor=float(metallic), roughnessFactor=float(roughness))
        done.content["extensions"]["KHR_materials_ior"] = {"ior": ior}

    def _convert_shader(self, material, done, node):
        if node.type == "BSDF_PRINCIPLED":
            self._convert_principled(material, done, node)
        elif node.type == "BSDF_DIFFUSE":
            self._set_plain(done, (1, 1, 1, 1), 0, 1, WATER_INDEX)
            self._set_colour(material, done, node.inputs["Color"])
            self._set_normal(material, done, node.inputs["Normal"])
        elif node.type == "BSDF_GLOSSY":
            self._set_plain(done, (1, 1, 1, 1), 1, node.inputs["Roughness"].default_value, 1.5)
            self._set_colour(material, done, node.inputs["Color"])
            self._set_normal(material, done, node.inputs["Normal"])
        elif node.type == "EMISSION":
            self._set_plain(done, (0, 0, 0, 1), 0, 1, WATER_INDEX)
            self._set_emission(material, done, node.inputs["Color"], node.inputs["Strength"])
        elif node.type == "MIX_SHADER":
            self._convert_mix(material, done, node)
        else:
            self._note(material, f"uwvdb has no {node.bl_label} shader; the material is a grey diffuse")
            self._set_plain(done, (0.8, 0.8, 0.8, 1), 0, 1, WATER_INDEX)

    def _convert_mix(self, material, done, node):
        """Transparent mixed with another shader by a texture's alpha is a cut-out, as Principled has
        it itself."""
        shaders = [source_of(node.inputs[1]), source_of(node.inputs[2])]
        if all(shaders) and shaders[0][0].type == "BSDF_TRANSPARENT":
            self._convert_shader(material, done, shaders[1][0])
            self._set_alpha(material, done, node.inputs[0])
            return
        self._note(material, "mixed shaders are not supported; the first that uwvdb has is taken")
        kinds = ("BSDF_PRINCIPLED", "BSDF_DIFFUSE", "BSDF_GLOSSY", "EMISSION", "MIX_SHADER")
        found = next((s[0] for s in shaders if s is not None and s[0].type in kinds), None)
        if found is None:
            self._set_plain(done, (0.8, 0.8, 0.8, 1), 0, 1, WATER_INDEX)
        else:
            self._convert_shader(material, done, found)

    def _convert_principled(self, material, done, node):
        inputs = node.inputs
        specular = inputs.get("Specular IOR Level") or inputs["Specular"]
        self._unlinked(material, specular)
        # Specular 0.5 means 4 % in air, Fresnel's for the index 1.5; Blender 4 scales that of IOR.
        f0 = 0.08 * float(specular.default_value)
        if "Specular IOR Level" in inputs:
            self._unlinked(material, inputs["IOR"])
            ior = float(inputs["IOR"].default_value)
            f0 = ((ior - 1) / (ior + 1)) ** 2 * 2 * float(specular.default_value)
        root = math.sqrt(min(max(f0, 0), 0.9))
        ior = (1 + root) / (1 - root) if f0 > 0 else WATER_INDEX
        self._set_plain(done, (1, 1, 1, 1), 0, 1, max(ior, 1))
        self._set_colour(material, done, inputs["Base Color"])
        self._set_roughness(material, done, inputs["Roughness"], inputs["Metallic"])
        self._set_normal(material, done, inputs["Normal"])
        self._set_emission(material, done, inputs.get("Emission Color") or inputs["Emission"],
                           inputs["Emission Strength"])
        self._set_alpha(material, done, inputs["Alpha"])
        for names, what in ((("Transmission", "Transmission Weight"), "transmission"),
                            (("Subsurface", "Subsurface Weight"), "subsurface scattering"),
                            (("Clearcoat", "Coat Weight"), "coat"),
                            (("Sheen", "Sheen Weight"), "sheen"), (("Anisotropic",), "anisotropy")):
            socket = next((inputs[name] for name in names if name in inputs), None)
            if socket is not None and (socket.is_linked or socket.default_value > 0):
                self._note(material, f"{what} is left out")

    def _unlinked(self, material, socket):
        if source_of(socket) is not None:
            self._note(material, f"the nodes behind '{socket.name}' are left out; its own value is taken")

    def _set_colour(self, material, done, socket):
        pbr = done.content["pbrMetallicRoughness"]
        factor, sources = self._product(socket)
        pictures = [node for node in sources if self._is_image(node)]
        paints = [node for node in sources if node.type in ("VERTEX_COLOR", "ATTRIBUTE")]
        texture = None
        if len(pictures) <= 1 and len(paints) <= 1 and len(pictures) + len(paints) == len(sources):
            if pictures:
                texture = self._texture(material, done, pictures[0], images.colour_file, "sRGB")
            if texture is not None or not pictures:
                pbr["baseColorFactor"] = factor + [1]
                if texture is not None:
                    pbr["baseColorTexture"] = texture
                for node in paints:
                    done.colours = (node.layer_name if node.type == "VERTEX_COLOR"
                                    else node.attribute_name)
                return
        self._unlinked(material, socket)
        pbr["baseColorFactor"] = [min(max(c, 0), 1) for c in socket.default_value[:3]] + [1]

    def _product(self, socket):
        """(colour, nodes) whose product a socket gets, through nodes that multiply with full effect."""
        found = source_of(socket)
        colour = self._constant(socket, found)
        if colour is not None:
            return colour, []
        node = found[0]
        sockets = _multiplied(node)
        if sockets is None:
            return [1.0, 1.0, 1.0], [node]
        (first, nodes), (second, others) = (self._product(socket) for socket in sockets)
        return [x * y for x, y in zip(first, second)], nodes + others

    @staticmethod
    def _constant(socket, found):
        """The colour of an unlinked socket, or of an RGB node."""
        if found is None:
            values = socket.default_value
        elif found[0].type == "RGB":
            values = found[1].default_value
        else:
            return None
        return [min(max(float(c), 0), 1) for c in values[:3]]

    def _set_roughness(self, material, done, roughness, metallic):
        """glTF has both in one image: roughness in green, metal in blue."""
        pbr = done.content["pbrMetallicRoughness"]
        pbr["roughnessFactor"] = float(roughness.default_value)
        pbr["metallicFactor"] = float(metallic.default_value)
        sources = [self._channel(material, socket) for socket in (roughness, metallic)]
        if not any(sources):
            return
        nodes = [source[0] for source in sources if source]
        size = max((node.image.size[:] for node in nodes), key=lambda wh: wh[0] * wh[1])
        values = numpy.ones((size[1], size[0], 3), numpy.float32)
        for at, key, source in ((1, "roughnessFactor", sources[0]), (2, "metallicFactor", sources[1])):
            if source:
                node, channel = source
                pixels = images.data_pixels(node.image)
                rows = numpy.arange(size[1]) * pixels.shape[0] // size[1]
                columns = numpy.arange(size[0]) * pixels.shape[1] // size[0]
                values[..., at] = channel(pixels)[rows[:, None], columns[None, :]]
                pbr[key] = 1.0
        texture = self._texture(material, done, nodes[0], lambda _: (images.png(values), "image/png"),
                                f"roughness {material.name_full}")
        if texture is not None:
            pbr["metallicRoughnessTexture"] = texture

    def _channel(self, material, socket):
        """(image node, pixels -> one channel) behind a socket of a number, or None."""
        found = source_of(socket)
        if found is None:
            return None
        node, output = found
        if node.type in ("SEPRGB", "SEPARATE_COLOR") and getattr(node, "mode", "RGB") == "RGB":
            inner = source_of(node.inputs[0])
            if inner is not None and self._is_image(inner[0]):
                index = list(node.outputs).index(output)
                return inner[0], lambda pixels: pixels[..., index]
        if self._is_image(node):
            if output.name == "Alpha":
                return node, lambda pixels: pixels[..., 3]
            # A colour becomes a number by its luminance.
            weights = numpy.array([0.2126, 0.7152, 0.0722], numpy.float32)
            return node, lambda pixels: pixels[..., :3] @ weights
        self._unlinked(material, socket)
        return None

    @staticmethod
    def _is_image(node):
        return node.type == "TEX_IMAGE" and node.image is not None and node.image.size[0] > 0

    def _set_normal(self, material, done, socket):
        found = source_of(socket)
        if found is None:
            return
        node = found[0]
        inner = source_of(node.inputs["Color"]) if node.type == "NORMAL_MAP" else None
        if inner is None or not self._is_image(inner[0]) or node.space != "TANGENT":
            self._note(material, f"the only bumps supported are tangent-space normal maps; "
                                 f"the {node.bl_label} node is left out")
            return
        texture = self._texture(material, done, inner[0], images.data_file, "data")
        if texture is not None:
            texture["scale"] = float(node.inputs["Strength"].default_value)
            done.content["normalTexture"] = texture

    def _set_emission(self, material, done, colour, strength):
        self._unlinked(material, strength)
        value = float(strength.default_value)
        if value < 0:
            self._note(material, "takes no light away: its negative emission is left out")
        if value <= 0:
            return
        constant, sources = self._product(colour)
        if sources:
            texture = None
            if len(sources) == 1 and self._is_image(sources[0]):
                texture = self._texture(material, done, sources[0], images.colour_file, "sRGB")
            if texture is None:
                self._unlinked(material, colour)
                constant = list(colour.default_value[:3])
            else:
                done.content["emissiveTexture"] = texture
        if max(constant) > 0:
            done.content["emissiveFactor"] = [min(max(float(c), 0), 1) for c in constant]
            done.content["extensions"]["KHR_materials_emissive_strength"] = {"emissiveStrength": value}

    def _set_alpha(self, material, done, socket):
        found = source_of(socket)
        if found is None:
            if socket.default_value < 1:
                self._note(material, "is opaque here: only cut-outs by a texture are supported")
            return
        pbr = done.content["pbrMetallicRoughness"]
        node, output = found
        base = pbr.get("baseColorTexture")
        known = self._textures.get((node.image.name_full, "sRGB")) if self._is_image(node) else None
        if known is None or output.name != "Alpha" or base is None or base["index"] not in known:
            self._note(material, "is opaque here: alpha has to be that of the base colour's texture")
            return
        done.content["alphaMode"] = "MASK"
        done.content["alphaCutoff"] = float(getattr(material, "alpha_threshold", 0.5))

    def _texture(self, material, done, node, file_of, use):
        """glTF's reference to the texture of an image node, or None with a note."""
        image = node.image
        if image.source in ("TILED", "MOVIE", "SEQUENCE"):
            kind = {"TILED": "tiles (UDIM)", "MOVIE": "a movie", "SEQUENCE": "a sequence"}[image.source]
            self._note(material, f"image '{image.name}' is {kind}, which uwvdb does not have")
            return None
        if node.projection != "FLAT":
            self._note(material, f"image '{image.name}' is projected as {node.projection.lower()}, "
                                 "but uwvdb needs texture coordinates (UV)")
            return None
        place = self._placement(material, node)
        if place is None:
            return None
        if image.size[0] == 0:
            self._note(material, f"image '{image.name}' cannot be loaded")
            return None
        if node.extension == "CLIP":
            self._note(material, f"image '{image.name}' continues beyond its edge: the extension Clip is not supported")
        uv_map, transform = place
        if uv_map not in done.uv_maps:
            done.uv_maps.append(uv_map)
        if len(done.uv_maps) > 2:
            self._note(material, "more than two UV maps; the further ones are left out")
            return None
        wrap = WRAPS[node.extension]
        key = (image.name_full, use)
        variants = self._textures.setdefault(key, {})
        sampler = {"wrapS": wrap, "wrapT": wrap,
                   "magFilter": 9728 if node.interpolation == "Closest" else 9729}
        for index, kept in variants.items():
            if kept == sampler:
                break
        else:
            index = self._glb.add_texture(*file_of(image), sampler)
            variants[index] = sampler
        texture = {"index": index, "texCoord": done.uv_maps.index(uv_map)}
        if transform:
            texture["extensions"] = {"KHR_texture_transform": transform}
        return texture

    def _placement(self, material, node):
        """(name of the UV map, '' for the active one; glTF's transform or None) of an image node."""
        found = source_of(node.inputs["Vector"])
        if found is None:
            return "", None
        transform = None
        if found[0].type == "MAPPING":
            mapping = found[0]
            transform = self._transform(mapping)
            if transform is None:
                self._note(material, f"the Mapping node of image '{node.image.name}' is left out: it "
                                     "has to be a Point mapping by numbers, turned about z alone")
                transform = {}
            found = source_of(mapping.inputs["Vector"])
        if found is not None and found[0].type == "UVMAP":
            return found[0].uv_map, transform
        if found is not None and (found[0].type, found[1].name) == ("TEX_COORD", "UV"):
            return "", transform
        self._note(material, f"image '{node.image.name}' is not placed by texture coordinates (UV) and "
                             "is left out")
        return None

    @staticmethod
    def _transform(mapping):
        """Blender's v runs upwards, glTF's downwards."""
        names = ("Location", "Rotation", "Scale")
        if mapping.vector_type != "POINT" or any(mapping.inputs[n].is_linked for n in names):
            return None
        location, rotation, scale = (mapping.inputs[n].default_value for n in names)
        if rotation[0] != 0 or rotation[1] != 0:
            return None
        sine, cosine = math.sin(rotation[2]), math.cos(rotation[2])
        # In Blender uv' = R S uv + t; glTF's (u, 1 - v) obeys the same form with this offset.
        return {"scale": [scale[0], scale[1]], "rotation": rotation[2],
                "offset": [location[0] - sine * scale[1],
                           1 - location[1] - cosine * scale[1]]}
