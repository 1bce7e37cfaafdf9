# ctest labels: analytic
"""Derivatives of images, against central differences."""

import pickle

import numpy as np
import pytest

import uwvdb

# One for all: at quality exact, most of the work is light that it keeps.
RENDERER = uwvdb.Renderer()


@pytest.fixture
def murky(scene):
    scene.update({"camera.resolution": [6, 4], "water.absorption": [0.3, 0.1, 0.05],
                  "water.scattering": {"b": [0.2, 0.25, 0.3], "phase": {"type": "hg", "g": 0.8}},
                  "render": {"samples": 1}})
    return scene


def with_volumes(scene):
    rng = np.random.default_rng(6)
    scene.volumes.add(rng.uniform(0.2, 1, (8, 6, 6)), voxel_size=0.2, origin=(-0.7, -0.5, 1),
                      concentration={"small": 2, "large": 10})
    scene.volumes.add(rng.uniform(0.2, 1, (6, 6, 6)), voxel_size=0.2, origin=(-0.3, -0.6, 1.2),
                      absorption=[2, 1.5, 1], scattering=0.8, name="ink")
    return scene


def central(render, step):
    """By Richardson from two steps: the error falls with step^4."""
    def difference(h):
        return (render(h).astype(np.float64) - render(-h)) / (2 * h)
    return (4 * difference(step / 2) - difference(step)) / 3


def rendered(scene, path, values, change):
    changed = scene.copy()
    changed[path] = np.array(values) + change
    return RENDERER.render(changed, quality="exact")["total"]


def assert_alike(derivative, expected):
    # Promised is 1e-4. Images are float32: their differences are good to some 3e-5 here.
    assert derivative.shape == expected.shape and derivative.dtype == np.float32
    error = np.abs(derivative - expected) / np.abs(expected).max(axis=(0, 1))
    assert error.max() < 1e-4
    assert np.abs(expected).max() > 0


@pytest.mark.parametrize("name, path", [("water.absorption", "water.absorption"),
                                        ("water.scattering", "water.scattering.b")])
def test_by_coefficients_of_the_water(murky, name, path):
    scene = with_volumes(murky)
    # Particles scatter by phase functions of their own, whatever the water's.
    scene["volumes[1].grids.ink.phase"] = {"type": "hg", "g": 0.5}
    image = RENDERER.render(scene, quality="exact", derivatives=[name])
    values = scene[path]
    assert_alike(image.derivative(name),
                 central(lambda h: rendered(scene, path, values, h), 0.004))


@pytest.mark.parametrize("has_plume, rms, worst", [(False, 3e-3, 1e-2), (True, 4e-3, 3e-2)])
@pytest.mark.parametrize("name, path", [("water.absorption", "water.absorption"),
                                        ("water.scattering", "water.scattering.b")])
def test_at_final_are_those_of_what_is_interpolated(murky, name, path, has_plume, rms, worst):
    """Against differences at exact: those of images at final are farther off than derivatives."""
    murky["camera.resolution"] = [24, 16]
    scene = with_volumes(murky) if has_plume else murky
    values = scene[path]
    expected = central(lambda h: rendered(scene, path, values, h), 0.004)
    derivative = RENDERER.render(scene, quality="final", derivatives=[name]).derivative(name)
    error = np.abs(derivative - expected) / np.abs(expected).max(axis=(0, 1))
    assert np.sqrt((error**2).mean()) < rms
    assert error.max() < worst
    exact = RENDERER.render(scene, quality="exact", derivatives=[name]).derivative(name)
    assert_alike(exact, expected)


@pytest.mark.parametrize("name, path", [
    ("small", "volumes[0].grids.array1.small"), ("large", "volumes[0].grids.array1.large")])
def test_by_concentrations(murky, name, path):
    scene = with_volumes(murky)
    name, value = f"concentration.{name}", scene[path]
    image = RENDERER.render(scene, quality="exact", derivatives=[name])
    expected = central(lambda h: rendered(scene, path, value, h * value), 0.08)
    assert_alike(image.derivative(name), expected)


