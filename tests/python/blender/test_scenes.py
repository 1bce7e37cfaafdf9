# ctest labels: metamorphic
"""The scene as Blender has it: against the same scene written by hand, against what Cycles sees of it,
and over time."""

import re
import sys
import time

from support import *

PLUME = ROOT / "assets/grids/plume128_blosc_half_0030.vdb"


def test_same_as_a_scene_written_by_hand():
    """Water, plume, lamps and port, once by the add-on and once in uwvdb's own words, y up."""
    scene = empty_scene(96, 64)
    world = scene.world.uwvdb
    world.kind, world.preset, world.use_particles = "PRESET", "jerlov-III", True
    world.small, world.large = 0.05, 0.1
    camera = scene.camera
    camera.location, camera.rotation_euler = (0.2, -3, 1.1), (math.radians(82), 0, math.radians(-6))
    camera.data.angle = math.radians(60)
    housing = camera.data.uwvdb
    housing.housing, housing.distance, housing.thickness = "FLAT", 0.02, 0.04
    box("Block", size=(0.5, 0.5, 0.5), location=(0.4, 0.6, 0.25)).data.materials.append(
        material("Red", (0.6, 0.3, 0.2))[0])
    square("Floor", size=30).data.materials.append(material("Sand", (0.5, 0.45, 0.35))[0])
    light("POINT", "Left", 300, (-1.5, -1, 2))
    light("SPOT", "Right", 800, (1.5, -0.5, 2), (0.3, 0.6, 0), spot_size=1.2, spot_blend=0.3)
    data = bpy.data.volumes.new("Plume")
    data.filepath = str(PLUME)
    plume = add("Plume", data, (-1, 0.5, 0.2), (0, 0, 0.2), (0.4, 0.4, 0.4))
    grid = plume.uwvdb.grids.add()
    grid.name, grid.small, grid.large = "density", 2, 3
    layer = scene.view_layers[0]
    layer.use_pass_z = layer.uwvdb.use_backscatter = layer.uwvdb.use_direct = True
    scene.uwvdb.samples = 1
    ours = render()

    def y_up(v):
        return [v[0], v[2], -v[1]]

    def aim(rotation):
        return y_up(Euler(rotation).to_matrix() @ Vector((0, 0, -1)))

    text = {
        "uwvdb": 1,
        "camera": {"resolution": [96, 64], "intrinsics": {"fov_x": 60},
                   "port": {"type": "flat", "distance": 0.02, "thickness": 0.04},
                   "pose": {"position": y_up(camera.location), "look_at": (
                       Vector(y_up(camera.location)) + Vector(aim(camera.rotation_euler)))[:]}},
        "water": {"preset": "jerlov-III", "particles": {"small": 0.05, "large": 0.1}},
        "volumes": [{"file": str(PLUME), "grids": {"density": {"small": 2, "large": 3}}, "transform": {
            "scale": 0.4, "rotate": [0, math.degrees(0.2), 0], "translate": [-1, 0.2, -0.5]}}],
        "geometry": [{"type": "box", "min": [0.15, 0, -0.85], "max": [0.65, 0.5, -0.35],
                      "reflectance": [0.6, 0.3, 0.2]},
                     {"type": "box", "min": [-15, -1, -15], "max": [15, 0, 15],
                      "reflectance": [0.5, 0.45, 0.35]}],
        "lamps": [{"name": "left", "position": y_up((-1.5, -1, 2)), "frame": "world", "power": 300},
                  {"name": "right", "position": y_up((1.5, -0.5, 2)), "frame": "world",
                   "direction": aim((0.3, 0.6, 0)), "intensity": 800 / (4 * math.pi),
                   "profile": {"type": "spot", "beam": math.degrees(1.2) * 0.85,
                               "edge": math.degrees(1.2) * 0.15,
                               "falloff": "blender" if bpy.app.version >= (3, 5, 0) else "blender-3.4"}}],
        "render": {"samples": 1}}
    with tempfile.TemporaryDirectory() as folder:
        with open(f"{folder}/hand.yaml", "w") as file:
            json.dump(text, file)
        uwvdb("render", "hand.yaml", "-o", "hand.exr", "--layers", "depth,backscatter,direct",
              "--compression", "none", folder=folder)
        image = sys.modules["uwvdb_blender.exr"].read(f"{folder}/hand.exr")
    wanted = image.get("", "RGBA")
    close(ours["Depth"][..., 0], image.get("depth", "Z")[..., 0], 1e-5, "depth",
          image.get("depth", "Z")[..., 0] > 0)
    close(ours["backscatter"], image.get("backscatter", "RGB"), 2e-3, "backscatter")
    off = numpy.abs(ours["Combined"] - wanted).max(axis=-1) / wanted[..., :3].max()
    print(f"    combined: {(off > 1e-3).sum()} pixels differ by more than 1e-3 of the greatest")
    assert (off > 1e-3).mean() < 0.005, "more than the edges differ"


