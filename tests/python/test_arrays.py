# ctest labels: unit
"""Volumes and surfaces from arrays."""

import numpy as np
import pytest

import uwvdb
from conftest import ROOT, SCENES

GRID = ROOT / "assets/grids/plume128_blosc_half_0030.vdb"


@pytest.fixture
def plume():
    rng = np.random.default_rng(1)
    return rng.uniform(0, 1, (20, 13, 9)).astype(np.float32)


def total(scene):
    """All layers but those that a scene without volumes lacks."""
    image = uwvdb.Renderer(threads=2).render(scene, "all")
    return image.pixels[..., [not name.startswith("plume.") for name in image.channels]].copy()


PLACE = dict(voxel_size=0.1, origin=(-1, -0.6, 1.2), concentration={"small": 2, "large": 10})


def test_any_type_and_order_is_the_same_volume(scene, plume):
    whole = (16 * plume).round()  # what every type can hold
    images = []
    wide = np.zeros((40, 26, 18), dtype=np.float32)
    wide[::2, ::2, ::2] = whole
    for array in (whole, np.asfortranarray(whole), whole.astype(np.float64), wide[::2, ::2, ::2],
                  whole.astype(np.int16), whole.astype(np.uint8), whole[::-1, ::-1][::-1, ::-1],
                  whole.tolist()):
        changed = scene.copy()
        changed.volumes.add(array, **PLACE)
        images.append(total(changed))
    for image in images[1:]:
        assert np.array_equal(image, images[0], equal_nan=True)
    assert not np.array_equal(images[0], total(scene), equal_nan=True)


def test_an_array_is_the_same_volume_as_its_file(scene):
    grid = uwvdb.read_vdb(GRID, "density")
    assert grid.values.max() > 0 and grid.values.dtype == np.float32
    of_file, of_array = scene.copy(), scene.copy()
    of_file["volumes"] = [{"file": str(GRID), "grids": {"density": {"small": 2}},
                           "transform": {"translate": [-2, -0.5, 3.5]}}]
    of_array.volumes.add(grid.values, world_from_index=grid.world_from_index,
                         concentration={"small": 2}, transform={"translate": [-2, -0.5, 3.5]})
    images = [uwvdb.Renderer().render(each, ["total", "transmittance"])
              for each in (of_file, of_array, scene)]
    # Blocks of 8^3 are quantised by themselves, to 1/131070 of their range, and begin elsewhere: so
    # do the cells in which in-scatter is interpolated, to 2e-3.
    for layer, error in (("transmittance", 2e-5), ("total", 2e-3)):
        first, second, empty = (image[layer] for image in images)
        assert np.allclose(first, second, rtol=error, atol=error * first.max())
        assert not np.allclose(first, empty, rtol=0.05, atol=0.05 * first.max())


def test_a_constant_array_is_uniform_water(scene):
    # The array holds all that the camera sees: absorption that it adds is absorption of the water.
    scene["water.scattering"] = {"b": 0, "phase": {"type": "hg", "g": 0.5}}
    scene["water.absorption"] = 0.1
    uniform = scene.copy()
    uniform["water.absorption"] = 0.35
    scene.volumes.add(np.full((30, 30, 30), 0.25), voxel_size=0.5, origin=(-7, -7, -7),
                      absorption=1, scattering=0)
    # Voxels are quantised exactly where a block is constant; columns of lamps interpolate.
    assert np.allclose(total(scene), total(uniform), rtol=1e-5, equal_nan=True)


def test_an_array_gives_off_light(scene):
    """In an array around the camera, in water that absorbs alone, one sees (1 - e^(-a L)) / a of what a
    cubic metre shines, up to a black wall. With absorption of its own it is the same as beside an array
    that absorbs."""
    scene["water.scattering"] = {"b": 0, "phase": {"type": "hg", "g": 0.5}}
    scene["water.absorption"] = 0.4
    scene["geometry[0].reflectance"] = 0
    scene["lamps"] = []
    array = np.full((16, 16, 16), 0.5)
    place = dict(voxel_size=1, origin=(-7.5, -7.5, -7.5))
    name = scene.volumes.add(array, emission=[4, 2, 1], **place)
    assert scene.volumes[0] == {"array": name, "emission": {name: {"per_unit": [4, 2, 1]}}}
    image = uwvdb.Renderer().render(scene, ["direct", "range", f"lamp.{name}"])
    truth = (1 - np.exp(-0.4 * image["range"][..., None])) / 0.4 * 0.5 * np.array([4, 2, 1])
    # Light is the mean over a pixel, the range that of its middle: pixels are 0.08 rad wide, whose square
    # over 12, for both directions, is 5e-4 of the way.
    assert np.allclose(image["direct"], truth, rtol=5e-4)
    assert np.allclose(image[f"lamp.{name}"], truth, rtol=5e-4)

    scene[f"volumes[0].emission.{name}.samples"] = 1
    beside, both = scene.copy(), scene.copy()
    beside.volumes.add(array, absorption=0.2, scattering=0, **place)
    del both.volumes[0]
    both.volumes.add(array, emission={"per_unit": [4, 2, 1], "name": "fire", "samples": 1},
                     absorption=0.2, scattering=0, **place)
    dimmed = uwvdb.Renderer().render(both, ["direct", "lamp.fire"])["direct"]
    assert np.array_equal(dimmed, uwvdb.Renderer().render(beside, ["direct"])["direct"])
    assert (dimmed < image["direct"]).all()


