"""Lights of Blender, with Cycles' meaning of watts, size and angle, as lamps of uwvdb."""

import math
import os
import re
import zlib

import bpy
from mathutils import Vector

from . import bands as colours
from . import features, meshes
from .nodes import output_of, source_of

# Cycles multiplies an emission by a luminaire's candelas over this (candelas to watts at 555 nm and
# the sphere's 4 pi, as its IES reader has them).
IES_UNIT = 177.83
# Of a light's sphere: half-shades on surfaces are smooth with any number of points, and each costs as much as a
# lamp in the water. The viewport's drafts take a quarter of them.
SPHERE_POINTS = 8
LEAST_SPREAD = math.radians(1)  # Cycles' own in Blender 3


class Lamps:
    def __init__(self, folder, bands, notes):
        self._folder, self._bands, self._notes = folder, bands, notes
        self._names = set()
        self.entries, self.objects = [], []  # of the section, and the names of their objects

    def add_all(self, depsgraph, to_metres, motion, surface):
        for instance in depsgraph.object_instances:
            if instance.object.type == "LIGHT" and instance.show_self:
                matrix = to_metres @ instance.matrix_world
                poses = motion.rigid_poses(meshes.key_of(instance)) if motion is not None else None
                self._add(instance.object, matrix, poses, surface, to_metres.median_scale)

    def _note(self, shown, text):
        self._notes.add(f"light '{shown.name}': {text}")

    def _add(self, shown, matrix, poses, surface, metres_per_unit):
        light = shown.data
        emission = self._emission(shown, light) if not features.is_portal(light) else None
        if emission is None:
            return
        strength, ies = emission
        energy = light.energy * 2 ** getattr(light, "exposure", 0)  # of Blender 4.4
        watts = [energy * value for value in colours.from_rgb(strength, self._bands)]
        if min(watts) < 0:
            self._note(shown, "is left out: it would take light away, as its Power or Strength is negative")
            return
        if max(strength) == 0:
            return
        if light.type != "POINT" and meshes.axes_of(matrix) < 3:
            self._note(shown, "is left out: its scale is 0")
            return
        entry = {"name": self._name(shown.name)}
        if light.type == "SUN":
            if surface is None:
                self._note(shown, "is left out: a sun needs the place where the water ends, "
                                  "World > Water > Surface")
                return
            if poses is not None:
                self._note(shown, "a sun does not move within the shutter's time")
            axis = -matrix.to_3x3().col[2].normalized()
            entry.update(type="sun", direction=list(axis), irradiance=watts,
                         angle=min(math.degrees(light.angle), 90))
            self._append(shown, entry)
            return
        # Cycles divides watts by squares of units. So does Blender's field of the power, which shows these watts.
        watts = [value * metres_per_unit**2 for value in watts]
        self._place(entry, matrix, poses)
        if light.type == "AREA":
            if light.size * (light.size_y if light.shape in ("RECTANGLE", "ELLIPSE") else light.size) == 0:
                self._note(shown, "is left out: its Size is 0")
                return
            self._shape(shown, entry, light, matrix, poses is not None)
            # W/sr on the axis per watt; the watts of Blender 3 are not those that an area emits.
            factor = 1 / math.pi if bpy.app.version >= (4, 0, 0) else 1 / 4
            has_spread = light.spread < math.pi - 1e-3
            if ies is not None and has_spread:
                self._note(shown, "its spread is left out: its light goes where the IES file says")
            elif has_spread:
                text, greatest = spread_luminaire(light.spread)
                entry["profile"] = {"type": "ies", "file": self._write_luminaire(text)}
                factor *= greatest
                entry["samples"] = _points_for(light.spread)
            elif ies is None:
                entry["profile"] = {"type": "cosine", "fwhm": 120}
        else:
            factor = 1 / (4 * math.pi)
            radius = light.shadow_soft_size * matrix.median_scale
            if radius > 0:
                entry.update(type="sphere", radius=radius, samples=SPHERE_POINTS)
            if light.type == "SPOT":
                entry["profile"] = self._spot(light, matrix)
        if ies is not None:
            file, reference = ies
            if light.type == "AREA":
                self._note(shown, "Cycles dims an area with an IES file by the cosine once more")
            if light.type == "SPOT":
                self._note(shown, "the cone is left out: an IES file has its own")
            # Cycles has a luminaire's horizontal angle 0 along the object's -y.
            turn = -90 if poses is not None else _rotation(matrix, -matrix.to_3x3().col[1])
            entry["profile"] = {"type": "ies", "file": file, "rotate": turn}
            factor *= 4 * math.pi / IES_UNIT * reference
        entry["intensity"] = [value * factor for value in watts]
        self._append(shown, entry)

    def _append(self, shown, entry):
        self.entries.append(entry)
        self.objects.append(shown.name)

    def _name(self, name):
        plain = plain_name(name)
        result, number = plain, 1
        while result in self._names:
            number += 1
            result = f"{plain}_{number}"
        self._names.add(result)
        return result

    @staticmethod
    def _place(entry, matrix, poses):
        """Blender's lights shine along their own -z."""
        if poses is not None:
            entry.update(position=[0, 0, 0], direction=[0, 0, -1], trajectory=poses)
            return
        entry.update(frame="world", position=list(matrix.translation))
        axis = -matrix.to_3x3().col[2].normalized()
        if axis.length > 0:
            entry["direction"] = list(axis)

    def _shape(self, shown, entry, light, matrix, moves):
        scale = matrix.to_scale()
        width = light.size * abs(scale.x)
        is_square = light.shape in ("SQUARE", "DISK")
        height = (light.size if is_square else light.size_y) * abs(scale.y)
        if light.shape in ("DISK", "ELLIPSE"):
            if abs(width - height) > 1e-4 * width:
                self._note(shown, "is a disk of the same area instead of an ellipse")
            entry.update(type="disk", radius=math.sqrt(width * height) / 2)
            return
        entry.update(type="rectangle", width=width, height=height)
        if not moves:
            entry["rotate"] = _rotation(matrix, matrix.to_3x3().col[0])

    @staticmethod
    def _spot(light, matrix):
        # A spot whose object is scaled along its axis has another cone in Cycles, too.
        size, blend = math.degrees(light.spot_size), light.spot_blend
        falloff = "blender" if bpy.app.version >= (3, 5, 0) else "blender-3.4"
        size = min(size, 180)  # Blender's greatest is more by its rounding.
        edge = size * blend / 2
        return {"type": "spot", "beam": size - edge, "edge": edge, "falloff": falloff}

    def _emission(self, shown, light):
        """(linear RGB by which the watts are multiplied, (IES file, its greatest candelas) or None);
        None if the light gives none."""
        colour = [float(c) for c in light.color]
        if getattr(light, "use_temperature", False):  # of Blender 4.5
            colour = [c * float(t) for c, t in zip(colour, light.temperature_color)]
        if not light.use_nodes or light.node_tree is None:
            return colour, None
        output = output_of(light)
        found = source_of(output.inputs["Surface"]) if output is not None else None
        if found is None:
            return None
        node = found[0]
        if node.type != "EMISSION":
            self._note(shown, f"only an Emission node is used, not {node.bl_label}")
            return colour, None
        strength = node.inputs["Strength"]
        value, ies, behind = strength.default_value, None, source_of(strength)
        if behind is not None and behind[0].type == "TEX_IES":
            ies = self._ies(shown, behind[0])
            if ies is not None:
                self._unlinked(shown, behind[0].inputs["Strength"])
                value = behind[0].inputs["Strength"].default_value
        else:
            self._unlinked(shown, strength)
        self._unlinked(shown, node.inputs["Color"])
        return [c * float(t) * float(value) for c, t in zip(colour, node.inputs["Color"].default_value)], ies

    def _unlinked(self, shown, socket):
        if source_of(socket) is not None:
            self._note(shown, f"the nodes behind '{socket.name}' are left out; its own value is taken")

    def _ies(self, shown, node):
        """(file in the scene's folder, greatest candelas) of an IES texture."""
        if node.mode == "INTERNAL":
            text = node.ies.as_string() if node.ies is not None else ""
        else:
            path = bpy.path.abspath(node.filepath)
            try:
                with open(path, encoding="latin-1") as file:
                    text = file.read()
            except OSError as error:
                self._note(shown, f"IES file '{path}': {error.strerror}; the light shines without it")
                return None
        seen = as_cycles_sees(text)
        if seen is None:
            self._note(shown, "its IES file cannot be read; the light shines without it")
            return None
        text, greatest = seen
        return self._write_luminaire(text), greatest

    def _write_luminaire(self, text):
        # The same light has the same file, so that what is known of it in the viewport stays.
        name = f"luminaire-{zlib.crc32(text.encode()):08x}.ies"
        with open(os.path.join(self._folder, name), "w", encoding="latin-1") as file:
            file.write(text)
        return name