def crowd():
    """Modifiers, instances of collections, of vertices and of geometry nodes, curves and text."""
    scene = empty_scene(120, 90)
    scene.camera.location = (0, -6, 0)
    scene.view_layers[0].use_pass_object_index = scene.view_layers[0].use_pass_position = True
    cube = box("Bent", size=(0.8, 0.8, 0.8), location=(-1.2, 0, 0.9), rotation=(0.4, 0.5, 0.1))
    cube.modifiers.new("Round", "SUBSURF").render_levels = 2
    array = cube.modifiers.new("Row", "ARRAY")
    array.count, array.relative_offset_displace = 2, (1.3, 0.1, 0.2)
    cube.pass_index = 3

    group = bpy.data.collections.new("Group")
    inner = box("Inner", size=(0.3, 0.3, 0.7), rotation=(0.2, 0.3, 0))
    scene.collection.objects.unlink(inner)
    group.objects.link(inner)
    inner.pass_index = 5
    for x in (0.3, 1.1):
        holder = add(f"Holder{x}", None, (x, 0.5, 0.9), (0.3, 0, x), (1, 1, 1.3))
        holder.instance_type, holder.instance_collection = "COLLECTION", group

    bearer = square("Bearer", size=1, location=(-1.1, 0, -0.9), rotation=(1.2, 0, 0))
    bearer.instance_type, bearer.show_instancer_for_render = "VERTS", False
    child = box("Child", size=(0.25, 0.25, 0.25))
    child.parent = bearer
    child.pass_index = 7

    text = bpy.data.curves.new("Text", "FONT")
    text.body, text.extrude, text.size = "uw", 0.05, 0.9
    add("Text", text, (0.2, 0, -1.2), (math.pi / 2, 0, 0)).pass_index = 9

    ring = bpy.data.curves.new("Ring", "CURVE")
    ring.dimensions, ring.bevel_depth = "3D", 0.06
    spline = ring.splines.new("NURBS")
    spline.points.add(5)
    for at, point in enumerate(spline.points):
        point.co = (0.5 * math.cos(at), 0.3, 0.5 * math.sin(at), 1)
    spline.use_cyclic_u = True
    add("Ring", ring, (1.8, 0, 0)).pass_index = 11

    hidden = box("Hidden", size=(3, 0.1, 3), location=(0, -2, 0))
    hidden.hide_render = True
    excluded = bpy.data.collections.new("Excluded")
    scene.collection.children.link(excluded)
    box_in = box("AlsoHidden", size=(3, 0.1, 3), location=(0, -2, 0))
    scene.collection.objects.unlink(box_in)
    excluded.objects.link(box_in)
    scene.view_layers[0].layer_collection.children["Excluded"].exclude = True
    return scene


def test_silhouettes_and_objects_against_cycles():
    crowd()
    ours, theirs = render(), render("CYCLES", samples=1)
    found, wanted = ours["IndexOB"][..., 0], theirs["IndexOB"][..., 0]
    seen = sorted(set(wanted.ravel()))
    assert seen == [0, 3, 5, 7, 9, 11], seen
    differ = (found != wanted).mean()
    print(f"    {(wanted > 0).mean():.1%} of the pixels see something, {differ:.3%} something else")
    assert differ < 0.002, f"{differ:.2%} of the pixels see other objects"
    both = (found > 0) & (found == wanted)
    close(ours["Position"], theirs["Position"], 1e-3, "position", both)


