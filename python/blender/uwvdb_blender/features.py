"""What of Blender a render leaves out, in one table: each feature that a scene uses is said once. What becomes of nodes
is said where they are read: materials.py, lamps.py, emission.py."""

import itertools

import numpy
from mathutils import Vector

from . import units, water
from .meshes import SURFACES, UNKNOWN, domain_settings, of_collection, shower_of
from .notes import Refusal

RAYS = ("visible_diffuse", "visible_glossy", "visible_transmission", "visible_volume_scatter")
# Of Blender's passes those that are made, and what are no passes.
PASSES = {"combined", "z", "position", "normal", "vector", "object_index", "material_index", "cryptomatte_object",
          "cryptomatte_material", "cryptomatte_accurate"}
NAMES_SAID = 3  # of the objects that have a feature


class Scene:
    """What the table is asked about. `clipping` is the camera's evaluated object, or None where it takes too long to
    look at clipping distances; `moments` is a Motion or None."""

    def __init__(self, depsgraph, clipping, moments):
        self.scene, self.layer = depsgraph.scene, depsgraph.view_layer
        self.clipping, self.moments = clipping, moments


class Feature:
    """`of` is the kind of what has it: objects are lights, surfaces, plumes, or shown as one of these two.
    `is_used(thing, scene)` is whether that uses it, for objects with the object that shows it as well; `says` is what
    is said, after the names of objects."""

    def __init__(self, of, says, is_used):
        self.of, self.says, self.is_used = of, says, is_used


def cycles(thing, name, default):
    """A setting that is the add-on Cycles' own in some versions, and Blender's in others."""
    for owner in (thing, getattr(thing, "cycles", None)):
        if owner is not None and hasattr(owner, name):
            return getattr(owner, name)
    return default


def is_portal(light):
    return light.type == "AREA" and cycles(light, "is_portal", False)


def _kinds_of(shown):
    if shown.type == "LIGHT":
        return ("light",)
    if shown.type == "VOLUME" or shown.type == "MESH" and domain_settings(shown) is not None:
        return ("object", "shown", "plume")
    return ("object", "shown", "surface") if shown.type in SURFACES else ("object",)


def _background(world):
    """Whether the background gives light."""
    if not world.use_nodes or world.node_tree is None:
        return max(world.color) > 0
    return any(node.type == "BACKGROUND" and (
        node.inputs["Strength"].is_linked or node.inputs["Strength"].default_value > 0) and (
        node.inputs["Color"].is_linked or max(node.inputs["Color"].default_value[:3]) > 0)
        for node in world.node_tree.nodes)


def _world_volume(world, scene):
    """Whether a world has a volume shader that is not what World > Water has."""
    if not water.has_volume(world):
        return False
    try:
        return not water.of_volume(world, units.metres_per_unit(scene)).are_of(world.uwvdb)
    except Refusal:
        return True


def _shadowless(light):
    return not getattr(light, "use_shadow", True) or not cycles(light, "cast_shadow", True)


def _curve_of_shutter(render):
    curve = getattr(render, "motion_blur_shutter_curve", None)
    return curve is not None and any(abs(point.location[1] - 1) > 1e-3 for point in curve.curves[0].points)


def _other_passes(layer):
    return [item.name for item in layer.bl_rna.properties if item.identifier.startswith("use_pass_")
            and item.identifier.removeprefix("use_pass_") not in PASSES and getattr(layer, item.identifier)]


