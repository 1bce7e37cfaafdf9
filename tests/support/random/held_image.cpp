#include "tests/support/random/held_image.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "core/base/parallel.h"
#include "core/light/integrator_table.h"
#include "media/volumes/load_volumes.h"
#include "render/renderer.h"
#include "render/scene_loading.h"
#include "tests/support/random/light_bounds.h"
#include "tests/support/random/reference_pixels.h"

namespace uw::test {
namespace {

constexpr auto k_options = "all,lamps";

Film rendered(Renderer& renderer, int threads, const RenderOptions& options) {
    const ThreadLimit limit(threads);
    renderer.render(options);
    return renderer.release_film();
}

/// What is greater than it may be.
class Oddities {
  public:
    void expect_at_most(double is, double most, Layer layer, int band, int x, int y) {
        constexpr double k_rounding = 1e-4;
        if (first_.empty() && is > (1 + k_rounding) * most + 1e-30)
            first_ =
                fmt::format("{} of ({}, {}), band {}: {} > {}",
                            k_layers[static_cast<std::size_t>(layer)].name, x, y, band, is, most);
    }
    const std::string& first() const { return first_; }

  private:
    std::string first_;
};

/// One scene's image, held to all that can be said without knowing it.
class HeldImage {
  public:
    HeldImage(const ImageScene& scene, InvariantCounts& counts)
        : scene_(scene),
          desc_(scene.desc()),
          counts_(counts),
          plan_(layer_plan(scene, k_options)),
          film_(first_image()) {}

    void hold() {
        hold_each_value();
        hold_sums();
        hold_shares();
        if (is_still_and_single()) hold_energy();
        hold_sensor();
        hold_same_bytes();
        if (desc_.render.integrator == RenderDesc::Integrator::volume && !has_lamp_at_plane_)
            hold_reference();
    }

  private:
    Film first_image() {
        Renderer renderer;
        renderer.set_scene(scene_);
        Film film = rendered(renderer, 1, {.layers = k_options});
        for (const Lamp& lamp : renderer.assembled().emitters) {
            has_lamp_at_plane_ |= is_at_plane(lamp, desc_);
            for (const double intensity : lamp.axis_intensity().first(desc_.water.bands_nm.size()))
                brightest_lamp_ = std::max(brightest_lamp_, intensity);
        }
        has_coarse_voxels_ = std::ranges::any_of(
            renderer.assembled().volume_reports, [&](const VolumeReport& report) {
                return coarse_voxel_warning(report, renderer.assembled().water.medium).has_value();
            });
        return film;
    }
    int bands() const { return static_cast<int>(desc_.water.bands_nm.size()); }
    double value(int channel, int x, int y) const {
        return static_cast<double>(film_.pixel(x, y)[static_cast<std::size_t>(channel)]);
    }
    double value(Layer layer, int band, int x, int y) const {
        // With three bands, R G B are the total.
        if (layer == Layer::total && bands() == 3) return value(band, x, y);
        return plan_.has(layer) ? value(plan_.first_channel(layer) + band, x, y) : 0;
    }
    template <class Visit>
    void for_pixels(const Visit& visit) const {
        for (int y = 0; y < film_.height(); ++y)
            for (int x = 0; x < film_.width(); ++x) visit(x, y);
    }

    double brightest_total() const {
        double brightest = 0;
        for_pixels([&](int x, int y) {
            for (int band = 0; band < bands(); ++band)
                brightest = std::max(brightest, value(Layer::total, band, x, y));
        });
        return brightest;
    }

    void hold_each_value() const {
        const std::vector<std::string>& names = film_.channel_names();
        std::string odd;
        for_pixels([&](int x, int y) {
            for (std::size_t c = 0; c < names.size() && odd.empty(); ++c) {
                const float v = film_.pixel(x, y)[c];
                // A colour outside those of the display's primaries has negative parts; snow is
                // what it adds less what it hides.
                const bool may_be_negative =
                    !is_light(names[c]) || (bands() != 3 && c < 3) || names[c].starts_with("snow.");
                if (!std::isfinite(v) || (v < 0 && !may_be_negative))
                    odd = fmt::format("{} of ({}, {}) is {}", names[c], x, y, v);
            }
        });
        EXPECT_EQ(odd, "");
    }

