#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/progress.h"
#include "media/light/deep_shadow_map.h"
#include "render/assembled_scene.h"

namespace uw {

/// The maps that one splat made, apart from those it reused.
struct SplatCounts {
    std::size_t shadow_maps = 0, column_maps = 0;
    std::uint64_t rays = 0;  // traced for these maps
    std::size_t bytes = 0;   // of their memory
};

/// Makes the deep shadow maps of a scene's lamps, and keeps them for the next render. A shadow map
/// depends on the lamp's position, the surfaces and the map's resolution; a column map on the
/// lamp's position, the concentration field, the map's resolution and its memory budget. A map is
/// reused if these are the same as at the previous splat: another camera, or another intensity or
/// colour of a lamp, needs no new map; a lamp that moved needs its own; another frame of a volume
/// needs new columns only; a lamp that turned or widened its beam needs new shadows only, within
/// that beam. A sun's shadows are finest around the camera, and follow it where surfaces are wide.
class LightSplatter {
  public:
    /// Returns the deep shadow map of every emitter of `scene`, the same to the bit as from a new
    /// splatter. Surfaces and fields are compared by object identity. The surfaces are kept alive;
    /// the field is not, so that its memory is free for the next one. Throws Interrupted, and
    /// InputError if the maps of all emitters will not fit into free memory.
    DeepShadows splat(
        const AssembledScene& scene, const DeepShadowOptions& options,
        const ProgressCallback& progress = [](double) {});

    /// The counts of the last splat.
    const SplatCounts& counts() const { return counts_; }

  private:
    struct Maps {
        Point3 lamp;
        int shadow_resolution;
        std::shared_ptr<const ShadowMap> shadows;
        std::shared_ptr<const ColumnMap> columns;
    };

    struct SunMaps {
        Sunlight sun;
        int shadow_resolution;
        std::vector<LightSquare> squares;
        std::shared_ptr<const SunShadowMap> shadows;
        std::shared_ptr<const SunColumnMap> columns;
    };

    std::shared_ptr<const DeepShadow> splat_lamp(const AssembledScene& scene, const Lamp& emitter,
                                                 const std::vector<Maps>& before);
    std::shared_ptr<const DeepShadow> splat_sun(const AssembledScene& scene, const Lamp& emitter,
                                                const std::vector<SunMaps>& before);
    int shadow_resolution(const Lamp& emitter) const;
    void drop_outdated(const AssembledScene& scene, const DeepShadowOptions& options);
    void expect_room(std::size_t done, std::size_t all) const;
    void complete(Maps& maps, const AssembledScene& scene, const Lamp& emitter);

    std::shared_ptr<const Surfaces> surfaces_;
    std::weak_ptr<const ConcentrationField> field_;
    DeepShadowOptions options_;  // of each emitter
    std::vector<Maps> maps_;
    std::vector<SunMaps> sun_maps_;
    SplatCounts counts_;
};

}  // namespace uw
