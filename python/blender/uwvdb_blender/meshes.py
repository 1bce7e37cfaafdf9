"""Meshes of the evaluated scene, with modifiers, instances and visibility, as a binary glTF file."""

import math
import time

import numpy

from . import glass, gltf, materials, units

SURFACES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
WITHOUT_SURFACE = {"EMPTY", "CAMERA", "LIGHT", "LIGHT_PROBE", "SPEAKER", "ARMATURE", "LATTICE",
                   "VOLUME"}
UNKNOWN = {"CURVES", "HAIR", "POINTCLOUD"}


def domain_settings(shown):
    """Settings of an object that is the domain of a gas, or None."""
    for modifier in shown.modifiers:
        if modifier.type == "FLUID" and modifier.fluid_type == "DOMAIN":
            settings = modifier.domain_settings
            if settings is not None and settings.domain_type == "GAS":
                return settings
    return None


def key_of(instance):
    """What stays the same of an instance from one moment to another."""
    parent = instance.parent.name_full if instance.parent is not None else ""
    persistent = tuple(instance.persistent_id) if instance.is_instance else ()
    return instance.object.name_full, parent, persistent


def shower_of(instance):
    """The object of the view layer that an instance belongs to."""
    return instance.parent if instance.is_instance and instance.parent is not None else instance.object


def of_collection(shower, name, layer):
    """Whether a view layer's collections have what the function of this name of an object tells."""
    return getattr(shower.original, name)(view_layer=layer)


def is_unseen(instance, layer):
    """Whether the camera does not see an object, which then is left out."""
    return (not instance.object.visible_camera
            or of_collection(shower_of(instance), "indirect_only_get", layer))


def is_held_out(instance, layer):
    """Whether an object is a hole in the picture."""
    return instance.object.is_holdout or of_collection(shower_of(instance), "holdout_get", layer)


def axes_of(matrix):
    """How many of its axes a matrix leaves: fewer than three where a scale is 0."""
    return sum(column.length_squared > 0 for column in matrix.to_3x3().col)


def may_deform(shown):
    """Whether an object's vertices may move against each other."""
    data = shown.original.data
    return (len(shown.original.modifiers) > 0 or getattr(data, "shape_keys", None) is not None
            or getattr(data, "animation_data", None) is not None or shown.type == "META")


def slots_of(shown, depsgraph):
    """The materials of an object's slots."""
    override = depsgraph.view_layer.material_override
    return (override,) if override is not None else tuple(s.material for s in shown.material_slots)


def mesh_key(shown, depsgraph, variant=None):
    """What is the same of objects that show the same mesh. `variant` tells those apart whose materials differ."""
    return (shown.type, shown.data.as_pointer(), shown.data.name_full, variant,
            tuple(m.name_full if m is not None else "" for m in slots_of(shown, depsgraph)))


def surfaces(depsgraph):
    """Instances that the render shows as surfaces."""
    for instance in depsgraph.object_instances:
        shown = instance.object
        if not instance.show_self or shown.type not in SURFACES or is_unseen(instance, depsgraph.view_layer):
            continue
        if axes_of(instance.matrix_world) < 2:
            continue  # What is a line or a point has no surface.
        if shown.type == "MESH" and domain_settings(shown) is not None:
            continue
        yield instance


