#include "cli/render/frame_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <system_error>
#include <utility>

#include "cli/camera_choice.h"
#include "cli/frame_list.h"
#include "core/base/error.h"
#include "core/base/frame_pattern.h"
#include "core/base/text.h"
#include "render/id_table.h"
#include "render/scene_motion.h"

namespace uw {

namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& file) {
    std::error_code ignored;
    return fs::is_regular_file(file, ignored);
}

void require_place(const char* option, const fs::path& name) {
    if (name.empty() || differs_by_frame(name)) return;
    throw UsageError(
        fmt::format("{} {}: all frames would be written to one file; put a placeholder for the "
                    "frame number in the name, such as out.####{}",
                    option, printable(name.string(), 300), name.extension().string()));
}

fs::path expanded(const fs::path& name, int frame) {
    return name.empty() ? name : file_of_frame(name, frame);
}

constexpr std::string_view k_camera_place = "{camera}";
constexpr std::string_view k_variation_place = "{variation}";

bool has_place(const fs::path& file, std::string_view place) {
    return file.string().find(place) != std::string::npos;
}

// The file of one of several: `name` replaces the placeholder, or `word` goes before the ending.
fs::path of_one(const fs::path& file, std::string_view place, const std::string& name,
                const std::string& word) {
    std::string text = file.string();
    std::size_t at = text.find(place);
    if (at == std::string::npos) {
        fs::path with_name = file;
        std::string ending = file.extension().string();
        with_name.replace_extension();
        if (with_name.extension() == k_sensor_ending) {
            ending.insert(0, k_sensor_ending);
            with_name.replace_extension();
        }
        with_name += "." + word + ending;
        return with_name;
    }
    for (; at != std::string::npos; at = text.find(place, at + name.size()))
        text.replace(at, place.size(), name);
    return text;
}

// The same of all files of a frame but its statistics, and the irradiance.
void name_images(OutputFiles& files, std::string_view place, const std::string& name,
                 const std::string& word) {
    for (fs::path* file : {&files.image, &files.preview, &files.sensor})
        if (!file->empty()) *file = of_one(*file, place, name, word);
    if (!files.ids.empty()) files.ids = id_table_beside(files.image);
}

void refuse_place(const FrameSequence& sequence, std::string_view place, const char* why) {
    for (const Frame& frame : sequence.frames)
        if (has_place(frame.files.main(), place))
            throw UsageError(fmt::format("-o {}: {}; take {} out",
                                         printable(frame.files.main().string(), 300), why, place));
}

bool has_sequence(const SceneDesc& scene) {
    return std::ranges::any_of(scene.volumes, &VolumeDesc::is_sequence) ||
           std::ranges::any_of(scene.geometry, &GeometryDesc::is_sequence);
}

}  // namespace

std::string place_in_run(const Frame& frame) {
    std::string place;
    if (frame.variation) place += fmt::format("variation {}: ", *frame.variation);
    if (frame.number) place += fmt::format("frame {}: ", *frame.number);
    if (!frame.camera_name.empty()) place += fmt::format("camera {}: ", frame.camera_name);
    return place;
}

bool has_sensor(const SceneDesc& scene) {
    return scene.camera.sensor || std::ranges::any_of(scene.cameras, [](const auto& entry) {
               return entry.camera.sensor.has_value();
           });
}

std::vector<int> all_frames(const SceneDesc& scene) {
    const std::optional<FrameRange> range = frames_of(scene);
    if (!range)
        throw UsageError(
            "--frames all: nothing in the scene has a trajectory or is animated; list the frames, "
            "such as 0-47");
    return parse_frame_list(fmt::format("{}-{}", range->first, range->last));
}

FrameSequence frames_of(const RenderArguments& a) {
    const OutputFiles names = output_files(a);
    if (a.frames.empty()) {
        OutputFiles files = names;
        files.numbers.clear();
        files.contact_sheet.clear();
        return {{{std::nullopt, std::move(files), 0, "", {}, {}}},
                {},
                names.numbers,
                names.contact_sheet};
    }
    if (a.frames.size() > 1) {
        require_place("-o", names.main());
        require_place("--irradiance-vdb", names.irradiance_vdb);
    }
    FrameSequence sequence;
    sequence.numbers = names.numbers;
    sequence.contact_sheet = names.contact_sheet;
    const bool one_each = !names.stats.empty() && differs_by_frame(names.stats);
    if (!one_each) sequence.stats = names.stats;
    for (const int number : a.frames) {
        OutputFiles files;
        files.image = expanded(names.image, number);
        files.preview = expanded(names.preview, number);
        files.sensor = expanded(names.sensor, number);
        if (!names.ids.empty()) files.ids = id_table_beside(files.image);
        if (one_each) files.stats = expanded(names.stats, number);
        files.irradiance_vdb = expanded(names.irradiance_vdb, number);
        sequence.frames.push_back({number, std::move(files), 0, "", {}, {}});
    }
    return sequence;
}

