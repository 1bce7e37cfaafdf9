// ctest labels: unit analytic
// The layers of a plume: boxes of particles in closed form, a Gaussian blob by quadrature, and a
// drift along which its points are projected.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/base/error.h"
#include "render/scene_loading.h"
#include "tests/support/image_of.h"
#include "tests/support/scene_folder.h"
#include "tests/support/test_scene.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw::test {
namespace {

constexpr int k_plume_width = 32, k_plume_height = 24;
constexpr const char* k_plume_layers =
    "plume.optical_depth,plume.opacity,plume.range_50,plume.range_10,range";
const std::array<double, 3> k_plume_per_unit{0.5, 1.0,
                                             1.6};  // attenuation where the grid is 1 [1/m]

VolumeDesc absorbing_volume(const std::filesystem::path& file) {
    VolumeDesc volume;
    volume.file = file;
    volume.where = "test";
    GridMappingDesc mapping;
    mapping.grid = "density";
    mapping.where = "test";
    mapping.optics = {{k_plume_per_unit.begin(), k_plume_per_unit.end()}, {0.0, 0.0, 0.0}, {}};
    volume.grids = {mapping};
    return volume;
}

/// A box of density 1 whose values are the centres of its voxels: it reaches from z = 1 to 3, and
/// far to the sides.
VdbFixture box_of_particles() {
    constexpr double k_blob_voxel = 0.05;
    VdbFixture grid;
    grid.boxes = {{{-60, -60, 0}, {59, 59, 39}, 1}};
    grid.file_from_index =
        Affine::translation({0.5 * k_blob_voxel, 0.5 * k_blob_voxel, 1 + 0.5 * k_blob_voxel}) *
        Affine::scale(Vector3(k_blob_voxel));
    return grid;
}

/// The film of a scene with values by layer.
class PlumeFilm {
  public:
    explicit PlumeFilm(const SceneDesc& desc)
        : plan_(layer_plan(SceneDesc(desc), k_plume_layers)),
          film_(image_of(desc, {.layers = k_plume_layers})) {}

    double at(Layer layer, int x, int y, int band = 0) const {
        return static_cast<double>(
            film_.pixel(x, y)[static_cast<std::size_t>(plan_.first_channel(layer) + band)]);
    }

  private:
    LayerPlan plan_;
    Film film_;
};

/// The point of [low, high] at which a descending function reaches `value`.
double solve(const std::function<double(double)>& descending, double value, double low,
             double high) {
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (descending(middle) > value ? low : high) = middle;
    }
    return low;
}

double mean_transmittance(double column) {
    double sum = 0;
    for (const double c : k_plume_per_unit) sum += std::exp(-c * column);
    return sum / 3;
}

/// The direction of a pixel of pinhole_scene, with z = 1.
Vector3 pixel_direction(int x, int y) {
    const double focal = 0.5 * k_plume_width / std::tan(std::numbers::pi / 6);
    return {(x + 0.5 - 0.5 * k_plume_width) / focal, (y + 0.5 - 0.5 * k_plume_height) / focal, 1};
}

// Interpolation makes the box's faces ramps of one voxel, whose columns are those of the box; the
// distances asked for lie well inside. The films hold 32-bit floats.
TEST(PlumeLayers, AreThoseOfABoxInClosedForm) {
    const TempDir dir;
    write_fixture(dir / "box.vdb", {box_of_particles()});
    SceneDesc desc = pinhole_scene(k_plume_width, k_plume_height);
    desc.volumes = {absorbing_volume(dir / "box.vdb")};
    const PlumeFilm open(desc);
    desc.geometry = {plane_at_z(2)};
    const PlumeFilm cut(desc);
    for (const auto& [x, y] : {std::pair{15, 12}, {3, 5}, {30, 20}}) {
        const double slant = glm::length(pixel_direction(x, y));
        const auto column_to = [&](double range) {
            return std::clamp(range / slant - 1, 0.0, 2.0) * slant;
        };
        for (int b = 0; b < 3; ++b) {
            const double c = k_plume_per_unit[static_cast<std::size_t>(b)];
            EXPECT_NEAR(open.at(Layer::plume_optical_depth, x, y, b), 2 * slant * c, 1e-4);
            EXPECT_NEAR(cut.at(Layer::plume_optical_depth, x, y, b), slant * c, 1e-4);
        }
        EXPECT_NEAR(open.at(Layer::plume_opacity, x, y), 1 - mean_transmittance(2 * slant), 1e-5);
        const auto seen = [&](double range) { return mean_transmittance(column_to(range)); };
        EXPECT_NEAR(open.at(Layer::plume_range_50, x, y), solve(seen, 0.5, 0, 5 * slant), 1e-4);
        EXPECT_NEAR(cut.at(Layer::plume_range_50, x, y), solve(seen, 0.5, 0, 5 * slant), 1e-4);
        // Neither falls to 0.1: the box is too thin.
        EXPECT_EQ(open.at(Layer::plume_range_10, x, y), 0);
        EXPECT_EQ(cut.at(Layer::plume_range_10, x, y), 0);
    }
}