class MeshFile:
    """The file, and what its numbers of objects and materials stand for in Blender. What must be read from
    Blender is read by read_some() and add_all(), all else is done when the file is written."""

    def __init__(self, notes, known=None, bakes=None):
        """`known` is what earlier files have read of objects that did not change since, by name; what this
        one reads is added. `bakes` is a bakes.Bakes or None."""
        self.glb = gltf.Glb()
        self.pass_indices, self.material_indices = [], []
        self.keys = []  # of the instances that became nodes, in their order
        self.held_out = set()  # names of nodes
        self._notes, self._known, self._bakes = notes, known, bakes
        self._materials = materials.Exporter(self.glb, notes)
        self._meshes, self._begun = {}, {}
        self._weights = {}  # of the morph targets of meshes that deform, by moment

    @property
    def is_empty(self):
        return not self.pass_indices

    def read_some(self, depsgraph, seconds):
        """Reads meshes, or parts of one, until that time has passed; whether there are none left."""
        end = time.monotonic() + seconds
        try:
            for instance in surfaces(depsgraph):
                self._mesh(instance, depsgraph, end)
        except _TimeIsUp:
            return False
        return True

    def add_all(self, depsgraph, to_metres, motion):
        for instance in surfaces(depsgraph):
            shown = instance.object
            shapes = motion.shapes(shown.name_full) if motion is not None else None
            mesh = self._mesh(instance, depsgraph, shapes=shapes)
            if mesh is None:
                continue
            poses = motion.poses(key_of(instance)) if motion is not None else None
            if poses is None:
                self.glb.add_node(shown.name, mesh, to_metres @ instance.matrix_world)
            else:
                self.glb.add_moving_node(shown.name, mesh, motion.times, poses)
            if shapes is not None and mesh in self._weights:
                self.glb.add_weights(motion.times, self._weights[mesh])
            if is_held_out(instance, depsgraph.view_layer):
                self.held_out.add(shown.name)
            self.pass_indices.append(shown.pass_index)
            self.keys.append(key_of(instance))
        self.material_indices = self._materials.pass_indices

    def _mesh(self, instance, depsgraph, end=math.inf, shapes=None):
        """Its number in the file; None if nothing of it is seen. Raises _TimeIsUp after that time, and goes
        on from there when it is called again. `shapes` are those of the moments, of what deforms."""
        shown = instance.object
        variant = self._bakes.variant(instance, depsgraph) if self._bakes is not None else None
        is_hole = is_held_out(instance, depsgraph.view_layer)
        key = (mesh_key(shown, depsgraph, variant), is_hole)
        if key not in self._meshes:
            slots = slots_of(shown, depsgraph)
            corners = self._begun.get(key) or self._known_corners(shown, depsgraph, len(slots))
            with _Reading(shown, end) as reading:
                if corners is None or not corners.is_whole and not corners.is_of(reading.mesh):
                    corners = self._begun[key] = Corners(reading.mesh, len(slots))
                while not corners.is_whole:
                    reading.go_on(corners.read_part)
                parts = self._parts(shown, corners, slots, _metres_of(shown, depsgraph), *key)
                for part in parts:
                    if corners.lacks(part.exported):
                        reading.go_on(lambda mesh, part=part: corners.read(mesh, part.exported))
            for part in parts:
                self._note_missing(shown, corners, part.exported)
            if self._known is not None and _shows_its_own(shown, depsgraph):
                self._known[shown.name_full] = corners
            targets = corners.others_of(shapes or [])
            self._meshes[key] = self.glb.add_mesh(
                shown.data.name, lambda glb: corners.primitives(glb, parts, targets)) if parts else None
            if targets:
                self._weights[self._meshes[key]] = [[float(shape is target) for target in targets] for shape in shapes]
        return self._meshes[key]

    def _known_corners(self, shown, depsgraph, slots):
        corners = self._known.get(shown.name_full) if self._known else None
        is_usable = corners is not None and corners.slots == slots and _shows_its_own(shown, depsgraph)
        return corners if is_usable else None

    def _parts(self, shown, corners, slots, metres, key, is_hole):
        """The materials of a mesh that are seen."""
        parts = []
        for index in corners.used_slots():
            material = slots[index] if slots else None
            if glass.is_clear(material):
                found = glass.glass_of(material) if not is_hole else None
                if found is None:
                    self._materials.note_clear(material)
                else:
                    parts.append(_Part(index, *self._materials.export_glass(
                        material, found, *corners.inside(index, metres))))
            elif is_hole and materials.shows_surface(material):
                parts.append(_Part(index, *self._materials.export_held_out()))
            elif materials.shows_surface(material):
                baked = self._bakes.of(key, index) if self._bakes is not None else None
                parts.append(_Part(index, *self._materials.export(material, baked)))
            else:
                self._notes.add(f"the volume of '{shown.name}' is left out: its material has a volume "
                                "shader, but uwvdb takes Volume objects and fluid domains")
        return parts

    def _note_missing(self, shown, corners, exported):
        for name in exported.uv_names:
            if corners.uv_maps[name] is None:
                self._notes.add(f"'{shown.name}' has no UV map {name!r} for its textures")
        if exported.colours is not None and corners.colours[exported.colours] is None:
            self._notes.add(f"'{shown.name}' has no colour attribute '{exported.colours}' for its "
                            "material")