def particles_of(scene):
    """The water is that of a preset, and so are its particles unless others are given."""
    for key in ("absorption", "scattering"):
        del scene[f"water.{key}"]
    return scene


@pytest.mark.parametrize("kind, ppm, given", [
    ("small", 0.05, {"large": 0.3}), ("large", 0.3, {"small": 0.05}),
    # Which absorb, but for the preset's own, 0.5 ppm, that its measured absorption holds.
    ("large", 0.7, {"absorption": "mineral"}), ("large", 0.2, {"absorption": "mineral"})])
def test_by_the_waters_own_particles(murky, kind, ppm, given):
    scene = with_volumes(particles_of(murky))
    scene["volumes[1].grids.ink.phase"] = {"type": "hg", "g": 0.5}
    scene["water.particles"] = {kind: ppm, **given}
    name = f"water.particles.{kind}"
    image = RENDERER.render(scene, quality="exact", derivatives=[name])
    assert_alike(image.derivative(name),
                 central(lambda h: rendered(scene, name, ppm, h), 0.08 * ppm))


def test_by_particles_that_the_water_has_none_of(murky):
    scene = particles_of(murky)
    scene["water.particles"] = {"small": 0, "large": 0}
    image = RENDERER.render(scene, quality="exact", derivatives=["water.particles.large"])

    def render(h):
        return rendered(scene, "water.particles.large", 0, h).astype(np.float64)
    # There is no less than nothing: forwards, by Richardson from three steps.
    zero, h = render(0), 0.08
    first = [(render(step) - zero) / step for step in (h, h / 2, h / 4)]
    second = [2 * finer - coarser for coarser, finer in zip(first, first[1:])]
    assert_alike(image.derivative("water.particles.large"), (4 * second[1] - second[0]) / 3)


def test_particles_that_change_what_a_grid_scatters_like(murky):
    scene = with_volumes(particles_of(murky))
    with pytest.raises(uwvdb.UsageError, match="grid ink scatters like the water.*give .* a phase"):
        RENDERER.render(scene, quality="draft", derivatives=["water.particles.small"])


def test_by_a_grid_with_coefficients_of_its_own(murky):
    rng = np.random.default_rng(6)
    murky.volumes.add(rng.uniform(0.2, 1, (8, 6, 6)), voxel_size=0.2, origin=(-0.7, -0.5, 1),
                      absorption=[1, 0.8, 0.6], scattering=0.5, name="ink")
    image = RENDERER.render(murky, quality="exact", derivatives=["concentration.ink"])

    def render(h):
        changed = murky.copy()
        changed.update({"volumes[0].grids.ink.absorption": (1 + h) * np.array([1, 0.8, 0.6]),
                        "volumes[0].grids.ink.scattering": (1 + h) * 0.5})
        return RENDERER.render(changed, quality="exact")["total"]
    assert_alike(image.derivative("concentration.ink"), central(render, 0.08))


def test_a_single_path_has_the_derivative_of_its_exponential(scene):
    # Water that only absorbs: every path's light is e^(-a l), l = from lamp to wall to camera.
    scene.update({"lamps": scene["lamps"][:1], "render": {"samples": 1},
                  "water.absorption": [0.3, 0.1, 0.05],
                  "water.scattering": {"b": 0, "phase": {"type": "hg", "g": 0.8}}})
    image = uwvdb.Renderer().render(scene, ["total", "position"], derivatives=["water.absorption"])
    to_lamp = np.linalg.norm(image["position"] - np.array([-0.5, 0, 0]), axis=-1)
    length = to_lamp + np.linalg.norm(image["position"], axis=-1)
    expected = -length[..., None] * image["total"]
    assert np.allclose(image.derivative("water.absorption"), expected, rtol=1e-5)


