#include "core/paths/path_tables.h"

#include <algorithm>
#include <span>
#include <utility>

namespace uw {

PathTables::PathTables(const LitScene& scene, const ScatteringTables& tables,
                       std::vector<std::shared_ptr<const DeepShadow>> deep_shadows)
    : optics(scene, /*exact=*/deep_shadows.empty()),
      scattering(tables),
      lamps(optics, scattering, std::move(deep_shadows)),
      guides(optics, scattering, lamps) {
    for (const Lamp& lamp : *scene.emitters) light += lamp.axis_intensity();
    for (std::size_t b = 0; b < optics.bands(); ++b) {
        const auto include = [&](const OpticalCoefficients& coefficients) {
            const double c = coefficients.attenuation(b);
            if (c > 0) albedo[b] = std::max(albedo[b], coefficients.total_scattering()[b] / c);
        };
        include(scene.medium->uniform);
        for (const Constituent& constituent : scene.medium->constituents)
            include(constituent.per_unit);
        albedo[b] = std::max(albedo[b], 0.1);
    }
    // Without any, surfaces may shine.
    const std::span<double> of_bands = light.first(optics.bands());
    if (std::ranges::all_of(of_bands, [](double value) { return value == 0; }))
        std::ranges::fill(of_bands, 1.0);
}

namespace {

// The indices of each lamp's first emitter, and of the one after the last.
std::vector<std::size_t> first_emitters(const std::vector<Lamp>& emitters) {
    std::vector<std::size_t> first;
    for (std::size_t i = 0; i < emitters.size(); ++i)
        if (emitters[i].index() == first.size()) first.push_back(i);
    first.push_back(emitters.size());
    return first;
}

}  // namespace

std::vector<LampView> lamp_views(const std::vector<Lamp>& emitters) {
    const std::vector<std::size_t> first = first_emitters(emitters);
    std::size_t most = 1;
    for (std::size_t j = 0; j + 1 < first.size(); ++j)
        most = std::max(most, first[j + 1] - first[j]);
    std::vector<LampView> views(most);
    for (std::size_t j = 0; j + 1 < first.size(); ++j) {
        const std::size_t count = first[j + 1] - first[j];
        for (std::size_t e = 0; e < count; ++e) {
            // Evenly among the views, each emitter as bright as it is in few of them.
            const std::size_t begin = e * most / count, end = (e + 1) * most / count;
            const double weight = static_cast<double>(most) / static_cast<double>(end - begin);
            const Lamp& emitter = emitters[first[j] + e];
            for (std::size_t view = begin; view < end; ++view) {
                views[view].lamps.push_back(count == 1 ? emitter : emitter.brightened(weight));
                views[view].emitters.push_back(first[j] + e);
            }
        }
    }
    return views;
}

}  // namespace uw
