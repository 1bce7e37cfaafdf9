// Whole images: the lamps' light splatted and every pixel rendered, from a loaded scene to a film
// of the total radiance. Each case is best run in its own process (scripts/bench does so).
#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "render/renderer.h"
#include "tests/bench/support/measure.h"
#include "tests/bench/support/process.h"
#include "tests/bench/support/reference_error.h"
#include "tests/bench/support/scenes.h"

namespace uw::bench {
namespace {

using Kind = SceneCase::Kind;

// How many pixels the reference integrator renders of a scene, and how finely: it is slow in grids.
struct ReferenceEffort {
    int pixels;
    double step;
};

ReferenceEffort reference_effort(const SceneCase& scene) {
    switch (scene.kind) {
        case Kind::s1:
            return {300, 0.0005};
        case Kind::uniform:
            return {400, 0.001};
        case Kind::plume:
            return {60, 0.002};
        case Kind::fog:
            return {std::max(6, 4000 / scene.voxels), 0.004};
    }
    return {};
}

/// A scene ready to be rendered, and what is measured only once however often it is rendered.
class ImageRun {
  public:
    explicit ImageRun(const SceneCase& scene) : case_(scene) {
        renderer_.set_scene(files_.read(scene));
        reset_peak_memory();
        renderer_.assemble();
    }

    void run(benchmark::State& state) {
        double splat_s = 0;
        const Film* film = nullptr;
        measure(state, Floor(scene()), case_.threads, [&] {
            renderer_.drop_light();
            const double begin = process_cpu_seconds();
            renderer_.splat();
            splat_s = process_cpu_seconds() - begin;
            film = &renderer_.render({.layers = k_layers});
            benchmark::DoNotOptimize(film->values().data());
            if (peak_mb_ == 0)
                peak_mb_ = peak_memory_mb();  // before the reference, which adds to it
        });
        if (error_.pixels == 0) {
            const ReferenceEffort effort = reference_effort(case_);
            error_ = compare_with_reference(scene(), layer_plan(scene().image, k_layers), *film,
                                            effort.pixels, effort.step);
        }
        state.counters["splat_s"] = splat_s;
        state.counters["layers_MB"] = 1e-6 * static_cast<double>(film->values().size_bytes());
        count(state);
    }

  private:
    static constexpr const char* k_layers = "total";

    const AssembledScene& scene() const { return renderer_.assembled(); }

    void count(benchmark::State& state) const {
        const RenderReport& report = renderer_.report();
        state.counters["rmse"] = error_.rmse;
        state.counters["largest_error"] = error_.largest;
        state.counters["reference_rmse"] = error_.reference;
        state.counters["pixels_compared"] = error_.pixels;
        state.counters["peak_MB"] = peak_mb_;
        state.counters["grids_MB"] = 1e-6 * static_cast<double>(report.grid_bytes);
        state.counters["pixels"] = 1.0 * case_.width * case_.height;
        state.counters["lamps"] = static_cast<double>(report.lamps);
        state.counters["bands"] = static_cast<double>(report.bands);
        state.counters["voxels"] = static_cast<double>(report.active_voxels);
        state.counters["triangles"] = static_cast<double>(report.triangles);
    }

    SceneCase case_;
    SceneFiles files_;
    Renderer renderer_;
    double peak_mb_ = 0;
    ReferenceError error_;
};

SceneCase sized(Kind kind, int width, int height) {
    SceneCase scene;
    scene.kind = kind;
    scene.width = width;
    scene.height = height;
    return scene;
}

std::vector<SceneCase> all_cases() {
    constexpr std::array<std::array<int, 2>, 3> k_sizes{{{640, 360}, {1920, 1080}, {3840, 2160}}};
    std::vector<SceneCase> cases{sized(Kind::s1, 320, 240), sized(Kind::uniform, 64, 36)};
    const auto add = [&](SceneCase scene, auto SceneCase::*member, auto value) {
        scene.*member = value;
        cases.push_back(scene);
    };
    for (const Kind kind : {Kind::uniform, Kind::plume}) {
        for (const auto& [width, height] : k_sizes) {
            cases.push_back(sized(kind, width, height));
            add(cases.back(), &SceneCase::threads, 2);
        }
        const SceneCase small = sized(kind, 640, 360);
        for (const int lamps : {1, 8}) add(small, &SceneCase::lamps, lamps);
        add(small, &SceneCase::bands, 16);
    }
    add(sized(Kind::uniform, 640, 360), &SceneCase::triangles, 10'000'000);
    for (const Fog kind : {Fog::dense, Fog::sparse})
        for (const int voxels : {128, 256, 512}) {
            SceneCase fog = sized(Kind::fog, 320, 180);
            fog.fog = kind;
            add(fog, &SceneCase::voxels, voxels);
        }
    SceneCase large = sized(Kind::fog, 640, 360);
    large.voxels = 512;
    add(large, &SceneCase::lamps, 2);
    SceneCase ball = sized(Kind::fog, 640, 360);
    ball.fog = Fog::ball;
    add(ball, &SceneCase::voxels, 256);
    return cases;
}

std::vector<Benchmark> all_benchmarks() {
    std::vector<Benchmark> benchmarks;
    for (const SceneCase& scene : all_cases())
        benchmarks.push_back({scene.name(), [scene] {
                                  const auto run = std::make_shared<ImageRun>(scene);
                                  return [run](benchmark::State& state) { run->run(state); };
                              }});
    return benchmarks;
}

}  // namespace
}  // namespace uw::bench

int main(int argc, char** argv) {
    return uw::bench::run_benchmarks(argc, argv, uw::bench::all_benchmarks());
}