def test_what_cannot_be_shown_is_named_once():
    scene = empty_scene()
    scene.frame_start, scene.frame_end = 1, 2
    scene.world.use_nodes = True
    scene.world.node_tree.nodes.new("ShaderNodeBackground")
    frosted, _, _, shader = material("Frosted", shader="ShaderNodeBsdfGlass")
    shader.inputs["Roughness"].default_value = 0.5
    square(location=(0, 3, 0)).data.materials.append(frosted)
    light("SUN")
    render()
    told = " | ".join(notes())
    for words in ("background gives no light", "'Frosted': rough glass is shown as smooth", "needs the place where the water"):
        assert words in told, (words, told)


def test_says_what_single_scattering_leaves_out():
    scene = empty_scene(32, 24)
    scene.world.uwvdb.kind, scene.world.uwvdb.preset = "PRESET", "jerlov-5C"
    square("Wall", size=20, location=(0, 2, 0), rotation=(math.pi / 2, 0, 0))
    light("POINT", "Lamp", 300, (0.5, 0, 0))
    render()
    told = [note for note in notes() if note.startswith("single scattering leaves out")]
    assert len(told) == 1 and "Render > uwvdb > Scattering: Multiple renders it" in told[0], notes()
    scene.uwvdb.property_unset("scattering")
    assert scene.uwvdb.scattering == "MULTIPLE"
    scene.uwvdb.quality = "DRAFT"
    render()
    assert not any("leaves out" in note for note in notes()), notes()


def test_keyframes_are_those_of_each_frame():
    """An animated object, light, water and housing give what the same settings give at rest."""
    scene = empty_scene()
    scene.world.uwvdb.kind = "CONSTITUENTS"
    cube = box(location=(0, 4, 0), rotation=(0.3, 0.2, 0.5))
    lamp = light("POINT", location=(1, 1, 1))
    housing = scene.camera.data.uwvdb
    housing.housing = "FLAT"
    for frame, (x, watts, small, distance) in {1: (0, 50, 0.1, 0.02), 11: (1, 250, 0.9, 0.22)}.items():
        cube.location.x, lamp.data.energy = x, watts
        scene.world.uwvdb.small, housing.distance = small, distance
        cube.keyframe_insert("location", frame=frame)
        lamp.data.keyframe_insert("energy", frame=frame)
        scene.world.keyframe_insert("uwvdb.small", frame=frame)
        scene.camera.data.keyframe_insert("uwvdb.distance", frame=frame)
    for action in bpy.data.actions:
        for curve in action.fcurves:
            for key in curve.keyframe_points:
                key.interpolation = "LINEAR"
    moved = render(frame=6)["Combined"]
    for owner in (cube, lamp.data, scene.world, scene.camera.data):
        owner.animation_data_clear()
    cube.location.x, lamp.data.energy = 0.5, 150
    scene.world.uwvdb.small, housing.distance = 0.5, 0.12
    rested = render()["Combined"]
    close(moved, rested, 1e-5, "animated")
    housing.distance = 0.02
    assert numpy.abs(render()["Combined"] - rested).max() > 1e-3 * rested[..., :3].max()


def test_vector_pass_against_cycles():
    scene = empty_scene()
    scene.render.use_motion_blur = False
    scene.view_layers[0].use_pass_vector = True
    camera = scene.camera
    cube = box(location=(0, 5, 0), rotation=(0.3, 0.2, 0.5), size=(2, 2, 2))
    square(size=40, location=(0, 9, 0), rotation=(math.pi / 2, 0, 0))
    for frame in (1, 4, 7):
        cube.location, cube.rotation_euler.z = (0.1 * frame, 5, 0.03 * frame**2), 0.05 * frame
        camera.location.x, camera.rotation_euler.z = 0.02 * frame**2, 0.01 * frame
        for owner, what in ((cube, "location"), (cube, "rotation_euler"), (camera, "location"),
                            (camera, "rotation_euler")):
            owner.keyframe_insert(what, frame=frame)
    ours, theirs = render(frame=4)["Vector"], render("CYCLES", frame=4, samples=1)["Vector"]
    off = numpy.abs(ours - theirs).max(axis=-1)
    print(f"    up to {numpy.abs(theirs).max():.1f} pixels; 98 % are within {numpy.quantile(off, 0.98):.1e}")
    assert numpy.abs(theirs).max() > 2 and numpy.quantile(off, 0.98) < 0.02


