#include "cli/validate/validate_command.h"

#include <unistd.h>

#include <fmt/format.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <ostream>
#include <utility>

#include "camera/camera.h"
#include "cli/console.h"
#include "cli/process.h"
#include "cli/validate/light_validation.h"
#include "cli/validate/validation_report.h"
#include "core/base/error.h"
#include "core/base/output_files.h"
#include "core/base/parallel.h"
#include "media/volumes/vdb_writer.h"
#include "render/scene_loading.h"
#include "render/scene_rendering.h"

namespace uw {

const char* const k_validate_examples = R"(Examples:
  uwvdb validate
  uwvdb validate plume.yaml --report plume.html
  uwvdb validate uniform.yaml --set water.absorption=0.1 --tolerance 0.002

Computes a scene in every available way and compares the results, per component and band:
McGlamery's planes and their limit, adaptive quadrature, the reference integrator and a VDB of
constant value against the volume integrator in uniform water (grids replaced by their mean), and on
the scene's own grids the volume against the reference integrator. If the scene has forward scatter,
its effect is compared, too, also with a sum over all pairs of pixels. If it has multiple
scattering, the fast form is compared with unbiased light paths, in units of their standard errors.
Without a scene: a built-in suite, which compares light paths with tables, too.
Exit codes: 0 all within the tolerance, 5 not; 1 internal fault, 2 wrong usage, 3 bad input,
4 cannot read or write, 130 interrupted.)";

Options validate_options(ValidateArguments& a) {
    Options options;
    options.path("SCENE", "", a.scene, "scene file; default: the built-in suite");
    options.set(a.overrides);
    options.path("--report", "FILE.html", a.report, "write one HTML page with pictures and plots");
    options.number("--tolerance", "R", a.tolerance, 0, 1,
                   "largest relative difference allowed at a pixel; default 0.001");
    options.threads(a.threads);
    options.confine();
    options.flag("--quiet", a.quiet, "print failed checks and errors only");
    return options;
}

namespace {

constexpr int k_width = 48, k_height = 36;

// A camera at the origin that looks along +z, 60 degrees wide; the world has the camera's axes. A
// wall of reflectance 0.5 ends the view at 4 m.
SceneDesc bare_scene() {
    SceneDesc desc;
    desc.camera.width = k_width;
    desc.camera.height = k_height;
    const double focal = 0.5 * k_width / std::tan(glm::radians(30.0));
    desc.camera.intrinsics = {focal, focal, 0.5 * k_width, 0.5 * k_height};
    GeometryDesc wall;
    wall.type = GeometryDesc::Type::plane;
    wall.point = {0, 0, 4};
    wall.normal = {0, 0, -1};
    desc.geometry = {wall};
    return desc;
}

WaterDesc henyey_greenstein() {
    WaterDesc water;
    water.absorption = PerBand{0.35, 0.08, 0.05};
    water.scattering = ScatteringDesc{{0.20, 0.22, 0.25}, {}};
    water.scattering->phase.function = HenyeyGreensteinDesc{0.9};
    return water;
}

WaterDesc kopelevich() {
    WaterDesc water;
    water.absorption = PerBand{0.30, 0.07, 0.03};
    water.small_ppm = 0.05;
    water.large_ppm = 0.6;
    return water;
}

// Strong, and several pixels wide at the wall.
ForwardScatterDesc forward_scatter(ForwardScatterDesc::Shape shape) {
    ForwardScatterDesc desc;
    desc.K = 1;
    desc.G = 0.02;
    desc.B = 0.1;
    desc.shape = shape;
    return desc;
}

LampDesc lamp(const std::string& name, const Point3& position, double intensity) {
    LampDesc desc;
    desc.name = name;
    desc.position = position;
    desc.intensity = PerBand{intensity, intensity, intensity};
    return desc;
}

GeometryDesc box(const Point3& min, const Point3& max) {
    GeometryDesc desc;
    desc.type = GeometryDesc::Type::box;
    desc.min = min;
    desc.max = max;
    return desc;
}

SceneDesc lamps_around_the_camera() {
    SceneDesc desc = bare_scene();
    desc.water = henyey_greenstein();
    desc.lamps = {lamp("beside", {0.5, -0.3, 0}, 20), lamp("far", {2.5, -1.5, 0.5}, 100),
                  lamp("behind", {0.4, -0.3, -1.5}, 50)};
    return desc;
}

SceneDesc through_a_port() {
    SceneDesc desc = bare_scene();
    desc.water = kopelevich();
    desc.camera.port = FlatPortDesc{};
    std::get<FlatPortDesc>(*desc.camera.port).normal = glm::normalize(Vector3(0.05, -0.03, 1));
    std::get<FlatPortDesc>(*desc.camera.port).distance = 0.02;
    std::get<FlatPortDesc>(*desc.camera.port).thickness = 0.04;
    desc.lamps = {lamp("beside", {1, -0.5, 0}, 50)};
    desc.water.forward_scatter = forward_scatter(ForwardScatterDesc::Shape::exponential);
    return desc;
}

SceneDesc shadow_and_spot() {
    SceneDesc desc = bare_scene();
    desc.water = henyey_greenstein();
    desc.geometry.push_back(box({0.1, -0.2, 1.0}, {0.4, 0.1, 1.3}));
    LampDesc spot = lamp("spot", {-1, -0.4, 0}, 80);
    spot.profile = SpotProfileDesc{70, 20};
    spot.direction = glm::normalize(Vector3(0.4, 0.1, 1));
    desc.lamps = {lamp("bare", {1, -0.5, 0}, 50), spot};
    desc.water.forward_scatter = forward_scatter(ForwardScatterDesc::Shape::gaussian);
    return desc;
}

// A Gaussian cloud of sigma 0.25 m, cut at four sigma, in voxels of 4 cm.
SceneDesc plume(const std::filesystem::path& file) {
    constexpr double k_sigma = 0.25, k_voxel = 0.04;
    constexpr int k_reach = 25;
    VdbOutputGrid grid;
    grid.name = "density";
    grid.size = {2 * k_reach + 1, 2 * k_reach + 1, 2 * k_reach + 1};
    grid.voxel_size = k_voxel;
    grid.origin = {-k_reach * k_voxel, -k_reach * k_voxel, 2.2 - k_reach * k_voxel};
    grid.value = [](int i, int j, int k) {
        const Vector3 d = k_voxel * (Vector3(i, j, k) - static_cast<double>(k_reach));
        return static_cast<float>(std::exp(-0.5 * glm::dot(d, d) / (k_sigma * k_sigma)));
    };
    write_vdb(file, {grid}, {{"creator", "uwvdb validate"}});
    SceneDesc desc = shadow_and_spot();
    desc.water = kopelevich();
    desc.water.forward_scatter = forward_scatter(ForwardScatterDesc::Shape::exponential);
    VolumeDesc volume;
    volume.file = file;
    volume.where = "plume";
    volume.centering = Centering::node;
    volume.up = UpAxis::y;
    GridMappingDesc mapping;
    mapping.grid = "density";
    mapping.small_ppm = 0.9;
    mapping.large_ppm = 3;
    mapping.where = "plume";
    volume.grids = {mapping};
    desc.volumes = {volume};
    // The reference integrates exact columns at every sample: fewer pixels.
    desc.camera.width /= 2;
    desc.camera.height /= 2;
    IntrinsicsDesc& k = desc.camera.intrinsics;
    k = {0.5 * k.fx, 0.5 * k.fy, 0.5 * k.cx, 0.5 * k.cy};
    return desc;
}

// All light includes what forward scatter stands for.
SceneDesc in_all_light(SceneDesc desc, int width, int height) {
    resize_image(desc.camera, width, height);
    desc.water.forward_scatter = {};
    desc.render.scattering = RenderDesc::Scattering::multiple;
    return desc;
}

}  // namespace

