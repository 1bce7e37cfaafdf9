#include "core/paths/path_tables.h"

#include <algorithm>
#include <span>
#include <utility>

#include "core/light/glass_shaded_emitter.h"

namespace uw {

PathTables::PathTables(const LitScene& scene, const ScatteringTables& tables,
                       const EmissionSampler& emission,
                       std::vector<std::shared_ptr<const DeepShadow>> deep_shadows,
                       std::vector<std::size_t> emitters)
    : optics(scene, /*exact=*/deep_shadows.empty()),
      scattering(tables),
      lamps(optics, scattering, std::move(deep_shadows), std::move(emitters)),
      guides(optics, scattering, lamps, emission) {
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
    // Without lamps, emissive surfaces may still give light.
    const std::span<double> of_bands = light.first(optics.bands());
    if (std::ranges::all_of(of_bands, [](double value) { return value == 0; }))
        std::ranges::fill(of_bands, 1.0);
}

namespace {

/// An emitter as paths see it: what glass does to its light they find along each line, in all bands
/// at once (NextEventEstimator).
struct PathEmitter {
    Lamp lamp;
    std::size_t number;  // of the scene's emitters, the first of those that are one for each band
};

std::vector<PathEmitter> without_glass(const std::vector<Lamp>& emitters) {
    std::vector<PathEmitter> result;
    const auto shaded = [&](std::size_t i) {
        return i < emitters.size() ? dynamic_cast<const GlassShadedEmitter*>(&emitters[i].emitter())
                                   : nullptr;
    };
    for (std::size_t i = 0; i < emitters.size(); ++i) {
        const GlassShadedEmitter* const first = shaded(i);
        if (first == nullptr) {
            result.push_back({emitters[i], i});
            continue;
        }
        const Lamp& lamp = emitters[i];
        Spectrum intensity = lamp.axis_intensity();
        std::size_t next = i + 1;
        for (; shaded(next) != nullptr && shaded(next)->original() == first->original(); ++next)
            intensity += emitters[next].axis_intensity();
        const Lamp whole(lamp.name(), first->original(), intensity, lamp.index(),
                         lamp.fraction() * static_cast<double>(next - i));
        result.push_back({lamp.is_met_by_paths() ? whole.met_by_paths() : whole, i});
        i = next - 1;
    }
    return result;
}

// A lamp's emitters, and those of its mirror image.
struct LampEmitters {
    std::vector<std::size_t> own, images;
};

std::vector<LampEmitters> emitters_by_lamp(const std::vector<PathEmitter>& emitters) {
    std::vector<LampEmitters> lamps;
    for (std::size_t i = 0; i < emitters.size(); ++i) {
        const Lamp& lamp = emitters[i].lamp;
        if (lamp.index() == lamps.size()) lamps.emplace_back();
        (lamp.is_mirrored() ? lamps.back().images : lamps.back().own).push_back(i);
    }
    return lamps;
}

}  // namespace

std::vector<LampView> lamp_views(const std::vector<Lamp>& all) {
    const std::vector<PathEmitter> emitters = without_glass(all);
    const std::vector<LampEmitters> lamps = emitters_by_lamp(emitters);
    std::size_t view_count = 1;
    for (const LampEmitters& lamp : lamps)
        if (!emitters[lamp.own.front()].lamp.is_met_by_paths())
            view_count = std::max(view_count, lamp.own.size());
    std::vector<LampView> views(view_count);
    // Distributes a lamp's emitters evenly among the views, each the brighter the fewer views it is
    // in. Those of a volume that paths meet are for guiding alone: one is enough.
    const auto distribute = [&](const std::vector<std::size_t>& of_lamp) {
        if (!of_lamp.empty() && emitters[of_lamp.front()].lamp.is_met_by_paths()) {
            const auto& [emitter, number] = emitters[of_lamp.front()];
            for (LampView& view : views) {
                view.lamps.push_back(emitter.brightened(1 / emitter.fraction()));
                view.emitters.push_back(number);
            }
            return;
        }
        const std::size_t count = of_lamp.size();
        for (std::size_t e = 0; e < count; ++e) {
            const std::size_t begin = e * view_count / count, end = (e + 1) * view_count / count;
            const double weight =
                static_cast<double>(view_count) / static_cast<double>(end - begin);
            const auto& [emitter, number] = emitters[of_lamp[e]];
            for (std::size_t view = begin; view < end; ++view) {
                views[view].lamps.push_back(count == 1 ? emitter : emitter.brightened(weight));
                views[view].emitters.push_back(number);
            }
        }
    };
    for (const LampEmitters& lamp : lamps) {
        distribute(lamp.own);
        distribute(lamp.images);
    }
    return views;
}

}  // namespace uw
