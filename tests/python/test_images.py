# ctest labels: unit
"""Images: the pixels of the command line, as arrays."""

import copy
import gc
import pickle
import warnings

import numpy as np
import pytest

import uwvdb
from conftest import SCENES, expect_same_file, run_program


@pytest.mark.parametrize("name", ["dive", "plume", "shallows", "stereo"])  # test_slow: all of them
def test_files_are_those_of_the_command_line(tmp_path, renderer, name):
    expect_same_file(SCENES / f"{name}.yaml", renderer, tmp_path)


def test_frames_and_windows_are_those_of_the_command_line(tmp_path, renderer):
    file = SCENES / "dive.yaml"
    run_program("render", file, "-o", tmp_path / "theirs.####.exr", "--size", "16x12", "--quality",
                "draft", "--frames", "3,4", "--crop", "2,3,9,8", "--quiet",
                "--layers", "total,flow,depth", "--precision", "float")
    scene = uwvdb.Scene.load(file)
    settings = dict(layers=["total", "flow", "depth"], quality="draft", size=(16, 12),
                    crop=(2, 3, 9, 8))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", uwvdb.SceneWarning)
        images = list(renderer.sequence(scene, range(3, 5), **settings))
    for frame, image in zip((3, 4), images):
        assert image.window == (2, 3, 9, 8) and image["flow"].shape == (5, 7, 2)
        image.save(tmp_path / "ours.exr", precision="float")
        theirs = tmp_path / f"theirs.{frame:04d}.exr"
        assert (tmp_path / "ours.exr").read_bytes() == theirs.read_bytes()


def test_layers_are_arrays(scene, renderer):
    image = renderer.render(scene, ["total", "depth", "normal", "lamps", "id"], "final")
    assert image["depth"].shape == (8, 12) and image["depth"].dtype == np.float32
    assert image["total"].shape == (8, 12, 3)
    assert image["normal"].shape == (8, 12, 3)
    assert list(image) == image.layers and "lamp.left" in image
    assert np.allclose(image["depth"], 3, atol=1e-5)
    assert np.array_equal(image["total"], image["rgb"])
    assert np.allclose(image["normal"], [0, 0, -1])
    assert image.objects == {1: "plane"} and np.all(image["id"] == 1)
    both = image["lamp.left"].astype(np.float64) + image["lamp.right"]
    assert np.allclose(both, image["total"], rtol=1e-6)
    with pytest.raises(KeyError, match="dept: the image has rgb, alpha, total"):
        image["dept"]


@pytest.mark.parametrize("bands", [1, 2, 5])
def test_any_number_of_bands(scene, renderer, bands):
    wavelengths = np.linspace(450.5, 650, bands)
    scene.update({"water.bands": wavelengths, "lamps.left.intensity": 10,
                  "lamps.right.intensity": 10})
    image = renderer.render(scene, ["total", "depth", "transmittance", "direct"])
    assert image["total"].shape == image["direct"].shape == (8, 12, bands)
    assert image["depth"].shape == (8, 12)
    assert image.bands == list(wavelengths)


def test_views_share_memory_and_outlive_the_image(scene, renderer):
    image = renderer.render(scene)
    depth, total = image["depth"], image["total"]
    assert np.shares_memory(depth, image.pixels) and np.shares_memory(total, image["rgb"])
    kept = depth.copy()
    del image
    gc.collect()
    for _ in range(3):  # memory that was freed would be used by these
        renderer.render(scene, "all")
    assert np.array_equal(depth, kept)
    depth[:] = 1  # the image's memory, not the renderer's
    assert np.array_equal(renderer.render(scene)["depth"], kept)


def test_images_are_the_same_for_any_number_of_threads_and_any_history(scene):
    scene["water.scattering"] = {"b": 0.3, "phase": {"type": "hg", "g": 0.8}}
    used = uwvdb.Renderer(threads=2)
    first = used.render(scene, "all").pixels
    other = scene.copy()
    other["lamps.left.position"] = [0, -0.3, 0.1]
    used.render(other)
    assert np.array_equal(used.render(scene, "all").pixels, first, equal_nan=True)
    alone = uwvdb.Renderer(threads=1).render(scene, "all").pixels
    assert np.array_equal(alone, first, equal_nan=True)


