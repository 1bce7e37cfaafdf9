"""Materials of Blender as those of glTF: of its nodes what uwvdb has, of the rest what was baked, and notes about what
was not."""

import math

import bpy
import numpy

from . import images, shaders
from .glass import is_clear, is_exactly_clear
from .nodes import output_of, reachable, source_of
from .shaders import WATER_INDEX

DEFAULT = {"name": "default", "pbrMetallicRoughness": {
    "baseColorFactor": [0.8, 0.8, 0.8, 1], "metallicFactor": 0, "roughnessFactor": 1},
    "extensions": {"KHR_materials_ior": {"ior": WATER_INDEX}}}
# What is held out gives no light, but stops it; alpha is made of the mattes afterwards (passes.py).
HELD_OUT = {"name": "holdout", "pbrMetallicRoughness": {
    "baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0, "roughnessFactor": 1},
    "extensions": {"KHR_materials_ior": {"ior": WATER_INDEX}}}
WRAPS = {"REPEAT": 10497, "EXTEND": 33071, "CLIP": 33071, "MIRROR": 33648}


NOT_TRANSPARENT = "is opaque here: only cut-outs by a texture are supported"
CHANNELS = ("colour", "surface", "normal", "emission", "alpha")


class Exported:
    """A glTF material, and which maps of coordinates and colours of the mesh it needs: `uv_maps` are names, or the
    bakes.Baked whose own coordinates they are."""

    def __init__(self, content):
        self.content, self.uv_maps, self.colours = content, [], None

    @property
    def uv_names(self):
        return [name for name in self.uv_maps[:2] if isinstance(name, str)]


def channels_to_bake(material):
    """What of a material is lost without a bake: some of CHANNELS."""
    if is_clear(material) or not shows_surface(material):
        return set()
    converter = Exporter(None, None)
    converter.convert(material)
    return converter.lost


def shows_surface(material):
    """False for materials of volumes alone, and for those that only let through."""
    if material is None or not material.use_nodes or material.node_tree is None:
        return True
    output = output_of(material)
    if output is None:
        return True
    return output.inputs["Surface"].is_linked or not output.inputs["Volume"].is_linked


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


class _Unknown:
    """Stands for nodes that colours cannot be read from."""

    type = ""


def _is_known(node):
    """False for attributes that no mesh has as colours, such as those of objects."""
    if node.type != "ATTRIBUTE":
        return True
    return node.attribute_type == "GEOMETRY" and any(
        node.attribute_name in mesh.color_attributes for mesh in bpy.data.meshes)


class Exporter:
    """Without a file and notes it only finds out what is `lost`."""

    def __init__(self, glb, notes):
        self._glb, self._notes = glb, notes
        self._known, self._textures = {}, {}
        self.lost, self._baked = set(), None
        self.pass_indices = []  # of the materials in the file's order

    def export(self, material, baked=None):
        """(index in the file, Exported) of a material, or of none; `baked` is the bakes.Baked of it on a mesh."""
        key = (material.name_full if material is not None else None, baked)
        if key not in self._known:
            done = Exported(dict(DEFAULT)) if material is None else self.convert(material, baked)
            self._known[key] = (self._glb.add_material(done.content), done)
            self.pass_indices.append(material.pass_index if material is not None else 0)
        return self._known[key]

    def export_held_out(self):
        """The same for surfaces of objects that are held out."""
        if HELD_OUT["name"] not in self._known:
            self._known[HELD_OUT["name"]] = (self._glb.add_material(HELD_OUT), Exported(HELD_OUT))
            self.pass_indices.append(0)
        return self._known[HELD_OUT["name"]]

    def _note(self, material, text):
        if self._notes is not None:
            self._notes.add(f"Material '{material.name}': {text}")

    def _lose(self, material, channels, text):
        """Says what is lost, unless it was baked."""
        self.lost.update(channels)
        if not channels or self._baked is None or not set(channels) <= self._baked.wanted:
            self._note(material, text)

    def export_glass(self, material, found, is_closed, chord):
        """The same as export() for a material that is a glass.Glass."""
        key = (material.name_full, is_closed, round(chord, 6))
        if key not in self._known:
            for fault in found.faults:
                self._note(material, fault)
            done = Exported(found.content(material.name, is_closed, chord))
            self._known[key] = (self._glb.add_material(done.content), done)
            self.pass_indices.append(material.pass_index)
        return self._known[key]

    def note_clear(self, material):
        """Says what is missing of a material that is clear."""
        if not is_exactly_clear(material):
            self._note(material, "lets all light through, as if it were not there: its refraction, reflection and "
                                 "colour are left out")

    def convert(self, material, baked=None):
        self._baked = baked
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
        if baked is not None:
            if not baked.put_into(done, self._glb, _threshold(material)):
                self._note(material, NOT_TRANSPARENT)
        return done

    def _set_plain(self, done, colour, metallic, roughness, ior):
        done.content["pbrMetallicRoughness"].update(
            baseColorFactor=[min(max(float(c), 0), 1) for c in colour[:3]] + [1],
            metallicFactor=float(metallic), roughnessFactor=float(roughness))
        done.content["extensions"]["KHR_materials_ior"] = {"ior": ior}

    def _convert_shader(self, material, done, node):
        if node.type in shaders.MIXTURES:
            self._convert_mixture(material, done, node)
        elif node.type == "BSDF_PRINCIPLED":
            self._convert_principled(material, done, node)
        elif node.type == "BSDF_DIFFUSE":
            self._set_plain(done, (1, 1, 1, 1), 0, 1, WATER_INDEX)
            self._set_colour(material, done, node.inputs["Color"])
            self._set_normal(material, done, node.inputs["Normal"])
        elif node.type == "BSDF_GLOSSY":
            self._set_plain(done, (1, 1, 1, 1), 1, node.inputs["Roughness"].default_value, 1.5)
            if node.inputs["Roughness"].is_linked:
                self._lose(material, ("surface",), "the nodes behind 'Roughness' are left out; its own value is taken")
            self._set_colour(material, done, node.inputs["Color"])
            self._set_normal(material, done, node.inputs["Normal"])
        elif node.type == "EMISSION":
            self._set_plain(done, (0, 0, 0, 1), 0, 1, WATER_INDEX)
            self._set_emission(material, done, node.inputs["Color"], node.inputs["Strength"])
        else:
            self._convert_others(material, done, node)

    def _convert_others(self, material, done, node):
        """Shaders that are as matt, or as mirrors, as these."""
        surface = shaders.merged([(1.0, node)])
        if surface is not None:
            self._set_surface(material, done, surface, [node])
        elif node.type in shaders.SHADERS:
            self._set_plain(done, (0.8, 0.8, 0.8, 1), 0, 1, shaders.index_of([node]))
            self._lose(material, CHANNELS, f"uwvdb has no {node.bl_label} shader; the material is a grey diffuse")
        else:
            self._note(material, f"uwvdb has no {node.bl_label} shader; the material is a grey diffuse")
            self._set_plain(done, (0.8, 0.8, 0.8, 1), 0, 1, WATER_INDEX)

    def _set_surface(self, material, done, surface, nodes):
        """A Surface that is the same everywhere."""
        self._set_plain(done, surface.colour, min(surface.metallic, 1), min(max(surface.roughness, 0), 1),
                        shaders.index_of(nodes))
        if surface.alpha < 1:
            self._note(material, NOT_TRANSPARENT)
        strength = max(surface.emission)
        if strength > 0:
            done.content["emissiveFactor"] = [max(part, 0) / strength for part in surface.emission]
            done.content["extensions"]["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}

    def _convert_mixture(self, material, done, node):
        """Shaders mixed by numbers are one, if they are numbers themselves. Transparent mixed with another one by a
        texture's alpha is a cut-out, as Principled has it itself."""
        parts = shaders.parts_of(node)
        if parts is not None:
            if len(parts) == 1 and abs(parts[0][0] - 1) < 1e-6:
                self._convert_shader(material, done, parts[0][1])
                return
            surface = shaders.merged(parts)
            if surface is not None:
                self._set_surface(material, done, surface, [found for _, found in parts])
                return
        sources = [source_of(socket) for socket in node.inputs if socket.type == "SHADER"]
        if node.type == "MIX_SHADER" and all(sources) and sources[0][0].type == "BSDF_TRANSPARENT":
            self._convert_shader(material, done, sources[1][0])
            self._set_alpha(material, done, node.inputs[0])
            return
        kinds = ("BSDF_PRINCIPLED", "BSDF_DIFFUSE", "BSDF_GLOSSY", "EMISSION", *shaders.MIXTURES)
        found = next((s[0] for s in sources if s is not None and s[0].type in kinds), None)
        lost, self.lost = self.lost, set()
        notes, self._notes = self._notes, None  # of one of them nothing has to be said
        if found is None:
            self._set_plain(done, (0.8, 0.8, 0.8, 1), 0, 1, WATER_INDEX)
        else:
            self._convert_shader(material, done, found)
        self.lost, self._notes = lost, notes
        done.content["extensions"]["KHR_materials_ior"] = {"ior": shaders.index_of(reachable(node))}
        self._lose(material, CHANNELS, "mixed shaders are not supported; the first that uwvdb has is taken")

    def _convert_principled(self, material, done, node):
        inputs = node.inputs
        self._unlinked(material, inputs.get("Specular IOR Level") or inputs["Specular"])
        if "Specular IOR Level" in inputs:
            self._unlinked(material, inputs["IOR"])
        self._set_plain(done, (1, 1, 1, 1), 0, 1, shaders.index_of([node]))
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

    def _unlinked(self, material, socket, *channels):
        if source_of(socket) is not None:
            self._lose(material, channels, f"the nodes behind '{socket.name}' are left out; its own value is taken")

    def _set_colour(self, material, done, socket):
        pbr = done.content["pbrMetallicRoughness"]
        factor, sources = self._product(socket)
        pictures = [node for node in sources if self._is_image(node)]
        paints = [node for node in sources if node.type in ("VERTEX_COLOR", "ATTRIBUTE")]
        texture = None
        if len(pictures) <= 1 and len(paints) <= 1 and len(pictures) + len(paints) == len(sources):
            if pictures:
                texture = self._texture(material, done, pictures[0], images.colour_file, "sRGB", "colour")
            if texture is not None or not pictures:
                pbr["baseColorFactor"] = factor + [1]
                if texture is not None:
                    pbr["baseColorTexture"] = texture
                for node in paints:
                    done.colours = (node.layer_name if node.type == "VERTEX_COLOR"
                                    else node.attribute_name)
                return
        self._unlinked(material, socket, "colour")
        pbr["baseColorFactor"] = [min(max(c, 0), 1) for c in socket.default_value[:3]] + [1]

    def _product(self, socket):
        """(colour, nodes) whose product a socket gets, through nodes that multiply with full effect."""
        found = source_of(socket)
        if found is None:
            return [min(max(float(part), 0), 1) for part in socket.default_value[:3]], []
        node = found[0]
        sockets = _multiplied(node)
        if sockets is None:
            return [1.0, 1.0, 1.0], [node if found[1].type == "RGBA" and _is_known(node) else _Unknown]
        (first, nodes), (second, others) = (self._product(socket) for socket in sockets)
        return [x * y for x, y in zip(first, second)], nodes + others

    def _set_roughness(self, material, done, roughness, metallic):
        """glTF has both in one image: roughness in green, metal in blue."""
        pbr = done.content["pbrMetallicRoughness"]
        pbr["roughnessFactor"] = float(roughness.default_value)
        pbr["metallicFactor"] = float(metallic.default_value)
        sources = [self._channel(material, socket) for socket in (roughness, metallic)]
        if not any(sources):
            return
        nodes = [source[0] for source in sources if source]
        if len({(node.image.name_full, self._where(node)) for node in nodes}) > 1 and any(
                self._where(node) != self._where(nodes[0]) for node in nodes):
            self._lose(material, ("surface",), "roughness and metal have textures that are placed differently: both "
                                               "are placed as the first")
        size = max((node.image.size[:] for node in nodes), key=lambda wh: wh[0] * wh[1])
        values = numpy.ones((size[1], size[0], 3) if self._glb is not None else (1, 1, 3), numpy.float32)
        for at, key, source in ((1, "roughnessFactor", sources[0]), (2, "metallicFactor", sources[1])):
            if source and self._glb is not None:
                node, channel = source
                pixels = images.data_pixels(node.image)
                rows = numpy.arange(size[1]) * pixels.shape[0] // size[1]
                columns = numpy.arange(size[0]) * pixels.shape[1] // size[0]
                values[..., at] = channel(pixels)[rows[:, None], columns[None, :]]
                pbr[key] = 1.0
        texture = self._texture(material, done, nodes[0], lambda _: (images.png(values), "image/png"),
                                f"roughness {material.name_full}", "surface")
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
        self._unlinked(material, socket, "surface")
        return None

    @staticmethod
    def _where(node):
        """What an image is placed by, for comparison."""
        found = source_of(node.inputs["Vector"])
        return (found[0].key, found[1].name) if found is not None else None

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
            self._lose(material, ("normal",), "the only bumps supported are tangent-space normal maps; "
                                              f"the {node.bl_label} node is left out")
            return
        if node.inputs["Strength"].is_linked:
            self._unlinked(material, node.inputs["Strength"], "normal")
        texture = self._texture(material, done, inner[0], images.data_file, "data", "normal")
        if texture is not None:
            texture["scale"] = float(node.inputs["Strength"].default_value)
            done.content["normalTexture"] = texture

    def _set_emission(self, material, done, colour, strength):
        if not (colour.source is None and max(colour.default_value[:3]) <= 0):
            self._unlinked(material, strength, "emission")
        value = float(strength.default_value)
        if value < 0:
            self._note(material, "takes no light away: its negative emission is left out")
        if value <= 0:
            return
        constant, sources = self._product(colour)
        if sources:
            texture = None
            if len(sources) == 1 and self._is_image(sources[0]):
                texture = self._texture(material, done, sources[0], images.colour_file, "sRGB", "emission")
            if texture is None:
                self._unlinked(material, colour, "emission")
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
                self._note(material, NOT_TRANSPARENT)
            return
        pbr = done.content["pbrMetallicRoughness"]
        node, output = found
        base = pbr.get("baseColorTexture")
        known = self._textures.get((node.image.name_full, "sRGB")) if self._is_image(node) else None
        if known is None or output.name != "Alpha" or base is None or base["index"] not in known:
            self._lose(material, ("colour", "alpha"),
                       "is opaque here: alpha has to be that of the base colour's texture")
            return
        done.content["alphaMode"] = "MASK"
        done.content["alphaCutoff"] = _threshold(material)

    def _texture(self, material, done, node, file_of, use, channel):
        """glTF's reference to the texture of an image node, or None with a note."""
        image, lost = node.image, (channel,)
        if image.source in ("TILED", "MOVIE", "SEQUENCE"):
            kind = {"TILED": "tiles (UDIM)", "MOVIE": "a movie", "SEQUENCE": "a sequence"}[image.source]
            self._lose(material, lost, f"image '{image.name}' is {kind}, which uwvdb does not have")
            return None
        if node.projection != "FLAT":
            self._lose(material, lost, f"image '{image.name}' is projected as {node.projection.lower()}, "
                                       "but uwvdb needs texture coordinates (UV)")
            return None
        place = self._placement(material, node, lost)
        if place is None:
            return None
        if image.size[0] == 0:
            self._note(material, f"image '{image.name}' cannot be loaded")
            return None
        if node.extension == "CLIP":
            self._lose(material, lost,
                       f"image '{image.name}' continues beyond its edge: the extension Clip is not supported")
        uv_map, transform = place
        if uv_map not in done.uv_maps:
            done.uv_maps.append(uv_map)
        if len(done.uv_maps) > 2:
            self._lose(material, lost, "more than two UV maps; the further ones are left out")
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
            index = self._glb.add_texture(*file_of(image), sampler) if self._glb is not None else len(variants)
            variants[index] = sampler
        texture = {"index": index, "texCoord": done.uv_maps.index(uv_map)}
        if transform:
            texture["extensions"] = {"KHR_texture_transform": transform}
        return texture

    def _placement(self, material, node, lost):
        """(name of the UV map, '' for the active one; glTF's transform or None) of an image node."""
        found = source_of(node.inputs["Vector"])
        if found is None:
            return "", None
        transform = None
        if found[0].type == "MAPPING":
            mapping = found[0]
            transform = self._transform(mapping)
            if transform is None:
                self._lose(material, lost, f"the Mapping node of image '{node.image.name}' is left out: it "
                                           "has to be a Point mapping by numbers, turned about z alone")
                transform = {}
            found = source_of(mapping.inputs["Vector"])
        if found is not None and found[0].type == "UVMAP":
            return found[0].uv_map, transform
        if found is not None and (found[0].type, found[1].name) == ("TEX_COORD", "UV"):
            return "", transform
        self._lose(material, lost, f"image '{node.image.name}' is not placed by texture coordinates (UV) and "
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


def _threshold(material):
    return float(getattr(material, "alpha_threshold", 0.5))
