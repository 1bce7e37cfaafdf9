"""The program's lines in Blender's words. They name keys of scene files and options of the command line, which are
not seen by whoever renders in Blender."""

import os
import re

# Sections of the scenes that the add-on writes, without the numbers of entries: where Blender has them, and their keys
# there; an empty key is the section itself. {lamp} and {volume} are objects.
SECTIONS = (
    ("camera", "", {
        "": "the camera", "calibration": "Camera > Housing > Calibration", "distortion": "Camera > Lens",
        "intrinsics": "Camera > Lens", "lens": "Camera > Depth of Field",
        "lens.f_number": "Camera > Depth of Field > F-Stop",
        "lens.focal_length": "Camera > Lens > Focal Length", "line_time": "the camera's rolling shutter",
        "lens.focus_distance": "Camera > Depth of Field > Focus Distance", "pose": "the camera's place",
        "resolution": "Output > Format > Resolution", "trajectory": "the camera's animation"}),
    ("camera.port", "Camera > Housing", {
        "": "", "type": "Port", "distance": "Distance", "thickness": "Thickness", "normal": "Tilt", "radius": "Radius",
        "center": "Centre", "n_air": "Index of Air", "n_glass": "Glass", "n_water": "Water",
        "fresnel": "Reflection Losses", "radiance_in": "Radiance In"}),
    ("camera.sensor", "Camera > Sensor", {
        "": "", "exposure": "Exposure", "pixel_pitch": "Pixel Pitch", "mosaic": "Mosaic", "full_well": "Full Well",
        "quantum_efficiency": "Quantum Efficiency", "read_noise": "Read Noise", "dark_current": "Dark Current",
        "bit_depth": "Bits", "seed": "Seed"}),
    ("water", "World > Water", {
        "": "", "preset": "Preset", "salinity": "Salinity", "temperature": "Temperature", "cdom": "Dissolved Matter",
        "chlorophyll": "Chlorophyll", "particles": "Own Particles", "particles.small": "Small Particles",
        "particles.large": "Large Particles", "absorption": "Absorption", "scattering": "Scattering",
        "scattering.phase": "Asymmetry g", "surface": "Surface"}),
    ("water.bands", "Render > uwvdb > Bands", {"": ""}),
    ("water.snow", "World > Water > Marine Snow", {
        "": "", "number": "Number", "diameter": "Diameter", "exponent": "Exponent", "reflectance": "Reflectance",
        "drift": "Drift", "seed": "Seed", "mean": "Mean"}),
    ("water.forward_scatter", "Render > Forward Scatter", {
        "": "", "K": "Strength K", "G": "G", "B": "Width B", "shape": "Shape"}),
    ("lamps", "the lights", {"": ""}),
    ("lamps[]", "light {lamp}", {
        "": "", "intensity": "Power", "irradiance": "Strength", "radius": "Radius", "width": "Size", "height": "Size",
        "angle": "Angle", "direction": "Rotation", "position": "Location", "trajectory": "its animation",
        "profile": "its cone or IES file", "profile.falloff": "Spot Size"}),
    ("volumes", "the volumes", {"": ""}),
    ("volumes.transform", "the volume's Transform", {"": ""}),
    ("volumes[]", "volume {volume}", {
        "": "", "file": "its file", "grids": "Concentrations", "emission": "its material's light",
        "transform": "Transform", "voxel_size": "its resolution"}),
    ("geometry", "the meshes", {"": ""}),
    ("render", "Render > uwvdb", {
        "": "", "integrator": "Integrator", "scattering": "Scattering", "samples": "Samples", "quality": "Quality"}),
    ("render.fps", "Output > Format > Frame Rate", {"": ""}),
    ("render.shutter", "Render > Motion Blur > Shutter", {"": ""}),
)


def _joined(first, second, between):
    return between.join(filter(None, (first, second)))


# Where Blender has a key; of several that one begins with the longest counts.
PLACES = {_joined(section, key, "."): _joined(place, name, ": " if "{" in place else " > ")
          for section, place, keys in SECTIONS for key, name in keys.items()}