def test_pictures(tmp_path, scene, renderer):
    image = renderer.render(scene)
    picture = image.srgb(exposure=4)
    assert picture.shape == (8, 12, 3) and picture.dtype == np.uint8
    linear = np.clip(4 * image["rgb"].astype(np.float64), 0, 1)
    srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    assert np.abs(picture - 255 * srgb).max() <= 0.5 + 1e-3  # rounded
    assert np.array_equal(image.srgb(), image.srgb(image.automatic_exposure))
    image.save(tmp_path / "picture.png")
    assert (tmp_path / "picture.png").read_bytes()[:4] == b"\x89PNG"
    image.save(tmp_path / "picture.bmp", exposure=4)
    bmp = np.frombuffer((tmp_path / "picture.bmp").read_bytes(), np.uint8)
    assert bmp[:2].tobytes() == b"BM"  # lines from the bottom, of blue, green and red, 54 bytes on
    assert np.array_equal(bmp[54:].reshape(8, 12, 3)[::-1, :, ::-1], picture)
    image.save(tmp_path / "light.tif", precision="float")
    image.save(tmp_path / "picture.tif")
    sizes = [(tmp_path / name).stat().st_size for name in ("light.tif", "picture.tif")]
    assert sizes[0] > sizes[1] > 0
    image["rgb"][:] = 0
    assert image.automatic_exposure is None and not image.srgb().any()
    with pytest.raises(uwvdb.UsageError, match="ends in .exr, .png"):
        image.save(tmp_path / "picture.gif")
    with pytest.raises(uwvdb.UsageError, match="precision: unknown 'double'"):
        image.save(tmp_path / "picture.exr", precision="double")
    with pytest.raises(uwvdb.IoError, match="picture.png"):
        image.save(tmp_path / "picture.png/image.exr")


def test_what_is_no_scene(renderer):
    with pytest.raises(uwvdb.UsageError, match="expected a Scene, found str; Scene.load"):
        renderer.render("plume.yaml")


def test_warnings_are_python_warnings(capfd, renderer):
    scene = uwvdb.Scene(camera={"resolution": [4, 4], "intrinsics": {"fov_x": 50}})
    with pytest.warns(uwvdb.SceneWarning, match="there are no lamps, so all that"):
        image = renderer.render(scene)
    assert image.warnings == scene.warnings
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("settings, message", [
    ({"layers": ["totl"]}, "did you mean 'total'"),
    ({"quality": "fine"}, "quality: unknown 'fine'; use draft, final or exact"),
    ({"integrator": "paths"}, "integrator: unknown 'paths'"),
    ({"samples": 100000}, "samples: expected 1 to 4096"),
    ({"crop": (0, 0, 100, 8)}, "not a window of the image of 12 x 8"),
    ({"error": 0.01}, "error: is for integrator path only"),
    ({"layers": "flow"}, "flow"),
    ({"camera": "left"}, "the scene has no camera 'left'; it has one camera"),
    ({"camera": 1}, "there is no camera 1"),
    ({"size": (8.5, 6)}, r"size: expected \(width, height\) in whole pixels, found \(8.5, 6\)"),
    ({"size": 8}, "size: expected .width, height. in whole pixels, found 8"),
    ({"size": (8, -6)}, "size: expected .width, height. of 1 pixel or more"),
    ({"crop": (0, 0, 4)}, "crop: expected .x0, y0, x1, y1. in whole pixels"),
    ({"samples": 0}, "samples: expected a whole number of 1 or more, found 0"),
    ({"samples": "many"}, "samples: expected a whole number of 1 or more, found 'many'"),
    ({"orders": -1}, "orders: expected a whole number of 0 or more, found -1"),
    ({"frame": "3"}, "frame: expected a whole number, found '3'"),
])
def test_what_cannot_be_rendered(scene, renderer, settings, message):
    with pytest.raises(uwvdb.UsageError, match=message) as caught:
        renderer.render(scene, **settings)
    assert "--" not in str(caught.value) and "\n" not in str(caught.value)
    renderer.render(scene)


def copies(value):
    """By every protocol of pickle, and by copy."""
    return [copy.copy(value), copy.deepcopy(value),
            *(pickle.loads(pickle.dumps(value, protocol=protocol))
              for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1))]


def test_images_can_be_pickled(tmp_path, scene, renderer):
    image = renderer.render(scene, "all", crop=(2, 1, 9, 7), integrator="volume",
                            derivatives=["water.absorption"])
    image.save(tmp_path / "first.exr")
    for other in copies(image):
        assert other.layers == image.layers and other.window == image.window
        assert other.channels == image.channels and other.bands == image.bands
        assert np.array_equal(other.pixels, image.pixels, equal_nan=True)
        assert other.metadata == image.metadata and other.report == image.report
        assert other.objects == image.objects and other.materials == image.materials
        assert other.objects and other.warnings == image.warnings
        assert np.array_equal(other.derivative("water.absorption"),
                              image.derivative("water.absorption"), equal_nan=True)
        assert np.array_equal(other.srgb(), image.srgb())
        other.save(tmp_path / "second.exr")
        assert (tmp_path / "first.exr").read_bytes() == (tmp_path / "second.exr").read_bytes()
    deep = copy.deepcopy(image)
    deep["depth"][:] = 7
    assert not np.any(image["depth"] == 7) and np.all(deep["depth"] == 7)


def test_reports_of_light_paths_can_be_pickled(scene, renderer):
    image = renderer.render(scene, integrator="path", samples=4)
    assert image.report["samples"] == 4 and image.report["error"] > 0
    for other in copies(image):
        assert other.report == image.report
