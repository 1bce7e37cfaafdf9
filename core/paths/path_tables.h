#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/base/spectrum.h"
#include "core/light/integrator.h"
#include "core/light/lamp.h"
#include "core/paths/guiding_distribution.h"
#include "core/paths/next_event_estimator.h"
#include "core/paths/path_segment.h"
#include "core/paths/scattering_tables.h"

namespace uw {

/// A scene's lamps as a light path sees them: each as one point, whatever its extent. The mean over
/// all views is the light of the lamps, so that a path that chooses one at random costs what it
/// does among point lamps.
struct LampView {
    std::vector<Lamp> lamps;            // one per lamp, and its mirror image if it has one
    std::vector<std::size_t> emitters;  // which of the scene's each of them is
};

/// As many views as the lamp with most emitters has, and one without lamps. `emitters`: as
/// LitScene::emitters.
std::vector<LampView> lamp_views(const std::vector<Lamp>& emitters);

/// What all paths through a scene look up that see its lamps alike (LampView).
struct PathTables {
    WaterOptics optics;
    const ScatteringTables& scattering;
    NextEventEstimator lamps;
    GuidingTables guides;
    Spectrum light;   // of all lamps on their axes, or 1 where there is none
    Spectrum albedo;  // the greatest of all the water may hold, at least 0.1: guides paths

    /// `scene`: with one emitter per lamp. `deep_shadows` and `emitters`: as NextEventEstimator
    /// takes them. What is referred to must outlive this object.
    PathTables(const LitScene& scene, const ScatteringTables& tables,
               std::vector<std::shared_ptr<const DeepShadow>> deep_shadows,
               std::vector<std::size_t> emitters);
    PathTables(const PathTables&) = delete;
    PathTables& operator=(const PathTables&) = delete;
    PathTables(PathTables&&) = delete;
    PathTables& operator=(PathTables&&) = delete;
    ~PathTables() = default;
};

}  // namespace uw
