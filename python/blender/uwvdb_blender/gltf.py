"""Writes a binary glTF file of meshes, materials and moving nodes. Axes stay Blender's, z up: the
scene that names the file has the same."""

import json
import struct

import numpy

FLOAT, UNSIGNED = 5126, 5125
SHAPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


class _Content:
    """All of a file but its nodes."""

    def __init__(self):
        self.parts, self.length = [], 0
        self.json = {"asset": {"version": "2.0", "generator": "uwvdb for Blender"},
                     "scene": 0, "meshes": [], "materials": [], "images": [], "textures": [],
                     "samplers": [], "accessors": [], "bufferViews": [], "animations": []}
        self.unmade = []  # (mesh, what makes its primitives)


class Glb:
    def __init__(self):
        self._content, self._nodes = _Content(), []

    def _add(self, key, value):
        self._content.json[key].append(value)
        return len(self._content.json[key]) - 1

    def _add_view(self, data):
        content = self._content
        at = content.length
        content.parts.append(data + b"\0" * (-len(data) % 4))
        content.length += len(content.parts[-1])
        return self._add("bufferViews", {"buffer": 0, "byteOffset": at, "byteLength": len(data)})

    def add_array(self, array):
        """Rows of floats, or whole numbers as indices."""
        is_index = array.dtype.kind in "iu"
        array = numpy.ascontiguousarray(array, numpy.uint32 if is_index else numpy.float32)
        rows = array.reshape(len(array), -1)
        accessor = {"bufferView": self._add_view(array.tobytes()), "count": len(rows),
                    "componentType": UNSIGNED if is_index else FLOAT, "type": SHAPES[rows.shape[1]]}
        if not is_index:
            columns = rows.T.copy()  # of which NumPy finds the least much faster
            accessor.update(min=columns.min(axis=1).tolist(), max=columns.max(axis=1).tolist())
        return self._add("accessors", accessor)

    def add_texture(self, data, mime_type, sampler):
        """An image's file in memory, and how it is sampled, as glTF has it."""
        image = self._add("images", {"bufferView": self._add_view(data), "mimeType": mime_type})
        return self._add("textures", {"source": image, "sampler": self._add("samplers", sampler)})

    def add_material(self, material):
        return self._add("materials", material)

    def add_mesh(self, name, make_primitives):
        """make_primitives(this file) is called when it is written, on the thread that writes."""
        mesh = {"name": name, "primitives": []}
        self._content.unmade.append((mesh, make_primitives))
        return self._add("meshes", mesh)

    def add_node(self, name, mesh, matrix):
        """A mesh at rest; the matrix is given by its columns."""
        self._nodes.append({"name": name, "mesh": mesh, "matrix": _by_columns(matrix)})

    def add_moving_node(self, name, mesh, times, poses):
        """A mesh that moves: for each time [s] (location, quaternion, scale)."""
        self._nodes.append({"name": name, "mesh": mesh})
        at = self.add_array(numpy.array(times))
        values = {"translation": [list(location) for location, _, _ in poses],
                  "rotation": [[q.x, q.y, q.z, q.w] for _, q, _ in poses],
                  "scale": [list(scale) for _, _, scale in poses]}
        for path, rows in values.items():
            self._animate(path, at, self.add_array(numpy.array(rows)))

    def add_weights(self, times, rows):
        """Of the morph targets of the node that was added last, for each time [s]."""
        self._animate("weights", self.add_array(numpy.array(times)), self.add_array(numpy.array(rows).reshape(-1)))

    def _animate(self, path, times, values):
        """Moves a part of the node that was added last."""
        animations = self._content.json["animations"]
        if not animations:
            animations.append({"channels": [], "samplers": []})
        animation = animations[0]
        animation["samplers"].append({"input": times, "output": values})
        animation["channels"].append({"sampler": len(animation["samplers"]) - 1,
                                      "target": {"node": len(self._nodes) - 1, "path": path}})

    def moved(self, matrices):
        """The same file with its nodes, all at rest, at other places."""
        result = Glb()
        result._content = self._content
        result._nodes = [{**node, "matrix": _by_columns(matrix)}
                         for node, matrix in zip(self._nodes, matrices, strict=True)]
        return result

    def is_of_the_meshes_of(self, other):
        return self._content is other._content

    def write(self, path):
        content = self._content
        while content.unmade:
            mesh, make_primitives = content.unmade.pop(0)
            mesh["primitives"] = make_primitives(self)
        written = {key: value for key, value in content.json.items() if value != []}
        written.update(nodes=self._nodes, scenes=[{"nodes": list(range(len(self._nodes)))}],
                       buffers=[{"byteLength": content.length}])
        text = json.dumps(written).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + content.length))
            file.write(struct.pack("<I4s", len(text), b"JSON") + text)
            file.write(struct.pack("<I4s", content.length, b"BIN\0"))
            file.writelines(content.parts)


def _by_columns(matrix):
    return [value for column in matrix.col for value in column]