def bending_board(material=None):
    """A board of many vertices across the view, whose right half an armature turns: by 0.2 rad at frame 2."""
    board = mesh("Board", [(0.25 * column - 1, 0, z) for column in range(9) for z in (-0.6, 0.6)],
                 [(2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1) for k in range(8)], location=(0, 6, 0))
    if material is not None:
        board.data.materials.append(material)
    data = bpy.data.armatures.new("Spine")
    spine = add("Spine", data, location=(0, 6, 0))
    bpy.context.view_layer.objects.active = spine
    bpy.ops.object.mode_set(mode="EDIT")
    for name, x in (("Left", -1), ("Right", 0)):
        bone = data.edit_bones.new(name)
        bone.head, bone.tail = (x, 0, 0), (x + 1, 0, 0)
    bpy.ops.object.mode_set(mode="OBJECT")
    for name in ("Left", "Right"):
        group = board.vertex_groups.new(name=name)
        for vertex in board.data.vertices:
            share = min(max(vertex.co.x + 0.5, 0), 1)
            group.add([vertex.index], share if name == "Right" else 1 - share, "ADD")
    board.modifiers.new("Spine", "ARMATURE").object = spine
    bone = spine.pose.bones["Right"]
    bone.rotation_mode = "XYZ"
    for frame in (1, 3):
        bone.rotation_euler.z = 0.2 * (frame - 1)
        bone.rotation_euler.x = 0.1 * (frame - 1)
        bone.keyframe_insert("rotation_euler", frame=frame)
    for curve in spine.animation_data.action.fcurves:
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"
    return board


def test_vectors_of_what_deforms_against_cycles():
    """A board bent by an armature; the same with its bending as a shape key of the mesh, and Blender's own object
    moving besides."""
    for kind in ("armature", "shape key"):
        scene = empty_scene()
        scene.render.use_motion_blur = False
        scene.view_layers[0].use_pass_vector = True
        if kind == "armature":
            board = bending_board()
            board.location.x = 0.1
        else:
            board = square(size=2, location=(0, 6, 0), rotation=(math.pi / 2, 0, 0))
            board.shape_key_add(name="Basis")
            key = board.shape_key_add(name="Wide")
            key.data[1].co.x += 0.5
            key.data[2].co.z += 0.4
            for frame in (1, 3):
                key.value, board.location.x = 0.5 * (frame - 1), 0.1 * frame
                key.keyframe_insert("value", frame=frame)
                board.keyframe_insert("location", frame=frame)
            for owner in (board, board.data.shape_keys):
                for curve in owner.animation_data.action.fcurves:
                    for point in curve.keyframe_points:
                        point.interpolation = "LINEAR"
        ours, theirs = render(frame=2)["Vector"], render("CYCLES", frame=2, samples=1)["Vector"]
        assert not any("Vector" in note for note in notes()), notes()
        off = numpy.abs(ours - theirs).max(axis=-1)
        shown = numpy.abs(theirs).max(axis=-1) > 0.3
        print(f"    {kind}: up to {numpy.abs(theirs).max():.1f} pixels, {shown.sum()} of them move; 95 % are within "
              f"{numpy.quantile(off[shown], 0.95):.1e}")
        assert shown.sum() > 100 and numpy.abs(theirs).max() > 2 and numpy.quantile(off[shown], 0.95) < 0.02


def test_blur_of_what_deforms_against_cycles():
    scene = empty_scene(96, 64)
    bending_board(material("Shining", (1, 1, 1), "ShaderNodeEmission")[0])
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.5
    scene.uwvdb.samples = 128
    ours, theirs = (passes["Combined"][..., 0] for passes in (render(frame=2), render("CYCLES", frame=2, samples=256)))
    scene.render.use_motion_blur = False
    sharp = render(frame=2)["Combined"][..., 0]
    off, blur = numpy.abs(ours - theirs), numpy.abs(sharp - theirs)
    print(f"    blur changes pixels by up to {blur.max():.2f}; the mean difference is {off.mean():.4f}, of the sharp "
          f"picture {blur.mean():.4f}; the greatest is {off.max():.2f}")
    # Noise of a pixel that an edge halves: 0.5 / sqrt(256) in Cycles, and here steps of half a pixel.
    assert blur.max() > 0.4 and off.mean() < 0.2 * blur.mean() and off.max() < 0.12


