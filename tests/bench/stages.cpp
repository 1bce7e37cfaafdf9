// Each stage of a render alone, on the plume scene at 640 x 360 unless its name says otherwise.
#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/output_files.h"
#include "core/base/parallel.h"
#include "core/geometry/geometry_scene.h"
#include "core/image/image_file.h"
#include "core/image/preview_exposure.h"
#include "core/passes/pixel_pass.h"
#include "render/renderer.h"
#include "tests/bench/support/measure.h"
#include "tests/bench/support/process.h"
#include "tests/bench/support/scenes.h"

namespace uw::bench {
namespace {

using Kind = SceneCase::Kind;

/// A loaded scene with its light, and what the stages after it work on.
class StageRun {
  public:
    StageRun(const SceneCase& scene, bool forward_scatter) : threads_(scene.threads) {
        SceneDesc desc = files_.read(scene);
        if (forward_scatter) desc.water.forward_scatter = {.K = 1, .G = 0.02, .B = 0.02};
        renderer_.set_scene(std::move(desc));
        reset_peak_memory();
        renderer_.assemble();
    }

    const AssembledScene& scene() const { return renderer_.assembled(); }
    const SceneDesc& desc() const { return scene().desc(); }
    Renderer& renderer() { return renderer_; }
    const LightTransport& transport() {
        if (!transport_.integrator) transport_ = renderer_.make_transport();
        return transport_;
    }
    PixelRenderer pixels() { return pixel_renderer(scene(), transport(), {false, true}); }
    LayerPlan plan() const { return layer_plan(scene().image, "default"); }
    Film film() const {
        const CameraDesc& camera = desc().camera;
        return {camera.width,
                camera.height,
                {0, 0, camera.width, camera.height},
                plan().channel_names()};
    }

    /// Runs passes on an image of the scene.
    void render(const LayerPlan& plan, Film& film, const std::function<void(Rendering&)>& run) {
        const BandColour colour(desc().water.bands_nm);
        const StageProgressCallback progress = [](Stage, double) {};
        ImageProgress reached;
        const LightTransport& by = transport();
        Rendering rendering = make_rendering(scene(), *scene().camera, by, renderer_.light(),
                                             {plan, colour, film, progress, reached});
        run(rendering);
    }

    /// Times `work` and records the memory that the scene and it need.
    void measure(benchmark::State& state, const std::function<void()>& work) const {
        double peak_mb = 0;
        bench::measure(state, Floor(scene()), threads_, [&] {
            work();
            peak_mb = peak_memory_mb();
        });
        state.counters["peak_MB"] = peak_mb;
    }

