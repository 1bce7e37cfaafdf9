"""Materials that light goes through: uwvdb has no refraction, so they are left out."""

from .nodes import output_of, source_of


def is_clear(material):
    """Whether light goes through most of a surface; opaque, it would be black."""
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