def test_entries_are_values_of_the_scene(scene, plume):
    name = scene.volumes.add(plume, **PLACE)
    assert name == "array1" and len(scene.volumes) == 1
    assert scene.volumes[0]["grids"]["array1"] == {"small": 2, "large": 10}
    before = total(scene)
    scene["volumes[0].grids.array1.small"] = 3
    assert not np.array_equal(total(scene), before, equal_nan=True)
    scene.volumes.add(plume, **PLACE, name="second")
    with pytest.raises(uwvdb.UsageError, match="there is a 'second' already"):
        scene.volumes.add(plume, **PLACE, name="second")
    del scene.volumes[-1]
    del scene.volumes[0]
    assert len(scene.volumes) == 0
    with pytest.raises(IndexError):
        del scene.volumes[0]


@pytest.mark.parametrize("array, settings, message", [
    (np.zeros((4, 4)), {}, r"expected an array of shape \(nx, ny, nz\), found \(4, 4\)"),
    (np.zeros((4, 0, 4)), {}, r"found \(4, 0, 4\)"),
    (np.zeros((2, 2, 2), complex), {}, "expected real numbers, found complex128"),
    (np.ones((2, 2, 2)), {"voxel_size": 0}, "expected lengths above 0 m, found 0"),
    (np.ones((2, 2, 2)), {"voxel_size": (1, 2)}, r"expected a number or three, found \(2,\)"),
    (np.ones((2, 2, 2)), {"origin": (1, 2)}, "origin: expected a number or three"),
    (np.ones((2, 2, 2)), {"origin": (1, np.nan, 0)}, "origin: expected finite numbers, found"),
    (np.ones((2, 2, 2)), {"voxel_size": np.inf}, "voxel_size: expected finite numbers"),
    (np.ones((2, 2, 2)), {"voxel_size": None, "world_from_index": np.diag([1, 0, 1, 1])},
     "world_from_index: expected finite numbers, and axes that span a volume"),
    (np.ones((2, 2, 2)), {"concentration": 3}, "concentration: expected ppm .*, found 3"),
    (np.ones((2, 2, 2)), {"concentration": "small"}, "expected ppm .*, found 'small'"),
    (np.ones((2, 2, 2)), {"voxel_size": None}, "give either voxel_size, with origin, or"),
    (np.ones((2, 2, 2)), {"world_from_index": np.eye(4)}, "give either voxel_size, with origin"),
    (np.ones((2, 2, 2)), {"voxel_size": None, "world_from_index": np.eye(3)},
     "expected a .4, 4. matrix"),
    (np.ones((2, 2, 2)), {"concentration": None}, "does not say what the values mean"),
])
def test_arrays_that_are_no_volume(scene, array, settings, message):
    with pytest.raises(uwvdb.UsageError, match=message) as caught:
        scene.volumes.add(array, **{**PLACE, **settings})
    assert "\n" not in str(caught.value)


def test_masked_arrays(scene, plume):
    # Which value an unknown one has is for the caller to say.
    masked = np.ma.masked_greater(plume, 0.5)
    with pytest.raises(uwvdb.UsageError, match="volumes.add: some values of the array are masked"):
        scene.volumes.add(masked, **PLACE)
    for vertices, faces in ((np.ma.masked_less(VERTICES, 0), FACES),
                            (VERTICES, np.ma.masked_equal(FACES, 1))):
        with pytest.raises(uwvdb.UsageError, match="some values of the array are masked"):
            scene.geometry.add(vertices, faces)
    with pytest.raises(uwvdb.UsageError, match="project: some values of the array are masked"):
        scene.camera.project(np.ma.masked_less([[0, 0, -1.0]], 0))
    assert len(scene.volumes) == 0 and len(scene.geometry) == 1
    filled, unmasked = scene.copy(), scene.copy()
    filled.volumes.add(masked.filled(0), **PLACE)
    unmasked.volumes.add(np.ma.array(np.where(plume > 0.5, 0, plume)), **PLACE)  # nothing is masked
    assert np.array_equal(total(filled), total(unmasked), equal_nan=True)