# Options, and what they take.
OPTIONS = {
    "quality": ("Render > uwvdb > Quality", "draft|final|exact"),
    "integrator": ("Render > uwvdb > Integrator", "volume|path|reference|planes"),
    "error": ("Render > uwvdb > Until Error", r"[\d.]+"), "samples": ("Render > uwvdb > Samples", r"\d+"),
    "size": ("Output > Format > Resolution", r"\d+x\d+"), "crop": ("Output > Format > Render Region", r"[\d,]+"),
    "threads": ("Render > uwvdb > Threads", r"\d+"), "layers": ("View Layer > Passes", None),
    "frames": ("Output > Frame Range", r"[\d-]+|all"),
}
# What is said in other ways.
PHRASES = (
    (r"add 'lamps'", "add a light"),
    (r"use fewer lamps, fewer `samples` of those with an extent,", "use fewer lights with a Radius or Size,"),
    (r"\bset K: 0, or use integrator volume with render\.scattering: single",
     "set water.forward_scatter.K to 0, or render.scattering: single"),
    (r"\b(write|set|or) K(?:: | to )0", lambda m: f"{m[1].replace('write', 'set')} water.forward_scatter.K to 0"),
    (r"\bwrite mean: added", "choose water.snow.mean: added"),
    (r"remove `volumes` and `water\.profile`, or use integrator volume",
     "hide the volumes, or choose render.integrator: volume"),
    (r"\bfx = (\S+) and cx = (\S+) pixels", r"a focal length of \1 pixels and a centre at \2"),
    (r"\bfx = (\S+) pixels", r"a focal length of \1 pixels"),
    (r"give fx >= \S+, or a distortion of the fisheye model",
     "choose a longer camera.lens.focal_length, or a panoramic Camera > Lens > Type"),
    (r"; names are relative to the scene file's folder", ""),
    (r"\buse integrator volume\b", "choose render.integrator: volume"),
    (r"; choose one: calibration: \{file.*", "; keep one of them in the file"),
    (r"give water: \{surface: \{.*?\}\}", "switch on water.surface"),
    (r"--integrator path with --error", "--integrator path and --error"),
)
# Keys that messages name without the section before them.
SHORT = {"lens": "camera.lens", "port": "camera.port", "sensor": "camera.sensor", "distortion": "camera.distortion",
         "intrinsics": "camera.intrinsics", "forward_scatter": "water.forward_scatter", "snow": "water.snow",
         "transform": "volumes.transform"}
ROOTS = "|".join([*(key for key in PLACES if not re.search(r"[.\[]", key)), *SHORT])
VALUES = "single|multiple|volume|path|reference|planes|draft|final|exact|included|added"
PATH = re.compile(rf"(?<![\w/.'>-])({ROOTS})((?:\[\d+\]|\.[A-Za-z_][\w-]*)+)(: (?:{VALUES})\b)?")
# What only scene files and command lines have: it is left out of advice, and said in plain words where it is no advice.
CODE = re.compile(r"--[a-z]|[`{}]|\b[A-Za-z]*[a-z0-9]_[a-z]\w*|(?<![\w/.])[a-z]+(?:\[\d*\])?(?:\.[a-z_]+)+\b|"
                  r"\b(?:add|give|write|set|remove|leave|another|without|with|or) '?[a-z]+'?(?:: |:$|'(?= |$|,))|"
                  r"'[a-z]+: |\b[a-z]+: (?:true|false|all|[\d\[])")
LINK = re.compile(r"volume(\d+)-[0-9a-f]{8}\.vdb")
LIGHT_OF_VOLUME = re.compile(r"'?\bvolume(\d+)-[A-Za-z0-9-]+'?")
FILES = "n?vdb|yaml|glb|csv|exr|png|jpe?g|tiff?|ies|txt|md|json|obj|ply"
QUOTED = re.compile(r"(?<!\w)'[^'{}]*[/.~][^'{}]*'(?!\w)|(?<=grid )'[^']*'|(?<=light )'[^']*'|(?<=volume )'[^']*'|"
                    rf"(?<![\w.])/[^ :;,]+|(?<![\w./])[\w-]+\.(?:{FILES})\b")