def test_motion_blur_against_cycles():
    """A shining board that moves while the shutter is open, at its three places."""
    for position in ("CENTER", "START", "END"):
        scene = empty_scene(96, 8)
        shining = material("Shining", (1, 1, 1), "ShaderNodeEmission")[0]
        board = square(size=1.5, location=(0, 6, 0), rotation=(math.pi / 2, 0, 0))
        board.data.materials.append(shining)
        for frame in (1, 3):
            board.location.x = 0.8 * (frame - 2)
            board.keyframe_insert("location", frame=frame)
            for curve in board.animation_data.action.fcurves:
                curve.keyframe_points[-1].interpolation = "LINEAR"
        scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 0.8
        owner = scene.render if hasattr(scene.render, "motion_blur_position") else scene.cycles
        owner.motion_blur_position = position
        scene.uwvdb.samples = 256
        ours, theirs = (passes["Combined"][4, :, 0]
                        for passes in (render(frame=2), render("CYCLES", frame=2, samples=1024)))
        assert not any("keys" in note for note in notes()), notes()
        assert ((theirs > 0.1) & (theirs < 0.9)).sum() > 8
        close(ours, theirs, 0.06, f"blur, {position}")


def test_stops_within_a_second():
    """What Esc does: the program ends, and nothing of it is left."""
    empty_scene()
    program = sys.modules["uwvdb_blender.program"]
    with tempfile.TemporaryDirectory() as folder:
        with open(f"{folder}/long.yaml", "w") as file:
            json.dump({"uwvdb": 1, "camera": {"resolution": [1920, 1080], "intrinsics": {"fov_x": 60}},
                       "water": {"preset": "jerlov-II"},
                       "geometry": [{"type": "plane", "point": [0, 0, 4], "normal": [0, 0, -1]}],
                       "lamps": [{"position": [1, 0, 0], "intensity": 50}]}, file)
        told, begun = [], time.monotonic()

        def is_cancelled():
            return len(told) > 3

        try:
            program.run([PROGRAM, "render", "long.yaml", "-o", "long.exr", "--integrator", "path",
                         "--samples", "4000"], folder, is_cancelled,
                        lambda *progress: told.append((time.monotonic(), progress)))
        except program.Stopped:
            pass
        else:
            raise AssertionError("ended by itself")
        ended = time.monotonic() - told[-1][0]
        print(f"    progress: {told[-1][1]}; stopped after {ended:.2f} s")
        assert ended < 1 and not os.path.exists(f"{folder}/long.exr")
        stage, fraction, seconds_left = told[-1][1]
        assert stage == "render" and 0 <= fraction < 1 and seconds_left > 0, told[-1]
        assert told[-1][0] - begun < 60


def test_an_exposure_for_dark_pictures_is_said():
    scene = empty_scene(48, 32)
    square(size=20, location=(0, 3, 0), rotation=(math.pi / 2, 0, 0))
    lamp = light("POINT", watts=0.01, location=(0, 1, 0))
    render()
    said = [note for note in notes() if "dark" in note]
    assert len(said) == 1, notes()
    print(f"    {said[0]}")
    scene.view_settings.exposure = float(re.search(r"Exposure (\S+) shows", said[0])[1])
    brightest = numpy.percentile(render()["Combined"][..., :3], 99) * 2**scene.view_settings.exposure
    assert 0.9 < brightest < 1.1 and not any("dark" in note for note in notes()), (brightest, notes())
    scene.view_settings.exposure, lamp.data.energy = 0, 100
    render()
    assert not any("dark" in note for note in notes())


