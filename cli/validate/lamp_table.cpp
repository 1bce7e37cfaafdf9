#include "cli/validate/lamp_table.h"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>
#include <numbers>

#include "cli/validate/light_mean.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/frame/path_pixels.h"
#include "core/lamps/lamp.h"

namespace uw {

namespace {

constexpr std::array<LampTableRow, 6> k_table{{
    {0.5, 10, {1.298567e+00, 4.015603e-01, 6.072572e-02, 6.492081e-03}, 1.768320e+00},
    {1, 5, {1.955968e+00, 8.166167e-01, 1.756715e-01, 2.737343e-02}, 2.980021e+00},
    {1, 45, {5.206465e-03, 5.210147e-03, 2.778505e-03, 1.102229e-03}, 1.501094e-02},
    {1, 120, {3.112558e-04, 3.987162e-04, 2.997133e-04, 1.831806e-04}, 1.467097e-03},
    {2, 2, {1.696868e+00, 8.024401e-01, 2.311521e-01, 5.538067e-02}, 2.801283e+00},
    {2, 20, {1.005820e-02, 1.590930e-02, 1.231261e-02, 6.341750e-03}, 4.842843e-02},
}};

constexpr double k_scattering = 0.8;  // of the table's water [1/m]

constexpr int k_rounds_of_row = 32, k_paths_of_row_round = 2048;
// Beyond which a comparison with the tables says nothing: of an order, and of all.
constexpr double k_most_error_of_order = 0.1, k_most_error_of_sum = 0.02;

// One pixel that looks along +z, so narrow that all of it looks at the same angle.
SceneDesc scene_of(const LampTableRow& row) {
    SceneDesc desc;
    desc.file = "tables";
    desc.camera.width = desc.camera.height = 1;
    desc.camera.intrinsics = {1e5, 1e5, 0.5, 0.5};
    desc.water.bands_nm = {540};
    desc.water.absorption = PerBand{1 - k_scattering};
    desc.water.scattering = ScatteringDesc{{k_scattering}, {}};
    desc.water.scattering->phase.function = HenyeyGreensteinDesc{0.9};
    LampDesc lamp;
    lamp.name = "lamp";
    const double angle = row.angle * std::numbers::pi / 180;
    lamp.position = Point3(row.distance * std::sin(angle), 0, row.distance * std::cos(angle));
    lamp.intensity = PerBand{1};
    desc.lamps = {lamp};
    desc.render.integrator = RenderDesc::Integrator::path;
    return desc;
}

void compare_row(const LampTableRow& row, const ValidationOptions& options,
                 LightValidation& result) {
    Renderer renderer;
    renderer.set_scene(scene_of(row));
    const LightTransport transport = renderer.make_transport();
    const PixelRenderer pixel = pixel_renderer(renderer.assembled(), transport);
    const PathPixels paths(pixel, row.orders.size() + 2);  // 0, the table's, and more
    std::vector<PixelResult> rounds(k_rounds_of_row);
    parallel_for(rounds.size(), [&](std::size_t i) {
        paths.render(
            0, 0, {static_cast<int>(i), k_paths_of_row_round},
            [&](int) {
                if (!options.proceed()) throw Interrupted();
            },
            rounds[i]);
    });
    const auto compare = [&](const std::string& what, double truth, double most_error,
                             const auto& light_of) {
        LightMean mean;
        for (const PixelResult& round : rounds) mean.add(light_of(round));
        result.checks.push_back(
            {"path", "table",
             fmt::format("{}, {:g} m, {:g} degrees", what, row.distance, row.angle),
             mean.mean() / truth - 1, mean.error() / truth, most_error});
    };
    // The table's lamp is a point; ours is a sphere in which nothing is scattered. What a point
    // lamp's light leaves there shines evenly again, as the lamp does: each order lacks as much of
    // the one before.
    constexpr double k_lacking = k_scattering * k_lamp_radius;
    double before = 0;
    for (std::size_t n = 1; n <= row.orders.size(); ++n) {
        const double order = row.orders[n - 1];
        compare(fmt::format("order {}", n), order - k_lacking * before, k_most_error_of_order,
                [n](const PixelResult& round) { return round.orders[n][0]; });
        before = order;
    }
    compare(
        "all orders", row.total - k_lacking * row.total, k_most_error_of_sum,
        [](const PixelResult& round) { return round.backscatter[0] + round.multiple_volume[0]; });
}

}  // namespace

std::span<const LampTableRow> lamp_table() {
    return k_table;
}

LightValidation validate_by_table(std::span<const LampTableRow> table,
                                  const ValidationOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    LightValidation result;
    result.name = "tables of a point lamp";
    options.say(result.name + ": path");
    result.notes.push_back(
        fmt::format("{} paths for each row; deviations relative to the table's value",
                    k_rounds_of_row * k_paths_of_row_round));
    for (const LampTableRow& row : table) compare_row(row, options, result);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    result.seconds = elapsed.count();
    return result;
}

}  // namespace uw
