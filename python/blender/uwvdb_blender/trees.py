"""What a material's node tree depends on, and a hash of all that it is made of."""

import hashlib
import os

import bpy
import numpy

from .nodes import output_of

# Nodes, or outputs of nodes, whose values differ with the direction from which a surface is seen.
OF_VIEW = {"FRESNEL": None, "LAYER_WEIGHT": None, "LIGHT_PATH": None, "CAMERA": None,
           "TEX_COORD": {"Camera", "Window", "Reflection"}, "NEW_GEOMETRY": {"Incoming", "Backfacing"}}
# Those whose values differ from object to object of the same mesh: TexCoord by another object, besides.
OF_OBJECT = {"OBJECT_INFO": None, "PARTICLE_INFO": None, "VECT_TRANSFORM": None,
             "NEW_GEOMETRY": {"Position", "Normal", "True Normal", "Tangent"}}
# Those that a mesh's shape has an effect on, not only its texture coordinates and attributes.
OF_SHAPE = {"NEW_GEOMETRY": None, "TEX_COORD": {"Object", "Normal"}, "AMBIENT_OCCLUSION": None, "BEVEL": None,
            "WIREFRAME": None, "OBJECT_INFO": set(), "TANGENT": None}
LAYOUT = {"rna_type", "location", "width", "height", "width_hidden", "select", "show_options", "show_preview",
          "show_texture", "hide", "label", "color", "use_custom_color", "parent", "dimensions", "internal_links",
          "inputs", "outputs", "bl_icon", "bl_description", "bl_label", "bl_static_type", "is_active_output",
          "location_absolute", "warning_propagation", "color_tag"}
DEPTH = 6


class Needs:
    """What has to be known of an object to show a material."""

    def __init__(self, material):
        self.uses = _used(output_of(material))
        self.view = sorted({node.bl_label for node, outputs in self.uses if _is(node, outputs, OF_VIEW)})
        self.is_of_object = any(_is(node, outputs, OF_OBJECT) or _is_placed_by_object(node, outputs)
                                or node.type == "ATTRIBUTE" and node.attribute_type != "GEOMETRY"
                                for node, outputs in self.uses)
        self.is_of_shape = self.is_of_object or any(_is(node, outputs, OF_SHAPE) for node, outputs in self.uses)
        self.has_bumps = any(node.type == "BUMP" for node, _ in self.uses)
        self.attributes = {node.attribute_name for node, _ in self.uses if node.type == "ATTRIBUTE"}
        self.object_attributes = {node.attribute_name for node, _ in self.uses
                                  if node.type == "ATTRIBUTE" and node.attribute_type in ("OBJECT", "INSTANCER")}
        self.objects = {node.object for node, outputs in self.uses if _is_placed_by_object(node, outputs)}
        self.images = {node.image for node, _ in self.uses if getattr(node, "image", None) is not None}
        self.digest = _digest_of_tree(material.node_tree)


def _is(node, outputs, table):
    if node.type not in table:
        return False
    names = table[node.type]
    return names is None or bool(outputs & names)


def _is_placed_by_object(node, outputs):
    return node.type == "TEX_COORD" and node.object is not None and "Object" in outputs


def _used(node):
    """[(Node, names of the outputs in use)] of all that has an effect on a node."""
    found, waiting = {}, [(node, None)]
    while waiting:
        node, output = waiting.pop()
        is_new = node.key not in found
        outputs = found.setdefault(node.key, (node, set()))[1]
        if output is not None:
            outputs.add(output.name)
        if is_new:
            waiting += [socket.feeder for socket in node.inputs if socket.feeder is not None]
    return list(found.values())


def _digest_of_tree(tree):
    content, seen = [], set()
    _add_tree(tree, content, seen)
    return hashlib.blake2b(repr(content).encode(), digest_size=16).hexdigest()


def _add_tree(tree, content, seen):
    if tree.name_full in seen:
        return
    seen.add(tree.name_full)
    content.append(tree.name_full)
    for node in tree.nodes:
        if node.type in ("FRAME", "REROUTE"):
            content.append(node.name)
            continue
        content.append((node.name, node.bl_idname, node.mute, _plain(node, 0)))
        content.append([(socket.identifier, socket.enabled, _value(socket)) for socket in node.inputs])
        if node.type in ("VALUE", "RGB", "NORMAL"):
            content.append([_value(socket) for socket in node.outputs])
        if node.type == "GROUP" and node.node_tree is not None:
            _add_tree(node.node_tree, content, seen)
    content.append([(link.from_node.name, link.from_socket.identifier, link.to_node.name, link.to_socket.identifier,
                     link.is_muted) for link in tree.links])


def _value(socket):
    value = getattr(socket, "default_value", None)
    return value if isinstance(value, (int, float, str, type(None))) else \
        tuple(value) if hasattr(value, "__len__") else getattr(value, "name_full", str(type(value)))


def _plain(thing, depth):
    """The settings of a struct of Blender, as plain values."""
    result = []
    for item in thing.bl_rna.properties:
        name = item.identifier
        if name in LAYOUT or depth > DEPTH:
            continue
        value = getattr(thing, name, None)
        if item.type == "POINTER":
            if isinstance(value, bpy.types.Image):
                value = image_digest(value)
            elif isinstance(value, bpy.types.Object):
                value = tuple(part for row in value.matrix_world for part in row)
            elif isinstance(value, bpy.types.ID):
                value = value.name_full
            elif value is not None:
                value = _plain(value, depth + 1)
        elif item.type == "COLLECTION":
            value = [_plain(part, depth + 1) for part in value] if value is not None else None
        elif item.is_readonly and depth == 0:
            continue
        elif getattr(item, "is_array", False) and value is not None:
            value = tuple(tuple(part) if hasattr(part, "__len__") else part for part in value)
        elif isinstance(value, set):
            value = sorted(value)
        result.append((name, value))
    return result


def image_digest(image):
    """What an image's pixels are known by."""
    how = (image.source, image.colorspace_settings.name, image.alpha_mode, tuple(image.size))
    if image.source in ("SEQUENCE", "MOVIE"):
        how += (bpy.context.scene.frame_current,)
    if image.packed_file is not None and not image.is_dirty:
        return (*how, hashlib.blake2b(image.packed_file.data, digest_size=16).hexdigest())
    if is_painted(image):
        values = numpy.empty(len(image.pixels), numpy.float32)
        image.pixels.foreach_get(values)
        return (*how, hashlib.blake2b(values.tobytes(), digest_size=16).hexdigest())
    path = bpy.path.abspath(image.filepath, library=image.library)
    names = [path] if image.source != "TILED" else [
        path.replace("<UDIM>", str(tile.number)).replace(
            "<UVTILE>", f"u{(tile.number - 1001) % 10 + 1}_v{(tile.number - 1001) // 10 + 1}") for tile in image.tiles]
    for name in names:
        try:
            stamp = os.stat(name)
            how += (name, stamp.st_mtime_ns, stamp.st_size)
        except OSError:
            how += (name, None)
    return how


def is_painted(image):
    """Whether pixels are in no file."""
    return image.source in ("GENERATED", "FILE") and image.packed_file is None and (
        image.is_dirty or image.source == "GENERATED") and image.size[0] > 0