def test_derivatives_leave_the_image_as_it_is_and_outlive_it(murky):
    renderer = uwvdb.Renderer()
    image = renderer.render(murky, "all", derivatives=["water.absorption", "water.scattering"])
    assert np.array_equal(image.pixels, uwvdb.Renderer().render(murky, "all").pixels,
                          equal_nan=True)
    derivative = image.derivative("water.absorption")
    kept = derivative.copy()
    del image
    renderer.render(murky)
    assert np.array_equal(derivative, kept)
    cropped = renderer.render(murky, crop=(1, 2, 4, 4), derivatives=["water.absorption"])
    assert cropped.derivative("water.absorption").shape == (2, 3, 3)


@pytest.mark.parametrize("changes, name, message", [
    ({}, "water.absorbtion", "unknown; use water.absorption"),
    ({}, "concentration.small", "the volumes hold nothing"),
    ({"render.integrator": "reference"}, "water.absorption", "integrators volume and path"),
    ({"water.forward_scatter": {"K": 0.1, "G": 0.1, "B": 0.1}}, "water.absorption",
     "blurs the finished image, .*; remove water.forward_scatter, or set its K to 0"),
    ({"water.snow": {"number": 2000, "diameter": ["0.2 mm", "5 mm"]}}, "water.absorption",
     "drawn particle by particle.*; remove water.snow"),
    ({}, "water.particles.small", "the water's scattering is given.*; remove water.scattering"),
])
def test_what_has_no_derivative(murky, changes, name, message):
    murky.update(changes)
    with pytest.raises(uwvdb.UsageError, match=f"^derivative '?{name}'?: .*{message}"):
        uwvdb.Renderer().render(murky, quality="draft", derivatives=[name])
    with pytest.raises(KeyError, match="request it"):
        uwvdb.Renderer().render(murky, quality="draft").derivative(name)


def test_light_matrix_mixes_lamps(scene):
    matrix = RENDERER.light_matrix(scene, quality="exact")
    assert matrix.lamps == ["left", "right"] and matrix.images.shape == (2, 8, 12, 3)
    assert np.abs(matrix.rest).max() < 1e-6
    factors = np.array([[2, 0.5, 1], [0, 3, 0.1]])
    mixed = matrix.mix(factors)
    scene.update({"lamps.left.intensity": factors[0] * scene["lamps.left.intensity"],
                  "lamps.right.intensity": factors[1] * scene["lamps.right.intensity"]})
    assert np.allclose(mixed, RENDERER.render(scene, quality="exact")["total"], rtol=1e-6)
    assert np.allclose(matrix.mix([1, 1]), matrix.images.sum(axis=0), rtol=1e-6)
    with pytest.raises(uwvdb.UsageError, match=r"expected factors of shape \(2,\) or \(2, 3\)"):
        matrix.mix([1, 2, 3])


def plain(scene):
    """Light scattered once, whose numbers are all written."""
    scene.update({"camera.resolution": [6, 4], "render": {"samples": 1, "scattering": "single"},
                  "water.absorption": [0.3, 0.1, 0.05], "lamps.left.profile":
                  {"type": "cosine", "fwhm": 80},
                  "water.scattering": {"b": [0.2, 0.25, 0.3], "phase": {"type": "hg", "g": 0.8}}})
    return scene


# The reference integrator has no nodes that move with lamps. Images are float32: smaller steps
# would leave too few digits.
@pytest.mark.parametrize("path, direction, step", [
    ("water.absorption", [1, 2, 0.5], 0.004), ("water.scattering.b", [1, 0.5, -1], 0.004),
    ("water.scattering.phase.g", 1, 0.004), ("lamps.left.intensity", [1, 2, 3], 0.1),
    ("lamps.left.position", [1, 0.5, 0.2], 0.005), ("lamps.left.direction", [1, 0, 0], 0.01),
    ("lamps.left.profile.fwhm", 1, 0.5), ("geometry[0].reflectance", 1, 0.02)])
def test_jvp_by_numbers_of_the_scene(scene, path, direction, step):
    scene = plain(scene)
    values = scene[path]

    def render(h):
        changed = scene.copy()
        changed[path] = (np.array(values) + h * np.array(direction)).tolist()
        return RENDERER.render(changed, quality="exact", integrator="reference")["total"]
    derivative = RENDERER.render(scene, quality="exact").jvp({path: direction})
    assert_alike(derivative, central(render, step))