def _metres_of(shown, depsgraph):
    """How long the units of an object's mesh are, in the mean of its axes."""
    return abs(shown.matrix_world.to_3x3().determinant()) ** (1 / 3) * units.metres_per_unit(depsgraph.scene)


def _shows_its_own(shown, depsgraph):
    """Whether an object shows its own data, rather than those that Geometry Nodes made for an instance
    and that have no name."""
    return shown.original.evaluated_get(depsgraph).data == shown.data and shown.type != "META"


class _Part:
    """The triangles of one material."""

    def __init__(self, slot, number, exported):
        self.slot, self.number, self.exported = slot, number, exported


class _TimeIsUp(Exception):
    pass


class _Reading:
    """An object's mesh, made of the object when it is first asked for. It goes when the object is evaluated
    anew, so it is not kept for longer than this."""

    def __init__(self, shown, end):
        self._shown, self._end, self._mesh, self._has_gone_on = shown, end, None, False

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self._mesh is not None:
            self._shown.to_mesh_clear()

    @property
    def mesh(self):
        if self._mesh is None:
            self._mesh = self._shown.to_mesh()
        return self._mesh

    def go_on(self, read):
        if self._has_gone_on and time.monotonic() > self._end:
            raise _TimeIsUp()
        self._has_gone_on = True
        read(self.mesh)


class Shape:
    """Where the vertices of an object are at a moment, and its normals."""

    def __init__(self, mesh):
        self.size = _size(mesh)
        self.positions = _read(mesh.vertices, "co", 3, numpy.float32)
        self.normals_of, self.normals = _read_normals(mesh)

    @classmethod
    def of(cls, shown):
        try:
            return cls(shown.to_mesh())
        finally:
            shown.to_mesh_clear()

    def __eq__(self, other):
        return self.size == other.size and numpy.array_equal(self.positions, other.positions)


