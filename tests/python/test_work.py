# ctest labels: unit
"""Rendering beside other work: progress, Ctrl-C, threads, processes."""

import multiprocessing
import os
import pickle
import resource
import signal
import threading
import time

import numpy as np
import pytest

import uwvdb
from conftest import LONG


def test_ctrl_c_stops_at_once_and_leaves_the_renderer_usable(scene, renderer):
    expected = renderer.render(scene).pixels.copy()
    # What runs in the background of a shell ignores it.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    begun, sent, later = threading.Event(), threading.Event(), []

    def interrupt():
        begun.wait()
        os.kill(os.getpid(), signal.SIGINT)
        sent.set()

    def watch(stage, fraction):
        if sent.is_set():
            later.append((stage, fraction))
        elif stage == "render" and fraction > 0:
            begun.set()
    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        renderer.render(scene, progress=watch, **LONG)
    thread.join()
    # The next look at signals, every 20 ms, sees it, or the one after that.
    assert len(later) <= 1 and all(fraction < 0.5 for _, fraction in later)
    assert np.array_equal(renderer.render(scene).pixels, expected)


def test_a_signal_stops_saving_and_leaves_nothing(scene, renderer, tmp_path):
    image = renderer.render(scene, size=(1600, 1200), quality="draft")
    image.pixels[...] = np.random.default_rng(1).random(image.pixels.shape)
    file = tmp_path / "image.exr"

    class Signalled(Exception):
        pass

    def interrupt(number, frame):
        signal.signal(number, signal.SIG_IGN)  # of the writes that follow
        raise Signalled

    # The write that makes the file larger than this, a fiftieth of all, sends the signal.
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    handler = signal.signal(signal.SIGXFSZ, interrupt)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1_000_000, limits[1]))
    try:
        with pytest.raises(Signalled):
            image.save(file, precision="float")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        signal.signal(signal.SIGXFSZ, handler)
    assert list(tmp_path.iterdir()) == []
    image.save(file, precision="float")
    assert file.stat().st_size > 20_000_000


def test_progress_is_told_in_the_thread_that_renders(scene, renderer):
    calls = []
    renderer.render(scene, progress=lambda stage, fraction: calls.append(
        (stage, fraction, threading.get_ident())))
    stages = [stage for stage, _, _ in calls]
    for stage in ("volumes", "geometry", "splat", "render"):
        assert (stage, 0) in [(name, fraction) for name, fraction, _ in calls]
    assert stages == sorted(stages, key=["volumes", "geometry", "splat", "render"].index)
    assert {thread for _, _, thread in calls} == {threading.get_ident()}
    assert all(0 <= fraction <= 1 for _, fraction, _ in calls)


def test_progress_ends_the_work(scene, renderer):
    expected = renderer.render(scene).pixels.copy()
    with pytest.raises(uwvdb.Interrupted, match="progress callback"):
        renderer.render(scene, progress=lambda stage, fraction: False, **LONG)

    def fail(stage, fraction):
        raise ZeroDivisionError("mine")
    with pytest.raises(ZeroDivisionError, match="mine"):
        renderer.render(scene, progress=fail, **LONG)

    def again(stage, fraction):
        renderer.render(scene)
    with pytest.raises(uwvdb.UsageError, match="this Renderer is at work"):
        renderer.render(scene, progress=again, **LONG)
    assert np.array_equal(renderer.render(scene).pixels, expected)


def test_other_threads_run_meanwhile(scene, renderer):
    turns = 0

    def count(stage, fraction):
        return turns < 50
    stop = threading.Event()

    def work():
        nonlocal turns
        while not stop.is_set():
            turns += 1
            time.sleep(0.001)
    thread = threading.Thread(target=work)
    thread.start()
    with pytest.raises(uwvdb.Interrupted):
        renderer.render(scene, progress=count, **LONG)
    stop.set()
    thread.join()
    assert turns >= 50


def test_renderers_in_threads(scene):
    expected = uwvdb.Renderer(threads=1).render(scene, "all").pixels.copy()
    found, errors = {}, []

    def work(number):
        try:
            renderer = uwvdb.Renderer(threads=1 + number % 2)
            for turn in range(5):
                found[number, turn] = renderer.render(scene, "all").pixels
        except Exception as error:  # to be shown by the main thread
            errors.append(error)
    threads = [threading.Thread(target=work, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not errors and len(found) == 20
    for image in found.values():
        assert np.array_equal(image, expected, equal_nan=True)


def with_arrays(scene):
    rng = np.random.default_rng(2)
    scene.volumes.add(rng.uniform(0, 1, (9, 10, 11)), voxel_size=0.1, origin=(-0.5, -0.5, 1),
                      concentration={"small": 5})
    scene.geometry.add([[0, 0, 2], [0.5, 0, 2], [0, 0.5, 2]], [[0, 1, 2]],
                       reflectance=[0.1, 0.2, 0.3])
    return scene


def test_scenes_can_be_pickled_with_their_arrays(scene):
    with_arrays(scene)
    again = pickle.loads(pickle.dumps(scene))
    assert again.to_dict() == scene.to_dict() and again.hash == scene.hash
    first = uwvdb.Renderer().render(scene, "all").pixels
    assert np.array_equal(uwvdb.Renderer().render(again, "all").pixels, first, equal_nan=True)
    with pytest.raises(uwvdb.InputError) as of_again:
        again["lamps.left.power"] = 1
    with pytest.raises(uwvdb.InputError) as of_scene:
        scene["lamps.left.power"] = 1
    assert str(of_again.value) == str(of_scene.value)


def render_in_process(scene):
    return uwvdb.Renderer(threads=2).render(scene).pixels.copy()


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_processes(scene, method):
    with_arrays(scene)
    # The parent has rendered: its threads are not those of a forked child.
    expected = render_in_process(scene)
    with multiprocessing.get_context(method).Pool(2) as pool:
        results = pool.map_async(render_in_process, [scene] * 4).get(timeout=600)
    for image in results:
        assert np.array_equal(image, expected)


def test_a_renderer_survives_a_fork(scene, renderer):
    expected = renderer.render(scene).pixels.copy()
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            same = np.array_equal(renderer.render(scene).pixels, expected)
            os.write(writer, b"same" if same else b"different")
        finally:
            os._exit(0)
    os.close(writer)
    with os.fdopen(reader, "rb") as result:
        assert result.read() == b"same"
    os.waitpid(child, 0)
    assert np.array_equal(renderer.render(scene).pixels, expected)
