"""Materials that uwvdb does not have, baked to textures by Cycles: in a Blender of its own (bake_worker.py), so that
the user's scene, selection and files stay as they are, and once, since what was baked is kept in the user's cache."""

import contextlib
import hashlib
import json
import math
import os
import pathlib
import shutil
import tempfile
import threading

import bpy
import numpy
from mathutils import Matrix

from . import glass, materials, meshes, program, shaders, trees
from .baked import Baked

VERSION = 1  # of what is kept: what was baked by others is baked anew
LEAST_SIZE, VIEW_SIZE = 64, 256
# Of instances that differ by more than their mesh; more of them look like one of these.
MOST_OF_A_MESH = 32
MOST_CORNERS = 4_000_000  # of a mesh that is unwrapped
MOST_BYTES_KEPT = 4 << 30
START = 0xdeadbeef + (2 << 2) + 13
BESIDE = 0.25  # of the picture, where a face whose middle is there may reach into it
FILL = 0.5  # of a texture, by what is on it
SECONDS_BETWEEN_LOOKS = 0.05
FAILURES = (program.Failed, RuntimeError, OSError)


def cache_folder():
    base = os.environ.get("XDG_CACHE_HOME") or os.path.join(os.path.expanduser("~"), ".cache")
    return pathlib.Path(base) / "uwvdb" / "blender"


def sight(camera, world_from_camera, size):
    """points of the world (n, 3) -> pixels per unit of length there, 0 where a camera does not look. `camera` is the
    scene's entry, its matrix and the points are in Blender's units."""
    lens = camera.get("intrinsics") or {"fx": size[0], "fy": size[0], "cx": size[0] / 2, "cy": size[1] / 2}
    turn = numpy.array(world_from_camera.to_3x3().normalized())
    place = numpy.array(world_from_camera.translation)

    def seen(points):
        x, y, z = ((points - place) @ turn).T * numpy.array([[1], [-1], [-1]])
        distance = numpy.maximum(numpy.sqrt(x**2 + y**2 + z**2), 1e-9)
        focal = math.sqrt(lens["fx"] * lens["fy"])
        if "distortion" in camera:
            angle = numpy.arccos(numpy.clip(z / distance, -1, 1))
            return focal / distance * (angle * focal < max(size) * (0.5 + BESIDE))
        front = numpy.maximum(z, 1e-9)
        column, row = lens["fx"] * x / front + lens["cx"], lens["fy"] * y / front + lens["cy"]
        inside = ((z > 0) & (column > -BESIDE * size[0]) & (column < (1 + BESIDE) * size[0])
                  & (row > -BESIDE * size[1]) & (row < (1 + BESIDE) * size[1]))
        return focal / distance * inside

    return seen


class _Job:
    def __init__(self, material, channels, needs, part, shown, matrix, extra):
        self.material, self.channels, self.needs, self.part = material, channels, needs, part
        self.shown, self.matrix, self.extra = shown, matrix, extra
        self.size = 1
        self.digest = self._digest()

    def _digest(self):
        digest = hashlib.blake2b(digest_size=16)
        digest.update(repr((VERSION, bpy.app.version, self.needs.digest, sorted(self.channels), self.extra)).encode())
        for name, values in sorted(self.part.arrays.items()):
            if name == "normals":
                continue  # they follow from the rest, and Blender's own sums of them differ from time to time
            if name != "positions" or self.needs.is_of_shape or not self.part.has_rest:
                digest.update(name.encode() + str(values.shape).encode())
                digest.update(numpy.ascontiguousarray(values))
        return digest.hexdigest()