@pytest.mark.parametrize("value", [1.0, np.float32(1), np.int8(1)])
def test_more_values_than_memory_holds(scene, value):
    # 17.6 TB as 32-bit floats, 4 or 8 bytes as they are.
    with pytest.raises(uwvdb.InputError, match=r"volumes.add: an array of shape \(16384, 16384, "
                       r"16384\) takes 1.76e\+04 GB of memory, but only .* are free; give fewer"):
        scene.volumes.add(np.broadcast_to(value, (1 << 14,) * 3), **PLACE)
    with pytest.raises(uwvdb.InputError, match="of memory, but only"):
        scene.geometry.add(np.broadcast_to(value, (1 << 42, 3)), FACES)
    assert len(scene.volumes) == 0 and len(scene.geometry) == 1


def test_values_that_repeat(scene, plume):
    repeated, whole = scene.copy(), scene.copy()
    layer = np.broadcast_to(plume[:, :, :1], (20, 13, 9))
    repeated.volumes.add(layer, **PLACE)
    whole.volumes.add(layer.copy(), **PLACE)
    assert np.array_equal(total(repeated), total(whole), equal_nan=True)


def test_meanings_that_no_file_could_have(scene, plume):
    with pytest.raises(uwvdb.InputError, match="must not be negative") as caught:
        scene.volumes.add(plume, **{**PLACE, "concentration": {"small": -1}})
    assert caught.value.key == "volumes[0].grids.array1.small"
    with pytest.raises(uwvdb.InputError, match="unknown key"):
        scene.volumes.add(plume, **{**PLACE, "concentration": {"smal": 1}})
    assert len(scene.volumes) == 0


def test_bad_values_are_warned_of(scene, renderer, plume):
    plume[0, 0, 0], plume[1, 1, 1], plume[2, 2, 2] = np.nan, -1, np.inf
    scene.volumes.add(plume, **PLACE)
    with pytest.warns(uwvdb.SceneWarning) as caught:
        renderer.render(scene)
    text = " ".join(str(warning.message) for warning in caught)
    assert "1 of 2340 active voxels are NaN" in text and "are negative" in text


def test_files_cannot_refer_to_arrays():
    text = (SCENES / "uniform.yaml").read_text() + (
        "\nvolumes: [{array: smoke, grids: {density: {small: 1}}}]\n")
    with pytest.raises(uwvdb.InputError, match="nothing in memory is called 'smoke'"):
        uwvdb.Scene.parse(text, file=SCENES / "x.yaml")


# A square before the wall, nearer to the camera.
VERTICES = [[-0.4, -0.4, 2], [0.4, -0.4, 2], [0.4, 0.4, 2], [-0.4, 0.4, 2]]
FACES = [[0, 1, 2], [0, 2, 3]]


def test_a_mesh_is_the_same_as_its_file(tmp_path, scene):
    lines = [f"v {x} {y} {z}\n" for x, y, z in VERTICES]
    lines += ["f " + " ".join(str(corner + 1) for corner in face) + "\n" for face in FACES]
    (tmp_path / "square.obj").write_text("".join(lines))
    of_file, of_array = scene.copy(), scene.copy()
    of_file["geometry"] = scene["geometry"] + [{"file": str(tmp_path / "square.obj"),
                                                "reflectance": 0.4}]
    name = of_array.geometry.add(np.array(VERTICES, np.float32), np.array(FACES, np.uint8),
                                 reflectance=0.4, name="square")
    assert name == "square" and len(of_array.geometry) == 2
    assert np.array_equal(total(of_file), total(of_array), equal_nan=True)
    image = uwvdb.Renderer().render(of_array, ["depth", "id"])
    assert image.objects == {1: "plane", 2: "square"}
    assert np.isclose(image["depth"][4, 6], 2)
    of_array["geometry[1].transform"] = {"translate": [0, 0, 0.5]}
    assert np.isclose(uwvdb.Renderer().render(of_array)["depth"][4, 6], 2.5)


@pytest.mark.parametrize("vertices, faces, error, message", [
    (np.zeros((4, 2)), FACES, uwvdb.UsageError, r"vertices: expected an array of shape \(V, 3\)"),
    (VERTICES, [[0, 1]], uwvdb.UsageError, r"faces: expected an array of shape \(F, 3\)"),
    (VERTICES, [[0.0, 1, 2]], uwvdb.UsageError, "faces: expected whole numbers, found float64"),
    (VERTICES, [[0, 1, 4]], uwvdb.InputError, "1 faces have a corner that is no vertex"),
    (VERTICES, [[0, 1, -1]], uwvdb.InputError, "corner that is no vertex"),
    (VERTICES, [[0, 1, 1]], uwvdb.InputError, "no face has an area"),
])
def test_arrays_that_are_no_mesh(scene, vertices, faces, error, message):
    with pytest.raises(error, match=message):
        scene.geometry.add(vertices, faces)
    assert len(scene.geometry) == 1