def test_every_kind_of_water_and_camera_renders():
    """What the panels offer is what the program takes, and it matters."""
    scene = empty_scene(24, 16)
    box(location=(0, 3, 0), rotation=(0.3, 0.2, 0.5))
    light("POINT", location=(1, 1, 1))
    layer, world, camera = scene.view_layers[0].uwvdb, scene.world.uwvdb, scene.camera.data.uwvdb
    for name in layer.__annotations__:
        setattr(layer, name, True)
    seen = []

    def differs(what):
        passes = render()
        total = passes["Combined"][..., :3].mean()
        assert total > 0 and numpy.isfinite(passes["Combined"]).all(), what
        assert all(abs(total / other - 1) > 1e-5 for other in seen), f"{what} makes no difference"
        seen.append(total)
        return passes

    passes = differs("no water")
    for name in ("direct", "backscatter", "forward", "clean", "transmittance", "irradiance", "albedo",
                 "range", "path", "lit", "lamp.Light"):
        assert name in passes, (name, list(passes))
    close(passes["lamp.Light"], passes["Combined"][..., :3], 1e-5, "the only light")
    world.kind = "PRESET"
    for item in world.bl_rna.properties["preset"].enum_items:
        world.preset = item.identifier
        differs(item.identifier)
    world.use_particles = True
    differs("own particles")
    world.kind, world.chlorophyll = "CONSTITUENTS", 2
    differs("constituents")
    world.cdom = 0.2
    differs("dissolved matter")
    world.kind = "COEFFICIENTS"
    passes = differs("coefficients")
    # The transmittance is that of the length in water, at 0.5, 0.27 and 0.23 per metre.
    length = passes["path"]
    close(passes["transmittance"], numpy.exp(-length * [0.5, 0.27, 0.23]), 2e-2, "transmittance",
          length[..., 0] > 0)
    world.use_snow = True
    differs("snow")
    world.snow_mean = "ADDED"
    differs("snow besides")
    world.use_snow = False
    scene.uwvdb.use_forward_scatter = True
    differs("forward scatter")
    scene.uwvdb.use_forward_scatter, scene.uwvdb.scattering = False, "MULTIPLE"
    assert "multiple" in differs("multiple scattering")
    scene.uwvdb.integrator, scene.uwvdb.use_error, scene.uwvdb.error = "PATH", True, 0.2
    assert "error" in differs("path")
    scene.uwvdb.integrator, scene.uwvdb.scattering = "VOLUME", "SINGLE"
    scene.uwvdb.bands = "450, 500, 550, 600, 650"
    passes = differs("five bands")
    assert {"total.500nm", "direct.650nm"} <= set(passes), list(passes)
    scene.uwvdb.bands = "620, 540, 450"
    for camera.housing in ("FLAT", "DOME"):
        differs(camera.housing)
    camera.use_sensor = True
    for camera.mosaic in ("MONO", "RGGB", "THREE"):
        passes = render()
        assert passes["sensor"].shape[-1] == (3 if camera.mosaic == "THREE" else 1)
        assert passes["sensor"].max() > 0 and (passes["sensor"] == passes["sensor"].round()).all()


def test_calibration():
    """A calibration's size and rays take the place of Blender's lens."""
    scene = empty_scene(40, 30)
    square(size=40, location=(0, 2, 0), rotation=(math.pi / 2, 0, 0))
    scene.view_layers[0].use_pass_position = True
    with tempfile.TemporaryDirectory() as folder:
        with open(f"{folder}/rig.yaml", "w") as file:
            file.write("%YAML:1.0\nimage_width: 40\nimage_height: 30\n"
                       "camera_matrix: !!opencv-matrix\n  rows: 3\n  cols: 3\n  dt: d\n"
                       "  data: [50., 0., 22., 0., 50., 14., 0., 0., 1.]\n"
                       "distortion_coefficients: !!opencv-matrix\n  rows: 1\n  cols: 5\n  dt: d\n"
                       "  data: [0., 0., 0., 0., 0.]\n")
        scene.camera.data.uwvdb.calibration = f"{folder}/rig.yaml"
        position = render()["Position"]
        scene.render.resolution_percentage = 200
        larger = render()["Position"]
    # OpenCV's pixels have their centres at whole numbers.
    close(position[15, :, 0], (numpy.arange(40) - 22) / 50 * 2, 1e-5, "x")
    assert larger.shape[:2] == (60, 80)
    close(larger[15::30, 1::2, 0].mean(axis=0) + larger[15::30, 0::2, 0].mean(axis=0), position[15, :, 0] * 2,
          1e-5, "x of an image twice as large")


