#pragma once

#include <string>
#include <vector>

#include "core/integrators/integrator_table.h"
#include "render/scene_rendering.h"
#include "tests/support/test_scene.h"

/// Whole images with their layers, forward scatter included, as `uwvdb render` makes them.
namespace uw::test {

/// The layers that a test looks at, per band and pixel, row by row.
class RenderedFilm {
  public:
    explicit RenderedFilm(const SceneDesc& desc)
        : plan_("all", desc.water.bands_nm, names_of(desc)),
          film_(desc.camera.width, desc.camera.height,
                {0, 0, desc.camera.width, desc.camera.height}, plan_.channel_names()) {
        const AssembledScene scene = assemble_scene(desc, [](const std::string&) {});
        DeepShadows fields;
        if (integrator_kind(desc.render.integrator).needs_deep_shadows)
            fields = splat_lamps(scene, {});
        warnings_ = scene.warnings;
        render_scene(scene, fields, make_light_transport(scene, fields), plan_,
                     BandColour(desc.water.bands_nm), film_,
                     [](const std::string&, double) { return true; });
    }

    const Film& film() const { return film_; }
    const std::vector<std::string>& warnings() const { return warnings_; }
    double value(Layer layer, int x, int y, int band) const {
        return at(plan_.first_channel(layer) + band, x, y);
    }
    double lamp(std::size_t index, int x, int y, int band) const {
        return at(plan_.first_channel_of_lamp(index) + band, x, y);
    }
    double total(int x, int y, int band) const { return at(band, x, y); }
    double sum(Layer layer, int band) const {
        double result = 0;
        for (int y = 0; y < film_.height(); ++y)
            for (int x = 0; x < film_.width(); ++x) result += value(layer, x, y, band);
        return result;
    }

  private:
    static std::vector<std::string> names_of(const SceneDesc& desc) {
        std::vector<std::string> names;
        for (const LampDesc& lamp : desc.lamps) names.push_back(lamp.name);
        return names;
    }
    double at(int channel, int x, int y) const {
        return static_cast<double>(film_.pixel(x, y)[static_cast<std::size_t>(channel)]);
    }

    LayerPlan plan_;
    Film film_;
    std::vector<std::string> warnings_;
};

/// The largest difference of two images in one layer, over the pixels and three bands, relative to
/// the second image there or, where that is darker, to 1 % of its mean.
inline double worst_difference(const RenderedFilm& a, const RenderedFilm& b, Layer layer) {
    double worst = 0;
    const int width = b.film().width(), height = b.film().height();
    for (int band = 0; band < 3; ++band) {
        const double floor = 0.01 * b.sum(layer, band) / (width * height);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const double truth = b.value(layer, x, y, band);
                const double error = std::abs(a.value(layer, x, y, band) - truth);
                if (error > 0) worst = std::max(worst, error / std::max(truth, floor));
            }
    }
    return worst;
}

}  // namespace uw::test
