"""Meshes of the evaluated scene, with modifiers, instances and visibility, as a binary glTF file."""

import bpy
import numpy

from . import gltf, materials

SURFACES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
WITHOUT_SURFACE = {"EMPTY", "CAMERA", "LIGHT", "LIGHT_PROBE", "SPEAKER", "ARMATURE", "LATTICE",
                   "VOLUME"}
UNKNOWN = {"CURVES": "hair curves", "HAIR": "hair curves", "POINTCLOUD": "point clouds",
           "GPENCIL": "Grease Pencil", "GREASEPENCIL": "Grease Pencil"}


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


def surfaces(depsgraph):
    """Instances that the render shows as surfaces."""
    for instance in depsgraph.object_instances:
        shown = instance.object
        if not instance.show_self or shown.type not in SURFACES:
            continue
        if shown.type == "MESH" and domain_settings(shown) is not None:
            continue
        yield instance


class MeshFile:
    """The file, and what its numbers of objects and materials stand for in Blender."""

    def __init__(self, notes):
        self.glb = gltf.Glb()
        self.pass_indices, self.material_indices = [], []
        self.keys = []  # of the instances that became nodes, in their order
        self._notes = notes
        self._materials = materials.Exporter(self.glb, notes)
        self._meshes = {}
        self._override = None  # the view layer's material for everything

    @property
    def is_empty(self):
        return not self.pass_indices

    def add_all(self, depsgraph, to_metres, motion):
        self._override = depsgraph.view_layer.material_override
        for instance in depsgraph.object_instances:
            if instance.object.type in UNKNOWN and instance.show_self:
                self._notes.add(f"{UNKNOWN[instance.object.type]} are left out")
            if instance.show_particles and any(s.settings.render_type == "PATH"
                                               for s in instance.object.particle_systems):
                self._notes.add("hair of particle systems is left out")
        for instance in surfaces(depsgraph):
            shown = instance.object
            if not shown.visible_camera:
                self._notes.add(f"'{shown.name}' is not visible to cameras and left out, its shadow, "
                                "too")
                continue
            if shown.is_holdout or shown.is_shadow_catcher:
                self._notes.add(f"'{shown.name}' is a plain surface: holdouts and shadow catchers are "
                                "not supported")
            if not shown.visible_shadow:
                self._notes.add(f"'{shown.name}' casts a shadow here")
            mesh = self._mesh(shown)
            if mesh is None:
                continue
            poses = motion.poses(key_of(instance)) if motion is not None else None
            if poses is None:
                self.glb.add_node(shown.name, mesh, to_metres @ instance.matrix_world)
            else:
                self.glb.add_moving_node(shown.name, mesh, motion.times, poses)
            self.pass_indices.append(shown.pass_index)
            self.keys.append(key_of(instance))
        self.material_indices = self._materials.pass_indices

    def _mesh(self, shown):
        slots = tuple(slot.material for slot in shown.material_slots)
        if self._override is not None:
            slots = (self._override,)
        key = (shown.type, shown.data.as_pointer(),
               tuple(m.name_full if m is not None else "" for m in slots))
        if key not in self._meshes:
            mesh = shown.to_mesh()
            try:
                primitives = self._primitives(shown, mesh, slots) if mesh is not None else []
            finally:
                shown.to_mesh_clear()
            self._meshes[key] = (self.glb.add_mesh(shown.data.name, primitives)
                                 if primitives else None)
        return self._meshes[key]

    def _primitives(self, shown, mesh, slots):
        mesh.calc_loop_triangles()
        triangles = len(mesh.loop_triangles)
        if triangles == 0:
            return []
        corners = numpy.empty(triangles * 3, numpy.int32)
        mesh.loop_triangles.foreach_get("loops", corners)
        corners = corners.reshape(-1, 3)
        which = numpy.zeros(triangles, numpy.int32)
        mesh.loop_triangles.foreach_get("material_index", which)
        which = numpy.clip(which, 0, max(len(slots) - 1, 0))
        attributes = _Attributes(mesh)
        primitives = []
        for index in numpy.unique(which):
            material = slots[index] if slots else None
            if not materials.shows_surface(material):
                self._notes.add(f"the volume of '{shown.name}' is left out: its material has a volume "
                                "shader, but uwvdb takes Volume objects and fluid domains")
                continue
            number, exported = self._materials.export(material)
            used, indices = numpy.unique(corners[which == index], return_inverse=True)
            primitive = {"attributes": {}, "material": number,
                         "indices": self.glb.add_array(indices.reshape(-1))}
            for name, values in attributes.of(exported, used, shown, self._notes):
                primitive["attributes"][name] = self.glb.add_array(values)
            primitives.append(primitive)
        return primitives


class _Attributes:
    """What the corners of a mesh's faces have, as glTF names it."""

    def __init__(self, mesh):
        self._mesh = mesh
        self._vertices = numpy.empty(len(mesh.loops), numpy.int32)
        mesh.loops.foreach_get("vertex_index", self._vertices)
        self._positions = numpy.empty((len(mesh.vertices), 3), numpy.float32)
        mesh.vertices.foreach_get("co", self._positions.reshape(-1))
        self._normals = numpy.empty((len(mesh.loops), 3), numpy.float32)
        if hasattr(mesh, "corner_normals"):  # Blender 4.1
            mesh.corner_normals.foreach_get("vector", self._normals.reshape(-1))
        else:
            mesh.calc_normals_split()
            mesh.loops.foreach_get("normal", self._normals.reshape(-1))

    def of(self, exported, used, shown, notes):
        yield "POSITION", self._positions[self._vertices[used]]
        yield "NORMAL", self._normals[used]
        for at, name in enumerate(exported.uv_maps[:2]):
            layers = self._mesh.uv_layers
            layer = layers.get(name) if name else next((l for l in layers if l.active_render), None)
            values = numpy.zeros((len(self._vertices), 2), numpy.float32)
            if layer is None:
                notes.add(f"'{shown.name}' has no UV map {name!r} for its textures")
            else:
                layer.data.foreach_get("uv", values.reshape(-1))
                values[:, 1] = 1 - values[:, 1]
            yield f"TEXCOORD_{at}", values[used]
        if exported.colours is not None:
            colours = self._colours(exported.colours)
            if colours is None:
                notes.add(f"'{shown.name}' has no colour attribute '{exported.colours}' for its "
                          "material")
            else:
                yield "COLOR_0", colours[used]

    def _colours(self, name):
        """Linear, as glTF has them."""
        known = self._mesh.color_attributes
        attribute = known.get(name) if name else (
            known[known.render_color_index] if len(known) > 0 else None)
        if attribute is None or attribute.domain not in ("POINT", "CORNER"):
            return None
        values = numpy.empty((len(attribute.data), 4), numpy.float32)
        attribute.data.foreach_get("color", values.reshape(-1))
        values = numpy.clip(values, 0, 1)
        values[:, 3] = 1
        return values if attribute.domain == "CORNER" else values[self._vertices]
