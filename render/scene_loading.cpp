#include "render/scene_loading.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "camera/calibration.h"
#include "camera/camera.h"
#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/text.h"
#include "core/geometry/gltf_reader.h"
#include "core/geometry/mesh_reader.h"
#include "core/image/colour_view.h"
#include "core/light/integrator_table.h"
#include "core/scene/key_path.h"
#include "core/scene/pose_file.h"
#include "core/scene/scene_desc.h"
#include "core/scene/variations.h"
#include "core/scene/yaml_document.h"
#include "media/volumes/fluid_domain.h"
#include "render/image_scene.h"

namespace uw {

namespace {

void add_to_hash(const std::string& hash, SceneDesc& scene) {
    ConfigNode both;
    both.kind = ConfigNode::Kind::scalar;
    both.quoted = true;
    both.scalar = scene.hash + hash;
    scene.hash = config_hash(both);
}

// Reads the calibration file that `camera` names, if any, into it.
void calibrate(CameraDesc& camera, SceneDesc& scene) {
    const auto calibration = apply_calibration(camera);
    if (!calibration) return;
    scene.warnings.insert(scene.warnings.end(), calibration->warnings.begin(),
                          calibration->warnings.end());
    add_to_hash(calibration->hash, scene);
}

// Finds the times at which the nodes of a glTF file move, and warns if these are at other frames
// than the scene's.
void look_for_animation(GeometryDesc& geometry, SceneDesc& scene) {
    const auto keys = gltf_keys(geometry.file);
    if (!keys) return;
    geometry.animation = keys->range;
    const double fps = scene.render.fps;
    const bool is_by_fps = scene.render.times == RenderDesc::Times::fps;
    if (!is_by_fps || are_whole_frames(keys->times, fps)) return;
    if (const auto rate = frame_rate_of(keys->times))
        scene.warnings.push_back(fmt::format(
            "{}.file: {}: its keys are those of frames at {:.5g} per second, but render.fps is "
            "{:.5g}, so that frame n is not the file's frame n; give render.fps: {:.5g}",
            geometry.where, printable(geometry.file.string(), 300), *rate, fps, *rate));
}

// Makes the trajectories, reading their files, and looks for animations.
void set_in_motion(SceneDesc& scene) {
    const auto load = [&](std::optional<TrajectoryDesc>& desc) {
        if (!desc) return;
        std::string doubt;
        const std::string hash = load_trajectory(*desc, scene.render.fps, doubt);
        if (!hash.empty()) add_to_hash(hash, scene);
        // If frames are poses, frame n is right, whatever the unit of time.
        if (!doubt.empty() && scene.render.times == RenderDesc::Times::fps)
            scene.warnings.push_back(fmt::format("{}.file: '{}': {}", desc->where,
                                                 printable(desc->file.string(), 300), doubt));
    };
    load(scene.camera.trajectory);
    load(scene.rig_trajectory);
    for (LampDesc& lamp : scene.lamps) load(lamp.trajectory);
    for (GeometryDesc& geometry : scene.geometry) {
        load(geometry.trajectory);
        const std::string extension = geometry.file.extension().string();
        if (!geometry.is_sequence && (extension == ".gltf" || extension == ".glb"))
            look_for_animation(geometry, scene);
    }
}

// Warns of caches whose frame rate is not that of the scene, as everything else would move at
// another speed.
void compare_frame_rates(SceneDesc& scene) {
    if (!has_motion(scene) || scene.render.times != RenderDesc::Times::fps) return;
    for (const VolumeDesc& volume : scene.volumes) {
        if (!volume.is_sequence) continue;
        const std::vector<int> frames = frames_found(volume.file);
        if (frames.empty()) continue;
        const auto rate = fluid_frame_rate(file_of_frame(volume.file, frames.front()));
        if (rate && *rate != scene.render.fps)
            scene.warnings.push_back(fmt::format(
                "{}: '{}' was baked at {:.4g} frames a second (with Time Scale 1), but what moves "
                "beside it has render.fps: {:g}; set that to {:.4g}",
                volume.where, volume.file.string(), *rate, scene.render.fps, *rate));
    }
}

SceneDesc complete(SceneDesc scene) {
    set_in_motion(scene);
    compare_frame_rates(scene);
    if (scene.cameras.empty()) {
        calibrate(scene.camera, scene);
        return scene;
    }
    for (RigCameraDesc& entry : scene.cameras) calibrate(entry.camera, scene);
    scene.camera = scene.cameras.front().camera;
    return scene;
}

}  // namespace

SceneDesc load_scene_tree(const ConfigNode& tree, const std::filesystem::path& file,
                          const SceneArrays* arrays) {
    return complete(scene_of_tree(tree, file, arrays));
}

SceneDesc load_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    const ConfigNode tree = read_scene_tree(file, overrides);
    read_variations(tree, file);
    return load_scene_tree(tree, file);
}

SceneDesc load_scene_text(std::string_view text, const std::filesystem::path& file) {
    const ConfigNode tree = scene_tree(text, file);
    read_variations(tree, file);
    return load_scene_tree(tree, file);
}

