# ctest labels: unit
"""Cameras, water, files."""

import copy
import csv
import io
import json
import pickle

import numpy as np
import pytest

import uwvdb
from conftest import ROOT, SCENES, run_program

PORT = SCENES / "port.yaml"
GRID = ROOT / "assets/grids/plume128_blosc_half_0030.vdb"


def table(text):
    rows = list(csv.DictReader(io.StringIO(text)))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def test_rays_are_those_of_the_command_line(tmp_path):
    camera = uwvdb.Scene.load(PORT).camera
    pixels = np.random.default_rng(3).uniform(-0.1, 1.1, (200, 2)) * [camera.width, camera.height]
    np.savetxt(tmp_path / "pixels.csv", pixels, delimiter=",", fmt="%.17g")
    found = table(run_program("rays", PORT, tmp_path / "pixels.csv", "--quiet"))
    rays = camera.rays(pixels)
    for name, array in (("origin", rays.origin), ("direction", rays.direction)):
        expected = np.stack([found[f"{name}_{axis}"] for axis in "xyz"], axis=-1)
        assert np.array_equal(array, expected, equal_nan=True)
    outside = (pixels < 0).any(axis=1) | (pixels > [camera.width, camera.height]).any(axis=1)
    assert outside.any() and np.isnan(rays.origin[outside]).all()
    assert not np.isnan(rays.origin[~outside]).any()


def test_projections_are_those_of_the_command_line_and_invert_rays(tmp_path):
    camera = uwvdb.Scene.load(PORT).camera
    pixels = camera.pixel_centres()[::97, ::89]
    rays = camera.rays(pixels)
    points = rays.origin + 1.7 * rays.direction
    assert points.shape == (*pixels.shape[:-1], 3)
    assert np.abs(camera.project(points) - pixels).max() < 2e-6  # as Camera::project promises
    np.savetxt(tmp_path / "points.csv", points.reshape(-1, 3), delimiter=",", fmt="%.17g")
    found = table(run_program("project", PORT, tmp_path / "points.csv", "--quiet"))
    expected = np.stack([found["pixel_x"], found["pixel_y"]], axis=-1)
    assert np.array_equal(camera.project(points).reshape(-1, 2), expected)


def test_points_that_are_not_in_the_image():
    camera = uwvdb.Scene(camera={"resolution": [100, 50], "intrinsics": {"fov_x": 90}}).camera
    points = [[0, 0, 1], [2, 0, 1], [0, 0, -1], [np.nan, 0, 1]]
    assert np.array_equal(camera.project(points),
                          [[50, 25], [np.nan] * 2, [np.nan] * 2, [np.nan] * 2], equal_nan=True)
    assert np.allclose(camera.project(points, beyond=True)[1], [150, 25])
    assert camera.matrix[0].tolist() == [pytest.approx(50), 0, 50]
    assert np.array_equal(camera.world_from_camera[3], [0, 0, 0, 1])
    for wrong in (np.zeros(2), np.zeros((4, 2)), 5):
        with pytest.raises(uwvdb.UsageError, match=r"expected an array of shape \(..., 3\)"):
            camera.project(wrong)


def test_cameras_of_other_wavelengths():
    scene = uwvdb.Scene.load(SCENES / "port.yaml")
    assert np.array_equal(scene.camera_at(wavelength=450).project([1, 0.5, 2]),
                          scene.camera.project([1, 0.5, 2]))  # its indices are numbers
    scene.update({"camera.port.n_glass": "bk7", "camera.port.n_water": "seawater"})
    assert scene.camera.wavelength == 540
    blue, green, red = (scene.camera_at(wavelength=nm) for nm in (450, 540, 620))
    assert blue.wavelength == 450
    x = [camera.project([1, 0.5, 2])[0] for camera in (red, green, blue)]
    assert x[0] + 0.2 < x[1] < x[2] - 0.2  # blue is enlarged most
    assert np.array_equal(green.project([1, 0.5, 2]), scene.camera.project([1, 0.5, 2]))
    again = pickle.loads(pickle.dumps(blue))
    assert again.wavelength == 450 and again.project([1, 0.5, 2])[0] == x[2]
    with pytest.raises(uwvdb.UsageError, match="wavelength"):
        scene.camera_at(wavelength=0.45)