ValidationSuite::ValidationSuite() {
    scenes_ = {{"lamps around the camera", lamps_around_the_camera()},
               {"through a port", through_a_port()},
               {"shadow and spot", shadow_and_spot()},
               {"plume", plume(folder_.path() / "plume.vdb")}};
    // The fast form costs as much in any image that has fewer pixels than it has nodes by default.
    all_light_ = {{"shadow and spot", in_all_light(shadow_and_spot(), 40, 30)}};
    for (auto& [name, desc] : all_light_) desc.file = name;
    for (auto& [name, desc] : scenes_) desc.file = name;
}

bool run_validate(const ValidateArguments& a, bool colour, std::ostream& out,
                  const TransportWrapper& volume) {
    const ThreadLimit limit(a.threads);
    if (a.scene.empty() && !a.overrides.empty())
        throw UsageError("--set: the built-in suite has no scene file to change; name a scene");
    if (!a.report.empty()) const AtomicFile probe(a.report);
    const ValidationSuite suite;
    std::vector<std::pair<std::string, SceneDesc>> scenes = suite.scenes();
    std::vector<std::pair<std::string, SceneDesc>> all_light = suite.all_light();
    if (!a.scene.empty()) {
        scenes = {{a.scene.filename().string(), load_scene(a.scene, a.overrides)}};
        scenes[0].second.water.snow.reset();  // particles do not depend on the method
        all_light.clear();
        if (layer_plan(scenes[0].second, {}).is_provided(Layer::multiple)) all_light = scenes;
    }

    ValidationOptions options;
    options.tolerance = a.tolerance;
    options.volume = volume;
    options.proceed = [] { return !stop_requested(); };
    if (!a.quiet) options.say = [](const std::string& what) { print_message(what + "\n"); };
    std::vector<SceneValidation> results;
    std::vector<LightValidation> lights;
    bool passed = true;
    const auto tell = [&](bool this_passed, const std::string& table) {
        passed = passed && this_passed;
        if (!a.quiet || !this_passed) out << table;
        out.flush();
    };
    for (auto& [name, desc] : scenes) {
        results.push_back(validate_scene(std::move(desc), name, options));
        tell(results.back().passed(), validation_table(results.back(), colour));
    }
    const auto keep = [&](LightValidation light) {
        lights.push_back(std::move(light));
        tell(lights.back().passed(), light_table(lights.back(), colour));
    };
    if (a.scene.empty()) keep(validate_by_table(lamp_table(), options));
    for (auto& [name, desc] : all_light) keep(validate_all_light(std::move(desc), name, options));
    if (!a.report.empty()) {
        begin_orderly_stop();  // or a temporary file might stay
        const StopScope scope(stop_flag());
        write_validation_report(a.report, results, lights);
        if (!a.quiet) print_message(fmt::format("wrote {}\n", a.report.string()));
    }
    if (!a.quiet || !passed) out << (passed ? "validation passed\n" : "validation FAILED\n");
    if (!out.flush()) throw IoError("standard output: cannot write; is the disk full?");
    return passed;
}

Command validate_command() {
    const auto arguments = std::make_shared<ValidateArguments>();
    return {"validate", "compare every way of computing a scene with the others",
            k_validate_examples, validate_options(*arguments), [arguments] {
                install_stop_signal();
                const bool colour = isatty(STDOUT_FILENO) != 0;
                return run_validate(*arguments, colour, std::cout) ? k_exit_done
                                                                   : k_exit_validation;
            }};
}

}  // namespace uw