class Words:
    """Translates the lines about one scene in a folder. `lamps` are the names of the objects of its lamps, `volumes`
    the names and files of its volumes, in the scene's order."""

    def __init__(self, folder="", lamps=(), volumes=()):
        self._folder, self._lamps, self._volumes = folder, list(lamps), list(volumes)

    def why(self, refusal):
        """The text of a Refusal, whoever it is by."""
        return self.of(str(refusal)) if refusal.is_by_program else str(refusal)

    def of(self, line):
        """A line without the place in a scene file, in Blender's words."""
        line = line.strip().removeprefix("uwvdb: ")
        line = re.sub(r"(^|(?<= ))(?:[^ ]*/)?scene\.yaml(?::\d+:\d+)?: ", "", line)
        if self._folder:
            line = line.replace(self._folder.rstrip(os.sep) + os.sep, "")
        line = re.sub(r"\b(?:image|left|right)/", "", line)
        line = re.sub(r"[\w-]*-meshes\.glb|\bmeshes\d+\.glb", "the meshes", line)
        line = re.sub(r"luminaire-[0-9a-f]{8}\.ies", "the light's IES file", line)
        line = LINK.sub(lambda m: self._volume(int(m[1]), 1), line)
        line = LIGHT_OF_VOLUME.sub(lambda m: f"the light of volume '{self._volume(int(m[1]), 0)}'", line)
        for pattern, text in PHRASES:
            line = re.sub(pattern, text, line)
        kept = []  # names and files stay as they are

        def keep(match):
            kept.append(match[0])
            return f"\0{len(kept) - 1}\0"

        line = self._section(re.sub(r"(?<=\0 has )[^;]*", keep, QUOTED.sub(keep, line)))
        line = re.sub(r"--set (\S+?)=(\w+)", r"\1: \2", line)
        line = re.sub(r"--([a-z-]+)(?: (\w[\w.,-]*))?", self._option, line)
        line = self._without_code(PATH.sub(self._path, line))
        for number in reversed(range(len(kept))):  # the later ones may hold the earlier
            line = line.replace(f"\0{number}\0", kept[number])
        return line

    def _volume(self, number, part):
        return self._volumes[number][part] if number < len(self._volumes) else "volume"

    def _section(self, line):
        """A line that begins with a section alone, such as 'camera: '."""
        found = re.match(rf"({ROOTS}): ", line)
        return f"{self._place(found[1])}: {line[found.end():]}" if found else line

    def _place(self, path):
        first = re.match(r"[a-z_]+", path)[0]
        number = re.match(r"[a-z]+\[(\d+)\]", path)
        plain = re.sub(r"\[\d+\]", "[]", SHORT.get(first, first) + path[len(first):])
        best = max((key for key in PLACES if plain == key or re.match(re.escape(key) + r"[.\[]", plain)), key=len)
        names = {"lamp": [f"'{name}'" for name in self._lamps], "volume": [f"'{v[0]}'" for v in self._volumes]}
        at = int(number[1]) if number else 0
        return PLACES[best].format(**{kind: of[at] if at < len(of) else f"{at + 1}" for kind, of in names.items()})

    def _path(self, match):
        value = match[3]
        value = re.sub(r"[a-z]", lambda m: m[0].upper(), value, count=1) if value else ""
        return self._place(match[1] + match[2]) + value

    @staticmethod
    def _option(match):
        name, value = match[1], match[2]
        if name not in OPTIONS:
            return match[0]
        place, takes = OPTIONS[name]
        if value and takes and re.fullmatch(takes, value.rstrip(",.")):
            return f"{place}: {value[0].upper()}{value[1:]}"
        return place + (f" {value}" if value else "")

    @staticmethod
    def _without_code(line):
        what, *advice = re.split(r"; ", line)
        what = re.sub(r"--([a-z-]+)", lambda m: m[1].replace("-", " "), what)
        what = re.sub(r"(?<![\w/.])(?:[a-z_]+(?:\[\d*\])?\.)+(?=[a-z_]+\b)", "", what)
        what = re.sub(r"(?<=[a-z0-9])_(?=[a-z0-9])", " ", re.sub(r"[`{}]", "", what))
        what = re.sub(r"(?<!\w)'([a-z ]+)'(?!\w)", r"\1", what)
        return "; ".join([what, *(text for text in advice if not CODE.search(text))])
