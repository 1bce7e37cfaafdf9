#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/base/spectrum.h"
#include "core/light/integrator.h"
#include "core/light/lamp.h"
#include "core/paths/emission_sampler.h"
#include "core/paths/guiding_distribution.h"
#include "core/paths/next_event_estimator.h"
#include "core/paths/path_segment.h"
#include "core/paths/scattering_tables.h"

namespace uw {

/// A scene's lamps as one light path sees them: each as a single point, whatever its extent. The
/// mean over all views is the light of the lamps. A path that chooses a view at random costs as
/// much as among point lamps.
struct LampView {
    std::vector<Lamp> lamps;            // one per lamp, and its mirror image if it has one
    std::vector<std::size_t> emitters;  // index of each among the scene's emitters
};

/// As many views as the lamp with the most emitters has, and one if there are no lamps. `emitters`:
/// as LitScene::emitters.
std::vector<LampView> lamp_views(const std::vector<Lamp>& emitters);

/// What all paths through a scene that see the same LampView look up.
struct PathTables {
    WaterOptics optics;
    const ScatteringTables& scattering;
    NextEventEstimator lamps;
    GuidingTables guides;
    Spectrum light;   // of all lamps on their axes, or 1 where there is none
    Spectrum albedo;  // the greatest of all that the water may contain, at least 0.1; for guiding

    /// `scene`: with one emitter per lamp. `deep_shadows` and `emitters`: see NextEventEstimator.
    /// What is referred to must outlive this object.
    PathTables(const LitScene& scene, const ScatteringTables& tables,
               const EmissionSampler& emission,
               std::vector<std::shared_ptr<const DeepShadow>> deep_shadows,
               std::vector<std::size_t> emitters);
    PathTables(const PathTables&) = delete;
    PathTables& operator=(const PathTables&) = delete;
    PathTables(PathTables&&) = delete;
    PathTables& operator=(PathTables&&) = delete;
    ~PathTables() = default;
};

}  // namespace uw