  private:
    int threads_;
    SceneFiles files_;
    Renderer renderer_;
    LightTransport transport_;
};

void load_volumes(StageRun& run, benchmark::State& state) {
    const AssembledScene& scene = run.scene();
    run.measure(state, [&] {
        std::vector<VolumeReport> reports;
        std::vector<std::string> warnings;
        benchmark::DoNotOptimize(uw::load_volumes(run.desc().volumes, scene.water.loads,
                                                  scene.water.medium.constituent_count(), reports,
                                                  warnings));
    });
}

void load_geometry(StageRun& run, benchmark::State& state) {
    run.measure(state, [&] {
        std::vector<std::string> warnings;
        benchmark::DoNotOptimize(
            build_surfaces(run.desc().geometry, run.scene().water.medium.wavelengths_nm, warnings));
    });
}

void splat(StageRun& run, benchmark::State& state) {
    run.measure(state, [&] {
        run.renderer().drop_light();
        const auto* light = &run.renderer().splat();
        benchmark::DoNotOptimize(light);
    });
}

// Computes every pixel's values and keeps none.
void march(StageRun& run, benchmark::State& state) {
    const PixelRenderer renderer = run.pixels();
    const CameraDesc& camera = run.desc().camera;
    run.measure(state, [&] {
        render_tiles(
            renderer, in_scatter_tolerance(run.desc().render), {},
            {0, 0, camera.width, camera.height}, [](double) {},
            [](int, int, const PixelResult& pixel) {
                double red = pixel.backscatter[0];
                benchmark::DoNotOptimize(red);
            });
    });
}

// An image with forward scatter; `render_s` is the CPU time of the same without.
void forward_scatter(StageRun& run, benchmark::State& state) {
    const LayerPlan plan = run.plan();
    Film film = run.film();
    const double begin = process_cpu_seconds();
    run.render(plan, film,
               [&](Rendering& rendering) { PixelPass(run.desc().render).run(rendering); });
    state.counters["render_s"] = process_cpu_seconds() - begin;
    run.measure(state, [&] {
        run.render(plan, film, [&](Rendering& rendering) {
            make_passes(run.scene().image).run(Pass::Of::light, rendering);
        });
    });
}

// One pixel's values into every pixel of a film of all default layers.
void store_film(StageRun& run, benchmark::State& state) {
    const PixelRenderer renderer = run.pixels();
    const LayerPlan plan = run.plan();
    const BandColour colour(run.desc().water.bands_nm);
    const CameraDesc& camera = run.desc().camera;
    PixelResult result;
    renderer.render(camera.width / 2, camera.height / 2, result);
    run.measure(state, [&] {
        Film film = run.film();
        for (int y = 0; y < camera.height; ++y)
            for (int x = 0; x < camera.width; ++x)
                store_pixel(result, plan, colour, film.pixel(x, y));
        benchmark::DoNotOptimize(film.values().data());
    });
}

Film rendered(StageRun& run, const char* layers) {
    const LayerPlan plan = layer_plan(run.scene().image, layers);
    const CameraDesc& camera = run.desc().camera;
    Film film(camera.width, camera.height, {0, 0, camera.width, camera.height},
              plan.channel_names());
    run.render(plan, film,
               [&](Rendering& rendering) { PixelPass(run.desc().render).run(rendering); });
    return film;
}

enum class Layers { usual, all };

template <Layers layers, ExrOptions::Precision precision, ExrCompression compression>
void write_image(StageRun& run, benchmark::State& state) {
    const Film film = rendered(run, layers == Layers::all ? "all" : "default");
    const ScratchFolder folder;
    const auto file = folder.path() / "image.exr";
    run.measure(state, [&] { write_exr(file, film, {}, {precision, compression}); });
    state.counters["written_MB"] = 1e-6 * static_cast<double>(std::filesystem::file_size(file));
}

void write_preview(StageRun& run, benchmark::State& state) {
    const Film film = rendered(run, "default");
    const ScratchFolder folder;
    const auto file = folder.path() / "image.png";
    run.measure(state, [&] {
        write_png(file, make_preview(film, automatic_exposure(film).value_or(1)), {});
    });
    state.counters["written_MB"] = 1e-6 * static_cast<double>(std::filesystem::file_size(file));
}

SceneCase plume(int width = 640, int height = 360) {
    SceneCase scene;
    scene.kind = Kind::plume;
    scene.width = width;
    scene.height = height;
    return scene;
}

SceneCase fog(int voxels, Fog kind) {
    SceneCase scene = plume(320, 180);
    scene.kind = Kind::fog;
    scene.voxels = voxels;
    scene.fog = kind;
    return scene;
}

struct Stage {
    std::string name;
    void (*run)(StageRun&, benchmark::State&);
    SceneCase scene;
};

std::vector<Stage> all_stages() {
    SceneCase uniform = plume(), many_triangles = plume();
    uniform.kind = many_triangles.kind = Kind::uniform;
    many_triangles.triangles = 10'000'000;
    std::vector<Stage> stages{{"load_vdb", load_volumes, plume()}};
    for (const int voxels : {128, 256, 512})
        for (const Fog kind : {Fog::dense, Fog::sparse})
            stages.push_back({"load_vdb", load_volumes, fog(voxels, kind)});
    for (const SceneCase& scene : {uniform, many_triangles}) {
        stages.push_back({"load_mesh", load_geometry, scene});
        stages.push_back({"splat", splat, scene});
    }
    stages.push_back({"splat", splat, plume()});
    stages.push_back({"march", march, uniform});
    stages.push_back({"march", march, plume()});
    for (const auto& [width, height] : {std::pair{640, 360}, {1280, 720}, {3840, 2160}}) {
        SceneCase sized = uniform;
        sized.width = width;
        sized.height = height;
        stages.push_back({"forward_scatter", forward_scatter, sized});
    }
    stages.push_back({"forward_scatter", forward_scatter, plume()});
    stages.push_back({"store_film", store_film, plume()});
    using enum ExrOptions::Precision;
    using enum ExrCompression;
    SceneCase uniform_hd = plume(1280, 720);
    uniform_hd.kind = Kind::uniform;
    for (const SceneCase& scene : {uniform_hd, plume(1280, 720)}) {
        stages.push_back({"write_exr", write_image<Layers::usual, automatic, zip>, scene});
        stages.push_back({"write_exr_zips", write_image<Layers::usual, automatic, zips>, scene});
        stages.push_back({"write_exr_none", write_image<Layers::usual, automatic, none>, scene});
        stages.push_back({"write_exr_float", write_image<Layers::usual, single, zip>, scene});
        stages.push_back({"write_exr_all", write_image<Layers::all, automatic, zip>, scene});
        stages.push_back({"write_exr_all_half", write_image<Layers::all, half, zip>, scene});
        stages.push_back({"write_png", write_preview, scene});
    }
    return stages;
}

std::vector<Benchmark> all_benchmarks() {
    std::vector<Benchmark> benchmarks;
    for (const Stage& stage : all_stages())
        benchmarks.push_back(
            {stage.name + "/" + stage.scene.name(), [stage] {
                 const auto run =
                     std::make_shared<StageRun>(stage.scene, stage.run == forward_scatter);
                 return [stage, run](benchmark::State& state) { stage.run(*run, state); };
             }});
    return benchmarks;
}

}  // namespace
}  // namespace uw::bench

int main(int argc, char** argv) {
    return uw::bench::run_benchmarks(argc, argv, uw::bench::all_benchmarks());
}
