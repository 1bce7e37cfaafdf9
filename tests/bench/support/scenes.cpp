#include "tests/bench/support/scenes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <numbers>
#include <vector>

#include "core/base/error.h"
#include "render/scene_loading.h"

namespace uw::bench {
namespace {

constexpr const char* k_s1 = R"(uwvdb: 1
camera:
  resolution: [320, 240]
  intrinsics: {fx: 207.8461, fy: 207.8461, cx: 160, cy: 120}
water:
  bands: [620, 540, 450]
  absorption: [0.35, 0.08, 0.05]
  scattering: {b: [0.20, 0.22, 0.25], phase: {type: hg, g: 0.9}}
geometry:
  - {type: plane, point: [0, 0, 4], normal: [0, 0, -1], reflectance: [0.5, 0.5, 0.5]}
  - {type: box, min: [0.1, -0.2, 1.0], max: [0.4, 0.1, 1.3], reflectance: [0.5, 0.5, 0.5]}
lamps:
  - {name: lamp, position: [1, -0.5, 0], intensity: [50, 50, 50]}
render: {samples: 1}
)";

// 620, 540 and 450 nm, or more bands evenly from 400 to 700 nm.
std::vector<double> wavelengths(int bands) {
    if (bands == 3) return {620, 540, 450};
    std::vector<double> nm(static_cast<std::size_t>(bands));
    for (std::size_t band = 0; band < nm.size(); ++band)
        nm[band] = 400 + 300.0 * static_cast<double>(band) / (bands - 1);
    return nm;
}

std::string per_band(int bands, const std::function<double(double nm)>& value) {
    std::vector<double> values;
    for (const double nm : wavelengths(bands)) values.push_back(value(nm));
    return fmt::format("[{:.6g}]", fmt::join(values, ", "));
}

// Clear water, dark in the red.
double absorption(double nm) {
    return 0.03 + 0.27 * std::pow(std::max(0.0, nm - 450) / 170, 2);
}

std::string lamp(int index, int bands) {
    // Consecutive lamps are far apart on the ring: few lamps light the scene from all sides, too.
    const double angle = index * std::numbers::pi * (3 - std::sqrt(5.0)) + 0.5;
    const double x = std::cos(angle), y = std::sin(angle);
    return fmt::format(
        "  - name: lamp{}\n    position: [{:.6f}, {:.6f}, 0]\n    direction: [{:.6f}, {:.6f}, 1]\n"
        "    profile: {{type: spot, beam: 70, edge: 10}}\n    intensity: {}\n",
        index + 1, 0.8 * x, 0.5 * y, -0.2 * x, -0.2 * y + 0.05,
        per_band(bands, [](double) { return 50; }));
}

std::string volume(const SceneCase& scene, const std::string& file) {
    if (scene.kind == SceneCase::Kind::plume)
        return fmt::format(
            "volumes:\n  - file: {}\n    grids: {{density: {{small: 2.0, large: 0.8}}}}\n"
            "    centering: cell\n    up: z\n    transform: {{translate: [-2.5, 0, 1.5]}}\n",
            file);
    return fmt::format(
        "volumes:\n  - file: {}\n    grids: {{density: {{absorption: {}, scattering: {}}}}}\n",
        file, per_band(scene.bands, [](double) { return 0.05; }),
        per_band(scene.bands, [](double) { return 0.4; }));
}

std::string text(const SceneCase& scene, const std::string& mesh, const std::string& vdb) {
    std::string yaml = fmt::format(
        "uwvdb: 1\ncamera:\n  resolution: [{0}, {1}]\n"
        "  intrinsics: {{fx: {2}, fy: {2}, cx: {3}, cy: {4}}}\n"
        "  pose: {{position: [0.6, 1.1, 3.2], look_at: [-0.15, 0.5, 0], up: [0, 1, 0]}}\n",
        scene.width, scene.height, 0.73 * scene.width, 0.5 * scene.width, 0.5 * scene.height);
    yaml += fmt::format(
        "water:\n  bands: [{}]\n  absorption: {}\n"
        "  scattering: {{b: {}, phase: {{type: hg, g: 0.9}}}}\n",
        fmt::join(wavelengths(scene.bands), ", "), per_band(scene.bands, absorption),
        per_band(scene.bands, [](double) { return 0.2; }));
    if (!vdb.empty()) yaml += volume(scene, vdb);
    yaml += fmt::format("geometry:\n  - {{file: {}, reflectance: {}}}\nlamps:\n", mesh,
                        per_band(scene.bands, [](double nm) { return nm / 1500; }));
    for (int i = 0; i < scene.lamps; ++i) yaml += lamp(i, scene.bands);
    return yaml + "render: {samples: 1}\n";
}

std::string fog_name(const SceneCase& scene) {
    const char* const names[]{"dense", "sparse", "ball"};
    return fmt::format("fog{}-{}", scene.voxels, names[static_cast<std::size_t>(scene.fog)]);
}

std::string kind_name(const SceneCase& scene) {
    switch (scene.kind) {
        case SceneCase::Kind::s1:
            return "s1";
        case SceneCase::Kind::uniform:
            return "uniform";
        case SceneCase::Kind::plume:
            return "plume";
        case SceneCase::Kind::fog:
            return fog_name(scene);
    }
    throw InputError("unknown kind of scene");
}

}  // namespace

std::string SceneCase::name() const {
    std::string name = fmt::format("{}/{}x{}/lamps:{}/bands:{}", kind_name(*this), width, height,
                                   kind == Kind::s1 ? 1 : lamps, bands);
    if (kind != Kind::s1 && triangles != SceneCase{}.triangles)
        name += fmt::format("/triangles:{}", triangles);
    return name + fmt::format("/threads:{}", threads);
}

SceneFiles::SceneFiles() {
    if (const char* folder = std::getenv("UWVDB_BENCH_FILES")) {
        folder_ = folder;
        return;
    }
    scratch_ = std::make_unique<const ScratchFolder>();
    folder_ = scratch_->path();
}

SceneDesc SceneFiles::read(const SceneCase& scene) const {
    std::string yaml = k_s1;
    if (scene.kind != SceneCase::Kind::s1) {
        const std::string mesh = fmt::format("seabed{}.ply", scene.triangles);
        if (!exists(folder_ / mesh)) write_seabed(folder_ / mesh, scene.triangles);
        std::string vdb;
        if (scene.kind == SceneCase::Kind::plume) vdb = UWVDB_BENCH_PLUME;
        if (scene.kind == SceneCase::Kind::fog) {
            vdb = fog_name(scene) + ".vdb";
            if (!exists(folder_ / vdb)) write_fog(folder_ / vdb, scene.voxels, scene.fog);
        }
        yaml = text(scene, mesh, vdb);
    }
    const std::filesystem::path file = folder_ / "scene.yaml";
    std::ofstream out(file);
    out << yaml;
    out.close();
    if (!out) throw IoError(file.string() + ": cannot write");
    return load_scene(file, {});
}

}  // namespace uw::bench