def test_backward_is_the_transpose_of_jvp(scene):
    scene = with_volumes(plain(scene))
    image = RENDERER.render(scene, quality="exact")
    weights = np.random.default_rng(1).normal(size=image["total"].shape)
    found = image.backward(weights, ["lamps.left.position", "volumes[1].grids.ink.scattering",
                                     "volumes[0].grids.array1.large"])
    along = {"lamps.left.position": np.array([0.3, -0.2, 0.1]),
             "volumes[1].grids.ink.scattering": np.array(0.5),
             "volumes[0].grids.array1.large": np.array(-2.0)}
    expected = (image.jvp(along) * weights).sum()
    assert sum((found[path] * along[path]).sum() for path in along) == pytest.approx(expected,
                                                                                   rel=1e-5)


def test_backward_to_voxels(scene):
    scene = plain(scene)
    rng = np.random.default_rng(6)
    values = rng.uniform(0.2, 1, (8, 6, 6))
    values[3, 3, 3] = 0  # also where there is nothing
    scene.volumes.add(values, voxel_size=0.2, origin=(-0.7, -0.5, 1), absorption=[2, 1.5, 1],
                      scattering=0.8, phase={"type": "hg", "g": 0.5}, name="ink")
    image = RENDERER.render(scene, quality="exact")
    weights = rng.normal(size=image["total"].shape)
    gradient = image.backward(weights, "volumes[0].array")["volumes[0].array"]
    assert gradient.shape == values.shape
    # Columns on the camera's ray are those of linear pieces, a quarter of a voxel long.
    tolerance = 2e-3 * np.linalg.norm(gradient)
    # All of them together: what a factor on what they mean does.
    along = {"volumes[0].grids.ink.absorption": [2, 1.5, 1],
             "volumes[0].grids.ink.scattering": 0.8}
    assert (gradient * values).sum() == pytest.approx(
        (image.jvp(along) * weights).sum(), abs=tolerance * np.linalg.norm(values))

    def render(h, direction):
        changed = scene.copy()
        changed.volumes.set_values("ink", values + h * direction)
        light = RENDERER.render(changed, quality="exact", integrator="reference")["total"]
        return (light * weights).sum()
    for direction in (rng.normal(size=values.shape) * (values > 0), np.eye(1, 288, 100).reshape(
            values.shape)):
        expected = central(lambda h: render(h, direction), 0.04)
        assert (gradient * direction).sum() == pytest.approx(
            expected, abs=tolerance * np.linalg.norm(direction))
    # At final a few nodes of each ray stand for all. For so many rays their noise is 0.12.
    many = dict(gradient=np.ones((24, 36, 3)), of="volumes[0].array", size=(36, 24))
    exact = image.backward(**many)["volumes[0].array"]
    drawn = image.backward(**many, quality="final")["volumes[0].array"]
    assert 0 < np.linalg.norm(drawn - exact) < 0.3 * np.linalg.norm(exact)


def test_at_final_backward_is_right_in_the_mean(scene):
    """A few nodes of each ray stand for all."""
    scene = with_volumes(plain(scene))
    scene["camera.resolution"] = [48, 32]
    names = ["lamps.left.position", "lamps.left.intensity", "lamps.right.intensity",
             "lamps.right.position", "water.absorption", "geometry[0].reflectance"]
    weights = np.ones((32, 48, 3))
    exact = RENDERER.backward(scene, weights, names, quality="exact")
    drawn = [RENDERER.backward(scene, weights, names, quality="final", seed=seed)
             for seed in range(6)]
    for name in names:
        values = np.array([found[name] for found in drawn])
        size = np.abs(exact[name]).max()
        # 1e-3: what the interpolated image is off at final.
        error = values.std(axis=0, ddof=1) / np.sqrt(len(drawn)) + 1e-3 * size
        assert (np.abs(values.mean(axis=0) - exact[name]) < 4 * error).all(), name
        # Least sure is what few pixels tell, which see the wall through gaps of the plume.
        assert values.std(axis=0).max() < 0.08 * size, name


