#include "tests/bench/support/floor.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <numeric>

#include "core/base/parallel.h"
#include "media/volumes/grid_field.h"
#include "tests/bench/support/process.h"

namespace uw::bench {
namespace {

constexpr int k_tile = 16;  // pixels along an edge, as in the renderer
constexpr double k_min_seconds = 0.05;

}  // namespace

double Floor::cpu_seconds() const {
    const double begin = process_cpu_seconds();
    double spent = 0;
    int rounds = 0;
    while (spent < k_min_seconds) {
        benchmark::DoNotOptimize(trace() + sum_voxels());
        spent = process_cpu_seconds() - begin;
        ++rounds;
    }
    return spent / rounds;
}

double Floor::trace() const {
    const int width = scene_.camera->width(), height = scene_.camera->height();
    const int columns = (width + k_tile - 1) / k_tile, rows = (height + k_tile - 1) / k_tile;
    std::vector<double> lit(static_cast<std::size_t>(columns * rows));
    parallel_for(lit.size(), [&](std::size_t tile) {
        const int x0 = static_cast<int>(tile) % columns * k_tile;
        const int y0 = static_cast<int>(tile) / columns * k_tile;
        for (int y = y0; y < std::min(y0 + k_tile, height); ++y)
            for (int x = x0; x < std::min(x0 + k_tile, width); ++x) {
                const auto ray = scene_.camera->refracted_ray(x + 0.5, y + 0.5);
                const double s = ray ? scene_.surfaces->hit_distance(*ray) : k_far;
                if (s >= k_far) continue;
                for (const Lamp& lamp : scene_.lamps)
                    lit[tile] +=
                        scene_.surfaces->occluded(lamp.origin(ray->at(s)), ray->at(s)) ? 0 : 1;
            }
    });
    return std::accumulate(lit.begin(), lit.end(), 0.0);
}

double Floor::sum_voxels() const {
    double sum = 0;
    // A Renderer always assembles a GridField, whatever the scene contains.
    for (const GridVolume& volume : dynamic_cast<const GridField&>(scene_.field->grids()).volumes())
        for (const NanoGrid& brick : volume.bricks()) sum += brick.stored_sum();
    return sum;
}

}  // namespace uw::bench
