"""Where everything is at other moments than the frame's own, for motion blur and the Vector pass."""

import zlib

import numpy

from . import meshes

CAMERA = "the camera"  # its key; others are tuples


class Motion:
    """Matrices at several times [s]; the scene's clock has the frame number over the frame rate."""

    def __init__(self, frames, rate):
        self.frames = frames
        self.times = [frame / rate for frame in frames]
        self._matrices = [{} for _ in frames]
        self._shapes = {}  # checksums of the vertices of what may deform, by object

    def gather(self, depsgraph, at, world_from_camera, to_metres):
        """Keeps where everything is in the scene as it is evaluated now, as frames[at]."""
        known = self._matrices[at]
        for instance in depsgraph.object_instances:
            shown = instance.object
            if shown.type in meshes.SURFACES or shown.type == "LIGHT":
                known[meshes.key_of(instance)] = to_metres @ instance.matrix_world
            if shown.type in meshes.SURFACES and meshes.may_deform(shown):
                shapes = self._shapes.setdefault(shown.name_full, {})
                if at not in shapes:
                    shapes[at] = _shape(shown)
        known[CAMERA] = world_from_camera

    @property
    def deforming(self):
        """Names of the objects whose vertices move against each other, or change in number."""
        return {name for name, shapes in self._shapes.items() if len(set(shapes.values())) > 1}

    def _of(self, key):
        """Its matrix at each time; None if it rests, or is not there all the time."""
        found = [known.get(key) for known in self._matrices]
        if any(matrix is None for matrix in found):
            return None
        first = found[0]
        moves = any(abs(matrix[i][j] - first[i][j]) > 1e-7 * max(1, abs(first[i][j]))
                    for matrix in found[1:] for i in range(3) for j in range(4))
        return found if moves else None

    def poses(self, key):
        """(location, rotation, scale) at each time, of what moves."""
        found = self._of(key)
        if found is None:
            return None
        result = [matrix.decompose() for matrix in found]
        for before, after in zip(result, result[1:]):
            after[1].make_compatible(before[1])
        return result

    def rigid_poses(self, key):
        """A trajectory for uwvdb: the axes of a light."""
        found = self._of(key)
        if found is None:
            return None
        keyframes = []
        for time, matrix in zip(self.times, found):
            location, rotation, _ = matrix.decompose()
            axes = rotation.to_matrix()
            keyframes.append({"time": time, "matrix": [
                [*axes[row], location[row]] for row in range(3)] + [[0.0, 0.0, 0.0, 1.0]]})
        return {"keyframes": keyframes, "interpolation": "linear"}

    def camera_matrices(self, key):
        return self._of(key)


def _shape(shown):
    mesh = shown.to_mesh()
    vertices = numpy.empty(3 * len(mesh.vertices), numpy.float32)
    mesh.vertices.foreach_get("co", vertices)
    shown.to_mesh_clear()
    return len(vertices), zlib.crc32(vertices.tobytes())
