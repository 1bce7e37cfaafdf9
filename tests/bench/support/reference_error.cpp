#include "tests/bench/support/reference_error.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/light/reference_integrator.h"

namespace uw::bench {
namespace {

struct Pixel {
    int x, y;
};

// About `wanted` pixels, evenly over the image.
std::vector<Pixel> lattice(int width, int height, int wanted) {
    const double area = static_cast<double>(width) * height / wanted;
    const int pitch = std::max(1, static_cast<int>(std::lround(std::sqrt(area))));
    std::vector<Pixel> pixels;
    for (int y = pitch / 2; y < height; y += pitch)
        for (int x = pitch / 2; x < width; x += pitch) pixels.push_back({x, y});
    return pixels;
}

// Total radiance by the reference integrator, band by band, pixel after pixel.
std::vector<double> radiance(const AssembledScene& scene, double step,
                             const std::vector<Pixel>& pixels) {
    const LightTransport transport{std::make_unique<ReferenceIntegrator>(scene.lit(), step),
                                   std::make_unique<DirectLighting>(scene.lit())};
    const PixelRenderer renderer = pixel_renderer(scene, transport);
    const auto bands = static_cast<std::size_t>(renderer.band_count());
    std::vector<double> values(pixels.size() * bands);
    parallel_for(pixels.size(), [&](std::size_t i) {
        PixelResult result;
        renderer.render(pixels[i].x, pixels[i].y, result);
        for (std::size_t band = 0; band < bands; ++band)
            values[i * bands + band] = result.direct[band] + result.backscatter[band];
    });
    return values;
}

std::vector<double> radiance(const LayerPlan& plan, const Film& film, std::size_t bands,
                             const std::vector<Pixel>& pixels) {
    // With three bands the total is R G B.
    const int first = std::max(0, plan.first_channel(Layer::total));
    std::vector<double> values;
    for (const Pixel& at : pixels) {
        const std::span<const float> channels = film.pixel(at.x, at.y);
        for (std::size_t band = 0; band < bands; ++band)
            values.push_back(channels[static_cast<std::size_t>(first) + band]);
    }
    return values;
}

double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

double rmse(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum / static_cast<double>(a.size()));
}

double max_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
}

}  // namespace

ReferenceError compare_with_reference(const AssembledScene& scene, const LayerPlan& plan,
                                      const Film& film, int pixels, double step) {
    const auto chosen = lattice(scene.camera->width(), scene.camera->height(), pixels);
    const auto measured =
        radiance(plan, film, static_cast<std::size_t>(scene.water.medium.band_count()), chosen);
    const auto truth = radiance(scene, step, chosen);
    const auto coarse = radiance(scene, 2 * step, chosen);
    const double scale = 1 / mean(truth);
    // If the errors e and 2e are uncorrelated, the difference is sqrt(5) e.
    return {static_cast<int>(chosen.size()), scale * rmse(measured, truth),
            scale * max_difference(measured, truth), scale * rmse(coarse, truth) / std::sqrt(5.0)};
}

}  // namespace uw::bench
