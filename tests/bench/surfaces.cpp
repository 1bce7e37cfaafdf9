#include "core/geometry/surfaces.h"

#include <benchmark/benchmark.h>

#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "core/geometry/embree_surfaces.h"

namespace uw {
namespace {

constexpr std::uint32_t k_cells = 224;  // 100 352 triangles
constexpr int k_tile = 32;
const Point3 k_lamp{0.8, -0.6, 0.1};

/// A bumpy wall of 6 m x 6 m, 4 m ahead.
std::unique_ptr<Surfaces> wall() {
    auto object = std::make_unique<MeshObject>();
    for (std::uint32_t j = 0; j <= k_cells; ++j) {
        for (std::uint32_t i = 0; i <= k_cells; ++i) {
            const double x = 6.0 * i / k_cells - 3, y = 6.0 * j / k_cells - 3;
            const double z =
                4 + 0.2 * std::sin(3 * x) * std::cos(4 * y) + 0.03 * std::sin(31 * x + 17 * y);
            for (const double value : {x, y, z}) {
                object->mesh.positions.push_back(static_cast<float>(value));
            }
        }
    }
    object->vertex_count = object->mesh.positions.size() / 3;
    object->mesh.positions.resize(object->mesh.positions.size() + 4);
    for (std::uint32_t j = 0; j < k_cells; ++j) {
        for (std::uint32_t i = 0; i < k_cells; ++i) {
            const std::uint32_t a = j * (k_cells + 1) + i, c = a + k_cells + 1;
            for (const std::uint32_t corner : {a, a + 1, c, a + 1, c + 1, c}) {
                object->mesh.triangles.push_back(corner);
            }
        }
    }
    object->reflectance = Spectrum{};
    SceneObjects objects{.meshes = {},
                         .shared_meshes = {},
                         .instances = {},
                         .spheres = {},
                         .planes = {},
                         .bounds = {},
                         .bands = ReflectanceBands({620, 540, 450}),
                         .names = {}};
    objects.meshes.push_back(std::move(object));
    return make_embree_surfaces(std::move(objects));
}

/// Tiles of pixels of an image of 512 x 512, f = 512, one tile after the other.
std::vector<Vector3> tile_directions() {
    std::vector<Vector3> directions;
    for (int tile = 0; tile < 256; ++tile) {
        for (int pixel = 0; pixel < k_tile * k_tile; ++pixel) {
            const double x = tile % 16 * k_tile + pixel % k_tile + 0.5;
            const double y = tile / 16 * k_tile + pixel / k_tile + 0.5;
            directions.push_back(glm::normalize(Vector3(x - 256, y - 256, 512)));
        }
    }
    return directions;
}

/// Runs `query` once per iteration; `rays` is how many rays it traces.
template <typename Query>
void measure(benchmark::State& state, std::size_t rays, const Query& query) {
    for (auto _ : state) query();
    state.counters["per_ray"] = benchmark::Counter(
        static_cast<double>(rays),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

struct Scene {
    std::unique_ptr<Surfaces> surfaces = wall();
    std::vector<Vector3> directions = tile_directions();
    std::vector<Ray> rays;
    std::vector<SurfaceHit> hits{directions.size()};
    std::vector<char> flags = std::vector<char>(directions.size());
    std::vector<double> distances = std::vector<double>(directions.size());
    std::vector<Point3> lit;  // points that the camera sees

    Scene() {
        for (const Vector3& direction : directions) rays.push_back({{}, direction});
        surfaces->closest_hits(rays, 1e6, hits, flags);
        for (const SurfaceHit& hit : hits) lit.push_back(hit.position);
    }
};

Scene& scene() {
    static Scene the_scene;
    return the_scene;
}

void camera_rays(benchmark::State& state, bool packets) {
    Scene& s = scene();
    measure(state, s.rays.size(), [&] {
        if (packets) {
            s.surfaces->closest_hits(s.rays, 1e6, s.hits, s.flags);
        } else {
            s.surfaces->Surfaces::closest_hits(s.rays, 1e6, s.hits, s.flags);
        }
    });
}

void shadow_map_rays(benchmark::State& state, bool packets) {
    Scene& s = scene();
    measure(state, s.rays.size(), [&] {
        if (packets) {
            s.surfaces->hit_distances(k_lamp, s.directions, s.distances);
        } else {
            s.surfaces->Surfaces::hit_distances(k_lamp, s.directions, s.distances);
        }
    });
}

void shadow_rays(benchmark::State& state, bool packets) {
    Scene& s = scene();
    measure(state, s.rays.size(), [&] {
        if (packets) {
            s.surfaces->occluded_many(k_lamp, s.lit, s.flags);
        } else {
            s.surfaces->Surfaces::occluded_many(k_lamp, s.lit, s.flags);
        }
    });
}

BENCHMARK_CAPTURE(camera_rays, single, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(camera_rays, packets, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(shadow_map_rays, single, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(shadow_map_rays, packets, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(shadow_rays, single, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(shadow_rays, packets, true)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace uw