class Corners:
    """What the corners of a mesh's faces have. Blender's own data do not stay, and reading them is slow: what
    can be told without it is not read, and they are read in parts."""

    def __init__(self, mesh, slots):
        """`slots` is how many materials the mesh has."""
        self.slots, self._count, self._size = slots, len(mesh.loops), _size(mesh)
        self.uv_maps, self.colours = {}, {}  # by name; None: there is none of this name
        self._unread = [self._read_faces, self._read_vertices, self._read_normals]

    @property
    def is_whole(self):
        return not self._unread

    def is_of(self, mesh):
        return self._size == _size(mesh)

    def read_part(self, mesh):
        self._unread[0](mesh)
        self._unread.pop(0)

    def _read_faces(self, mesh):
        """Faces of three or four corners are divided here, where it takes no time of Blender's."""
        self._starts = _read(mesh.polygons, "loop_start", 1, numpy.int32).reshape(-1)
        self._totals = _read(mesh.polygons, "loop_total", 1, numpy.int32).reshape(-1)
        self._corners = self._which = None
        if self._count > 0 and self._totals.max() > 4:
            mesh.calc_loop_triangles()
            self._corners = _read(mesh.loop_triangles, "loops", 3, numpy.int32)
        which = mesh.attributes.get("material_index")
        if self.slots > 1 and which is not None and self._count > 0:
            which = _read(which.data, "value", 1, numpy.int32).reshape(-1)
            self._which = numpy.repeat(numpy.clip(which, 0, self.slots - 1), self._totals - 2)

    def _read_vertices(self, mesh):
        vertices = mesh.attributes.get(".corner_vert")  # of Blender 3.6
        self._vertices = (_read(mesh.loops, "vertex_index", 1, numpy.int32) if vertices is None else
                          _read(vertices.data, "value", 1, numpy.int32)).reshape(-1)
        self._positions = _read(mesh.vertices, "co", 3, numpy.float32)

    def _read_normals(self, mesh):
        self._normals_of, self._normals = _read_normals(mesh)

    def others_of(self, shapes):
        """Those of an object's shapes that this is not, each once."""
        others = []
        for shape in shapes:
            if (shape.size == self._size and not any(shape is other for other in others)
                    and not numpy.array_equal(shape.positions, self._positions)):
                others.append(shape)
        return others

    def used_slots(self):
        if self._count == 0:
            return []
        return [0] if self._which is None else numpy.flatnonzero(numpy.bincount(self._which)).tolist()

    @property
    def totals(self):
        """Corners of each face."""
        return self._totals

    def faces_of(self, slot):
        """(numbers of the corners, numbers of the vertices, numbers of the faces, arrays) of the faces of one material,
        by themselves: positions, corners as numbers of these, the first corner of each face, normals of the corners.
        None if there are none."""
        faces = numpy.arange(len(self._totals))
        if self._which is not None:
            firsts = numpy.cumsum(self._totals - 2) - (self._totals - 2)
            faces = numpy.flatnonzero(self._which[firsts] == slot)
        totals = self._totals[faces]
        if len(faces) == 0 or slot > 0 and self._which is None:
            return None
        starts = (numpy.cumsum(totals) - totals).astype(numpy.int32)
        loops = numpy.repeat(self._starts[faces] - starts, totals) + numpy.arange(totals.sum())
        vertices, corners = numpy.unique(self._vertices[loops], return_inverse=True)
        return loops, vertices, faces, {
            "positions": self._positions[vertices], "corners": corners.astype(numpy.int32).reshape(-1),
            "starts": starts, "normals": self._corner_normals(loops)}

    def inside(self, slot, scale):
        """Whether the faces of one material enclose something, and how far light goes through that in the mean;
        `scale` is how long its units are."""
        shape = self.faces_of(slot)[3]
        if not glass.is_closed(shape["corners"], shape["starts"]):
            return False, 0.0
        return True, glass.mean_chord(shape["positions"], shape["corners"], shape["starts"], scale)

    def lacks(self, exported):
        return (any(name not in self.uv_maps for name in exported.uv_names)
                or exported.colours is not None and exported.colours not in self.colours)

    def read(self, mesh, exported):
        """Reads what a material needs besides."""
        layers = mesh.uv_layers
        for name in exported.uv_names:
            if name not in self.uv_maps:
                layer = layers.get(name) if name else next((l for l in layers if l.active_render), None)
                self.uv_maps[name] = None if layer is None else _read(layer.data, "uv", 2, numpy.float32)
        name, known = exported.colours, mesh.color_attributes
        if name is not None and name not in self.colours:
            attribute = known.get(name) if name else (
                known[known.render_color_index] if len(known) > 0 else None)
            if attribute is None or attribute.domain not in ("POINT", "CORNER"):
                self.colours[name] = None
            else:
                values = _read(attribute.data, "color", 4, numpy.float32)
                self.colours[name] = (values, attribute.domain == "CORNER")

    def primitives(self, glb, parts, targets=()):
        """`targets` are shapes that the mesh can be given."""
        return [self._primitive(glb, part, targets) for part in parts]

    def _primitive(self, glb, part, targets):
        corners = self._triangles()
        if self._which is None:
            used, indices = slice(None), corners
        else:
            used, indices = numpy.unique(corners[self._which == part.slot], return_inverse=True)
        attributes = {name: glb.add_array(values) for name, values in self._attributes(used, part.exported)}
        primitive = {"attributes": attributes, "material": part.number,
                     "indices": glb.add_array(indices.reshape(-1))}
        if targets:
            primitive["targets"] = [{name: glb.add_array(values) for name, values in self._changes(used, target)}
                                    for target in targets]
        return primitive

    def _triangles(self):
        """Three corners each, in the order of the faces."""
        if self._corners is not None:
            return self._corners
        are_quads = self._totals == 4
        firsts = numpy.cumsum(self._totals - 2) - (self._totals - 2)
        triangles = numpy.empty((int((self._totals - 2).sum()), 3), numpy.int32)
        triangles[firsts] = self._starts[:, None] + numpy.array([0, 1, 2])
        triangles[firsts[are_quads] + 1] = self._starts[are_quads, None] + numpy.array([0, 2, 3])
        # The other diagonal where the first lies outside, as Blender does.
        corner = self._positions[self._vertices[self._starts[are_quads, None] + numpy.arange(4)]]
        first, middle, last = (corner[:, at] - corner[:, 0] for at in (1, 2, 3))
        sides = (numpy.cross(first, middle) * numpy.cross(last, middle)).sum(axis=1)
        flipped = numpy.flatnonzero(are_quads)[sides > 0]
        triangles[firsts[flipped]] = self._starts[flipped, None] + numpy.array([0, 1, 3])
        triangles[firsts[flipped] + 1] = self._starts[flipped, None] + numpy.array([1, 2, 3])
        return triangles

    def _corner_normals(self, used, normals=None):
        normals = self._normals if normals is None else normals
        if self._normals_of == "POINT":
            return normals[self._vertices[used]]
        if self._normals_of == "FACE":
            return numpy.repeat(normals, self._totals, axis=0)[used]
        return normals[used]

    def _changes(self, used, shape):
        """What a shape adds to the attributes, as glTF names them."""
        yield "POSITION", (shape.positions - self._positions)[self._vertices[used]]
        if shape.normals_of == self._normals_of:
            yield "NORMAL", self._corner_normals(used, shape.normals) - self._corner_normals(used)

    def _attributes(self, used, exported):
        """As glTF names them."""
        vertices = self._vertices[used]
        yield "POSITION", self._positions[vertices]
        yield "NORMAL", self._corner_normals(used)
        for at, name in enumerate(exported.uv_maps[:2]):
            values = numpy.zeros((len(vertices), 2), numpy.float32)
            known = self.uv_maps[name] if isinstance(name, str) else name.uvs
            if known is not None:
                values[:] = known[used]
                values[:, 1] = 1 - values[:, 1]
            yield f"TEXCOORD_{at}", values
        if exported.colours is not None and self.colours[exported.colours] is not None:
            values, are_of_corners = self.colours[exported.colours]
            values = numpy.clip(values[used if are_of_corners else vertices], 0, 1)  # linear, as glTF's
            values[:, 3] = 1
            yield "COLOR_0", values


