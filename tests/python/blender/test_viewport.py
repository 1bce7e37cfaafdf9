# ctest labels: metamorphic
"""The rendered 3D view without a window: its cameras against Blender's matrices, its pictures against F12,
and what is described anew when something changes."""

import time

from support import *

PLUME = ROOT / "assets/grids/plume128_blosc_half_0030.vdb"
SECONDS_TO_WAIT = 120


def viewport():
    return sys.modules["uwvdb_blender.viewport"]


class View:
    """A 3D view of 96 x 64 pixels, as its RegionView3D describes it."""

    size = (96, 64)

    def __init__(self, eye, rotation=(math.pi / 2, 0, 0), window=None):
        turn = Euler(rotation).to_matrix().to_4x4()
        self.view_matrix = (Matrix.Translation(eye) @ turn).inverted()
        self.window_matrix = window or perspective(1.8, 2.7)


def perspective(fx, fy, near=0.1, far=100):
    """As Blender's, not in the middle."""
    return Matrix(((fx, 0, 0.1, 0), (0, fy, -0.05, 0),
                   (0, 0, -(far + near) / (far - near), -2 * far * near / (far - near)), (0, 0, -1, 0)))


def parallel(width, height):
    return Matrix(((2 / width, 0, 0, 0.1), (0, 2 / height, 0, -0.05), (0, 0, -0.01, 0), (0, 0, 0, 1)))


class Shown:
    """A Session and Surroundings of the scene as it stands."""

    def __enter__(self):
        self.session = viewport().Session(PROGRAM)
        self.surroundings = viewport().Surroundings(self.session, PROGRAM)
        return self

    def __exit__(self, *_):
        self.session.close()
        self.session.wait_until_closed()
        assert not os.path.exists(self.session.folder)

    def update(self):
        self.depsgraph = bpy.context.evaluated_depsgraph_get()
        self.surroundings.update(self.depsgraph)
        while self.surroundings.is_reading:
            self.surroundings.read_on(self.depsgraph)

    def ask(self, view, through_camera=False):
        notes = sys.modules["uwvdb_blender.notes"].Notes()
        frame = viewport().frame_of(self.depsgraph, view.size, view, through_camera, notes)
        self.session.show(self.surroundings.with_camera(frame.camera), self.surroundings.words,
                          self.surroundings.meshes)
        return frame, notes.texts

    def final(self):
        """The final picture's rows from the top."""
        end = time.monotonic() + SECONDS_TO_WAIT
        while not self.session.is_final:
            assert not self.session.message, self.session.message
            assert time.monotonic() < end, "there is no final picture"
            time.sleep(0.01)
        return self.session.picture.rows[::-1].copy()


def pond():
    scene = empty_scene()
    scene.world.uwvdb.kind, scene.world.uwvdb.preset = "PRESET", "jerlov-II"
    scene.camera.location = (0, -3, 0.4)
    square("Floor", size=20, location=(0, 0, -1)).data.materials.append(material("Sand", (0.5, 0.4, 0.3))[0])
    box("Block", size=(0.5, 0.5, 0.5))
    light("POINT", "Left", 300, (-1, -2, 1))
    light("SPOT", "Right", 500, (1, -2, 1), (0.9, 0, 0.4), spot_size=1)
    return scene


def test_the_camera_view_is_what_f12_renders():
    scene = pond()
    scene.camera.data.uwvdb.housing = "FLAT"
    wanted = render()["Combined"]
    with Shown() as shown:
        shown.update()
        view = View((0, -3, 0.4), window=scene.camera.calc_matrix_camera(shown.depsgraph, x=96, y=64))
        frame, _ = shown.ask(view, through_camera=True)
        close(frame.rectangle, (0, 0, 96, 64), 1e-5, "frame")
        close(shown.final()[..., :3], wanted[..., :3], 1e-3, "picture")
        assert frame.camera["port"]["type"] == "flat"