class Bakes:
    """What is baked of a scene. make() has to be called before of()."""

    def __init__(self, limit, threads, notes):
        """`limit` is the greatest side of a texture; 0: nothing is baked."""
        self._limit, self._threads, self._notes = limit, threads, notes
        self._needs, self._found, self._jobs = {}, {}, {}
        self._own = {}  # of objects that differ from others of the same mesh: which bake they have

    def variant(self, instance, depsgraph):
        """What an object is told from others of its mesh by; None if their materials do not differ."""
        if not any(self._need(material) and self._need(material)[1].is_of_object
                   for material in meshes.slots_of(instance.object, depsgraph)):
            return None
        key = meshes.key_of(instance)
        if key not in self._own:
            mesh = meshes.mesh_key(instance.object, depsgraph)
            others = [number for other, number in self._own.values() if other == mesh]
            number = len(others)
            if number >= MOST_OF_A_MESH:
                number %= MOST_OF_A_MESH
                self._notes.add(f"'{instance.object.name}': more than {MOST_OF_A_MESH} copies look different by their "
                                f"materials' nodes: the further ones look like the first {MOST_OF_A_MESH}")
            self._own[key] = mesh, number
        return self._own[key][1]

    def of(self, mesh_key, slot):
        """The Baked of a mesh's material slot, or None."""
        return self._found.get((mesh_key, slot))

    def _need(self, material):
        """(channels, trees.Needs) of what has to be baked of a material; None if nothing has."""
        if self._limit == 0 or material is None or not material.use_nodes or material.node_tree is None:
            return None
        name = material.name_full
        if name not in self._needs:
            channels = materials.channels_to_bake(material)
            self._needs[name] = (channels, trees.Needs(material)) if channels else None
        return self._needs[name]

    def make(self, depsgraph, seen, is_cancelled, on_progress):
        """Bakes what is not kept. `seen(points)` are the pixels per unit of length at points of the world, 0 where
        the camera does not look. Raises program.Stopped."""
        missing = self.look(depsgraph, seen)
        if missing:
            work = Work(missing)
            try:
                _on_main_thread(lambda: work.hand_over(depsgraph.scene, self._threads), is_cancelled)
                work.run(is_cancelled, on_progress)
            except FAILURES as error:
                self._notes.add(f"{work.names} could not be baked: {error}")
            finally:
                work.close()
        self.find()

    def look(self, depsgraph, seen=None):
        """Plans, and returns what is not kept for a Work; without `seen`, in the size that views have."""
        for instance in meshes.surfaces(depsgraph):
            self._plan(instance, depsgraph, seen)
        missing = []
        for places in self._by_digest().values():
            job, size = places[0][1], max(job.size for _, job in places)
            if _kept(job.digest, size) is None:
                job.size = size
                missing.append(job)
        return missing

    def find(self):
        """Reads what is kept of all that was looked at."""
        for digest, places in self._by_digest().items():
            path = _kept(digest, 1, best=True)
            for place, job in places if path is not None else ():
                self._found[place] = _read(path, job)

    def _by_digest(self):
        result = {}
        for place, job in self._jobs.items():
            result.setdefault(job.digest, []).append((place, job))
        return result

    def _plan(self, instance, depsgraph, seen):
        shown = instance.object
        slots = meshes.slots_of(shown, depsgraph)
        if meshes.is_held_out(instance, depsgraph.view_layer):
            return
        needed = [self._need(material) for material in slots]
        if not any(needed):
            return
        key = meshes.mesh_key(shown, depsgraph, self.variant(instance, depsgraph))
        matrix = instance.matrix_world.copy()
        for slot, need in enumerate(needed):
            if need is None or glass.is_clear(slots[slot]) or not materials.shows_surface(slots[slot]):
                continue
            job = self._jobs.get((key, slot))
            if job is None:
                part = _Part.read(shown, slots, slot, need[1])
                if part is None:
                    continue
                if part.corners > MOST_CORNERS:
                    self._notes.add(f"'{shown.name}': its material '{slots[slot].name}' is not baked, as it has more "
                                    f"than {MOST_CORNERS // 1_000_000} million corners of faces")
                    continue
                if need[1].view:
                    self._notes.add(f"Material '{slots[slot].name}': what differs with the direction of view "
                                    f"({', '.join(need[1].view)}) is as a camera sees it at right angles")
                extra = _object_values(instance, need[1], matrix)
                job = self._jobs[key, slot] = _Job(slots[slot], need[0], need[1], part, shown, matrix, extra)
            wanted = min(VIEW_SIZE, self._limit) if seen is None else job.part.size(matrix, seen, self._limit)
            job.size = max(job.size, wanted)