def test_cameras_of_rigs():
    scene = uwvdb.Scene.load(SCENES / "stereo.yaml")
    left, right = (scene.camera_at(name) for name in scene.cameras)
    assert np.array_equal(scene.camera.world_from_camera, left.world_from_camera)
    assert not np.array_equal(right.world_from_camera, left.world_from_camera)
    with pytest.raises(uwvdb.UsageError, match="the scene has several"):
        uwvdb.Renderer().render(scene)


def test_water():
    water = uwvdb.Water("jerlov-II", bands=range(400, 701, 10))
    assert water.bands.tolist() == list(range(400, 701, 10))
    assert water.absorption.shape == water.scattering.shape == (31,)
    assert np.all(water.absorption > 0) and water.absorption[-1] > water.absorption[5]
    printed = json.loads(run_program("water", "jerlov-II", "--bands", "400:700:10", "--json"))
    assert np.allclose(printed["uniform"]["a"], water.absorption, rtol=1e-5)
    # A phase function's integral over the sphere is 1: midpoints in the cosine's cube, as it peaks.
    edges = np.concatenate([[0], np.geomspace(1e-4, 180, 20001)])
    middle = np.radians(0.5 * (edges[1:] + edges[:-1]))
    p = water.phase(np.degrees(middle))
    integral = (2 * np.pi * p * np.sin(middle) * np.radians(np.diff(edges))).sum(axis=1)
    assert p.shape == (31, 20001) and np.allclose(integral, 1, rtol=2e-3)
    assert np.allclose(water.attenuation, water.absorption + water.scattering)


def test_water_of_coefficients():
    water = uwvdb.Water(bands=[500], absorption=0.1,
                        scattering={"b": 0.4, "phase": {"type": "hg", "g": 0.5}})
    assert water.absorption == [0.1] and water.scattering == [0.4]
    cosine = np.cos(np.radians(40))
    henyey_greenstein = (1 - 0.25) / (4 * np.pi * (1.25 - cosine) ** 1.5)
    assert water.phase(40) == pytest.approx(henyey_greenstein)
    assert water.phase([[40, 50]]).shape == (1, 1, 2)
    with pytest.raises(uwvdb.InputError, match="jerlov-7"):
        uwvdb.Water("jerlov-7")


def test_water_of_scenes(scene):
    scene.volumes.add(np.ones((4, 4, 4)), voxel_size=1, absorption=[1, 2, 3], scattering=4,
                      name="ink")
    (ink,) = scene.water.constituents
    assert ink["name"] == "ink" and ink["absorption"].tolist() == [1, 2, 3]


def test_vdb_files():
    found = uwvdb.inspect(GRID)
    (density,) = [grid for grid in found["grids"] if grid["name"] == "density"]
    grid = uwvdb.read_vdb(GRID, "density")
    stored = grid.values[grid.values != 0]
    assert density["max"] == pytest.approx(float(grid.values.max()))
    assert stored.size <= density["active_voxels"] <= grid.values.size
    assert np.allclose(grid.voxel_size, density["voxel_size"])
    # The bounds are those of cells around the values.
    corners = np.array([[-0.5, -0.5, -0.5, 1], [*(np.array(grid.values.shape) - 0.5), 1]])
    corners = corners @ grid.world_from_index.T
    assert np.allclose(corners.min(axis=0)[:3], density["bounds"][0])
    assert np.allclose(corners.max(axis=0)[:3], density["bounds"][1])
    with pytest.raises(uwvdb.InputError, match="desity"):
        uwvdb.read_vdb(GRID, "desity")
    with pytest.raises(uwvdb.IoError, match="nowhere.vdb"):
        uwvdb.read_vdb("nowhere.vdb")
    with pytest.raises(uwvdb.InputError):
        uwvdb.inspect(PORT)