// The grid's trilinear interpolation of a Gaussian is off by up to h^2 / (4 sigma^2) = 1.4e-3 of
// its value, and what is cut off by less; distances follow by as much of the blob's width.
TEST(PlumeLayers, AreThoseOfAGaussianByQuadrature) {
    constexpr double k_blob_sigma = 0.4, k_blob_voxel = 0.03, k_blob_peak = 6, k_blob_middle = 2.5;
    VdbFixture grid;
    const int reach = static_cast<int>(4.5 * k_blob_sigma / k_blob_voxel);
    grid.min = {-reach, -reach, -reach};
    grid.max = {reach, reach, reach};
    grid.value = [=](int i, int j, int k) {
        return k_blob_peak * std::exp(-0.5 * k_blob_voxel * k_blob_voxel * (i * i + j * j + k * k) /
                                      (k_blob_sigma * k_blob_sigma));
    };
    grid.file_from_index =
        Affine::translation({0.0, 0.0, k_blob_middle}) * Affine::scale(Vector3(k_blob_voxel));
    const TempDir dir;
    write_fixture(dir / "blob.vdb", {grid});
    SceneDesc desc = pinhole_scene(k_plume_width, k_plume_height);
    desc.volumes = {absorbing_volume(dir / "blob.vdb")};
    const PlumeFilm film(desc);
    for (const auto& [x, y] : {std::pair{16, 12}, {19, 10}, {13, 15}}) {
        const Vector3 direction = glm::normalize(pixel_direction(x, y));
        const auto column_to = [&](double range) {
            constexpr int k_blob_steps = 4000;
            double sum = 0;
            for (int i = 0; i < k_blob_steps; ++i) {
                const Vector3 from_middle =
                    (i + 0.5) / k_blob_steps * range * direction - Vector3(0, 0, k_blob_middle);
                sum += std::exp(-0.5 * glm::dot(from_middle, from_middle) /
                                (k_blob_sigma * k_blob_sigma));
            }
            return k_blob_peak * sum * range / k_blob_steps;
        };
        const double whole = column_to(6);
        for (int b = 0; b < 3; ++b) {
            const double truth = k_plume_per_unit[static_cast<std::size_t>(b)] * whole;
            EXPECT_NEAR(film.at(Layer::plume_optical_depth, x, y, b), truth, 2e-3 * truth);
        }
        const auto seen = [&](double range) { return mean_transmittance(column_to(range)); };
        EXPECT_NEAR(film.at(Layer::plume_opacity, x, y), 1 - mean_transmittance(whole), 1e-3);
        EXPECT_NEAR(film.at(Layer::plume_range_50, x, y), solve(seen, 0.5, 0, 6), 1e-3);
        EXPECT_NEAR(film.at(Layer::plume_range_10, x, y), solve(seen, 0.1, 0, 6), 2e-3);
    }
}

// Water of its own attenuation, and the same everywhere, is no plume.
TEST(PlumeLayers, AreOfTheParticlesAlone) {
    const TempDir dir;
    write_fixture(dir / "box.vdb", {box_of_particles()});
    SceneDesc desc = pinhole_scene(k_plume_width, k_plume_height);
    desc.volumes = {absorbing_volume(dir / "box.vdb")};
    const PlumeFilm clear(desc);
    desc.water.absorption = {0.9, 0.4, 0.3};
    const PlumeFilm turbid(desc);
    for (const Layer layer : {Layer::plume_optical_depth, Layer::plume_opacity})
        EXPECT_EQ(clear.at(layer, 10, 10), turbid.at(layer, 10, 10));
    desc.volumes.clear();
    EXPECT_THROW(layer_plan(SceneDesc(desc), "plume.opacity"), UsageError);
    EXPECT_FALSE(layer_plan(SceneDesc(desc), "all").has(Layer::plume_opacity));
}

// A quarter turn, and a scale, of the file's axes: the drift must take part in both.
TEST(PlumeLayers, FlowIsTheProjectedDriftOfWhatIsSeen) {
    const SceneFolder folder;
    write_moving_grid(folder / "box.vdb", box_of_particles(), {0.6, -0.2, 0.5},
                      VelocityKind::vectors);
    const SceneDesc all = load_scene(
        folder.write("scene.yaml",
                     "uwvdb: 1\n"
                     "camera:\n"
                     "  resolution: [32, 24]\n"
                     "  intrinsics: {fov_x: 60}\n"
                     "  pose: {position: [0, 0, 0], look_at: [0, 0, 1], up: [0, -1, 0]}\n"
                     "render: {samples: 1, fps: 10}\n"
                     "volumes:\n"
                     "  - file: box.vdb\n"
                     "    up: y\n"
                     "    centering: node\n"
                     "    grids: {density: {absorption: [0.5, 1.0, 1.6]}}\n"
                     "    velocity: {grid: vel}\n"
                     "    transform: {scale: 1, rotate: [0, 0, 90]}\n"),
        {});
    const Film film = [&] {
        Renderer renderer;
        renderer.set_scene(scene_of_image(all, {3}));
        renderer.render({.layers = "plume.flow"});
        return renderer.release_film();
    }();
    const auto first = static_cast<std::size_t>(
        std::find(film.channel_names().begin(), film.channel_names().end(), "plume.flow.X") -
        film.channel_names().begin());
    ASSERT_LT(first, film.channel_names().size());
    const Vector3 drift{0.2, 0.6, 0.5};  // (x, y) to (-y, x)
    for (const auto& [x, y] : {std::pair{16, 12}, {5, 7}, {28, 3}}) {
        const Vector3 direction = pixel_direction(x, y);
        const double slant = glm::length(direction);
        const double half = 0.5 * (1 + mean_transmittance(2 * slant));
        const double z = 1 + solve(mean_transmittance, half, 0, 2 * slant) / slant;
        const Vector3 then = z * direction + 0.1 * drift;
        const double focal = 0.5 * k_plume_width / std::tan(std::numbers::pi / 6);
        const auto pixel = film.pixel(x, y);
        // The median is found in a profile of piecewise linear values, which is exact here.
        EXPECT_NEAR(static_cast<double>(pixel[first]), focal * (then.x / then.z - direction.x),
                    1e-4);
        EXPECT_NEAR(static_cast<double>(pixel[first + 1]), focal * (then.y / then.z - direction.y),
                    1e-4);
    }
}

}  // namespace
}  // namespace uw::test