void set_variation(FrameSequence& sequence, int variation) {
    const std::string name = fmt::format("{:04}", variation);
    for (Frame& frame : sequence.frames) {
        frame.variation = variation;
        OutputFiles& files = frame.files;
        name_images(files, k_variation_place, name, "v" + name);
        if (!files.irradiance_vdb.empty())
            files.irradiance_vdb =
                of_one(files.irradiance_vdb, k_variation_place, name, "v" + name);
        if (frame.number || has_place(files.stats, k_variation_place)) {
            if (!files.stats.empty())
                files.stats = of_one(files.stats, k_variation_place, name, "v" + name);
        } else if (!files.stats.empty()) {
            sequence.stats = std::exchange(files.stats, {});  // one file about all of them
        }
    }
}

void add_cameras(FrameSequence& sequence, const SceneDesc& scene, const std::string& only) {
    if (!only.empty()) camera_called(only, scene.cameras);
    refuse_place(sequence, k_variation_place, "the scene itself is rendered, not its --variations");
    if (scene.cameras.empty()) {
        refuse_place(sequence, k_camera_place, "the scene has one camera, which has no name");
        return;
    }
    std::vector<Frame> frames;
    for (const Frame& frame : sequence.frames) {
        bool is_first = true;
        for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
            const std::string& name = scene.cameras[i].name;
            if (!only.empty() && name != only) continue;
            Frame of_camera = frame;
            OutputFiles& files = of_camera.files;
            name_images(files, k_camera_place, name, name);
            if ((frame.number || frame.variation) && !files.stats.empty())
                files.stats = of_one(files.stats, k_camera_place, name, name);
            if (!is_first) files.irradiance_vdb.clear();
            is_first = false;
            of_camera.camera = i;
            of_camera.camera_name = name;
            frames.push_back(std::move(of_camera));
        }
    }
    sequence.frames = std::move(frames);
    const Frame& first = sequence.frames.front();
    if (sequence.frames.size() == 1 || first.number || first.variation) return;
    // The statistics of all cameras go to one file.
    sequence.stats = first.files.stats;
    for (Frame& frame : sequence.frames) frame.files.stats.clear();
}

void add_sensor_images(FrameSequence& sequence, const SceneDesc& scene) {
    for (Frame& frame : sequence.frames) {
        const CameraDesc& camera =
            scene.cameras.empty() ? scene.camera : scene.cameras[frame.camera].camera;
        OutputFiles& files = frame.files;
        const bool is_alone = !files.sensor.empty();
        const auto refuse = [&](const char* what) {
            throw UsageError(fmt::format("-o {}: {}", printable(files.sensor.string(), 300), what));
        };
        if (!camera.sensor) {
            if (is_alone)
                refuse(
                    "the camera has no sensor to make it with; add camera.sensor to the scene, "
                    "or give a name that ends in .exr or .png");
            continue;
        }
        const DevelopmentDesc::Format format = camera.sensor->image.format;
        const bool is_png = format == DevelopmentDesc::Format::png;
        if (!is_alone)
            files.sensor = sensor_image_beside(files.main(), format);
        else if ((files.sensor.extension() == ".png") != is_png)
            refuse(is_png ? "the camera's image is a PNG; give a name that ends in .sensor.png, or "
                            "set camera.sensor.image.format to jpeg"
                          : "the camera's image is a JPEG; give a name that ends in .jpg, or leave "
                            "out camera.sensor.image.format");
    }
}

bool is_rendered(const Frame& frame, const std::vector<InputFile>& inputs,
                 const std::function<bool(const fs::path&)>& is_image_of) {
    const OutputFiles& files = frame.files;
    if (!is_file(files.image) || !is_file(files.preview)) return false;
    if (!files.irradiance_vdb.empty() && !is_file(files.irradiance_vdb)) return false;
    if (!files.ids.empty() && !is_file(files.ids)) return false;
    if (!files.sensor.empty() && !is_file(files.sensor)) return false;
    std::error_code error;
    const auto rendered = fs::last_write_time(files.image, error);
    if (error) return false;
    const auto is_newer = [&](const InputFile& input) {
        if (input.is_hashed) return false;
        const auto written = fs::last_write_time(input.file, error);
        return !error && written > rendered;
    };
    if (std::ranges::any_of(inputs, is_newer)) return false;
    return is_image_of(files.image);
}

std::optional<std::string> frame_warning(const RenderArguments& a, const SceneDesc& scene) {
    if (!a.frames.empty() && has_sensor(scene)) return std::nullopt;  // noise of its own
    if (a.frames.size() > 1 && !has_sequence(scene) && !has_motion(scene))
        return "--frames: all frames are alike, because nothing in the scene moves and no file has "
               "a placeholder for the frame number, such as file: smoke_####.vdb";
    if (!a.frames.empty()) return std::nullopt;
    for (const fs::path* name : {&a.output, &a.stats, &a.irradiance_vdb})
        if (!name->empty() && !is_file(*name) && differs_by_frame(*name))
            return fmt::format("{}: used as written; give --frames to render a sequence",
                               printable(name->string(), 300));
    return std::nullopt;
}

}  // namespace uw