def test_points_are_where_blender_has_them():
    """In perspective and orthographic views, in metres and in other units."""
    place = Vector((0.21, 0.4, 0.13))
    for unit in (1.0, 0.1):
        for kind, window in (("perspective", perspective(1.8, 2.7)), ("orthographic", parallel(3, 2))):
            scene = empty_scene()
            scene.unit_settings.scale_length, scene.uwvdb.samples = unit, 64
            shader, *_ = material("Lit", shader="ShaderNodeEmission")
            box("Small", size=(0.25, 0.02, 0.25), location=place).data.materials.append(shader)
            view = View((0.1, -2.5, 0.2), window=window)
            with Shown() as shown:
                shown.update()
                frame, _ = shown.ask(view)
                rows = shown.final()
            light_of = rows[..., 1] / rows[..., 1].max()
            y, x = numpy.mgrid[0:64, 0:96] + 0.5
            found = ((light_of * x).sum() / light_of.sum(), (light_of * y).sum() / light_of.sum())
            seen = window @ view.view_matrix @ Vector((place.x, place.y - 0.01, place.z, 1))
            wanted = ((seen.x / seen.w + 1) * 48, (1 - seen.y / seen.w) * 32)
            off = math.dist(found, wanted)
            print(f"    {kind}, unit {unit}: {off:.3f} pixels off")
            assert off < 0.05, (kind, found, wanted)
            assert ("port" in frame.camera) == (kind == "orthographic")


def test_the_water_of_an_orthographic_view_begins_at_its_eye():
    """The same for all pixels: exp(-c d) of the light without water."""
    lit = {}
    for kind in ("NONE", "COEFFICIENTS"):
        scene = empty_scene()
        scene.world.uwvdb.kind = kind
        scene.world.uwvdb.absorption, scene.world.uwvdb.scattering = (0.3, 0.2, 0.1), (0, 0, 0)
        shader, *_ = material("Lit", shader="ShaderNodeEmission")
        square("Wall", size=20, rotation=(math.pi / 2, 0, 0)).data.materials.append(shader)
        with Shown() as shown:
            shown.update()
            shown.ask(View((0, -2, 0), window=parallel(3, 2)))
            lit[kind] = shown.final()[..., :3]
    wanted = numpy.broadcast_to(numpy.exp(numpy.array([-0.6, -0.4, -0.2])), lit["NONE"].shape)
    close(lit["COEFFICIENTS"] / lit["NONE"], wanted, 2e-3, "transmittance")


def test_only_what_changed_is_described_anew():
    scene = pond()
    written = []
    with Shown() as shown:
        shown.update()
        view = View((0, -3, 0.4))
        shown.ask(view)
        before = shown.final()
        first, process = shown.surroundings.meshes, shown.session._process.pid

        bpy.data.objects["Left"].location.x = 0.5
        shown.update()
        assert shown.surroundings.meshes is first, "a lamp moved, and the meshes were written again"
        shown.ask(view)
        moved = shown.final()
        assert numpy.abs(moved - before).max() > 0.01 * before.max()

        bpy.data.lights["Left"].energy *= 2
        bpy.data.lights["Right"].energy *= 2
        shown.update()
        shown.ask(view)
        end = time.monotonic() + SECONDS_TO_WAIT
        while shown.session.picture.rows[..., 0].max() < 1.9 * moved[..., 0].max():
            assert time.monotonic() < end, "the picture did not become brighter"
            time.sleep(0.01)
        close(shown.session.picture.rows[::-1][..., :3], 2 * moved[..., :3], 2e-3, "twice the watts")

        bpy.data.objects["Block"].location.x = 0.8
        shown.update()
        assert shown.surroundings.meshes[1].is_of_the_meshes_of(first[1]), "the meshes themselves are new"
        shown.ask(view)
        elsewhere = shown.final()
        assert shown.session._process.pid == process
    with Shown() as fresh:
        fresh.update()
        fresh.ask(view)
        assert (fresh.final() == elsewhere).all(), "another picture than from the beginning"