    // Sums of floats, each rounded: a few units in the last place of the largest. Snow may hide
    // what the others add.
    void hold_sums() const {
        constexpr double k_rounding = 1e-5;
        // Below that, floats have fewer digits.
        constexpr double k_least = 1e-30;
        std::string odd;
        for_pixels([&](int x, int y) {
            for (int band = 0; band < bands() && odd.empty(); ++band) {
                const double total = value(Layer::total, band, x, y);
                double sum = 0, largest = 0;
                for (const Layer part : {Layer::direct, Layer::forward, Layer::backscatter,
                                         Layer::multiple, Layer::snow}) {
                    sum += value(part, band, x, y);
                    largest = std::max(largest, std::abs(value(part, band, x, y)));
                }
                if (std::abs(sum - total) > k_rounding * largest + k_least)
                    odd = fmt::format("({}, {}), band {}: {} is not {}", x, y, band, sum, total);
            }
        });
        EXPECT_EQ(odd, "");
    }

    void hold_shares() const {
        Oddities odd;
        for_pixels([&](int x, int y) {
            for (int band = 0; band < bands(); ++band) {
                const auto check = [&](Layer layer, double most) {
                    odd.expect_at_most(value(layer, band, x, y), most, layer, band, x, y);
                };
                if (band == 0) check(Layer::lit, 1);
                check(Layer::transmittance, 1);
                check(Layer::albedo, 1);
            }
        });
        EXPECT_EQ(odd.first(), "");
    }

    /// Layers of ground truth are those of the pixel's centre, or of a particle that hides it;
    /// light is a mean over its samples.
    bool is_still_and_single() const {
        const RenderDesc& render = desc_.render;
        const bool in_focus = !desc_.camera.lens || !desc_.camera.lens->focus_distance;
        const bool is_hidden = desc_.water.snow && desc_.water.snow->in_ground_truth;
        return !is_hidden && render.samples == 1 &&
               render.integrator != RenderDesc::Integrator::path && in_focus &&
               render.shutter == 0 && render.output == RenderDesc::Output::radiance;
    }