def _read_normals(mesh):
    """(of what they are: POINT, FACE or CORNER; the normals)."""
    if hasattr(mesh, "normals_domain"):  # Blender 4.1
        normals_of = mesh.normals_domain
    else:
        are_smooth = _read(mesh.polygons, "use_smooth", 1, bool)
        normals_of = ("CORNER" if mesh.use_auto_smooth else "POINT" if are_smooth.all() else
                      "CORNER" if are_smooth.any() else "FACE")
    if normals_of == "POINT":
        return normals_of, _read(mesh.vertex_normals, "vector", 3, numpy.float32)
    if normals_of == "FACE":
        return normals_of, _read(mesh.polygon_normals, "vector", 3, numpy.float32)
    if hasattr(mesh, "calc_normals_split"):  # Blender 4.0 has corner_normals, too, but they are empty
        mesh.calc_normals_split()
        return normals_of, _read(mesh.loops, "normal", 3, numpy.float32)
    return normals_of, _read(mesh.corner_normals, "vector", 3, numpy.float32)


def _read(items, name, width, kind):
    values = numpy.empty((len(items), width), kind)
    items.foreach_get(name, values.reshape(-1))
    return values


def _size(mesh):
    return len(mesh.vertices), len(mesh.loops), len(mesh.polygons)
