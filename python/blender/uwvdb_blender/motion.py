"""Where everything is at other moments than the frame's own, for motion blur and the Vector pass."""

from . import meshes

CAMERA = "the camera"  # its key; others are tuples


class Motion:
    """Matrices at several times [s]; the scene's clock has the frame number over the frame rate."""

    def __init__(self, frames, rate):
        self.frames = frames
        self.times = [frame / rate for frame in frames]
        self._matrices = [{} for _ in frames]
        self._shapes = {}  # of what may deform, by object: by moment

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
                    shape = meshes.Shape.of(shown)
                    # One that stays the same is kept once.
                    shapes[at] = next((known for known in shapes.values() if known == shape), shape)
        known[CAMERA] = world_from_camera

    @property
    def changing(self):
        """Names of the objects whose vertices or faces change in number."""
        return {name for name, shapes in self._shapes.items()
                if len({shape.size for shape in shapes.values()}) > 1}

    def shapes(self, name):
        """An object's shape at each time; None if it keeps it, changes its vertices in number, or is not there
        all the time."""
        shapes = self._shapes.get(name, {})
        if len(shapes) < len(self.frames) or name in self.changing:
            return None
        shapes = [shapes[at] for at in range(len(self.frames))]
        return shapes if any(shape is not shapes[0] for shape in shapes) else None

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

