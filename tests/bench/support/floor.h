#pragma once

#include "render/scene_assembly.h"

namespace uw::bench {

/// The minimum cost of an image of a scene (docs/performance.md): its primary rays and, where one
/// meets a surface, a shadow ray to each lamp, by Embree alone; and one pass over the voxels of its
/// grids. No light is computed.
class Floor {
  public:
    /// `scene` outlives the floor.
    explicit Floor(const AssembledScene& scene) : scene_(scene) {}

    /// CPU time of the floor on all threads allowed [s], the mean of as many rounds as take 50 ms.
    double cpu_seconds() const;

  private:
    double trace() const;
    double sum_voxels() const;

    const AssembledScene& scene_;
};

}  // namespace uw::bench
