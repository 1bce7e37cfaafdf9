// Lines through a dense grid of 256^3 voxels, between the camera and points behind it: their exact
// columns, and their profiles with a knot every quarter voxel.
#include <benchmark/benchmark.h>

#include <memory>
#include <vector>

#include "render/renderer.h"
#include "tests/bench/support/scenes.h"

namespace uw::bench {
namespace {

constexpr int k_tile = 32;  // pixels, as images are rendered

struct Fog256 {
    SceneFiles files;
    Renderer renderer;
    std::vector<Ray> rays;  // of an image of 320 x 180, every second of both, tile by tile
    double reach = 5;       // [m]

    Fog256() {
        SceneCase scene{.kind = SceneCase::Kind::fog, .width = 320, .height = 180};
        scene.voxels = 256;
        renderer.set_scene(files.read(scene));
        renderer.assemble();
        const Affine& pose = renderer.assembled().desc().camera.world_from_camera;
        for (int y0 = 0; y0 < 180; y0 += k_tile)
            for (int x0 = 0; x0 < 320; x0 += k_tile)
                for (int y = y0; y < y0 + k_tile; ++y)
                    for (int x = x0; x < x0 + k_tile; ++x)
                        rays.push_back(
                            {pose * Point3(0, 0, 0),
                             glm::normalize(pose.linear() * Vector3(x - 160, y - 90, 0.73 * 320))});
    }
    const ConcentrationField& field() const { return *renderer.assembled().lit().field; }
};

Fog256& fog() {
    static Fog256 the_fog;
    return the_fog;
}

void count(benchmark::State& state, std::size_t rays) {
    state.counters["per_line"] = benchmark::Counter(
        static_cast<double>(rays),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void columns(benchmark::State& state) {
    const Fog256& f = fog();
    std::vector<double> column(1);
    double sum = 0;
    for (auto _ : state)
        for (const Ray& ray : f.rays) {
            f.field().column(ray.origin, ray.at(f.reach), column);
            sum += column[0];
        }
    benchmark::DoNotOptimize(sum);
    count(state, f.rays.size());
}

void profiles(benchmark::State& state) {
    const Fog256& f = fog();
    ConcentrationProfile profile;
    std::size_t knots = 0;
    for (auto _ : state)
        for (const Ray& ray : f.rays) {
            f.field().profile(ray, f.reach, profile);
            knots += profile.s.size();
        }
    benchmark::DoNotOptimize(knots);
    count(state, f.rays.size());
}

BENCHMARK(columns)->Unit(benchmark::kMillisecond);
BENCHMARK(profiles)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace uw::bench
