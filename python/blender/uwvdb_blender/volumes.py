"""Volume objects and caches of fluid domains, where they are in Blender."""

import contextlib
import os
import re
import zlib

import bpy
import numpy
from mathutils import Matrix

from . import bands as colours
from . import emission, meshes, program, units
from .notes import Refusal
from .words import Words

class Source:
    """A file of an object's volume in this frame, a name that stands for all frames (for advice), and
    where its index space or its own space lies."""

    def __init__(self, path, pattern, is_noise):
        self.path, self.pattern, self.is_noise = path, pattern, is_noise


def source_of(shown, frame):
    """The Source of an object in a frame, None if it has no volume then; Refusal if its file is not there."""
    if shown.type == "VOLUME":
        return _of_volume_object(shown)
    settings = meshes.domain_settings(shown) if shown.type == "MESH" else None
    return _of_domain(shown, settings, frame) if settings is not None else None


def _of_volume_object(shown):
    data = shown.data
    if not data.filepath:
        return None
    is_loaded, path = data.grids.load(), data.grids.frame_filepath
    if is_loaded and not path:
        return None  # The frame is outside a sequence that is clipped.
    path = path or bpy.path.abspath(data.filepath, library=data.library)
    if not os.path.isfile(path):
        raise Refusal(f"volume '{shown.name}': there is no file {path}")
    return Source(path, _pattern(path) if data.is_sequence else path, False)


def _of_domain(shown, settings, frame):
    folder = bpy.path.abspath(settings.cache_directory)
    if settings.cache_data_format != "OPENVDB":
        raise Refusal(f"fluid domain '{shown.name}': its cache has to be OpenVDB (Physics > Fluid > "
                      "Cache > Format Volumes)")
    number = frame - (settings.cache_frame_offset if settings.cache_type != "REPLAY" else 0)
    noise = os.path.join(folder, "noise", f"fluid_noise_{number:04d}.vdb")
    data = os.path.join(folder, "data", f"fluid_data_{number:04d}.vdb")
    for path, is_noise in ((noise, True), (data, False)):
        if (settings.use_noise or not is_noise) and os.path.isfile(path):
            return Source(path, _pattern(path), is_noise)
    raise Refusal(f"fluid domain '{shown.name}': frame {number} is not baked, there is no file {data}")


def _pattern(path):
    """The name of a sequence, for `uwvdb info`: its last number in number signs."""
    folder, name = os.path.split(path)
    return os.path.join(folder, re.sub(r"(\d+)(?=\D*$)", lambda m: "#" * len(m[1]), name))


def advice(path, source, is_cancelled=lambda: False):
    """{grid: (small, large)} in ppm per unit of a volume as large as its file says, and the names of
    all grids of numbers."""
    return _advice(source, lambda pattern: program.info(path, pattern, source.path, is_cancelled))


def advice_soon(path, source):
    """The same without waiting: program.NotYet until it is known."""
    return _advice(source, lambda pattern: program.info_soon(path, pattern, source.path))


def _advice(source, look):
    try:
        found = look(source.pattern)
    except program.Failed:
        # Numbers without leading zeros have no pattern that their length tells.
        found = look(source.path)
    told = found["advice"]
    mapped = {name: (told["small_ppm"] * told["scale"], told["large_ppm"] * told["scale"])
              for name in told["map"]} if "small_ppm" in told else {}
    return mapped, [grid["name"] for grid in found["grids"] if grid["unusable"] is None]


def size_of(shown, scene):
    """The matrix that makes metres of the sizes in an object's file: a cache of a domain is as large
    there as in Blender's world."""
    to_metres = units.to_metres(scene)
    return to_metres @ shown.matrix_world if shown.type == "VOLUME" else to_metres


def for_size(told, matrix):
    """Such advice for the volume as large as it is here: what makes it smaller makes it denser."""
    mapped, names = told
    scale = abs(matrix.to_3x3().determinant()) ** (1 / 3) or 1.0
    return {name: (small / scale, large / scale) for name, (small, large) in mapped.items()}, names


def _domain_place(shown, source):
    """(object from index space, further keys of the entry) of a domain. Blender stretches the cells over
    the box of the evaluated mesh, which for an adaptive domain is that of the frame's part of it; sizes
    and places in the file are not needed."""
    settings = meshes.domain_settings(shown)
    cells = [n * (settings.noise_scale if source.is_noise else 1) for n in settings.domain_resolution]
    mesh = shown.to_mesh()
    corners = numpy.empty((len(mesh.vertices), 3), numpy.float32)
    mesh.vertices.foreach_get("co", corners.reshape(-1))
    shown.to_mesh_clear()
    low, high = corners.min(axis=0), corners.max(axis=0)
    size = [(high[axis] - low[axis]) / cells[axis] for axis in range(3)]
    return (Matrix.Translation([float(v) for v in low])
            @ Matrix.Diagonal([float(v) for v in size] + [1.0])), {"voxel_size": 1}


