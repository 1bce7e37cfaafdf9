#include "render/validation/light_trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <random>

#include "core/base/parallel.h"
#include "core/image/pixel_image.h"
#include "core/image/preview_exposure.h"
#include "core/light/lamp.h"
#include "core/passes/path_pass.h"
#include "render/light_points.h"

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
constexpr double k_max_error_of_order = 0.1, k_max_error_of_sum = 0.02;

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
    lamp.position = {row.distance * std::sin(angle), 0, row.distance * std::cos(angle)};
    lamp.intensity = PerBand{1};
    desc.lamps = {lamp};
    desc.render.integrator = RenderDesc::Integrator::path;
    return desc;
}

std::vector<PixelResult> rounds_of(const LampTableRow& row) {
    Renderer renderer;
    renderer.set_scene(scene_of(row));
    const LightTransport transport = renderer.make_transport();
    const PixelRenderer pixel = pixel_renderer(renderer.assembled(), transport);
    const PathPixels paths(pixel, row.orders.size() + 2);  // 0, the table's, and more
    std::vector<PixelResult> rounds(k_rounds_of_row);
    parallel_for(rounds.size(), [&](std::size_t i) {
        paths.render(
            0, 0, {static_cast<int>(i), k_paths_of_row_round}, [](int) {}, rounds[i]);
    });
    return rounds;
}

double all_orders(const PixelResult& round) {
    return round.backscatter[0] + round.multiple_volume[0];
}

void compare_row(const LampTableRow& row, LightValidation& result) {
    const std::vector<PixelResult> rounds = rounds_of(row);
    const auto compare = [&](const std::string& what, double truth, double max_error,
                             const auto& light_of) {
        LightMean mean;
        for (const PixelResult& round : rounds) mean.add(light_of(round));
        result.checks.push_back(
            {"path", "table",
             fmt::format("{}, {:g} m, {:g} degrees", what, row.distance, row.angle),
             mean.mean() / truth - 1, mean.error() / truth, max_error});
    };
    // The table's lamp is a point; ours is a sphere in which nothing is scattered. What a point
    // lamp's light leaves there shines evenly again, as the lamp does: each order lacks as much of
    // the one before.
    constexpr double k_lacking = k_scattering * k_lamp_radius;
    double before = 0;
    for (std::size_t n = 1; n <= row.orders.size(); ++n) {
        const double order = row.orders[n - 1];
        compare(fmt::format("order {}", n), order - k_lacking * before, k_max_error_of_order,
                [n](const PixelResult& round) { return round.orders[n][0]; });
        before = order;
    }
    compare("all orders", row.total - k_lacking * row.total, k_max_error_of_sum, all_orders);
}

// One pixel is drawn from each cell of a lattice over the image.
constexpr int k_columns = 12, k_rows = 8;
constexpr int k_longest_side_in_all_light = 320;  // of the image [pixels]
// The rounds of paths are independent; their spread tells the error.
constexpr int k_rounds = 16, k_paths_of_round = 256;
// Rays per pixel of the fast form: as many as integrator path has for what is no mean over paths.
constexpr int k_samples = 16;
// The fast form smooths neighbouring nodes together, so that its errors are alike around them. At
// least so many parts of an image have errors of their own.
constexpr double k_independent_parts = 20;
// The standard error of the mean over the pixels, relative to all light, beyond which the
// comparison says nothing.
constexpr double k_max_error = 0.02;

constexpr std::array<Layer, 4> k_part_layers{Layer::direct, Layer::backscatter,
                                             Layer::multiple_volume, Layer::multiple_surface};
constexpr const char* k_layers = "direct,backscatter,multiple.volume,multiple.surface";

/// The parts of LightParts that are compared.
struct Light {
    const char* name;
    bool volume, surface;

    double of(double of_volume, double of_surface) const {
        return (volume ? of_volume : 0) + (surface ? of_surface : 0);
    }
};
constexpr std::array<Light, 3> k_lights{{{"multiple.volume", true, false},
                                         {"multiple.surface", false, true},
                                         {"multiple", true, true}}};

struct Pixel {
    int x, y;
    /// Their means over the rounds, by light and band.
    std::array<std::vector<LightMean>, k_lights.size()> lights;
};