    /// No more light than the lamps give (light_bounds.h).
    void hold_energy() const {
        Oddities odd;
        const Camera camera(desc_.camera);
        const bool is_diffuse = std::ranges::none_of(desc_.geometry, [](const GeometryDesc& g) {
            return g.type == GeometryDesc::Type::file;
        });
        const std::vector<double> of_lamps = max_radiance_of_lamps(desc_);
        const double brightest = brightest_total();
        for_pixels([&](int x, int y) {
            const int first = plan_.first_channel(Layer::position);
            const Point3 at(value(first, x, y), value(first + 1, x, y), value(first + 2, x, y));
            // Rays are traced in single precision.
            const double error = 1e-5 * (1 + value(Layer::range, 0, x, y)) +
                                 1e-6 * std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)});
            const std::vector<double> most = max_irradiance(desc_, at, error);
            const std::optional<Ray> ray = camera.refracted_ray(x + 0.5, y + 0.5);
            const std::optional<std::vector<double>> max_scattered =
                ray ? max_in_scatter(desc_, *ray) : std::nullopt;
            for (int band = 0; band < bands(); ++band) {
                const auto check = [&](Layer layer, double bound) {
                    odd.expect_at_most(value(layer, band, x, y), bound, layer, band, x, y);
                };
                const auto b = static_cast<std::size_t>(band);
                check(Layer::direct, value(Layer::clean, band, x, y));
                check(Layer::irradiance, most[b]);
                if (is_diffuse)
                    check(Layer::clean,
                          value(Layer::albedo, band, x, y) * most[b] / std::numbers::pi +
                              of_lamps[b]);
                // Within what the fast integrator promises (hold_reference).
                if (max_scattered)
                    check(Layer::backscatter, 1.02 * (*max_scattered)[b] + 0.01 * brightest);
                counts_.bounded += max_scattered ? 1 : 0;
            }
        });
        EXPECT_EQ(odd.first(), "");
    }

    void hold_sensor() const {
        if (!desc_.camera.sensor) return;
        const double white = std::exp2(desc_.camera.sensor->bit_depth) - 1;
        Oddities odd;
        for_pixels([&](int x, int y) {
            const int first = plan_.first_channel(Layer::sensor);
            odd.expect_at_most(value(first, x, y), white, Layer::sensor, 0, x, y);
        });
        EXPECT_EQ(odd.first(), "");
    }

    void hold_same_bytes() const {
        Renderer renderer;
        renderer.set_scene(scene_);
        const Film three = rendered(renderer, 3, {.layers = k_options});
        EXPECT_TRUE(same(film_, three)) << "three threads";
        const PixelWindow window{film_.width() / 3, film_.height() / 3, (2 * film_.width() + 2) / 3,
                                 (2 * film_.height() + 2) / 3};
        const Film part = rendered(renderer, 2, {.layers = k_options, .window = window});
        EXPECT_TRUE(same(cropped(film_, window), part)) << "a part";
    }
    static bool same(const Film& a, const Film& b) {
        return std::ranges::equal(a.values(), b.values());
    }

    /// The fast integrator promises 1 % of the brighter pixels' light (docs/validation.md).
    void hold_reference() {
        if (scattering_of(desc_.render) != RenderDesc::Scattering::single) return;
        // What comes from behind 32 optical depths is left out.
        constexpr double k_darkest = 1e-14;
        // The share of the light that there would be without shadows, at their edges and on what is
        // lit from behind: edges are at most 3e-4 of the distance from where they should be
        // (ShadowMap).
        constexpr double k_edges = 1e-4;
        // Which its warning tells (voxel_depth.h).
        const double share = has_coarse_voxels_ ? 5 : 1;
        const double brightest = brightest_total();
        ReferencePixels reference(scene_);
        const ImageScene open = scene_.with([](SceneDesc& desc) { desc.geometry.clear(); });
        const int width = film_.width(), height = film_.height();
        for (const auto& [x, y] :
             {std::pair{width / 4, height / 3}, {2 * width / 3, 2 * height / 3}}) {
            const std::vector<double> truth = reference.at(x, y);
            std::vector<double> allowed;
            bool is_off = false;
            for (int band = 0; band < bands(); ++band) {
                const double expected = truth[static_cast<std::size_t>(band)];
                allowed.push_back(share * (0.02 * expected + 0.01 * brightest) +
                                  k_darkest * brightest_lamp_);
                is_off |= std::abs(value(Layer::total, band, x, y) - expected) > allowed.back();
            }
            if (is_off && !desc_.geometry.empty()) {
                const std::vector<double> without_shadows = ReferencePixels(open).at(x, y);
                for (std::size_t band = 0; band < allowed.size(); ++band)
                    allowed[band] += k_edges * without_shadows[band];
            }
            for (int band = 0; band < bands(); ++band) {
                const auto b = static_cast<std::size_t>(band);
                EXPECT_NEAR(value(Layer::total, band, x, y), truth[b], allowed[b])
                    << "pixel " << x << ", " << y << ", band " << band;
            }
            ++counts_.compared;
        }
    }

    const ImageScene& scene_;
    const SceneDesc& desc_;  // that of `scene_`
    InvariantCounts& counts_;
    LayerPlan plan_;
    double brightest_lamp_ = 0;  // of its intensities
    bool has_lamp_at_plane_ = false, has_coarse_voxels_ = false;
    Film film_;
};

}  // namespace

void hold_image(const ImageScene& scene, InvariantCounts& counts) {
    HeldImage(scene, counts).hold();
}

}  // namespace uw::test
