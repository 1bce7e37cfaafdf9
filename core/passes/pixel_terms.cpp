#include "core/passes/pixel_terms.h"

#include <numeric>

#include "core/geometry/surface_reflection.h"
#include "core/light/submerged.h"

namespace uw {

namespace {

/// Passes contributions on, each multiplied by a weight.
class WeightedTerms final : public ContributionSink {
  public:
    WeightedTerms(ContributionSink& sink, double weight) : sink_(sink), weight_(weight) {}

    int add_vertex(int before, const PathVertex& vertex) override {
        return sink_.add_vertex(before, vertex);
    }
    void add(const PathContribution& contribution) override {
        for (std::size_t b = 0; b < contribution.radiance.size(); ++b)
            radiance_[b] = weight_ * contribution.radiance[b];
        PathContribution weighted = contribution;
        weighted.radiance = radiance_.first(contribution.radiance.size());
        sink_.add(weighted);
    }

  private:
    ContributionSink& sink_;
    double weight_;
    Spectrum radiance_;
};

}  // namespace

void add_direct_light(const LitScene& scene, const SurfaceSample& surface,
                      const SurfaceLight& light, std::size_t light_index, ContributionSink& sink,
                      Spectrum& leaving) {
    const auto bands = static_cast<std::size_t>(scene.medium->band_count());
    const std::span<const double> to_camera = light.to_camera(light_index);
    const SurfaceReflection reflection(*scene.surfaces, surface, static_cast<int>(bands));
    Spectrum arriving, brdf;
    PathContribution contribution{
        .distance = surface.hit.distance,
        .radiance = arriving.first(bands),
        .vertex = sink.add_vertex(k_no_vertex, {PathVertex::Kind::camera, surface.ray.origin}),
        .place = surface.hit.position,
        .hit = &surface.hit};
    if (reflection.emits()) {
        for (std::size_t b = 0; b < bands; ++b) {
            leaving[b] += reflection.emission()[b];
            arriving[b] = reflection.emission()[b] * to_camera[b];
        }
        contribution.lamp = lamp_of_emission(*scene.surfaces, surface.hit).value_or(k_no_lamp);
        sink.add(contribution);
    }
    contribution.reflections = 1;
    for (std::size_t j = 0; j < light.emitter_count(); ++j) {
        if (!light.visible(light_index, j)) continue;
        brdf_for(light.emitters()[j], reflection, surface, brdf);
        for (std::size_t b = 0; b < bands; ++b) {
            const double reflected = light.irradiance(light_index, j, b) * brdf[b];
            leaving[b] += reflected;
            arriving[b] = reflected * to_camera[b];
        }
        contribution.lamp = light.emitters()[j].index();
        contribution.emitter = j;
        sink.add(contribution);
    }
}

void add_quadrature_terms(const PixelRenderer& pixels, const VolumeIntegrator& water,
                          const PixelView& view, const SurfaceLight& light,
                          ContributionSink& sink) {
    if (!view.ray) return;
    const auto bands = static_cast<std::size_t>(pixels.band_count());
    WeightedTerms of_sample(sink, 1.0 / pixels.samples());
    Spectrum ignored;
    for (std::size_t i = 0; i < view.samples.size(); ++i)
        add_direct_light(pixels.scene(), view.samples[i], light, i, of_sample, ignored);
    const int vertex = sink.add_vertex(k_no_vertex, {PathVertex::Kind::camera, view.ray->origin});
    for (const SeenLamp& lamp : view.lamps)
        of_sample.add({.lamp = lamp.lamp,
                       .distance = lamp.distance,
                       .radiance = lamp.arriving.first(bands),
                       .vertex = vertex,
                       .place = view.ray->at(lamp.distance)});
    // The light scattered at a node reaches all samples whose distance lies beyond it.
    std::vector<double> remaining_weights(view.weights.size());
    std::partial_sum(view.weights.rbegin(), view.weights.rend(), remaining_weights.rbegin());
    Spectrum arriving;
    const std::vector<Lamp>& emitters = *pixels.scene().emitters;
    water.visit_nodes(*view.ray, view.distances, [&](const VolumeIntegrator::Node& node) {
        arriving = remaining_weights[node.distance] * node.radiance;
        sink.add({.lamp = emitters[node.emitter].index(),
                  .scatterings = 1,
                  .from_water = true,
                  .distance = node.s,
                  .radiance = arriving.first(bands),
                  .vertex = vertex,
                  .place = view.ray->at(node.s),
                  .emitter = node.emitter,
                  .columns = node.columns,
                  .concentration = node.concentration});
    });
}

}  // namespace uw
