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
#include "media/volumes/volume_sequence.h"
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

// Lists the frames that lack a file of a sequence in the scene.
class MissingFrames {
  public:
    void look(const SourceLocation& where, const fs::path& name, const FrameSequence& sequence) {
        std::vector<int> missing;
        for (const Frame& frame : sequence.frames)
            if (frame.camera == sequence.frames.front().camera &&
                !is_file(file_of_frame(name, *frame.number)))
                missing.push_back(*frame.number);
        if (missing.empty()) return;
        text_ += fmt::format("{}{}.file: '{}' has no file for {} {}", text_.empty() ? "" : "; ",
                             where, printable(name.string(), 300),
                             missing.size() == 1 ? "frame" : "frames", format_frame_list(missing));
    }
    void refuse() const {
        if (!text_.empty())
            throw IoError(text_ + "; choose --frames that exist, or add the missing files");
    }

  private:
    std::string text_;
};

void check_volumes(const FrameSequence& sequence, const SceneDesc& scene) {
    for (std::size_t v = 0; v < scene.volumes.size(); ++v) {
        if (!scene.volumes[v].is_sequence) continue;
        VolumeSequenceCheck check;
        for (const Frame& frame : sequence.frames)
            if (frame.camera == sequence.frames.front().camera)
                check.take(scene_of_image(scene, frame.choice()).volumes[v]);
    }
}

constexpr std::string_view k_camera_place = "{camera}";

// The file of one camera: its name replaces the placeholder, or goes before the ending.
fs::path of_camera(const fs::path& file, const std::string& camera) {
    std::string name = file.string();
    std::size_t at = name.find(k_camera_place);
    if (at == std::string::npos) {
        fs::path with_name = file;
        std::string ending = file.extension().string();
        with_name.replace_extension();
        if (with_name.extension() == k_sensor_ending) {
            ending.insert(0, k_sensor_ending);
            with_name.replace_extension();
        }
        with_name += "." + camera + ending;
        return with_name;
    }
    for (; at != std::string::npos; at = name.find(k_camera_place, at + camera.size()))
        name.replace(at, k_camera_place.size(), camera);
    return name;
}

void refuse_camera_places(const FrameSequence& sequence) {
    for (const Frame& frame : sequence.frames)
        if (frame.files.main().string().find(k_camera_place) != std::string::npos)
            throw UsageError(
                fmt::format("-o {}: the scene has one camera, which has no name; take {} out",
                            printable(frame.files.main().string(), 300), k_camera_place));
}

bool has_sensor(const SceneDesc& scene) {
    return scene.camera.sensor || std::ranges::any_of(scene.cameras, [](const auto& entry) {
               return entry.camera.sensor.has_value();
           });
}

bool has_sequence(const SceneDesc& scene) {
    return std::ranges::any_of(scene.volumes, &VolumeDesc::is_sequence) ||
           std::ranges::any_of(scene.geometry, &GeometryDesc::is_sequence);
}

}  // namespace

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
        return {{{std::nullopt, std::move(files), 0, ""}}, {}, names.numbers, names.contact_sheet};
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
        sequence.frames.push_back({number, std::move(files), 0, ""});
    }
    return sequence;
}

void add_cameras(FrameSequence& sequence, const SceneDesc& scene, const std::string& only) {
    if (!only.empty()) camera_called(only, scene.cameras);
    if (scene.cameras.empty()) {
        refuse_camera_places(sequence);
        return;
    }
    std::vector<Frame> frames;
    for (const Frame& frame : sequence.frames) {
        bool is_first = true;
        for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
            const std::string& name = scene.cameras[i].name;
            if (!only.empty() && name != only) continue;
            OutputFiles files = frame.files;
            if (!files.image.empty()) files.image = of_camera(files.image, name);
            if (!files.preview.empty()) files.preview = of_camera(files.preview, name);
            if (!files.sensor.empty()) files.sensor = of_camera(files.sensor, name);
            if (!files.ids.empty()) files.ids = id_table_beside(files.image);
            if (frame.number && !files.stats.empty()) files.stats = of_camera(files.stats, name);
            if (!is_first) files.irradiance_vdb.clear();
            is_first = false;
            frames.push_back({frame.number, std::move(files), i, name});
        }
    }
    sequence.frames = std::move(frames);
    if (sequence.frames.size() == 1 || sequence.frames.front().number) return;
    // Without --frames the statistics of all cameras go to one file.
    sequence.stats = sequence.frames.front().files.stats;
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

void check_frames(const FrameSequence& sequence, const SceneDesc& scene) {
    const bool numbered = !sequence.frames.empty() && sequence.frames.front().number;
    if (numbered) {
        MissingFrames missing;
        for (const VolumeDesc& volume : scene.volumes) {
            if (volume.is_sequence) missing.look(volume.where, volume.file, sequence);
            if (volume.motion && volume.motion->is_sequence && volume.motion->file != volume.file)
                missing.look(volume.motion->where, volume.motion->file, sequence);
        }
        for (const GeometryDesc& mesh : scene.geometry)
            if (mesh.is_sequence) missing.look(mesh.where, mesh.file, sequence);
        missing.refuse();
        check_volumes(sequence, scene);
    }
    OutputCheck outputs;
    MeshSideFiles known;
    for (const Frame& frame : sequence.frames)
        outputs.take_inputs(input_files(scene_of_image(scene, frame.choice()), known));
    for (const Frame& frame : sequence.frames) outputs.take_outputs(frame.files);
    OutputFiles about_all;
    about_all.stats = sequence.stats;
    about_all.numbers = sequence.numbers;
    about_all.contact_sheet = sequence.contact_sheet;
    outputs.take_outputs(about_all);
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