def test_written_vdb_files_are_the_arrays(scene, renderer, tmp_path):
    file = tmp_path / "smoke.vdb"
    rng = np.random.default_rng(3)
    smoke = np.zeros((21, 14, 9))
    smoke[2:20, 1:13, :] = rng.uniform(0.1, 1, (18, 12, 9))
    heat = rng.uniform(300, 400, (8, 8, 8)).astype(np.float32)
    uwvdb.write_vdb(file, {"density": smoke, "heat": heat[::-1]}, voxel_size=0.1,
                    origin=(-1, -0.6, 1.2))
    found = {grid["name"]: grid for grid in uwvdb.inspect(file)["grids"]}
    assert found["density"]["active_voxels"] == 18 * 12 * 9
    assert np.allclose(found["heat"]["voxel_size"], 0.1)
    # The box of the values that are not 0, to the bit as 32-bit floats.
    density = uwvdb.read_vdb(file, "density")
    assert np.array_equal(density.values, smoke[2:20, 1:13, :].astype(np.float32))
    assert np.allclose(density.origin, (-0.8, -0.5, 1.2), atol=1e-12)
    heated = uwvdb.read_vdb(file, "heat")
    assert np.array_equal(heated.values, heat[::-1])
    assert np.allclose(heated.origin, (-1, -0.6, 1.2), atol=1e-12)
    # A scene shows the same volume of the file and of the array.
    of_file, of_array = scene.copy(), scene.copy()
    of_file["volumes"] = [{"file": str(file), "grids": {"density": {"large": 10}}}]
    of_array.volumes.add(smoke, voxel_size=0.1, origin=(-1, -0.6, 1.2),
                         concentration={"large": 10})
    seen, expected, empty = (renderer.render(each, ["transmittance"])["transmittance"]
                             for each in (of_file, of_array, scene))
    # Blocks of 8^3 are quantised by themselves, to 1/131070 of their range, and begin elsewhere.
    assert np.allclose(seen, expected, rtol=2e-5)
    assert not np.allclose(seen, empty, rtol=0.05)
    other = tmp_path / "one.vdb"
    uwvdb.write_vdb(other, np.ones((2, 2, 2), np.uint8), 1, name="one")
    assert uwvdb.read_vdb(other).name == "one"


def test_write_vdb_refuses_what_is_no_grid(tmp_path):
    file = tmp_path / "bad.vdb"
    ones = np.ones((3, 3, 3))
    broken = ones.copy()
    broken[0, 1, 2] = np.nan
    for arguments, message in (((ones[0], 1), "three axes"), ((broken, 1), r"at \[0, 1, 2\]"),
                               ((ones, 0), "above 0"), ((ones, (1, 1, 2)), "above 0"),
                               ((ones * 1j, 1), "real numbers"),
                               (({}, 1), "no array"), ((ones, 1, (0, np.inf, 0)), "finite")):
        with pytest.raises(uwvdb.UsageError, match=message):
            uwvdb.write_vdb(file, *arguments)
    with pytest.raises(uwvdb.UsageError, match="ends in .vdb"):
        uwvdb.write_vdb(tmp_path / "smoke", ones, 1)
    assert not list(tmp_path.iterdir())
    (tmp_path / "folder.vdb").mkdir()
    with pytest.raises(uwvdb.IoError):
        uwvdb.write_vdb(tmp_path / "folder.vdb", ones, 1)


OPENCV = """\
%YAML:1.0
image_width: 640
image_height: 480
camera_matrix: !!opencv-matrix {rows: 3, cols: 3, dt: d, data: [500, 0, 320, 0, 510, 240, 0, 0, 1]}
distortion_coefficients: !!opencv-matrix {rows: 1, cols: 5, dt: d, data: [-0.1, 0.01, 0, 0, 0]}
"""


def test_calibrations(tmp_path):
    (tmp_path / "camera.yaml").write_text(OPENCV)
    found = uwvdb.calibration.load(tmp_path / "camera.yaml")
    assert found.format == "opencv" and found.names == [] or found.names == [found.name]
    scene = uwvdb.Scene(camera=found.section)
    for camera in (found.camera, scene.camera):
        # OpenCV counts from the first pixel's centre.
        assert camera.matrix.tolist() == [[500, 0, 320.5], [0, 510, 240.5], [0, 0, 1]]
        assert camera.distortion[0] == "brown-conrady"
        assert camera.distortion[1][:2].tolist() == [-0.1, 0.01]
        # On the x axis: x' = x (1 + k1 x^2 + k2 x^4).
        x = 0.3 * (1 - 0.1 * 0.09 + 0.01 * 0.0081)
        assert np.allclose(camera.project([0.6, 0, 2]), [320.5 + 500 * x, 240.5])
    (tmp_path / "broken.yaml").write_text(OPENCV.replace("camera_matrix", "matrix"))
    with pytest.raises(uwvdb.InputError, match="broken.yaml"):
        uwvdb.calibration.load(tmp_path / "broken.yaml")


