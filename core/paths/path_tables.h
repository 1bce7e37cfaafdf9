#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "core/integrators/deep_shadow.h"
#include "core/paths/lamp_gathering.h"
#include "core/paths/lamp_glow.h"
#include "core/paths/path_vertex.h"
#include "core/paths/scattering_tables.h"
#include "core/paths/water_segment.h"

namespace uw {

/// What all paths through a scene look up that see its lamps alike (LampView).
struct PathTables {
    WaterOptics optics;
    const ScatteringTables& scattering;
    LampGathering lamps;
    LampGlow glow;
    VertexTables vertices;
    Spectrum light;   // of all lamps on their axes, or 1 without lamps
    Spectrum albedo;  // the greatest of all the water may hold, at least 0.1: guides paths

    /// `scene`: with one emitter per lamp. `deep_shadows`: as LampGathering takes them. What is
    /// referred to must outlive this object.
    PathTables(const LitScene& scene, const ScatteringTables& tables,
               std::vector<std::shared_ptr<const DeepShadow>> deep_shadows)
        : optics(scene),
          scattering(tables),
          lamps(optics, scattering, std::move(deep_shadows)),
          glow(optics, scattering),
          vertices{&optics, &scattering, &glow} {
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
        if (scene.emitters->empty())
            for (std::size_t b = 0; b < optics.bands(); ++b) light[b] = 1;
    }
};

}  // namespace uw
