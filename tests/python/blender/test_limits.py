# ctest labels: unit slow
"""Every setting at the ends of what Blender permits gives an image, or a refusal in Blender's words."""

from plumes import *
from support import *
from test_words import keys, left

PLUME = ROOT / "assets/grids/plume128_blosc_half_0030.vdb"
FAR = 1e12  # what stands for Blender's greatest numbers
OF_BLENDER = {
    "camera": ("lens", "sensor_width", "shift_x", "shift_y", "clip_start", "clip_end", "type"),
    "dof": ("use_dof", "focus_distance", "aperture_fstop"),
    "light": ("energy", "color", "shadow_soft_size", "spot_size", "spot_blend", "angle", "size", "size_y", "spread",
              "shape"),
    "render": ("motion_blur_shutter", "border_min_x", "border_max_x", "border_min_y", "border_max_y"),
    "lamp": ("scale", "location"), "plume": ("scale", "location"), "mesh": ("scale", "location"),
    "unit": ("scale_length",),
}


def full_scene(kind="POINT"):
    scene = empty_scene(8, 6)
    world = scene.world.uwvdb
    world.kind, world.use_surface, scene.uwvdb.quality = "PRESET", True, "DRAFT"
    shape = box("Block", location=(0, 3, 0), rotation=(0.3, 0.2, 0.5))
    shape.data.materials.append(material("White")[0])
    lamp = light(kind, location=(1, 1, 1))
    plume = volume_object(PLUME, location=(-3, 7, -1))
    camera = scene.camera.data
    return scene, {"scene": scene.uwvdb, "world": world, "housing": camera.uwvdb, "grid": plume.uwvdb.grids[0],
                   "camera": camera, "dof": camera.dof, "light": lamp.data, "lamp": lamp, "plume": plume, "mesh": shape,
                   "render": scene.render, "unit": scene.unit_settings}


def ends_of(item):
    if item.type == "BOOLEAN":
        return [False, True]
    if item.type == "ENUM":
        return [choice.identifier for choice in item.enum_items]
    if item.type not in ("FLOAT", "INT"):
        return []
    ends = {max(min(end, FAR), -FAR) if item.type == "FLOAT" else end
            for end in (item.hard_min, item.hard_max, item.soft_min, item.soft_max)}
    if item.identifier == "samples":  # that many would take long
        ends = {end for end in ends if end <= 16}
    return [[end] * item.array_length if item.is_array else end for end in ends]


def without_faults(engine):
    """Blender prints errors of Python in an engine, and goes on: here they are raised afterwards."""
    faults, render_as_it_is = [], engine.UwvdbEngine._render

    def watched(self, *arguments):
        try:
            render_as_it_is(self, *arguments)
        except (sys.modules["uwvdb_blender.notes"].Refusal, OSError):
            raise
        except Exception as fault:
            faults.append(fault)

    engine.UwvdbEngine._render = watched
    try:
        bpy.ops.render.render()
    finally:
        engine.UwvdbEngine._render = render_as_it_is
    if faults:
        raise faults[0]


def settles(what, known):
    """Renders; all that is said is in Blender's words."""
    try:
        without_faults(sys.modules["uwvdb_blender.engine"])
        told = list(notes())
    except RuntimeError as error:
        told = [str(error).strip().removeprefix("Error: ")]
        assert "Traceback" not in told[0], (what, told)
    for line in told:
        assert not left(line.removeprefix("uwvdb: "), known), (what, line)
        assert "uwvdb-blender-" not in line and "scene.yaml" not in line, (what, line)
    return told


def walk(name, kinds=("POINT",), before=((),)):
    known, count, refused = keys(), 0, set()
    for kind in kinds:
        for setting in before:
            _, owners = full_scene(kind)
            owner = owners[name]
            if setting:
                setattr(owner, *setting)
            for item in owner.bl_rna.properties:
                chosen = OF_BLENDER.get(name)
                if item.is_readonly or item.identifier in ("name", "rna_type") or (
                        chosen is not None and item.identifier not in chosen):
                    continue
                old = getattr(owner, item.identifier)
                old = list(old) if getattr(item, "is_array", False) else old
                for end in ends_of(item):
                    setattr(owner, item.identifier, end)
                    told = settles((name, kind, setting, item.identifier, end), known)
                    count += 1
                    refused |= {line for line in told if line.startswith("uwvdb: ")}
                setattr(owner, item.identifier, old)
    print(f"    {name}: {count} renders; refused: {len(refused)}")
    for line in sorted(refused):
        print(f"        {line}")
    assert count > 1


def test_lights():
    walk("light", ("POINT", "SPOT", "AREA", "SUN"))
    walk("lamp", ("AREA", "SPOT"))


def test_objects_and_units():
    for name in ("plume", "mesh", "unit", "grid"):
        walk(name)


def test_scales_of_0():
    """What an animation shrinks to nothing is left out, and does not end it; a point lights as in Cycles."""
    for scale in ((0, 0, 0), (1, 0, 0), (0, 1, 1), (1, 1, 0)):
        for kind in ("POINT", "SPOT", "AREA", "SUN"):
            _, owners = full_scene(kind)
            for name in ("lamp", "plume", "mesh"):
                owners[name].scale = scale
            told = settles((scale, kind), keys())
            assert not any(line.startswith("uwvdb: ") for line in told), (scale, kind, told)
            assert any("'Plume' is left out: its scale is 0" in line for line in told), told
            assert any("'Light': is left out: its scale is 0" in line for line in told) == (kind != "POINT"), told


def test_cameras():
    walk("camera")
    walk("dof", before=(("use_dof", True),))
    walk("housing", before=(("housing", "FLAT"), ("housing", "DOME"), ("use_sensor", True)))


def test_water():
    walk("world", before=(("kind", "CONSTITUENTS"), ("kind", "COEFFICIENTS"), ("use_snow", True)))


def test_renders():
    walk("scene", before=((), ("integrator", "PATH"), ("use_forward_scatter", True)))
    walk("render", before=(("use_motion_blur", True), ("use_border", True)))