def _is_beyond_clipping(shown, scene):
    """Whether a surface reaches beyond the camera's Clip End, or is nearer than its Clip Start."""
    camera = scene.clipping
    if camera is None or camera.type != "CAMERA":
        return False
    data, view = camera.data, camera.matrix_world.normalized().inverted()
    corners = [view @ shown.matrix_world @ Vector(corner) for corner in shown.bound_box]
    if max(-corner.z for corner in corners) > data.clip_end * 1.001:
        return True
    if shown.type != "MESH" or abs(shown.matrix_world.determinant()) < 1e-12:
        return False
    place = numpy.array(shown.matrix_world.inverted() @ camera.matrix_world.translation)
    reach = data.clip_start / (abs(shown.matrix_world.to_3x3().determinant()) ** (1 / 3))
    box = numpy.array([corner[:] for corner in shown.bound_box])
    if (numpy.maximum(box.min(axis=0) - place, place - box.max(axis=0)) > reach).any():
        return False
    return len(shown.data.polygons) > 0 and shown.closest_point_on_mesh(Vector(place), distance=reach)[0]


TABLE = (
    # What is shown, as surfaces or plumes.
    Feature("shown", "not visible to cameras: left out, and so is its shadow", lambda o, by, s: not o.visible_camera),
    Feature("shown", "in a collection that is Indirect Only: left out, and so are its shadow and its light",
            lambda o, by, s: o.visible_camera and of_collection(by, "indirect_only_get", s.layer)),
    Feature("plume", "shown like any other: holdouts of volumes, and of collections with them, are left out",
            lambda o, by, s: o.is_holdout or of_collection(by, "holdout_get", s.layer)),
    Feature("surface", "shown like any other: shadow catchers are left out", lambda o, by, s: o.is_shadow_catcher),
    Feature("shown", "casts a shadow here, although its Ray Visibility has none",
            lambda o, by, s: not o.visible_shadow),
    Feature("shown", "visible to all light: here, Ray Visibility has an effect for cameras only",
            lambda o, by, s: not all(getattr(o, rays) for rays in RAYS)),
    Feature("surface", "changes its vertices or faces in number, which motion blur and the Vector pass leave out",
            lambda o, by, s: s.moments is not None and o.name_full in s.moments.changing),
    Feature("shown", "blurred as it moves, although its own Motion Blur is off",
            lambda o, by, s: s.scene.render.use_motion_blur and not cycles(o, "use_motion_blur", True)),
    Feature("shown", "not culled: Camera Cull and Distance Cull are left out",
            lambda o, by, s: s.scene.render.use_simplify and any(
                cycles(s.scene, f"use_{kind}_cull", False) and cycles(o, f"use_{kind}_cull", False)
                for kind in ("camera", "distance"))),
    Feature("surface", "reaches beyond the camera's Clip Start or End, which have no effect here",
            lambda o, by, s: _is_beyond_clipping(o, s)),
    # Objects of other kinds.
    Feature("object", "left out: hair curves and point clouds are not shown", lambda o, by, s: o.type in UNKNOWN),
    Feature("object", "drawn by Blender over the picture, without water",
            lambda o, by, s: o.type in ("GPENCIL", "GREASEPENCIL")),
    Feature("object", "shown without the hair of its particle systems",
            lambda o, by, s: any(p.settings.render_type == "PATH" for p in o.particle_systems)),
    Feature("plume", "left out: it has no file; volumes that Geometry Nodes or modifiers make are not shown",
            lambda o, by, s: o.type == "VOLUME" and not o.data.filepath),
    Feature("plume", "shown as its file has it: modifiers of volumes are left out",
            lambda o, by, s: o.type == "VOLUME" and o.data.filepath and len(o.modifiers) > 0),
    # Lights.
    Feature("light", "left out: portals give no light of their own", lambda o, by, s: is_portal(o.data)),
    Feature("light", "casts shadows here although they are switched off", lambda o, by, s: _shadowless(o.data)),
    Feature("light", "lights everything: its Ray Visibility is left out",
            lambda o, by, s: not all(getattr(o, rays) for rays in RAYS)),
    Feature("light", "lights everything, whatever it is linked to", lambda o, by, s: (
        getattr(o, "light_linking", None) is not None
        and bool(o.light_linking.receiver_collection or o.light_linking.blocker_collection))),
    # The camera.
    Feature("camera", "the aperture is a circle: its blades and ratio are left out", lambda c, s: (
        c.dof.use_dof and c.type == "PERSP" and (c.dof.aperture_blades > 0 or c.dof.aperture_ratio != 1))),
    Feature("camera", "depth of field is left out, as a fisheye has none here",
            lambda c, s: c.dof.use_dof and c.type == "PANO"),
    Feature("camera", "spherical stereo is left out: both eyes look the same way everywhere", lambda c, s: (
        s.scene.render.use_multiview and c.type == "PANO" and c.stereo.use_spherical_stereo)),
    # The world.
    Feature("world", "the world's background gives no light under water", lambda w, s: _background(w)),
    Feature("world", "the world's volume shader is left out: the water is that of World > Water, where From Volume "
                     "Shader reads it", lambda w, s: _world_volume(w, s.scene)),
    # The view layer.
    Feature("layer", "View Layer > Filter is left out: surfaces, volumes and motion blur are shown",
            lambda v, s: not all(getattr(v, f"use_{kind}", True) for kind in ("solid", "volumes", "motion_blur"))),
    Feature("layer", "some passes are not made; View Layer > Passes lists those that are",
            lambda v, s: bool(_other_passes(v)) or len(getattr(v, "aovs", ())) > 0),
    Feature("layer", "light groups make no passes: View Layer > Passes > Lamps has each light by itself",
            lambda v, s: len(getattr(v, "lightgroups", ())) > 0),
    Feature("layer", "the view layer's World Override is left out",
            lambda v, s: getattr(v, "world_override", None) is not None),
    # The render.
    Feature("scene", "Film > Exposure of Cycles is left out: Render > Color Management > Exposure has the same effect",
            lambda r, s: abs(cycles(r, "film_exposure", 1) - 1) > 1e-6),
    Feature("scene", "Film > Transparent is left out: there is water behind everything",
            lambda r, s: r.render.film_transparent),
    Feature("scene", "the shutter opens at once: its curve is left out",
            lambda r, s: r.render.use_motion_blur and _curve_of_shutter(r.render)),
    Feature("scene", "all rows are exposed at once: the rolling shutter is left out",
            lambda r, s: r.render.use_motion_blur and cycles(r, "rolling_shutter_type", "NONE") != "NONE"),
    Feature("scene", "Blender draws Freestyle's lines over the picture, with no water in front of them",
            lambda r, s: r.render.use_freestyle and s.layer.use_freestyle),
)