def pickled(value):
    return pickle.loads(pickle.dumps(value))


@pytest.mark.parametrize("name", ["port.yaml", "stereo.yaml", "uniform.yaml"])
def test_cameras_can_be_pickled(name):
    scene = uwvdb.Scene.load(SCENES / name)
    for camera in [scene.camera_at(index) for index in range(max(1, len(scene.cameras)))]:
        for other in (pickled(camera), copy.copy(camera), copy.deepcopy(camera)):
            pixels = camera.pixel_centres()[::37, ::41]
            assert (other.width, other.height) == (camera.width, camera.height)
            for ours, theirs in zip(other.rays(pixels), camera.rays(pixels)):
                assert np.array_equal(ours, theirs, equal_nan=True)
            points = camera.rays(pixels).origin + 2 * camera.rays(pixels).direction
            assert np.array_equal(other.project(points), camera.project(points), equal_nan=True)
            assert np.array_equal(other.world_from_camera, camera.world_from_camera)


@pytest.mark.parametrize("keys", [
    {"port": {"type": "dome", "center": [0.001, 0, 0.002], "radius": 0.05, "thickness": 0.005}},
    {"port": {"type": "flat", "distance": 0.02, "thickness": 0.01, "normal": [0.1, 0, 1]}},
    {"distortion": {"model": "fisheye", "k": [0.1, 0.01, 0, 0.001]}},
    {"distortion": {"k": [-0.1, 0.01, 0.003], "p": [0.001, 0.002]}},
])
def test_lenses_and_ports_are_pickled(keys):
    scene = uwvdb.Scene(camera={"resolution": [100, 50], "intrinsics": {"fov_x": 90}, **keys})
    camera, other = scene.camera, pickled(scene.camera)
    pixels = camera.pixel_centres()[::7, ::7]
    for ours, theirs in zip(other.rays(pixels), camera.rays(pixels)):
        assert np.array_equal(ours, theirs, equal_nan=True)
    assert other.distortion[0] == camera.distortion[0]
    assert np.array_equal(other.distortion[1], camera.distortion[1])
    assert np.array_equal(other.matrix, camera.matrix)


def test_water_can_be_pickled():
    scene = uwvdb.Scene.load(SCENES / "uniform.yaml")
    scene.volumes.add(np.ones((2, 2, 2)), voxel_size=1, concentration={"small": 1, "large": 2})
    of_scene = scene.water
    scene["water.salinity"] = 1  # which is no business of the water that was taken before
    for water in (uwvdb.Water("jerlov-II", bands=range(400, 701, 50), particles={"small": 0.5}),
                  of_scene):
        for other in (pickled(water), copy.copy(water), copy.deepcopy(water)):
            assert np.array_equal(other.bands, water.bands)
            assert np.array_equal(other.absorption, water.absorption)
            assert np.array_equal(other.scattering, water.scattering)
            assert np.array_equal(other.phase(range(0, 181, 5)), water.phase(range(0, 181, 5)))
            assert other.phase_functions == water.phase_functions
            assert [c["name"] for c in other.constituents] == [
                c["name"] for c in water.constituents]
    assert of_scene.constituents


def test_a_camera_behind_a_rolling_shutter_says_how_to_pickle_it():
    scene = uwvdb.Scene(camera={
        "resolution": [100, 50], "intrinsics": {"fov_x": 90}, "line_time": 1e-3,
        "trajectory": {"keyframes": [{"time": 0, "position": [0, 0, 0], "look_at": [0, 0, 9]},
                                     {"time": 9, "position": [9, 0, 0], "look_at": [9, 0, 9]}]}})
    with pytest.raises(TypeError, match="rolling shutter cannot be pickled; pickle its scene"):
        pickle.dumps(scene.camera_at(frame=24))
