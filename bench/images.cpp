// Whole images: the lamps' light splatted and every pixel rendered, from a scene that is loaded to
// a film of the total radiance. Each case is best run in a process of its own (scripts/bench does).
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "bench/support/measure.h"
#include "bench/support/process.h"
#include "bench/support/reference_error.h"
#include "bench/support/scenes.h"
#include "core/frame/render_film.h"

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

/// A scene ready to be rendered, and what is only measured once however often it is.
class ImageRun {
  public:
    explicit ImageRun(const SceneCase& scene) : case_(scene) {
        const SceneDesc desc = files_.read(scene);
        reset_peak_memory();
        scene_ = assemble_scene(desc, [](const std::string&) {});
    }

    void run(benchmark::State& state) {
        DeepShadows deep_shadows;
        double splat_s = 0;
        measure(state, Floor(scene_), case_.threads, [&] {
            splat_s = render(deep_shadows);
            if (peak_mb_ == 0)
                peak_mb_ = peak_memory_mb();  // before the reference, which adds to it
        });
        if (error_.pixels == 0) {
            const ReferenceEffort effort = reference_effort(case_);
            error_ = compare_with_reference(scene_, plan(), *film_, effort.pixels, effort.step);
        }
        state.counters["splat_s"] = splat_s;
        count(state);
    }

  private:
    LayerPlan plan() const {
        return {"total", scene_.desc.water.bands_nm, lamp_names(scene_.desc)};
    }

    // Returns the CPU time of the splat [s].
    double render(DeepShadows& deep_shadows) {
        deep_shadows.clear();
        const double begin = process_cpu_seconds();
        deep_shadows = splat_lamps(scene_, DeepShadowOptions{});
        const double splat_s = process_cpu_seconds() - begin;
        const CameraDesc& camera = scene_.desc.camera;
        film_.emplace(camera.width, camera.height, PixelWindow{0, 0, camera.width, camera.height},
                      plan().channel_names());
        film_bytes_ = film_->values().size_bytes();
        render_scene(scene_, deep_shadows, make_light_transport(scene_, deep_shadows), plan(),
                     BandColour(scene_.desc.water.bands_nm), *film_,
                     [](const std::string&, double) { return true; });
        benchmark::DoNotOptimize(film_->values().data());
        return splat_s;
    }

    void count(benchmark::State& state) const {
        double voxels = 0, grid_bytes = 0;
        for (const VolumeReport& report : scene_.volume_reports) {
            voxels += static_cast<double>(report.statistics.active_voxels);
            grid_bytes += static_cast<double>(report.bytes);
        }
        state.counters["rmse"] = error_.rmse;
        state.counters["largest_error"] = error_.largest;
        state.counters["reference_rmse"] = error_.reference;
        state.counters["pixels_compared"] = error_.pixels;
        state.counters["peak_MB"] = peak_mb_;
        state.counters["grids_MB"] = 1e-6 * grid_bytes;
        state.counters["layers_MB"] = 1e-6 * static_cast<double>(film_bytes_);
        state.counters["pixels"] = 1.0 * case_.width * case_.height;
        state.counters["lamps"] = static_cast<double>(scene_.lamps.size());
        state.counters["bands"] = scene_.water.medium.band_count();
        state.counters["voxels"] = voxels;
        state.counters["triangles"] = static_cast<double>(scene_.surfaces->triangle_count());
    }

    SceneCase case_;
    SceneFiles files_;
    AssembledScene scene_;
    std::size_t film_bytes_ = 0;
    double peak_mb_ = 0;
    std::optional<Film> film_;  // of the last render
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
    for (const bool dense : {true, false})
        for (const int voxels : {128, 256, 512}) {
            SceneCase fog = sized(Kind::fog, 320, 180);
            fog.dense = dense;
            add(fog, &SceneCase::voxels, voxels);
        }
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