def plain_name(name):
    """A light's name as uwvdb has it."""
    return re.sub(r"[^A-Za-z0-9_-]", "_", name)[:60] or "lamp"


def _rotation(matrix, axis):
    """Degrees by which uwvdb turns a rectangle, so that its width lies along an axis, or a luminaire, so
    that its horizontal angle 0 does. Unturned that is the world's x, projected, or y if the lamp shines
    along x; 90 degrees are at x cross direction."""
    direction, axis = -matrix.to_3x3().col[2].normalized(), axis.normalized()
    unturned = Vector((1, 0, 0)) - direction.x * direction
    if unturned.length < 1e-6:
        unturned = Vector((0, 1, 0)) - direction.y * direction
    unturned.normalize()
    return math.degrees(math.atan2(axis.dot(unturned.cross(direction)), axis.dot(unturned)))


def spread_luminaire(spread):
    """(LM-63 text, intensity on the axis over that of a diffuse area) of an area's Spread [rad]. Cycles
    shines through a grid of slats: the radiance falls as tan(half) - tan(angle), for the same watts."""
    half = max(spread, LEAST_SPREAD) / 2
    # The intensity's second derivative is its negative, so that steps of a degree are off by 4e-5.
    steps = max(math.ceil(math.degrees(half)), 16)
    angles = [half * step / steps for step in range(steps)]
    values = [math.cos(a) - math.sin(a) / math.tan(half) for a in angles]
    rows = [[f"{math.degrees(a):.6f}" for a in (*angles, half)] + ["90"],
            [f"{1e4 * value:.3f}" for value in values] + ["0", "0"]]
    text = ("IESNA:LM-63-1995\nTILT=NONE\n"
            f"1 -1 1 {len(rows[0])} 1 1 2 0 0 0\n1 1 1\n{' '.join(rows[0])}\n0\n{' '.join(rows[1])}\n")
    return text, math.tan(half) / (math.tan(half) - half)