std::vector<Pixel> draw_pixels(int width, int height, std::size_t bands) {
    std::mt19937 random(1);  // the same everywhere
    const auto draw = [&](int begin, int end) {
        return begin + static_cast<int>(random() % static_cast<unsigned>(end - begin));
    };
    const int columns = std::min(k_columns, width), rows = std::min(k_rows, height);
    std::vector<Pixel> pixels;
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const int x = draw(i * width / columns, (i + 1) * width / columns);
            const int y = draw(j * height / rows, (j + 1) * height / rows);
            pixels.push_back({x, y, {}});
            for (auto& light : pixels.back().lights) light.resize(bands);
        }
    }
    return pixels;
}

class AllLightTrial {
  public:
    AllLightTrial(const ImageScene& scene, const std::string& name,
                  const ValidationOptions& options, const TransportChange& under_test)
        : scene_(scene.with([](SceneDesc& desc) {
              show_radiance_in_water(desc, k_longest_side_in_all_light);
              desc.render.scattering = RenderDesc::Scattering::multiple;
              desc.render.samples = k_samples;
          })),
          options_(options),
          under_test_(under_test) {
        result_.name = name + ", all light";
        result_.bands_nm = scene_.desc().water.bands_nm;
    }

    LightValidation run() {
        const auto start = std::chrono::steady_clock::now();
        render_fast();
        trace_paths();
        compare();
        note();
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
        result_.seconds = elapsed.count();
        return std::move(result_);
    }

  private:
    std::size_t bands() const { return result_.bands_nm.size(); }

    Renderer make_renderer(RenderDesc::Integrator integrator) {
        Renderer renderer;
        renderer.set_scene(
            scene_.with([&](SceneDesc& desc) { desc.render.integrator = integrator; }));
        return renderer;
    }

    void render_fast() {
        options_.say(result_.name + ": volume");
        Renderer renderer = make_renderer(RenderDesc::Integrator::volume);
        LightTransport transport = renderer.make_transport();
        if (under_test_) transport = under_test_(std::move(transport));
        const RenderOptions request{.layers = k_layers, .transport = &transport};
        const Film& film = renderer.render(request);
        error_ = renderer.report().multiple_error.value_or(0);
        pointed_lamps_ =
            pointed_lamp_notes(renderer.assembled(), find_pointed_lamps(renderer.assembled()));
        const LayerPlan plan = layer_plan(renderer.scene(), k_layers);
        pixels_ = draw_pixels(film.width(), film.height(), bands());
        result_.parts.resize(bands());
        const double pixel_weight = 1.0 / (film.width() * film.height());
        for (std::size_t part = 0; part < k_part_layers.size(); ++part) {
            const auto first = static_cast<std::size_t>(plan.first_channel(k_part_layers[part]));
            for (int y = 0; y < film.height(); ++y)
                for (int x = 0; x < film.width(); ++x)
                    for (std::size_t b = 0; b < bands(); ++b)
                        result_.parts[b].means[part] +=
                            pixel_weight * static_cast<double>(film.pixel(x, y)[first + b]);
        }
        const auto first_of = [&](Layer layer) {
            return static_cast<std::size_t>(plan.first_channel(layer));
        };
        for (const Pixel& pixel : pixels_) {
            const auto channels = film.pixel(pixel.x, pixel.y);
            for (const Light& light : k_lights)
                for (std::size_t b = 0; b < bands(); ++b)
                    fast_.push_back(light.of(
                        static_cast<double>(channels[first_of(Layer::multiple_volume) + b]),
                        static_cast<double>(channels[first_of(Layer::multiple_surface) + b])));
        }
        take_pictures(film, plan);
    }

    // All at the exposure of the first.
    void take_pictures(const Film& film, const LayerPlan& plan) {
        const double exposure = automatic_exposure(film).value_or(1.0);
        result_.pictures.emplace_back("all light", make_preview(film, exposure));
        const BandColour colour(result_.bands_nm);
        const auto take = [&](const std::string& name, const std::vector<Layer>& layers) {
            Preview picture(film.width(), film.height());
            for (int y = 0; y < film.height(); ++y) {
                for (int x = 0; x < film.width(); ++x) {
                    Spectrum sum{};
                    for (const Layer layer : layers)
                        for (std::size_t b = 0; b < bands(); ++b)
                            sum[b] += static_cast<double>(film.pixel(
                                x, y)[static_cast<std::size_t>(plan.first_channel(layer)) + b]);
                    const LinearRgb rgb = colour(sum);
                    for (std::size_t c = 0; c < 3; ++c)
                        picture(x, y)[c] = srgb_bytes()(exposure * rgb[c]);
                }
            }
            result_.pictures.emplace_back(name, std::move(picture));
        };
        take("single scattering (direct, backscatter)", {Layer::direct, Layer::backscatter});
        take("multiple.volume", {Layer::multiple_volume});
        take("multiple.surface", {Layer::multiple_surface});
    }