class Work:
    """Jobs for a Blender that bakes. hand_over() needs Blender's data, run() does not."""

    def __init__(self, jobs):
        self._jobs, self._folder = jobs, tempfile.mkdtemp(prefix="uwvdb-bake-")
        self.names = ", ".join(sorted({f"'{job.material.name}'" for job in jobs}))
        self.digests = {job.digest for job in jobs}

    def hand_over(self, scene, threads):
        _write_materials(self._jobs, self._folder)
        _write_job(self._jobs, self._folder, scene, threads)

    def run(self, is_cancelled, on_progress):
        arguments = [bpy.app.binary_path, "--background", "--factory-startup", "--python",
                     str(pathlib.Path(__file__).with_name("bake_worker.py")), "--", self._folder]
        program.run(arguments, self._folder, is_cancelled, on_progress)
        _forget_oldest()

    def close(self):
        shutil.rmtree(self._folder, ignore_errors=True)


class InBackground:
    """A Work that goes on while the view is drawn."""

    def __init__(self, work):
        self.work, self.error, self._is_cancelled = work, "", False
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    @property
    def is_done(self):
        return not self._thread.is_alive()

    def cancel(self):
        self._is_cancelled = True

    def _run(self):
        try:
            self.work.run(lambda: self._is_cancelled, lambda *_: None)
        except program.Stopped:
            pass
        except FAILURES as error:
            self.error = f"{self.work.names} could not be baked: {error}"
        finally:
            self.work.close()


class _Part:
    """The faces of a mesh that have one material, as arrays."""

    def __init__(self, arrays, loops, count, texspace, uvs, colours):
        self.arrays, self._loops, self._count = arrays, loops, count
        self.texspace, self.uvs, self.colours = texspace, uvs, colours

    @property
    def has_rest(self):
        return "undeformed" in self.arrays

    @property
    def corners(self):
        return len(self.arrays["corners"])

    @staticmethod
    def read(shown, slots, slot, needs):
        try:
            return _Part._of(shown.to_mesh(), len(slots), slot, needs)
        finally:
            shown.to_mesh_clear()

    @staticmethod
    def _of(mesh, slots, slot, needs):
        corners = meshes.Corners(mesh, slots)
        while not corners.is_whole:
            corners.read_part(mesh)
        found = corners.faces_of(slot)
        if found is None:
            return None
        loops, vertices, faces, arrays = found
        smooth = numpy.empty(len(mesh.polygons), bool)
        mesh.polygons.foreach_get("use_smooth", smooth)
        arrays["smooth"] = smooth[faces]
        if mesh.has_custom_normals:
            arrays["turned"] = numpy.rint(50 * arrays["normals"]).astype(numpy.int8)
        rest = numpy.empty((len(mesh.vertices), 3), numpy.float32)
        mesh.vertices.foreach_get("undeformed_co", rest.reshape(-1))
        rest = rest[vertices]
        if not numpy.allclose(rest, arrays["positions"], atol=1e-6 * max(float(numpy.ptp(rest)), 1e-30)):
            arrays["undeformed"] = rest
        layers = mesh.uv_layers
        for layer in layers:
            values = numpy.empty((len(mesh.loops), 2), numpy.float32)
            layer.data.foreach_get("uv", values.reshape(-1))
            arrays[f"uv:{layer.name}"] = values[loops]
        known = mesh.color_attributes
        for attribute in mesh.attributes:
            field = _field(attribute, needs.attributes, known)
            if field is None:
                continue
            kind, name, width = field
            values = numpy.empty((len(attribute.data), width), numpy.float32)
            attribute.data.foreach_get(name, values.reshape(-1))
            domain = attribute.domain
            if domain == "FACE":
                values, domain = numpy.repeat(values, corners.totals, axis=0)[loops], "CORNER"
            elif domain in ("POINT", "CORNER"):
                values = values[vertices if domain == "POINT" else loops]
            else:
                continue
            arrays[f"{kind}:{domain}:{attribute.name}"] = values
        shown_uvs = next((layer.name for layer in layers if layer.active_render), "")
        shown_colours = known[known.render_color_index].name if len(known) > 0 else ""
        texspace = (tuple(mesh.texspace_location), tuple(mesh.texspace_size))
        return _Part(arrays, loops, len(mesh.loops), texspace, shown_uvs, shown_colours)

    def size(self, matrix, seen, limit):
        """The side of a texture with about a texel for each pixel where the camera sees the mesh."""
        positions, starts = self.arrays["positions"].astype(float), self.arrays["starts"]
        world = positions @ numpy.array(matrix.to_3x3()).T + numpy.array(matrix.translation)
        corners = world[self.arrays["corners"]]
        totals = numpy.diff(numpy.append(starts, len(corners)))
        middle = numpy.add.reduceat(corners, starts) / totals[:, None]
        # Twice the area of a polygon is the length of the sum of its corners' cross products.
        following = numpy.arange(1, len(corners) + 1)
        following[starts + totals - 1] = starts
        origin = numpy.repeat(corners[starts], totals, axis=0)
        crosses = numpy.cross(corners - origin, corners[following] - origin)
        areas = numpy.linalg.norm(numpy.add.reduceat(crosses, starts), axis=1) / 2
        density = seen(middle) ** 2
        pixels = (areas * density).sum()
        if pixels <= 0:
            return LEAST_SIZE
        wanted = math.sqrt(areas.sum() * (areas * density**2).sum() / pixels / FILL)
        # To the nearest power of two, so that a camera that comes closer does not bake with each frame.
        size = 2 ** round(math.log2(max(wanted, 1)))
        return int(min(max(size, min(LEAST_SIZE, limit)), limit))

    def spread(self, uvs):
        """Texture coordinates of these faces' corners, as those of the whole mesh."""
        if len(uvs) == self._count:
            return uvs
        result = numpy.zeros((self._count, 2), numpy.float32)
        result[self._loops] = uvs
        return result


