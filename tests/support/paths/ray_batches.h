#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/support/paths/path_scene.h"
#include "tests/support/paths/term_sums.h"

namespace uw::test {

/// Independent batches of paths of one camera ray.
inline std::vector<TermSums> ray_batches(const PathScene& scene, const Ray& ray, std::uint64_t seed,
                                         std::size_t batches = 32, std::uint32_t paths = 1 << 10) {
    const PathTracer tracer(scene.lit());
    return run_batches(batches, scene.band_count(), seed,
                       [&](std::uint64_t batch_seed, TermSums& sums) {
                           trace_ray(tracer, *scene.surfaces, ray, batch_seed, paths, sums);
                       });
}

}  // namespace uw::test
