# ctest labels: unit threads
"""The package in several Python threads at once. The thread sanitizer watches it, too."""

import os
import pickle
import queue
import signal
import threading
from collections.abc import Mapping

import numpy as np
import pytest

import uwvdb
from conftest import LONG, ROOT

GRID = ROOT / "assets/grids/plume128_blosc_half_0030.vdb"

DERIVATIVES = ["water.absorption", "concentration.small"]

# What is rendered, each by other parts of the renderer.
WAYS = [
    dict(layers="all", quality="final"),
    dict(layers=["total", "lamps", "id"], size=(9, 7), samples=2),
    dict(layers="total", integrator="path", samples=4),
    dict(layers="total", quality="final", derivatives=DERIVATIVES),
    dict(layers=["total", "depth"], quality="draft", crop=(2, 1, 9, 6)),
]


def run_in_threads(work, count=4):
    """Runs work(0), work(1) ... in threads that begin together, and raises what one does."""
    errors, begin = [], threading.Barrier(count)

    def run(number):
        try:
            begin.wait()
            work(number)
        except BaseException as error:
            errors.append(error)
    threads = [threading.Thread(target=run, args=(number,)) for number in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for error in errors:
        raise error


def values_of(image, settings):
    """A copy of all that was rendered."""
    return [image.pixels.copy(), *(image.derivative(name).copy()
                                   for name in settings.get("derivatives", []))]


def same(first, second):
    return len(first) == len(second) and all(
        np.array_equal(a, b, equal_nan=True) for a, b in zip(first, second))


@pytest.fixture
def full(scene):
    """A scene with a volume and a mesh from arrays."""
    rng = np.random.default_rng(3)
    scene.volumes.add(rng.uniform(0, 1, (9, 10, 11)), voxel_size=0.1, origin=(-0.5, -0.5, 1),
                      concentration={"small": 5})
    scene.geometry.add([[0, 0, 2], [0.5, 0, 2], [0, 0.5, 2]], [[0, 1, 2]],
                       reflectance=[0.1, 0.2, 0.3])
    return scene


def test_threads_render_one_scene_in_all_ways(full):
    alone = uwvdb.Renderer(threads=1)
    expected = [values_of(alone.render(full, **way), way) for way in WAYS]

    def work(number):
        renderer = uwvdb.Renderer(threads=1 + number % 3)
        for turn in range(len(WAYS)):
            index = (turn + number) % len(WAYS)
            found = renderer.render(full, **WAYS[index])
            assert same(values_of(found, WAYS[index]), expected[index]), WAYS[index]
    run_in_threads(work)


def test_layers_pass_from_thread_to_thread(full):
    expected = uwvdb.Renderer(threads=1).render(full, ["total", "depth"], "draft")
    rendered = queue.Queue()

    def work(number):
        if number < 2:
            renderer = uwvdb.Renderer(threads=2)
            for _ in range(4):
                image = renderer.render(full, ["total", "depth"], "draft")
                # The views are all that is left of the image.
                rendered.put((image["total"], image["depth"]))
                del image
            return
        for _ in range(4):
            total, depth = rendered.get()
            assert np.array_equal(total, expected["total"])
            assert np.array_equal(depth, expected["depth"])
            total *= 2
            assert np.array_equal(total, 2 * expected["total"])
    run_in_threads(work)


def test_threads_read_and_write_one_image(full, tmp_path):
    image = uwvdb.Renderer().render(full, "all", "final", derivatives=["water.absorption"])
    pixels, picture = image.pixels.copy(), image.srgb()
    slope = image.derivative("water.absorption").copy()
    image.save(tmp_path / "expected.exr")
    expected = (tmp_path / "expected.exr").read_bytes()

    def work(number):
        for turn in range(3):
            file = tmp_path / f"{number}.{turn}.exr"
            image.save(file)
            assert file.read_bytes() == expected
            image.save(file.with_suffix(".png"))
            assert np.array_equal(image.srgb(), picture)
            assert np.array_equal(image.pixels, pixels, equal_nan=True)
            assert np.array_equal(image.derivative("water.absorption"), slope)
            assert image.report["pixels"] == pixels.shape[0] * pixels.shape[1]
            assert "total" in image.layers and image.metadata and image.objects
    run_in_threads(work)


def test_light_matrices_are_mixed_in_threads(full):
    expected = uwvdb.Renderer(threads=1).light_matrix(full, quality="draft")
    rng = np.random.default_rng(4)
    factors = rng.uniform(0, 3, (4, 2, 3))
    mixed = [expected.mix(each) for each in factors]

    def work(number):
        found = uwvdb.Renderer(threads=1 + number % 2).light_matrix(full, quality="draft")
        assert found.lamps == ["left", "right"]
        assert np.array_equal(found.images, expected.images)
        assert np.array_equal(found.rest, expected.rest)
        for other, each in zip(mixed, factors):  # one matrix by all threads, too
            assert np.array_equal(found.mix(each), other)
            assert np.array_equal(expected.mix(each), other)
    run_in_threads(work)


def test_scenes_are_made_and_changed_while_others_render(full):
    array = np.random.default_rng(5).uniform(0, 1, (8, 8, 8)).astype(np.float32)
    expected = uwvdb.Renderer(threads=1).render(full, quality="draft").pixels.copy()

    def changed(number):
        scene = pickle.loads(pickle.dumps(full.copy()))
        scene["lamps.left.intensity"] = [number + 1] * 3
        scene.volumes.add(array, voxel_size=0.1, origin=(0, 0, 1 + 0.1 * number), absorption=1,
                          scattering=0)
        del scene["geometry[0]"]
        return scene
    images = [uwvdb.Renderer(threads=1).render(changed(number), quality="draft").pixels
              for number in range(4)]

    def work(number):
        renderer = uwvdb.Renderer(threads=2)
        for _ in range(3):
            assert np.array_equal(renderer.render(full, quality="draft").pixels, expected)
            found = renderer.render(changed(number), quality="draft").pixels
            assert np.array_equal(found, images[number])
    run_in_threads(work)


def test_files_cameras_and_water_in_threads(full):
    camera, grid = full.camera, uwvdb.read_vdb(GRID, "density")
    pixels = np.random.default_rng(6).uniform(0, 8, (5000, 2))
    rays = camera.rays(pixels)
    phase, inspection = full.water.phase(np.arange(181)), uwvdb.inspect(GRID)

    def work(number):
        mine = full.camera if number % 2 else camera
        found = mine.rays(pixels)
        assert np.array_equal(found.origin, rays.origin)
        assert np.array_equal(found.direction, rays.direction)
        seen = mine.project(found.origin[:1500] + 2 * found.direction[:1500])
        assert np.allclose(seen, pixels[:1500], atol=1e-5)  # project() is to 1e-6 pixels
        assert np.array_equal(uwvdb.read_vdb(GRID, "density").values, grid.values)
        assert uwvdb.inspect(GRID) == inspection
        assert np.array_equal(full.water.phase(np.arange(181)), phase)
        assert uwvdb.Scene.parse("uwvdb: 1\ncamera: {resolution: [4, 3], intrinsics: {fov_x: 50}}\n"
                                 "water: {preset: jerlov-II}\n").lamps == []
    run_in_threads(work)


def test_one_stops_and_the_others_go_on(full):
    expected = uwvdb.Renderer(threads=1).render(full, "all", "draft").pixels.copy()

    def fail(stage, fraction):
        if stage == "render":
            raise ZeroDivisionError("mine")

    def work(number):
        renderer = uwvdb.Renderer(threads=2)
        for turn in range(3):
            if (turn + number) % 2:
                with pytest.raises(uwvdb.Interrupted, match="progress callback"):
                    renderer.render(full, quality="draft", progress=lambda *_: False, **LONG)
                with pytest.raises(ZeroDivisionError, match="mine"):
                    renderer.render(full, quality="draft", progress=fail, **LONG)
            found = renderer.render(full, "all", "draft").pixels
            assert np.array_equal(found, expected, equal_nan=True)
    run_in_threads(work)


def test_ctrl_c_ends_the_main_thread_and_no_other(full, renderer):
    expected = renderer.render(full, "all", "draft").pixels.copy()
    # What runs in the background of a shell ignores it.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    images, begun, interrupted = queue.Queue(), threading.Event(), threading.Event()

    def render():
        other = uwvdb.Renderer(threads=2)
        while True:
            last = interrupted.is_set()
            images.put(other.render(full, "all", "draft").pixels)
            if last:
                return

    def interrupt():
        begun.wait()
        os.kill(os.getpid(), signal.SIGINT)

    def watch(stage, fraction):
        if stage == "render" and fraction > 0:
            begun.set()
    threads = [threading.Thread(target=work) for work in (render, render, interrupt)]
    for thread in threads:
        thread.start()
    with pytest.raises(KeyboardInterrupt):
        renderer.render(full, quality="draft", progress=watch, **LONG)
    interrupted.set()
    for thread in threads:
        thread.join()
    assert np.array_equal(renderer.render(full, "all", "draft").pixels, expected, equal_nan=True)
    assert images.qsize() >= 2
    while not images.empty():
        assert np.array_equal(images.get(), expected, equal_nan=True)


def test_a_renderer_refuses_other_threads_while_it_works(full, renderer):
    expected = renderer.render(full, quality="draft").pixels.copy()
    works, refused = threading.Event(), threading.Event()

    def watch(stage, fraction):
        works.set()
        return not refused.is_set()

    def work(number):
        if number == 0:
            try:
                with pytest.raises(uwvdb.Interrupted):
                    renderer.render(full, quality="draft", progress=watch, **LONG)
            finally:
                works.set()
            return
        works.wait()
        try:
            with pytest.raises(uwvdb.UsageError, match="at work, in another thread"):
                renderer.render(full)
            with pytest.raises(uwvdb.UsageError, match="at work in another thread"):
                renderer.clear()
        finally:
            refused.set()
    run_in_threads(work, count=2)
    assert np.array_equal(renderer.render(full, quality="draft").pixels, expected)


class Meddling(Mapping):
    """A value that adds to the scene while it is read, as another thread may at that moment."""

    def __init__(self, values, meddle):
        self.values_, self.meddle = values, meddle

    def __getitem__(self, key):
        return self.values_[key]

    def __iter__(self):
        self.meddle()
        return iter(self.values_)

    def __len__(self):
        return len(self.values_)


def test_what_is_added_meanwhile_by_the_same_name_is_not_lost(scene):
    place = dict(voxel_size=0.1, origin=(0, 0, 1), absorption=1, scattering=0)

    def other():
        scene.volumes.add(np.full((4, 4, 4), 2.0), **place)
    with pytest.raises(uwvdb.UsageError, match="volumes.add: there is a 'array1' already"):
        scene.volumes.add(np.ones((4, 4, 4)), **place,
                          transform=Meddling({"translate": [0, 0, 1]}, other))
    assert [entry["array"] for entry in scene.volumes] == ["array1"]
    assert scene.volumes.add(np.ones((4, 4, 4)), **place) == "array2"