def _field(attribute, names, colours):
    if attribute.name.startswith(".") or attribute.domain not in ("POINT", "CORNER", "FACE"):
        return None
    if attribute.data_type in ("FLOAT_COLOR", "BYTE_COLOR"):
        return "colour", "color", 4
    if attribute.name not in names:
        return None
    return {"FLOAT": ("number", "value", 1), "INT": ("number", "value", 1), "BOOLEAN": ("number", "value", 1),
            "FLOAT_VECTOR": ("vector", "vector", 3)}.get(attribute.data_type)


def _object_values(instance, needs, matrix):
    """What nodes read of an object, as far as a material does."""
    shown = instance.object
    if not needs.is_of_object:
        scale = [float(f"{abs(part):.5g}") for part in matrix.to_scale()] if needs.has_bumps else None
        return {"scale": scale}
    attributes = {}
    for name in needs.object_attributes:
        with contextlib.suppress(KeyError, ValueError, TypeError):
            value = shown[name] if name in shown.keys() else shown.path_resolve(name)
            attributes[name] = float(value) if isinstance(value, (int, float)) else [float(part) for part in value][:3]
    return {"matrix": [float(part) for row in matrix for part in row], "attributes": attributes,
            "object": {"Location": list(matrix.translation), "Color": list(shown.color[:3]),
                       "Alpha": float(shown.color[3]), "Object Index": float(shown.pass_index),
                       "Random": _random_number(instance) / 0xffffffff}}


def _random_number(instance):
    """Cycles' of an object: a hash of its name, or what instances have themselves."""
    if instance.is_instance:
        return instance.random_id & 0xffffffff
    number = 0
    for byte in instance.object.name_full.encode():
        number = (37 * number + byte) & 0xffffffff
    # Jenkins' lookup3 of two words, the second of which is 0.
    a, b, c = (number + START) & 0xffffffff, START, START
    for turn in (14, 11, 25, 16, 4, 14, 24):
        c = ((c ^ b) - (b << turn | b >> 32 - turn)) & 0xffffffff
        a, b, c = b, c, a
    return b