def _points_for(spread):
    """Points of an area: the narrower their beams, the more of them overlap into an even one."""
    return int(min(max(64 / math.tan(max(spread, LEAST_SPREAD) / 2) ** 2, 32), 512))


def as_cycles_sees(text):
    """(LM-63 text, its greatest candelas with multiplier and ballast factor); None if it cannot be read.
    Cycles counts horizontal angles the other way round, which matters where they go beyond 180."""
    before, found, rest = text.partition("TILT=")
    lines = rest.splitlines()
    if not found or not lines or lines[0].strip().upper() != "NONE":
        return None
    try:
        words = " ".join(lines[1:]).replace(",", " ").split()
        numbers = [float(word) for word in words]
        vertical, horizontal = int(numbers[3]), int(numbers[4])
        at = 13 + vertical
        angles, values = numbers[at:at + horizontal], numbers[at + horizontal:]
        rows = [values[row * vertical:(row + 1) * vertical] for row in range(horizontal)]
        greatest = numbers[2] * numbers[10] * max(max(row) for row in rows)
        if len(rows[-1]) != vertical:
            return None
    except (ValueError, IndexError):
        return None
    if angles[-1] <= 180:
        return text, greatest
    turned = [words[:10], words[10:13], words[13:at], [f"{360 - a:g}" for a in reversed(angles)]]
    turned += [[f"{value:g}" for value in row] for row in reversed(rows)]
    return f"{before}TILT=NONE\n" + "".join(" ".join(line) + "\n" for line in turned), greatest
