"""Writes a binary glTF file of meshes, materials and moving nodes. Axes stay Blender's, z up: the
scene that names the file has the same."""

import copy
import json
import struct

import numpy

FLOAT, UNSIGNED = 5126, 5125
SHAPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


class Glb:
    def __init__(self):
        self._parts, self._length = [], 0
        self._json = {"asset": {"version": "2.0", "generator": "uwvdb for Blender"},
                      "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [],
                      "materials": [], "images": [], "textures": [], "samplers": [],
                      "accessors": [], "bufferViews": [], "animations": []}

    def _add(self, key, value):
        self._json[key].append(value)
        return len(self._json[key]) - 1

    def _add_view(self, data):
        at = self._length
        self._parts.append(data + b"\0" * (-len(data) % 4))
        self._length += len(self._parts[-1])
        return self._add("bufferViews", {"buffer": 0, "byteOffset": at, "byteLength": len(data)})

    def add_array(self, array):
        """Rows of floats, or whole numbers as indices."""
        is_index = array.dtype.kind in "iu"
        array = numpy.ascontiguousarray(array, numpy.uint32 if is_index else numpy.float32)
        rows = array.reshape(len(array), -1)
        accessor = {"bufferView": self._add_view(array.tobytes()), "count": len(rows),
                    "componentType": UNSIGNED if is_index else FLOAT, "type": SHAPES[rows.shape[1]]}
        if not is_index:
            accessor.update(min=rows.min(axis=0).tolist(), max=rows.max(axis=0).tolist())
        return self._add("accessors", accessor)

    def add_texture(self, data, mime_type, sampler):
        """An image's file in memory, and how it is sampled, as glTF has it."""
        image = self._add("images", {"bufferView": self._add_view(data), "mimeType": mime_type})
        return self._add("textures", {"source": image, "sampler": self._add("samplers", sampler)})

    def add_material(self, material):
        return self._add("materials", material)

    def add_mesh(self, name, primitives):
        return self._add("meshes", {"name": name, "primitives": primitives})

    def add_node(self, name, mesh, matrix):
        """A mesh at rest; the matrix is given by its columns."""
        node = self._add("nodes", {"name": name, "mesh": mesh, "matrix": _by_columns(matrix)})
        self._json["scenes"][0]["nodes"].append(node)

    def add_moving_node(self, name, mesh, times, poses):
        """A mesh that moves: for each time [s] (location, quaternion, scale)."""
        node = self._add("nodes", {"name": name, "mesh": mesh})
        self._json["scenes"][0]["nodes"].append(node)
        if not self._json["animations"]:
            self._json["animations"].append({"channels": [], "samplers": []})
        animation = self._json["animations"][0]
        at = self.add_array(numpy.array(times))
        values = {"translation": [list(location) for location, _, _ in poses],
                  "rotation": [[q.x, q.y, q.z, q.w] for _, q, _ in poses],
                  "scale": [list(scale) for _, _, scale in poses]}
        for path, rows in values.items():
            animation["samplers"].append({"input": at, "output": self.add_array(numpy.array(rows))})
            animation["channels"].append({"sampler": len(animation["samplers"]) - 1,
                                          "target": {"node": node, "path": path}})

    def moved(self, matrices):
        """The same file with its nodes, all at rest, at other places."""
        result = copy.copy(self)
        result._json = {**self._json, "nodes": [
            {**node, "matrix": _by_columns(matrix)}
            for node, matrix in zip(self._json["nodes"], matrices, strict=True)]}
        return result

    def write(self, path):
        content = {key: value for key, value in self._json.items() if value != []}
        content["buffers"] = [{"byteLength": self._length}]
        text = json.dumps(content).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + self._length))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text)
            file.write(struct.pack("<I4s", self._length, b"BIN\0"))
            file.writelines(self._parts)


def _by_columns(matrix):
    return [value for column in matrix.col for value in column]