def _kept(digest, size, best=False):
    """The file of a bake of this size or up to four times as fine; the finest, if the best is asked for."""
    sizes = {int(path.stem.rpartition("-")[2]): path for path in cache_folder().glob(f"{digest}-*.npz")}
    fitting = sorted(found for found in sizes if found >= size and (best or found <= 4 * size))
    if not fitting:
        return None
    path = sizes[fitting[-1 if best else 0]]
    with contextlib.suppress(OSError):
        os.utime(path)
    return path


def _read(path, job):
    with numpy.load(path, allow_pickle=False) as file:
        content = {name: file[name] for name in file.files}
    return Baked(content, job.part.spread(content.pop("uvs")), job.channels)


def _forget_oldest():
    files = []
    for path in cache_folder().glob("*.npz"):
        with contextlib.suppress(OSError):
            stamp = path.stat()
            files.append((stamp.st_mtime, stamp.st_size, path))
    total = sum(size for _, size, _ in files)
    for _, size, path in sorted(files):
        if total <= MOST_BYTES_KEPT:
            return
        with contextlib.suppress(OSError):
            path.unlink()
        total -= size


def _on_main_thread(work, is_cancelled):
    """Blender's data may be read and written there alone, while it goes on drawing; F12 renders on another."""
    if threading.current_thread() is threading.main_thread():
        work()
        return
    done, failed = threading.Event(), []

    def run():
        try:
            work()
        except Exception as error:  # it belongs to the render
            failed.append(error)
        done.set()

    bpy.app.timers.register(run)
    while not done.wait(SECONDS_BETWEEN_LOOKS):
        if is_cancelled():
            if bpy.app.timers.is_registered(run):
                bpy.app.timers.unregister(run)
            raise program.Stopped()
    if failed:
        raise failed[0]


def _write_materials(jobs, folder):
    """Writes the materials, and the pixels that are in no file."""
    originals = {job.material.original for job in jobs}
    own = {material for material in originals if material.library is None}
    if own:
        bpy.data.libraries.write(os.path.join(folder, "materials.blend"), own, path_remap="ABSOLUTE")
    painted = {}
    for job in jobs:
        for image in job.needs.images:
            if trees.is_painted(image) and image.name not in painted:
                values = numpy.empty((image.size[1], image.size[0], 4), numpy.float32)
                image.original.pixels.foreach_get(values.reshape(-1))
                painted[image.name] = f"painted-{len(painted)}.npy"
                numpy.save(os.path.join(folder, painted[image.name]), values)
    with open(os.path.join(folder, "painted.json"), "w", encoding="utf-8") as file:
        json.dump(painted, file)


def _write_job(jobs, folder, scene, threads):
    cache = cache_folder()
    cache.mkdir(parents=True, exist_ok=True)
    with open(os.path.join(folder, "painted.json"), encoding="utf-8") as file:
        painted = json.load(file)
    objects = {thing.name: [part for row in thing.matrix_world for part in row]
               for job in jobs for thing in job.needs.objects}
    content = {"threads": threads, "painted": painted, "objects": objects, "jobs": []}
    for number, job in enumerate(jobs):
        numpy.savez(os.path.join(folder, f"mesh-{number}.npz"), **job.part.arrays)
        matrix = job.extra.get("matrix")
        if matrix is None:
            scale = job.extra["scale"] or (1, 1, 1)
            matrix = [part for row in Matrix.Diagonal((*scale, 1)) for part in row]
        library = job.material.original.library
        content["jobs"].append({
            "material": job.material.name, "library": bpy.path.abspath(library.filepath) if library else None,
            "frame": scene.frame_current + scene.frame_subframe, "mesh": f"mesh-{number}.npz", "size": job.size,
            "channels": sorted(job.channels), "matrix": matrix, "uvs": job.part.uvs, "colours": job.part.colours,
            "texspace": job.part.texspace, "object": job.extra.get("object", {}),
            "attributes": job.extra.get("attributes", {}),
            "is_single": sum(node.type in shaders.SHADERS for node, _ in job.needs.uses) == 1,
            "out": str(cache / f"{job.digest}-{job.size}.npz")})
    with open(os.path.join(folder, "job.json"), "w", encoding="utf-8") as file:
        json.dump(content, file)
