"""Bakes materials in a Blender of its own, so that the user's file has no part in it:

    blender -b --factory-startup --python bake_worker.py -- FOLDER

FOLDER/job.json is what bakes.py writes: names of materials, meshes as arrays, sizes. Each result is an .npz of texture
coordinates and of textures as PNG. Progress goes to stderr as that of the program uwvdb."""

import json
import os
import pathlib
import sys
import traceback

import bpy
import numpy
from mathutils import Matrix

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import images  # noqa: E402
import shaders  # noqa: E402
import unwrapping  # noqa: E402

CONSTANT = 1 / 1024  # a texture that varies less is a number
NORMAL_CONSTANT = 1 / 255
# Nodes that look around and are noisy; all others are exact at the texel's centre.
SAMPLED = {"AMBIENT_OCCLUSION": 32, "BEVEL": 32}


def trees_of(tree, known=None):
    known = {} if known is None else known
    if tree is not None and tree.name_full not in known:
        known[tree.name_full] = tree
        for node in tree.nodes:
            if node.type == "GROUP":
                trees_of(node.node_tree, known)
    return list(known.values())


def matrix_of(numbers):
    return Matrix([numbers[4 * row:4 * row + 4] for row in range(4)])


class Work:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        with open(self.folder / "job.json", encoding="utf-8") as file:
            self.content = json.load(file)
        bpy.ops.wm.read_factory_settings(use_empty=True)
        self.scene = bpy.context.scene
        self.scene.render.engine = "CYCLES"
        cycles = self.scene.cycles
        cycles.device, cycles.use_denoising, cycles.use_adaptive_sampling = "CPU", False, False
        self.scene.render.bake.use_selected_to_active = False
        if self.content["threads"] > 0:
            self.scene.render.threads_mode, self.scene.render.threads = "FIXED", self.content["threads"]

    def run(self):
        jobs = self.content["jobs"]
        for number, job in enumerate(jobs):
            self.tell(number / len(jobs), f"baking material {number + 1} of {len(jobs)}")
            self.do(job)

    @staticmethod
    def tell(fraction, stage):
        print(json.dumps({"stage": stage, "fraction": fraction}), file=sys.stderr, flush=True)

    def material(self, name, library):
        """A fresh copy each time, since baking rebuilds it."""
        with bpy.data.libraries.load(library or str(self.folder / "materials.blend"), link=False) as (source, wanted):
            if name not in source.materials:
                raise RuntimeError(f"material '{name}' could not be handed over")
            wanted.materials = [name]
        made = wanted.materials[0]
        for image, file in self.content["painted"].items():
            if image in bpy.data.images:
                values = numpy.load(self.folder / file)
                painted = bpy.data.images[image]
                painted.source = "GENERATED"
                painted.scale(values.shape[1], values.shape[0])
                painted.pixels.foreach_set(values.reshape(-1))
        for name, rows in self.content["objects"].items():
            if name in bpy.data.objects:
                thing = bpy.data.objects[name]
                thing.parent = None
                thing.constraints.clear()
                thing.animation_data_clear()
                thing.matrix_world = matrix_of(rows)
        return made

    def do(self, job):
        material = self.material(job["material"], job["library"])
        self.scene.frame_set(int(job["frame"] // 1), subframe=job["frame"] % 1)
        arrays = numpy.load(self.folder / job["mesh"], allow_pickle=False)
        thing = build(arrays, job)
        self.scene.collection.objects.link(thing)
        thing.matrix_world = matrix_of(job["matrix"])
        thing.data.materials.append(material)
        bpy.context.view_layer.objects.active = thing
        thing.select_set(True)
        trees = trees_of(material.node_tree)
        settle(trees, job, thing)
        layer = unwrapping.unwrap(thing, job["uvs"])
        mesh = thing.data
        mesh.uv_layers.active = layer
        layer.active_render = True
        channels = Channels(material, trees, job["is_single"])
        baker = Baker(self.scene, thing, material, job["size"], trees)
        uvs = numpy.empty((len(mesh.loops), 2), numpy.float32)
        layer.data.foreach_get("uv", uvs.reshape(-1))
        result = {"uvs": uvs, **textures(channels, baker, set(job["channels"]))}
        out = job["out"]
        with open(out + ".new", "wb") as file:
            numpy.savez(file, **result)
        os.replace(out + ".new", out)
        baker.close()
        bpy.data.objects.remove(thing)
        bpy.data.meshes.remove(mesh)
        bpy.data.materials.remove(material)
        # The next one comes with its own images, groups and objects, under the names that they had.
        bpy.data.orphans_purge(do_local_ids=True, do_linked_ids=True, do_recursive=True)


def build(arrays, job):
    """The object of a mesh's arrays, without its matrix."""
    mesh = bpy.data.meshes.new("mesh")
    vertices, corners, starts = arrays["positions"], arrays["corners"], arrays["starts"]
    mesh.vertices.add(len(vertices))
    mesh.vertices.foreach_set("co", arrays["undeformed"].reshape(-1) if "undeformed" in arrays
                              else vertices.reshape(-1))
    mesh.loops.add(len(corners))
    mesh.loops.foreach_set("vertex_index", corners)
    mesh.polygons.add(len(starts))
    totals = numpy.diff(numpy.append(starts, len(corners))).astype(numpy.int32)
    mesh.polygons.foreach_set("loop_start", starts)
    if not bpy.types.MeshPolygon.bl_rna.properties["loop_total"].is_readonly:
        mesh.polygons.foreach_set("loop_total", totals)
    mesh.polygons.foreach_set("use_smooth", numpy.ones(len(starts), bool))
    for name in arrays.files:
        if name.startswith("uv:"):
            layer = mesh.uv_layers.new(name=name[3:], do_init=False)
            layer.data.foreach_set("uv", arrays[name].reshape(-1))
    for key, kind in (("colour", "FLOAT_COLOR"), ("vector", "FLOAT_VECTOR"), ("number", "FLOAT")):
        for name in arrays.files:
            what, _, rest = name.partition(":")
            if what != key:
                continue
            domain, _, own = rest.partition(":")
            layer = mesh.attributes.new(own, kind, domain)
            field = {"colour": "color", "vector": "vector", "number": "value"}[key]
            layer.data.foreach_set(field, arrays[name].reshape(-1))
    if job["colours"] and job["colours"] in mesh.color_attributes:
        mesh.color_attributes.render_color_index = mesh.color_attributes.find(job["colours"])
    mesh.update(calc_edges=True)
    if hasattr(mesh, "use_auto_smooth"):
        mesh.use_auto_smooth, mesh.auto_smooth_angle = True, 3.15
    mesh.normals_split_custom_set(arrays["normals"])
    mesh.use_auto_texspace = False
    mesh.texspace_location, mesh.texspace_size = job["texspace"]
    thing = bpy.data.objects.new("object", mesh)
    if "undeformed" in arrays:  # Generated coordinates are those of the shape without keys
        thing.shape_key_add(name="rest", from_mix=False)
        key = thing.shape_key_add(name="shape", from_mix=False)
        key.data.foreach_set("co", vertices.reshape(-1))
        key.value = 1
        thing.active_shape_key_index = 0  # that is unwrapped, so that all shapes have the same map
    return thing


def settle(trees, job, thing):
    """Replaces what a bake would not have: the UV map that a mesh shows, what objects are, rays of cameras."""
    for tree in trees:
        for node in list(tree.nodes):
            if node.type in ("UVMAP", "NORMAL_MAP", "TANGENT") and hasattr(node, "uv_map") and not node.uv_map:
                node.uv_map = job["uvs"]
            elif node.type == "TEX_IMAGE" and not node.inputs["Vector"].is_linked:
                tree.links.new(uv_source(tree, job), node.inputs["Vector"])
            elif node.type == "TEX_COORD":
                replaced(tree, node.outputs["UV"], lambda: uv_source(tree, job))
                if node.object is None:
                    continue
            elif node.type == "OBJECT_INFO":
                for output in node.outputs:
                    value = job["object"].get(output.name)
                    if value is not None:
                        replaced(tree, output, lambda value=value: number_source(tree, value))
            elif node.type == "LIGHT_PATH":
                for output in node.outputs:
                    is_camera = float(output.name == "Is Camera Ray")
                    replaced(tree, output, lambda value=is_camera: number_source(tree, value))
            elif node.type == "ATTRIBUTE" and node.attribute_type in ("OBJECT", "INSTANCER"):
                value = job["attributes"].get(node.attribute_name)
                for output in node.outputs:
                    if value is not None and output.is_linked:
                        replaced(tree, output, lambda value=value: number_source(tree, value))


def uv_source(tree, job):
    node = tree.nodes.new("ShaderNodeUVMap")
    node.uv_map = job["uvs"]
    return node.outputs[0]


def number_source(tree, value):
    if isinstance(value, (int, float)):
        node = tree.nodes.new("ShaderNodeValue")
        node.outputs[0].default_value = value
        return node.outputs[0]
    node = tree.nodes.new("ShaderNodeCombineXYZ")
    for socket, part in zip(node.inputs, value):
        socket.default_value = part
    return node.outputs[0]


def replaced(tree, output, make):
    targets = [link.to_socket for link in output.links]
    if targets:
        source = make()
        for target in targets:
            tree.links.new(source, target)


class Channels:
    """Lets the shaders of a material shine with one of their own inputs."""

    def __init__(self, material, trees, is_single):
        self.is_single = is_single  # has one shader alone
        self._sources = []  # (tree, shader, its output, what that feeds)
        for tree in trees:
            for node in list(tree.nodes):
                output = next((o for o in node.outputs if o.type == "SHADER"), None)
                if node.type in shaders.SHADERS and output is not None and output.is_linked:
                    self._sources.append((tree, node, output, [link.to_socket for link in output.links]))

    def show(self, what):
        """Of "colour", "surface", "emission", "clear"; "" puts the shaders back."""
        for tree, node, output, targets in self._sources:
            source = output
            if what:
                emission = tree.nodes.new("ShaderNodeEmission")
                self._connect(tree, getattr(self, f"_{what}")(tree, node), emission.inputs["Color"])
                emission.inputs["Strength"].default_value = 1
                source = emission.outputs[0]
            for target in targets:
                tree.links.new(source, target)

    @staticmethod
    def _connect(tree, value, socket):
        if isinstance(value, bpy.types.NodeSocket):
            tree.links.new(value, socket)
        else:
            socket.default_value = (*value, 1.0)

    @staticmethod
    def _read(node, names):
        """A number, a colour, or the socket that feeds an input."""
        if isinstance(names, float):
            return names
        if names is None:
            return (0.0, 0.0, 0.0)
        socket = next((node.inputs[name] for name in names if name in node.inputs), None)
        if socket is None:
            return 0.0
        link = next((link for link in socket.links if link.is_valid and not link.is_muted), None)
        if link is not None:
            return link.from_socket
        value = socket.default_value
        return float(value) if isinstance(value, (int, float)) else tuple(value[:3])

    @staticmethod
    def _math(tree, operation, a, b):
        if isinstance(a, float) and isinstance(b, float):
            return {"MULTIPLY": a * b, "ADD": a + b, "SUBTRACT": a - b}[operation]
        node = tree.nodes.new("ShaderNodeMath")
        node.operation = operation
        for value, socket in ((a, node.inputs[0]), (b, node.inputs[1])):
            if isinstance(value, float):
                socket.default_value = value
            else:
                tree.links.new(value, socket)
        return node.outputs[0]

    def _opacity(self, tree, node, shader):
        """What is not let through."""
        clear = self._math(tree, "MULTIPLY", self._read(node, shader.clear),
                           self._math(tree, "SUBTRACT", 1.0, self._number(tree, self._read(node, shader.metallic))))
        return self._math(tree, "MULTIPLY", self._number(tree, self._read(node, shader.opacity)),
                          self._math(tree, "SUBTRACT", 1.0, clear))

    def _number(self, tree, value):
        """A socket of a colour as the number that Cycles makes of it."""
        if isinstance(value, bpy.types.NodeSocket) and value.type == "RGBA":
            node = tree.nodes.new("ShaderNodeRGBToBW")
            tree.links.new(value, node.inputs[0])
            return node.outputs[0]
        return value

    def _scaled(self, tree, colour, factor):
        if isinstance(factor, float) and factor == 1.0:
            return colour
        node = tree.nodes.new("ShaderNodeVectorMath")
        node.operation = "SCALE"
        if isinstance(colour, tuple):
            node.inputs[0].default_value = colour
        else:
            tree.links.new(colour, node.inputs[0])
        if isinstance(factor, float):
            node.inputs["Scale"].default_value = factor
        else:
            tree.links.new(factor, node.inputs["Scale"])
        return node.outputs[0]

    def _as_colour(self, value):
        return (value,) * 3 if isinstance(value, float) else value

    def _colour(self, tree, node):
        shader = shaders.SHADERS[node.type]
        colour = self._as_colour(self._read(node, shader.colour))
        return self._scaled(tree, colour, self._opacity(tree, node, shader))

    def _emission(self, tree, node):
        shader = shaders.SHADERS[node.type]
        strength = self._math(tree, "MULTIPLY", self._number(tree, self._read(node, shader.strength)),
                              self._number(tree, self._read(node, shader.opacity)))
        return self._scaled(tree, self._as_colour(self._read(node, shader.emission)), strength)

    def _clear(self, tree, node):
        through = self._math(tree, "SUBTRACT", 1.0, self._opacity(tree, node, shaders.SHADERS[node.type]))
        return self._combined(tree, (through, 0.0, 0.0))

    def _surface(self, tree, node):
        """Roughness and gloss, the first times the second, and what of the colour is a mirror's; of a single shader
        roughness, metallic, 1."""
        shader = shaders.SHADERS[node.type]
        rough, metallic = (self._number(tree, self._read(node, names)) for names in (shader.roughness, shader.metallic))
        if self.is_single:
            return self._combined(tree, (rough, metallic, 1.0))
        if shader.colour is None:
            return (0.0, 0.0, 0.0)
        opacity, gloss = self._opacity(tree, node, shader), shaders.FAINT_GLOSS
        if shader.has_gloss:
            gloss = self._math(tree, "ADD", shaders.LEAST_GLOSS,
                               self._math(tree, "MULTIPLY", 1 - shaders.LEAST_GLOSS, metallic))
        gloss = self._math(tree, "MULTIPLY", gloss, opacity)
        colour = self._read(node, shader.colour)
        if isinstance(colour, tuple):
            bright = sum(part * weight for part, weight in zip(colour, shaders.LUMINANCE))
        else:
            bright = self._number(tree, colour)
        mirrored = self._math(tree, "MULTIPLY", self._math(tree, "MULTIPLY", opacity, metallic), bright)
        return self._combined(tree, (self._math(tree, "MULTIPLY", gloss, rough), mirrored, gloss))

    @staticmethod
    def _combined(tree, parts):
        if all(isinstance(part, float) for part in parts):
            return tuple(parts)
        node = tree.nodes.new("ShaderNodeCombineXYZ")
        for socket, part in zip(node.inputs, parts):
            if isinstance(part, float):
                socket.default_value = part
            else:
                tree.links.new(part, socket)
        return node.outputs[0]


class Baker:
    def __init__(self, scene, thing, material, size, trees):
        self.scene, self.size = scene, size
        self.image = bpy.data.images.new("bake", size, size, alpha=True, float_buffer=True, is_data=True)
        self.node = material.node_tree.nodes.new("ShaderNodeTexImage")
        self.node.image = self.image
        material.node_tree.nodes.active = self.node
        scene.cycles.samples = max([SAMPLED.get(node.type, 1) for tree in trees for node in tree.nodes] + [1])

    def bake(self, kind="EMIT"):
        """(rows from the top of RGB, which texels are of the mesh)"""
        options = {"normal_space": "TANGENT"} if kind == "NORMAL" else {}
        bpy.ops.object.bake(type=kind, margin=max(self.size // 64, 2), margin_type="EXTEND", use_clear=True,
                            target="IMAGE_TEXTURES", save_mode="INTERNAL", **options)
        values = numpy.empty(self.size * self.size * 4, numpy.float32)
        self.image.pixels.foreach_get(values)
        values = values.reshape(self.size, self.size, 4)[::-1]
        seen = values[..., 3] > 0.5
        if not seen.any():
            raise RuntimeError("Cycles has baked nothing")
        return numpy.nan_to_num(values[..., :3]), seen

    def close(self):
        bpy.data.images.remove(self.image)


def varies(values, seen, by=CONSTANT):
    return bool((numpy.ptp(values[seen], axis=0) > by).any())


def encoded(values):
    return numpy.frombuffer(images.png(values, 16), numpy.uint8)


def textures(channels, baker, wanted):
    """Arrays of the result: of each channel a `_factor` if it is the same everywhere, else a `_png`."""
    result = {}
    if wanted & {"colour", "alpha", "surface"}:
        channels.show("colour")
        colour, seen = baker.bake()
    if "alpha" in wanted:
        channels.show("clear")
        alpha = (1 - baker.bake()[0][..., :1]).clip(0, 1)
    if "surface" in wanted:
        channels.show("surface")
        values, _ = baker.bake()
        rough, metallic, gloss = (values[..., at] for at in range(3))
        if not channels.is_single:
            bright = colour @ numpy.array(shaders.LUMINANCE, numpy.float32)
            rough = numpy.divide(rough, gloss, out=numpy.ones_like(rough), where=gloss > 0)
            metallic = numpy.divide(metallic, bright, out=numpy.zeros_like(rough), where=bright > 0)
        values = numpy.stack([numpy.ones_like(rough), rough, metallic], axis=-1).clip(0, 1)
        if varies(values, seen):
            result["surface_png"] = encoded(values)
        else:
            result["surface_factor"] = values[seen].mean(axis=0)[1:]
    if wanted & {"colour", "alpha"}:
        if "alpha" in wanted:
            colour = numpy.divide(colour, alpha, out=numpy.zeros_like(colour), where=alpha > 1e-4)
            has_holes = (alpha[seen] < 1 - CONSTANT).any()
            if has_holes:
                colour = numpy.concatenate([colour, alpha], axis=-1)
        if varies(colour, seen):
            colour = colour.clip(0, 1)
            colour[..., :3] = images.srgb_from_linear(colour[..., :3])
            result["colour_png"] = encoded(colour)
        else:
            result["colour_factor"] = colour[seen].mean(axis=0).clip(0, 1)
    if "emission" in wanted:
        channels.show("emission")
        light, seen = baker.bake()
        light = light.clip(0, None)
        greatest = float(light[seen].max())
        if not varies(light, seen, CONSTANT * max(greatest, 1e-6)):
            result["emission_factor"] = light[seen].mean(axis=0)
        else:
            result["emission_png"] = encoded(images.srgb_from_linear(light / greatest))
            result["emission_strength"] = numpy.float64(greatest)
    channels.show("")
    if "normal" in wanted:
        values, seen = baker.bake("NORMAL")
        if (numpy.abs(values[seen] - [0.5, 0.5, 1]) > NORMAL_CONSTANT).any():
            result["normal_png"] = encoded(values.clip(0, 1))
    return result


def main():
    arguments = sys.argv[sys.argv.index("--") + 1:]
    Work(arguments[0]).run()


if __name__ == "__main__":
    try:
        main()
        code = 0
    except Exception as error:  # one line for whoever started this
        traceback.print_exc(file=sys.stdout)
        print(f"{type(error).__name__}: {error}".splitlines()[0], file=sys.stderr)
        code = 1
    sys.stderr.flush()
    os._exit(code)  # Blender's own way out takes seconds