def test_advice_is_not_waited_for():
    scene = empty_scene()
    data = bpy.data.volumes.new("Plume")
    data.filepath = str(PLUME)
    add("Plume", data)
    program = sys.modules["uwvdb_blender.program"]
    program._info_of.clear()
    with Shown() as shown:
        shown.update()
        assert program.is_asking() and "volumes" not in shown.surroundings.with_camera({})
        assert any("being looked at" in note for note in shown.surroundings.notes)
        end = time.monotonic() + SECONDS_TO_WAIT
        while program.is_asking():
            assert time.monotonic() < end
            time.sleep(0.01)
        shown.update()
        assert "density" in shown.surroundings.with_camera({})["volumes"][0]["grids"]


def test_what_is_not_shown_is_said():
    scene = pond()
    scene.camera.data.uwvdb.use_sensor = scene.render.use_motion_blur = True
    scene.uwvdb.integrator = "PATH"
    with Shown() as shown:
        shown.update()
        _, notes = shown.ask(View((0, -3, 0.4)), through_camera=True)
        said = " ".join(notes + shown.surroundings.notes)
        for words in ("sensor", "motion blur", "integrator"):
            assert words in said, words
        assert shown.surroundings.with_camera({})["render"]["scattering"] == "multiple"


def test_an_error_is_told_and_goes_when_it_is_mended():
    scene = pond()
    scene.world.uwvdb.use_snow, scene.world.uwvdb.snow_least, scene.world.uwvdb.snow_greatest = True, 9, 8
    with Shown() as shown:
        shown.update()
        shown.ask(View((0, -3, 0.4)))
        end = time.monotonic() + SECONDS_TO_WAIT
        while not shown.session.message:
            assert time.monotonic() < end
            time.sleep(0.01)
        print(f"    {shown.session.message}")
        assert shown.session.message.startswith("World > Water > Marine Snow") and "\n" not in shown.session.message
        scene.world.uwvdb.snow_least = 1
        shown.update()
        shown.ask(View((0, -3, 0.4)))
        while not shown.session.is_final:
            assert time.monotonic() < end
            time.sleep(0.01)
        assert not shown.session.message


def test_a_program_that_ends_is_started_again():
    pond()
    with Shown() as shown:
        shown.update()
        shown.ask(View((0, -3, 0.4)))
        before = shown.final()
        shown.session._process.kill()
        end = time.monotonic() + SECONDS_TO_WAIT
        while "has ended" not in shown.session.message:
            assert time.monotonic() < end
            time.sleep(0.01)
        shown.session._process.wait()
        bpy.data.objects["Left"].location.x = 0.5
        shown.update()
        shown.ask(View((0, -3, 0.4)))
        while shown.session.message:
            assert time.monotonic() < end
            time.sleep(0.01)
        assert (shown.final() != before).any()


def test_bakes_appear_when_they_are_there():
    """Before that, the view shows what it has; then what F12 renders."""
    kept = os.environ.get("XDG_CACHE_HOME")
    os.environ["XDG_CACHE_HOME"] = tempfile.mkdtemp(prefix="uwvdb-test-")
    try:
        scene = pond()
        made, nodes, links, node = material("Checked")
        links.new(nodes.new("ShaderNodeTexChecker").outputs[0], node.inputs["Color"])
        bpy.data.objects["Block"].data.materials.append(made)
        view = View((0, -3, 0.4), window=scene.camera.calc_matrix_camera(
            bpy.context.evaluated_depsgraph_get(), x=96, y=64))
        with Shown() as shown:
            shown.update()
            assert shown.surroundings.is_baking
            shown.ask(view, through_camera=True)
            before = shown.final()
            end = time.monotonic() + SECONDS_TO_WAIT
            while not shown.surroundings.has_baked():
                assert time.monotonic() < end
                time.sleep(0.01)
            assert not shown.surroundings.is_baking
            shown.update()
            assert not shown.surroundings.is_baking
            assert not any("'Checked'" in note for note in shown.surroundings.notes)
            shown.ask(view, through_camera=True)
            after = shown.final()
        wanted = render()["Combined"]
        assert numpy.abs(before - after).max() > 0.1 * wanted.max()
        close(after[..., :3], wanted[..., :3], 2e-3, "picture")
    finally:
        os.environ.pop("XDG_CACHE_HOME")
        if kept is not None:
            os.environ["XDG_CACHE_HOME"] = kept
