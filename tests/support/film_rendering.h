#pragma once

#include <string>
#include <vector>

#include "render/renderer.h"
#include "tests/support/test_scene.h"

/// Whole images with their layers, forward scatter included, as `uwvdb render` makes them.
namespace uw::test {

/// The layers that a test examines, per band and pixel, row by row.
class RenderedFilm {
  public:
    explicit RenderedFilm(const SceneDesc& desc)
        : plan_(layer_plan(SceneDesc(desc), k_layers)), film_(rendered(desc, warnings_)) {}

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
    static constexpr const char* k_layers = "all";

    static Film rendered(const SceneDesc& desc, std::vector<std::string>& warnings) {
        Renderer renderer;
        renderer.set_scene(SceneDesc(desc));
        const Film& film = renderer.render({.layers = k_layers});
        warnings = renderer.report().warnings;
        return film;
    }
    double at(int channel, int x, int y) const {
        return static_cast<double>(film_.pixel(x, y)[static_cast<std::size_t>(channel)]);
    }

    LayerPlan plan_;
    std::vector<std::string> warnings_;
    Film film_;
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