def test_view_layers_and_the_compositor():
    """Each view layer has its own objects and passes, and the compositor gets them by name."""
    scene = empty_scene(40, 30)
    light("POINT", location=(1, 0, 1))
    box("Near", location=(0, 3, 0))
    square("Wall", size=30, location=(0, 6, 0), rotation=(math.pi / 2, 0, 0))
    group = bpy.data.collections.new("Front")
    scene.collection.children.link(group)
    scene.collection.objects.unlink(bpy.data.objects["Near"])
    group.objects.link(bpy.data.objects["Near"])
    back = scene.view_layers.new("Back")
    back.layer_collection.children["Front"].exclude = True
    front = scene.view_layers[0]
    front.use_pass_z = back.use_pass_z = True
    back.uwvdb.use_clean = True
    scene.use_nodes = True
    tree = scene.node_tree
    tree.nodes.clear()
    source, negative = tree.nodes.new("CompositorNodeRLayers"), tree.nodes.new("CompositorNodeInvert")
    source.layer = "Back"
    assert source.outputs["clean"].enabled and source.outputs["Depth"].enabled
    target = tree.nodes.new("CompositorNodeComposite")
    tree.links.new(source.outputs["clean"], negative.inputs["Color"])
    tree.links.new(negative.outputs["Color"], target.inputs["Image"])
    with tempfile.TemporaryDirectory() as folder:
        settings = scene.render.image_settings
        settings.file_format, settings.color_depth = "OPEN_EXR_MULTILAYER", "32"
        settings.exr_codec = "NONE"
        scene.render.filepath = f"{folder}/image.exr"
        bpy.ops.render.render(write_still=True)
        channels = sys.modules["uwvdb_blender.exr"].read(scene.render.filepath).channels
    depths = [channels[f"{layer.name}.Depth.Z"][15, 20] for layer in (front, back)]
    assert numpy.allclose(depths, (2.5, 6), rtol=1e-5), depths
    assert "Back.clean.R" in channels and f"{front.name}.clean.R" not in channels
    close(channels["Composite.Combined.R"], 1 - channels["Back.clean.R"], 1e-5, "composite")


def test_moving_lights_and_turned_panels():
    """A panel and a luminaire that move with the shutter open are, in the mean, where they are at rest."""
    scene = empty_scene(60, 40)
    square("Wall", size=30, location=(0, 4, 0), rotation=(math.pi / 2, 0, 0))
    box(location=(0.4, 3.5, 0.2), size=(0.5, 0.5, 0.5), rotation=(0.1, 0.2, 0.3))
    lamp = light("AREA", location=(-0.6, 1.5, 0.5), rotation=(1.3, 0.1, -0.4), shape="RECTANGLE", size=0.9,
                 size_y=0.1)
    rested = render()["Combined"][..., 0]
    for frame, x in ((1, -0.61), (3, -0.59)):
        lamp.location.x = x
        lamp.keyframe_insert("location", frame=frame)
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 0.5
    scene.uwvdb.samples = 16
    moving = render(frame=2)["Combined"][..., 0]
    median_close(moving, rested, 5e-3, "moving panel", rested > 0.02 * rested.max())


def test_scenes_are_kept_for_other_commands():
    scene = empty_scene(40, 30)
    light("POINT", location=(1, 0, 1))
    box(location=(0, 3, 0))
    with tempfile.TemporaryDirectory() as folder:
        scene.uwvdb.kept_in = folder
        ours = render(frame=7)["Combined"]
        place = f"{folder}/0007_ViewLayer"
        scene_text = json.loads(pathlib.Path(place, "scene.yaml").read_text())
        assert scene_text["uwvdb"] == 2 and len(scene_text["lamps"]) == 1
        uwvdb("render", "scene.yaml", "-o", "image.exr", "--compression", "none", "--precision", "float",
              folder=place)
        again = sys.modules["uwvdb_blender.exr"].read(f"{place}/image.exr").get("", "RGBA")
    close(again, ours, 1e-6, "rendered again")


def test_material_of_the_view_layer():
    scene = empty_scene(24, 16)
    light("POINT")
    wall = square(size=40, location=(0, 2, 0), rotation=(math.pi / 2, 0, 0))
    wall.data.materials.append(material("White", (0.9, 0.9, 0.9))[0])
    scene.view_layers[0].uwvdb.use_albedo = True
    scene.view_layers[0].material_override = material("Clay", (0.5, 0.4, 0.3))[0]
    close(render()["albedo"][8, 12], [0.5, 0.4, 0.3], 1e-5, "albedo")