SHEET = [[-0.6, -0.5, 1.4], [0.7, -0.4, 1.8], [0.6, 0.5, 1.7], [-0.7, 0.4, 1.3]]


def textured(scene, texture):
    """A sheet ahead, tilted, with a texture."""
    scene.geometry.add(SHEET, [[0, 1, 2], [0, 2, 3]], uvs=[[0, 0], [1, 0], [1, 1], [0, 1]],
                       texture=texture, name="sheet")
    return f"geometry[{len(scene.geometry) - 1}].texture"


# Fine texels are averaged in the image, by way of halved textures; coarse ones interpolated.
@pytest.mark.parametrize("width, height", [(5, 4), (61, 47)])
def test_backward_to_texels(scene, width, height):
    scene = plain(scene)
    scene["camera.resolution"] = [8, 6]
    rng = np.random.default_rng(3)
    texels = rng.uniform(0.2, 0.8, (height, width, 3))
    path = textured(scene, texels)
    image = RENDERER.render(scene)
    weights = rng.normal(size=image["total"].shape)
    gradient = image.backward(weights, path)[path]
    assert gradient.shape == texels.shape
    direction = rng.normal(size=texels.shape)

    def render(h):
        changed = scene.copy()
        changed.geometry.set_texture("sheet", texels + h * direction)
        return (RENDERER.render(changed)["total"] * weights).sum()
    # Images are float32. Light of surfaces is exact at final, too.
    assert (gradient * direction).sum() == pytest.approx(
        central(render, 0.02),
        abs=1e-4 * np.linalg.norm(gradient) * np.linalg.norm(direction))


def test_of_all_light_by_texels(scene):
    """All of an even texture together are the reflectance in its place, by the same paths."""
    scene = plain(scene)
    scene["camera.resolution"] = [8, 6]
    scene["render"] = {"integrator": "path", "samples": 16}
    even = scene.copy()
    reflectance = np.array([0.3, 0.6, 0.5])
    even.geometry.add(SHEET, [[0, 1, 2], [0, 2, 3]], reflectance=reflectance.tolist())
    path = textured(scene, np.broadcast_to(reflectance, (4, 5, 3)))
    weights = np.random.default_rng(3).normal(size=(6, 8, 3))
    by_texel = RENDERER.backward(scene, weights, path)[path]
    expected = RENDERER.backward(even, weights, "geometry[1].reflectance")
    assert by_texel.shape == (4, 5, 3)
    assert np.allclose(by_texel.sum(axis=(0, 1)), expected["geometry[1].reflectance"], rtol=1e-4,
                       atol=1e-5 * np.abs(by_texel).sum())


def test_textures_are_kept_and_checked(scene):
    texels = np.full((2, 3, 3), 0.25)
    texels[0, 0] = [0.5, 0.75, 1]
    textured(scene, texels)
    settings = dict(size=(24, 18))
    image = RENDERER.render(scene, ["clean"], **settings)["clean"]
    again = RENDERER.render(pickle.loads(pickle.dumps(scene)), ["clean"], **settings)["clean"]
    assert (image == again).all()
    other = scene.copy()
    other.geometry.set_texture("sheet", np.full((1, 1, 3), 0.25))
    assert (RENDERER.render(other, ["clean"], **settings)["clean"] < image).any()
    with pytest.raises(uwvdb.UsageError, match="expected reflectances from 0 to 1"):
        scene.geometry.set_texture("sheet", np.full((2, 2, 3), 128))
    with pytest.raises(uwvdb.UsageError, match=r"expected an array of shape \(height, width, 3\)"):
        scene.geometry.set_texture("sheet", np.full((2, 2), 0.5))
    with pytest.raises(uwvdb.UsageError, match="no mesh 'rock' with a texture"):
        scene.geometry.set_texture("rock", texels)
    with pytest.raises(uwvdb.UsageError, match="give uvs and a texture, or neither"):
        scene.geometry.add(np.eye(3), [[0, 1, 2]], texture=texels)
    with pytest.raises(uwvdb.UsageError, match="uvs: expected numbers of at most 1e"):
        scene.geometry.add(np.eye(3), [[0, 1, 2]], uvs=np.full((3, 2), np.nan), texture=texels)
    with pytest.raises(uwvdb.UsageError, match=r"uvs: expected an array of shape \(3, 2\)"):
        scene.geometry.add(np.eye(3), [[0, 1, 2]], uvs=np.zeros((2, 2)), texture=texels)
    with pytest.raises(uwvdb.UsageError, match="geometry\\[0\\].texture: only of textures in memory"):
        RENDERER.backward(scene, np.ones((8, 12, 3)), "geometry[0].texture")