OF_KIND = {kind: [feature for feature in TABLE if feature.of == kind]
           for kind in ("light", "object", "shown", "surface", "plume")}


def note_all(depsgraph, notes, camera, moments, is_view=False):
    """Adds a note for each feature of the table that the evaluated scene uses. `camera` is an evaluated object or None,
    `moments` a Motion or None; a view, which is described again and again, does not look at clipping distances."""
    scene = Scene(depsgraph, None if is_view else camera, moments)
    things = {"scene": scene.scene, "layer": scene.layer, "world": scene.scene.world,
              "camera": camera.data if camera is not None and camera.type == "CAMERA" else None}
    for feature in TABLE:
        thing = things.get(feature.of)
        if thing is not None and feature.is_used(thing, scene):
            notes.add(feature.says)
    names, seen = {}, set()
    for instance in depsgraph.object_instances:
        shown, shower = instance.object, shower_of(instance)
        key = (shown.name_full, shower.name_full)
        if key in seen or not (instance.show_self or instance.show_particles):
            continue
        seen.add(key)
        for feature in itertools.chain.from_iterable(map(OF_KIND.__getitem__, _kinds_of(shown))):
            if feature.is_used(shown, shower, scene):
                known = names.setdefault(feature, [])
                if shown.name not in known:
                    known.append(shown.name)
    for feature, users in names.items():
        said = ", ".join(f"'{name}'" for name in users[:NAMES_SAID])
        more = f" and {len(users) - NAMES_SAID} more" if len(users) > NAMES_SAID else ""
        notes.add(f"{'light ' if feature.of == 'light' else ''}{said}{more}: {feature.says}")