namespace {

constexpr std::size_t k_longest_value = 80;    // maximum length of a value in messages
constexpr std::size_t k_longest_values = 300;  // maximum length of all values in messages

/// Returns the origin of a drawn value, for messages about faults in it.
std::string origin_of(const DrawnValue& value, int variation) {
    return fmt::format("{}: variation {}: {}", value.where, variation,
                       printable(value.override_text(), k_longest_value));
}

void refuse_overrides_of_drawn(const ConfigNode& tree, const VariationsDesc& desc,
                               const std::vector<std::string>& overrides) {
    for (const std::string& text : overrides)
        for (const std::string& key : drawn_keys(desc))
            if (is_part_of(tree, text.substr(0, end_of_path(text)), key))
                throw UsageError(fmt::format(
                    "--set {}: the variations draw {}, so this would have no effect; leave it out, "
                    "or take the key out of variations",
                    printable(text, k_longest_value), printable(key)));
}

}  // namespace

SceneVariations::SceneVariations(const std::filesystem::path& file,
                                 const std::vector<std::string>& overrides)
    : file_(file), tree_(read_scene_tree(file, overrides)), desc_(read_variations(tree_, file)) {
    if (desc_) refuse_overrides_of_drawn(tree_, *desc_, overrides);
}

SceneVariations::SceneVariations(ConfigNode tree, std::filesystem::path file)
    : file_(std::move(file)), tree_(std::move(tree)), desc_(read_variations(tree_, file_)) {}

VariedScene SceneVariations::varied(int variation, const SceneArrays* arrays) const {
    ConfigNode tree = tree_;
    const std::vector<DrawnValue> drawn = values(variation);
    try {
        for (const DrawnValue& value : drawn) {
            const std::string place = origin_of(value, variation);
            set_value(tree, value.key, parse_yaml_value(value.text, place), place);
        }
        SceneDesc desc = load_scene_tree(tree, file_, arrays);
        return {std::move(tree), std::move(desc)};
    } catch (const InputError& fault) {
        // The message of a fault in one of the values already names it.
        const std::string_view what = fault.what();
        for (const DrawnValue& value : drawn)
            if (what.starts_with(origin_of(value, variation))) throw;
        throw InputError(fmt::format("{} (variation {}: {})", what, variation,
                                     printable(values_text(drawn), k_longest_values)));
    } catch (const IoError& fault) {
        throw IoError(fmt::format("{} (variation {}: {})", fault.what(), variation,
                                  printable(values_text(drawn), k_longest_values)));
    }
}

namespace {

RenderDesc::Integrator integrator_named(const std::string& name) {
    for (const auto& [known, integrator] : k_integrator_names)
        if (name == known) return integrator;
    throw UsageError(fmt::format("--integrator: unknown '{}'; use {}", printable(name),
                                 alternatives(words_of(k_integrator_names))));
}

RenderDesc::Quality quality_named(const std::string& name) {
    for (const auto& [known, quality] : k_quality_names)
        if (name == known) return quality;
    throw UsageError(
        fmt::format("--quality: unknown '{}'; use draft, final or exact", printable(name)));
}

}  // namespace

void apply_request(const ImageRequest& request, SceneDesc& scene) {
    RenderDesc& render = scene.render;
    if (!request.quality.empty()) render.quality = quality_named(request.quality);
    if (!request.integrator.empty()) render.integrator = integrator_named(request.integrator);
    const IntegratorKind& kind = integrator_kind(render.integrator);
    if (render.quality == RenderDesc::Quality::draft) render.samples = kind.draft_samples;
    if (request.samples && request.error)
        throw UsageError("--samples and --error: each says how long to go on; give one of them");
    if (request.samples) render.samples = *request.samples;
    const int most = kind.traces_paths ? k_max_paths : k_max_samples;
    if (samples_of(render) > most)
        throw UsageError(fmt::format(
            "{}: expected 1 to {}, found {}; only integrator path takes more",
            request.samples ? "--samples" : "render.samples", most, samples_of(render)));
    if (request.size) resize_images(scene, (*request.size)[0], (*request.size)[1]);
}

namespace {

namespace fs = std::filesystem;

const std::vector<fs::path>& known_side_files(SideFiles& known, const fs::path& file,
                                              const auto& find) {
    const auto [found, is_new] = known.try_emplace(file);
    if (is_new) found->second = find();
    return found->second;
}

}  // namespace

std::vector<InputFile> input_files(const SceneDesc& whole, const ImageChoice& choice,
                                   SideFiles& known) {
    check_moment(whole, choice);
    const auto of_frame = [&](const auto& input) {
        return choice.frame && input.is_sequence ? file_of_frame(input.file, *choice.frame)
                                                 : input.file;
    };
    std::vector<InputFile> files{{whole.file, "the scene", true}};
    for (const NamedFile& named : whole.files)
        files.push_back({of_frame(named), named.key->what, named.key->is_hashed});
    const auto add_all = [&](const std::vector<fs::path>& side_files, const char* what) {
        for (const fs::path& file : side_files) files.push_back({file, what});
    };
    for (const VolumeDesc& volume : whole.volumes) {
        if (volume.file.empty()) continue;
        const fs::path file = of_frame(volume);
        add_all(known_side_files(known, file, [&] { return files_named_by_volume(file); }),
                "the configuration of a fluid in the scene");
    }
    for (const GeometryDesc& geometry : whole.geometry) {
        if (geometry.type != GeometryDesc::Type::file || geometry.file.empty()) continue;
        const fs::path mesh = of_frame(geometry);
        add_all(known_side_files(known, mesh, [&] { return files_named_by_mesh(mesh); }),
                "a texture, buffer or material library of a mesh");
    }
    if (const std::optional<ViewDesc>& view = whole.render.view; view && !view->config.empty())
        add_all(known_side_files(known, view->config, [&] { return files_named_by_view(*view); }),
                "the OpenColorIO view of the scene");
    return files;
}

}  // namespace uw