class Volumes:
    """The section `volumes`. `advise` gives the advice for a Source."""

    def __init__(self, folder, notes, advise):
        self._folder, self._notes, self._advise = folder, notes, advise
        self.entries, self.objects = [], []  # of the section, and the names and files of their objects

    def add_all(self, depsgraph, to_metres):
        for instance in depsgraph.object_instances:
            shown = instance.object
            if not instance.show_self or meshes.is_unseen(instance, depsgraph.view_layer):
                continue
            try:
                source = source_of(shown, depsgraph.scene.frame_current)
                if source is not None:
                    self._add(shown, source, depsgraph.scene, to_metres @ instance.matrix_world)
            except Refusal as missing:
                self._notes.add(f"{Words().why(missing)}; it is left out")
        if self.entries and depsgraph.scene.render.use_motion_blur:
            self._notes.add("volumes stand still while the shutter is open")

    def _add(self, shown, source, scene, matrix):
        if meshes.axes_of(matrix) < 3:
            self._notes.add(f"'{shown.name}' is left out: its scale is 0")
            return
        # Under a name of its own: the file's place says nothing that Blender does not know better.
        # It differs from file to file, so that whoever reads the scene again sees that one has changed.
        state = f"{os.path.abspath(source.path)} {os.stat(source.path).st_mtime_ns}"
        link = f"volume{len(self.entries)}-{zlib.crc32(state.encode()):08x}.vdb"
        grids = {}
        for mapping in shown.uwvdb.grids:
            name = mapping.name
            if source.is_noise and not name.endswith("_noise"):
                name += "_noise"
            grids[name] = {"small": mapping.small, "large": mapping.large}
        is_domain = shown.type != "VOLUME"
        of_file, extra = _domain_place(shown, source) if is_domain else (Matrix.Identity(4), {})
        light = self._light(shown, source, scene)
        if not grids:
            mapped, _ = for_size(self._advise(source), size_of(shown, scene))
            grids = {name: {"small": small, "large": large}
                     for name, (small, large) in mapped.items()}
            if not grids and not light:
                self._notes.add(f"'{shown.name}' is left out: no grid of its file looks like a "
                                "concentration; map one in its panel uwvdb")
                return
            if grids:
                self._notes.add(f"'{shown.name}' has ppm by advice: " + ", ".join(
                    f"{name} {g['small']:.3g} small, {g['large']:.3g} large"
                    for name, g in grids.items()))
        grids = {n: {k: v for k, v in g.items() if v > 0} for n, g in grids.items()}
        content = {"grids": {n: g for n, g in grids.items() if g}, "emission": light}
        content = {section: entries for section, entries in content.items() if entries}
        if not content:
            return
        with contextlib.suppress(FileExistsError):
            os.symlink(os.path.abspath(source.path), os.path.join(self._folder, link))
        self.objects.append((shown.name, source.path))
        self.entries.append({"file": link, **content, "centering": "cell", "up": "y", **extra,
                             "transform": self._transform(shown, matrix @ of_file)})

    def _light(self, shown, source, scene):
        """What the object's material gives off: the entries of `emission`."""
        if not emission.emits(shown):
            return {}
        suffix = "_noise" if source.is_noise else ""
        _, names = self._advise(source)
        domain = meshes.domain_settings(shown) if shown.type == "MESH" else None
        found = emission.of_object(shown, domain, {name.removesuffix(suffix) for name in names},
                                   colours.parse(scene.uwvdb.bands),
                                   units.metres_per_unit(scene), self._notes)
        # The name of its lamp: letters, digits and hyphens.
        number = len(self.entries)
        return {grid + suffix: {**light, "name": re.sub("[^A-Za-z0-9-]", "-", f"volume{number}-{grid}")[:64]}
                for grid, light in found.items()}

    def _transform(self, shown, matrix):
        location, rotation, scale = matrix.decompose()
        back = Matrix.LocRotScale(location, rotation, scale)
        largest = max(abs(matrix[i][j]) for i in range(3) for j in range(3))
        if any(abs(back[i][j] - matrix[i][j]) > 1e-4 * largest for i in range(3) for j in range(3)):
            self._notes.add(f"volume '{shown.name}' is sheared in Blender, but not here")
        # uwvdb turns about fixed axes, x first, and so does Blender's order XYZ.
        turn = rotation.to_euler("XYZ")
        return {"scale": list(scale), "rotate": [angle * 180 / numpy.pi for angle in turn],
                "translate": list(location)}
