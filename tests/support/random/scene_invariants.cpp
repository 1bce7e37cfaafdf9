#include "tests/support/random/scene_invariants.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/integrators/integrator_table.h"
#include "render/renderer.h"
#include "render/scene_loading.h"
#include "tests/support/random/random_scene.h"

namespace uw::test {
namespace {

constexpr auto k_options = "all,lamps";

Film rendered(const SceneDesc& desc, int threads, const RenderOptions& options) {
    const ThreadLimit limit(threads);
    Renderer renderer;
    renderer.set_scene(SceneDesc(desc));
    renderer.render(options);
    return renderer.release_film();
}

/// One scene's image, held to all that can be said without knowing it.
class HeldImage {
  public:
    HeldImage(const SceneDesc& desc, InvariantCounts& counts)
        : desc_(desc),
          counts_(counts),
          plan_(layer_plan(desc, k_options)),
          film_(rendered(desc, 1, {.layers = k_options})) {}

    void hold() {
        hold_each_value();
        hold_sums();
        hold_energy();
        hold_same_bytes();
        if (desc_.render.integrator == RenderDesc::Integrator::volume) hold_reference();
    }

  private:
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

    void hold_each_value() const {
        const std::vector<std::string>& names = film_.channel_names();
        std::string odd;
        for_pixels([&](int x, int y) {
            for (std::size_t c = 0; c < names.size() && odd.empty(); ++c) {
                const float v = film_.pixel(x, y)[c];
                // A colour outside those of the display's primaries has negative parts.
                const bool may_be_negative = !is_light(names[c]) || (bands() != 3 && c < 3);
                if (!std::isfinite(v) || (v < 0 && !may_be_negative))
                    odd = fmt::format("{} of ({}, {}) is {}", names[c], x, y, v);
            }
        });
        EXPECT_EQ(odd, "");
    }

    // Sums of floats, each rounded: a few units in the last place of the largest.
    void hold_sums() const {
        constexpr double k_rounding = 1e-5;
        // Below that, floats have fewer digits.
        constexpr double k_least = 1e-30;
        std::string odd;
        for_pixels([&](int x, int y) {
            for (int band = 0; band < bands() && odd.empty(); ++band) {
                const double total = value(Layer::total, band, x, y);
                double sum = 0;
                for (const Layer part : {Layer::direct, Layer::forward, Layer::backscatter,
                                         Layer::multiple, Layer::snow})
                    sum += value(part, band, x, y);
                if (std::abs(sum - total) > k_rounding * total + k_least)
                    odd = fmt::format("({}, {}), band {}: {} is not {}", x, y, band, sum, total);
            }
        });
        EXPECT_EQ(odd, "");
    }

    void hold_energy() const {
        constexpr double k_rounding = 1e-4;
        std::string odd;
        for_pixels([&](int x, int y) {
            for (int band = 0; band < bands() && odd.empty(); ++band) {
                const auto check = [&](const char* what, double is, double most) {
                    if (is > (1 + k_rounding) * most + 1e-30)
                        odd = fmt::format("{} of ({}, {}), band {}: {} > {}", what, x, y, band, is,
                                          most);
                };
                check("lit", value(Layer::lit, 0, x, y), 1);
                check("transmittance", value(Layer::transmittance, band, x, y), 1);
                check("albedo", value(Layer::albedo, band, x, y), 1);
                // Layers of ground truth are those of the pixel's centre; light is a mean.
                if (desc_.render.samples == 1)
                    check("direct", value(Layer::direct, band, x, y),
                          value(Layer::clean, band, x, y));
            }
        });
        EXPECT_EQ(odd, "");
    }

    void hold_same_bytes() const {
        const Film three = rendered(desc_, 3, {.layers = k_options});
        EXPECT_TRUE(std::ranges::equal(film_.values(), three.values(), [](float a, float b) {
            return a == b;
        })) << "three threads";
        const PixelWindow window{5, 3, 9, 6};
        const Film part = rendered(desc_, 2, {.layers = k_options, .window = window});
        const Film expected = cropped(film_, window);
        EXPECT_TRUE(std::ranges::equal(part.values(), expected.values())) << "a part";
    }

    /// The fast integrator promises 1 % of the brighter pixels' light (docs/validation.md).
    void hold_reference() {
        if (scattering_of(desc_.render) != RenderDesc::Scattering::single) return;
        SceneDesc slow = desc_;
        slow.render.integrator = RenderDesc::Integrator::reference;
        double brightest = 0;
        for_pixels([&](int x, int y) {
            for (int band = 0; band < bands(); ++band)
                brightest = std::max(brightest, value(Layer::total, band, x, y));
        });
        constexpr auto k_total = "total";
        const int first = bands() == 3 ? 0 : layer_plan(slow, k_total).first_channel(Layer::total);
        for (const auto& [x, y] : {std::pair{4, 3}, {11, 6}}) {
            const Film truth =
                rendered(slow, 2, {.layers = k_total, .window = PixelWindow{x, y, x + 1, y + 1}});
            for (int band = 0; band < bands(); ++band) {
                const auto channel = static_cast<std::size_t>(first + band);
                const double expected = static_cast<double>(truth.pixel(x, y)[channel]);
                EXPECT_NEAR(value(Layer::total, band, x, y), expected,
                            0.02 * expected + 0.01 * brightest)
                    << "pixel " << x << ", " << y << ", band " << band;
            }
            ++counts_.compared;
        }
    }

    const SceneDesc& desc_;
    InvariantCounts& counts_;
    LayerPlan plan_;
    Film film_;
};

}  // namespace

InvariantCounts hold_invariants(std::uint64_t first, int count, Scattered scattered) {
    InvariantCounts counts;
    for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(count); ++seed) {
        const std::string text = random_scene(seed);
        SCOPED_TRACE(fmt::format("seed {}:\n{}", seed, text));
        try {
            const ResolvedScene scene(load_scene_text(text, "random.yaml"));
            if (scattered == Scattered::once &&
                scattering_of(scene.desc().render) != RenderDesc::Scattering::single) {
                ++counts.left_out;
                continue;
            }
            HeldImage(scene.desc(), counts).hold();
            ++counts.rendered;
        } catch (const InputError& error) {
            EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos);
            ++counts.refused;
        } catch (const std::exception& error) {
            ADD_FAILURE() << error.what();
        }
    }
    return counts;
}

}  // namespace uw::test