    void trace_paths() {
        options_.say(result_.name + ": path");
        Renderer renderer = make_renderer(RenderDesc::Integrator::path);
        const LightTransport transport = renderer.make_transport();
        const PixelRenderer pixel = pixel_renderer(renderer.assembled(), transport);
        const PathPixels paths(pixel, 0);
        const auto traced = [](int) {};
        parallel_for(pixels_.size(), [&](std::size_t i) {
            PixelResult result;
            for (int round = 0; round < k_rounds; ++round) {
                paths.render(pixels_[i].x, pixels_[i].y, {round, k_paths_of_round}, traced, result);
                for (std::size_t l = 0; l < k_lights.size(); ++l)
                    for (std::size_t b = 0; b < bands(); ++b)
                        pixels_[i].lights[l][b].add(
                            result.pixel_factor *
                            k_lights[l].of(result.multiple_volume[b], result.multiple_surface[b]));
            }
        });
    }

    void compare() {
        for (std::size_t l = 0; l < k_lights.size(); ++l)
            for (std::size_t b = 0; b < bands(); ++b) compare(l, b);
    }

    void compare(std::size_t light, std::size_t band) {
        const double mean = result_.parts[band].all();
        if (!(mean > 0)) return;
        const auto count = static_cast<double>(pixels_.size());
        const double of_fast = error_ * mean;
        double sum = 0, variance = 0, squares = 0, squares_in_errors = 0, worst = 0;
        for (std::size_t i = 0; i < pixels_.size(); ++i) {
            const LightMean& path = pixels_[i].lights[light][band];
            const double difference =
                fast_[(i * k_lights.size() + light) * bands() + band] - path.mean();
            const double error = std::hypot(path.error(), of_fast);
            sum += difference;
            variance += path.error() * path.error();
            squares += difference * difference;
            const double in_errors = difference == 0 ? 0 : difference / error;
            squares_in_errors += in_errors * in_errors;
            worst = std::max(worst, std::abs(in_errors));
        }
        variance = variance / (count * count) + of_fast * of_fast / k_independent_parts;
        result_.checks.push_back(
            {"volume", "path",
             fmt::format("{}, {:g} nm", k_lights[light].name, result_.bands_nm[band]),
             sum / count / mean, std::sqrt(variance) / mean, k_max_error,
             PixelSpread{pixels_.size(), std::sqrt(squares / count) / mean,
                         std::sqrt(squares_in_errors / count), worst}});
    }

    void note() {
        result_.notes = {
            fmt::format("{} x {} pixels; the fast form states a standard error of {:.2g} %",
                        scene_.desc().camera.width, scene_.desc().camera.height, 100 * error_),
            fmt::format("compared at {} pixels drawn at random, with {} paths in each",
                        pixels_.size(), k_rounds * k_paths_of_round)};
        for (std::string& line : pointed_lamps_) result_.notes.push_back(std::move(line));
    }

    ImageScene scene_;
    const ValidationOptions& options_;
    const TransportChange& under_test_;
    LightValidation result_;
    double error_ = 0;                        // stated by the fast form
    std::vector<std::string> pointed_lamps_;  // what both leave out
    std::vector<Pixel> pixels_;
    std::vector<double> fast_;  // by pixel, light and band
};

}  // namespace

std::span<const LampTableRow> lamp_table() {
    return k_table;
}

LightMean scattered_around_lamp(double distance, double angle) {
    LightMean mean;
    for (const PixelResult& round : rounds_of({.distance = distance, .angle = angle}))
        mean.add(all_orders(round));
    return mean;
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
    for (const LampTableRow& row : table) compare_row(row, result);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    result.seconds = elapsed.count();
    return result;
}

LightValidation validate_by_table(const ValidationOptions& options) {
    return validate_by_table(k_table, options);
}

LightValidation validate_all_light(const ImageScene& scene, const std::string& name,
                                   const ValidationOptions& options,
                                   const TransportChange& under_test) {
    return AllLightTrial(scene, name, options, under_test).run();
}

LightValidation validate_all_light(const ImageScene& scene, const std::string& name,
                                   const ValidationOptions& options) {
    return validate_all_light(scene, name, options, {});
}

}  // namespace uw