@pytest.mark.parametrize("path, direction, step", [
    ("water.absorption", [1, 1, 1], 0.02), ("water.scattering.b", [1, 1, 1], 0.04),
    ("water.scattering.phase.g", 1, 0.02), ("geometry[0].reflectance", 1, 0.1)])
def test_of_all_light(scene, path, direction, step):
    """Within three standard errors of central differences, mean over the image: those of the
    differences, which are twenty times those of the derivative."""
    scene = plain(scene)
    scene["camera.resolution"] = [4, 3]
    del scene["render.scattering"]
    scene["render.integrator"] = "path"
    values = scene[path]

    def render(h):
        changed = scene.copy()
        changed[path] = (np.array(values) + h * np.array(direction)).tolist()
        image = RENDERER.render(changed, ["total", "error"], samples=2048)
        return image["total"].astype(float).mean(), np.sqrt((image["error"]**2).sum()) / 36
    (more, error), (less, _) = render(step), render(-step)
    found = RENDERER.jvp(scene, {path: direction}, samples=512).mean()
    assert abs(found - (more - less) / (2 * step)) < 3 * np.sqrt(2) * error / (2 * step)
    assert abs(found) > 10 * error  # some of it


def test_of_all_light_by_voxels_and_by_names(scene):
    scene = with_volumes(plain(scene))
    scene["camera.resolution"] = [3, 2]
    del scene["render.scattering"]
    scene["render.integrator"] = "path"
    image = RENDERER.render(scene, samples=64, derivatives=["concentration.ink"])
    weights = np.ones(image["total"].shape)
    # The same paths: to rounding, but for what voxels of 16 bits are quantised by.
    gradient = image.backward(weights, "volumes[1].array")["volumes[1].array"]
    values = np.random.default_rng(6)
    values.uniform(0.2, 1, (8, 6, 6))
    ink = values.uniform(0.2, 1, (6, 6, 6))
    assert (gradient * ink).sum() == pytest.approx(image.derivative("concentration.ink").sum(),
                                                   rel=1e-4)


@pytest.mark.parametrize("path, message", [
    ("camera.intrinsics.fov_x", "where the camera sees a point"),
    ("geometry[0].point", "it moves surfaces"),
    ("water.salinity", "is not written in the scene"),
    ("lamps.left.name", "expected a number or a list of numbers"),
    ("volumes[0].array", "is not written in the scene")])
def test_by_what_there_is_none(scene, path, message):
    with pytest.raises(uwvdb.UsageError, match=f"{message}"):
        RENDERER.jvp(plain(scene), {path: 1})


def test_a_gradient_of_another_shape(scene):
    with pytest.raises(uwvdb.UsageError, match=r"expected the shape .* \(4, 6, 3\), found \(4, 6\)"):
        RENDERER.backward(plain(scene), np.zeros((4, 6)), "water.absorption")
    with pytest.raises(uwvdb.UsageError, match="volumes in memory"):
        RENDERER.backward(plain(scene), np.zeros((4, 6, 3)), "volumes[0].array")


def test_a_pickled_image_has_lost_its_scene(scene):
    image = pickle.loads(pickle.dumps(RENDERER.render(scene)))
    with pytest.raises(uwvdb.UsageError, match="use Renderer.jvp"):
        image.jvp({"water.absorption": 1})
