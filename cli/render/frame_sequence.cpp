#include "cli/render/frame_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "cli/image_choice.h"
#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/output_files.h"
#include "core/base/text.h"
#include "core/image/colour_view.h"
#include "core/image/image_formats.h"
#include "render/image_header.h"
#include "render/image_scene.h"

namespace uw {

namespace {

namespace fs = std::filesystem;

struct NamedFile {
    std::string name;  // for messages
    fs::path file;
};

std::vector<NamedFile> named(const OutputFiles& files) {
    std::vector<NamedFile> result;
    if (!files.image.empty()) result.push_back({"the image", files.image});
    if (!files.preview.empty()) result.push_back({"the preview", files.preview});
    if (!files.sensor.empty()) result.push_back({"the camera's image", files.sensor});
    if (!files.deep.empty()) result.push_back({"--deep", files.deep});
    if (!files.stats.empty()) result.push_back({"--stats", files.stats});
    if (!files.contact_sheet.empty()) result.push_back({"--contact-sheet", files.contact_sheet});
    if (!files.numbers.empty()) result.push_back({"--numbers", files.numbers});
    if (!files.ids.empty()) result.push_back({"the table of ids", files.ids});
    if (!files.manifest_csv.empty()) result.push_back({"the manifest", files.manifest_csv});
    if (!files.manifest_json.empty()) result.push_back({"the manifest", files.manifest_json});
    if (!files.irradiance_vdb.empty()) result.push_back({"--irradiance-vdb", files.irradiance_vdb});
    return result;
}

// One name per file, however it is written: without links, "." and "..".
fs::path identity(const fs::path& file) {
    std::error_code error;
    const fs::path found = fs::weakly_canonical(fs::absolute(file, error), error);
    return error ? file : found;
}

void refuse_other_ending(const char* option, const fs::path& file, const char* ending,
                         const char* format) {
    if (file.extension() != ending)
        throw UsageError(fmt::format("{} {}: it is written as {}; give a name that ends in {}",
                                     option, printable(file.string(), 300), format, ending));
}

// Whether a file of this name is the camera's image alone.
bool is_sensor_image(const fs::path& file) {
    const OutputFormat* const format = output_format(file);
    if (format == nullptr) return false;
    return format->library == OutputFormat::Library::libjpeg ||
           (format->library == OutputFormat::Library::libpng &&
            file.stem().extension() == k_sensor_ending);
}

// Requests that only an EXR can satisfy. `is_light`: the file contains the light's R, G and B.
void refuse_exr_options(const RenderArguments& a, const OutputFormat& format, bool is_light) {
    const auto refuse = [&](bool is_given, const char* option) {
        if (!is_given) return;
        const std::string what = is_light                    ? "R, G and B"
                                 : is_sensor_image(a.output) ? "the camera's image"
                                                             : fmt::format("a {}", format.name);
        throw UsageError(
            fmt::format("{}: is for the EXR, but -o {} is {} alone; give a name that ends in .exr",
                        option, printable(a.output.string(), 300), what));
    };
    refuse(!a.layers.empty(), "--layers");
    refuse(a.orders.has_value(), "--orders");
    refuse(!a.precision.empty() && format.holds != OutputFormat::Holds::either, "--precision");
    refuse(!a.compression.empty(), "--compression");
    refuse(a.is_aces, "--aces");
    refuse(a.deep.has_value(), "--deep");
    refuse(a.resume, "--resume");
}

// Requests that an ACES image container cannot satisfy.
void refuse_with_aces(const RenderArguments& a) {
    const auto refuse = [&](bool is_given, const char* option) {
        if (is_given)
            throw UsageError(
                fmt::format("{}: an ACES image container has R, G, B and A alone, as half floats "
                            "without compression; leave out --aces or {}",
                            option, option));
    };
    refuse(!a.layers.empty(), "--layers");
    refuse(a.orders.has_value(), "--orders");
    refuse(a.deep.has_value(), "--deep");
    refuse(!a.precision.empty(), "--precision");
    refuse(!a.compression.empty(), "--compression");
}

// Moves the name of what is to be written to the place of its kind: light, a picture of it, or the
// camera's image. Light and the image of its place have a preview.
void sort_by_format(const RenderArguments& a, OutputFiles& files) {
    const std::string name = printable(files.image.string(), 300);
    const OutputFormat* const format = output_format(files.image);
    if (format == nullptr)
        throw UsageError(
            fmt::format("-o {}: no format of images has this ending; give a name that ends in {}",
                        name, output_endings()));
    if (!a.precision.empty() && a.precision != "float" &&
        format->holds == OutputFormat::Holds::either)
        throw UsageError(fmt::format(
            "--precision {}: -o {} holds light in 32-bit floats or a picture of it in whole "
            "numbers; use float, or leave it out",
            a.precision, name));
    const bool is_light = format->holds == OutputFormat::Holds::light ||
                          (format->holds == OutputFormat::Holds::either && !a.precision.empty());
    if (format->library != OutputFormat::Library::openexr) refuse_exr_options(a, *format, is_light);
    if (a.is_aces) refuse_with_aces(a);
    if (!is_light && a.preview_bits.value_or(8) > format->max_bits)
        throw UsageError(
            fmt::format("--preview-bits {}: a {} has {} bits per channel; give a name that ends in "
                        ".png or .tif",
                        *a.preview_bits, format->name, format->max_bits));
    try {
        require_writer(*format);
    } catch (const UsageError& error) {
        throw UsageError(fmt::format("-o {}: {}", name, error.what()));
    }
    if (is_light) {
        files.preview = files.image;
        files.preview.replace_extension(".png");
        return;
    }
    fs::path& place = is_sensor_image(files.image) ? files.sensor : files.preview;
    place = std::exchange(files.image, {});
}

}  // namespace

bool is_exr(const fs::path& file) {
    const OutputFormat* const format = output_format(file);
    return format != nullptr && format->library == OutputFormat::Library::openexr;
}

fs::path sensor_image_beside(const fs::path& image, DevelopmentDesc::Format format) {
    const char* const ending = format == DevelopmentDesc::Format::jpeg ? ".jpg" : ".png";
    fs::path beside = image;
    return beside.replace_extension(std::string(k_sensor_ending) + ending);
}

fs::path deep_image_beside(const fs::path& image) {
    fs::path beside = image;
    return beside.replace_extension(".deep.exr");
}

OutputFiles output_files(const RenderArguments& a) {
    OutputFiles files;
    const char* const ending = a.frames.empty() ? ".exr" : ".####.exr";
    files.image = a.output.empty() ? a.scene.filename().replace_extension(ending) : a.output;
    sort_by_format(a, files);
    if (!a.contact_sheet.empty()) {
        refuse_other_ending("--contact-sheet", a.contact_sheet, ".png", "PNG");
        if (!files.preview.empty() && !has_ending_of_image(files.preview))
            throw UsageError(fmt::format(
                "--contact-sheet: it is made of the files written, and {} is not read; give -o a "
                "name that ends in .tif or .png",
                output_format(files.preview)->name));
        files.contact_sheet = a.contact_sheet;
    }
    files.stats = a.stats;
    if (!a.numbers.empty() && !a.prints_numbers()) {
        refuse_other_ending("--numbers", a.numbers, ".csv", "CSV");
        files.numbers = a.numbers;
    }
    if (!files.image.empty() && requests_ids(a.layers)) files.ids = id_table_beside(files.image);
    if (a.deep) files.deep = deep_image_beside(files.image);
    files.irradiance_vdb = a.irradiance_vdb;
    if (!a.irradiance_vdb.empty())
        refuse_other_ending("--irradiance-vdb", a.irradiance_vdb, ".vdb", "OpenVDB");
    return files;
}

void OutputCheck::take_inputs(const std::vector<InputFile>& inputs) {
    for (const auto& [file, what, is_hashed] : inputs) taken_.emplace(identity(file), what);
}

void OutputCheck::take_outputs(const OutputFiles& files) {
    for (const auto& [name, file] : named(files)) {
        const auto [other, is_new] = taken_.emplace(identity(file), name);
        if (!is_new)
            throw UsageError(fmt::format("{}: {} would replace {}; give another name",
                                         printable(file.string(), 300), name, other->second));
    }
    for (const auto& [name, file] : named(files)) {
        if (tidied_.insert(file.parent_path()).second)
            AtomicFile::remove_left_overs(file.parent_path());
        const AtomicFile probe(file);
    }
}

namespace {

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

// Names all files of a frame in this way but its statistics and the irradiance.
void name_images(OutputFiles& files, std::string_view place, const std::string& name,
                 const std::string& word) {
    for (fs::path* file : {&files.image, &files.preview, &files.sensor})
        if (!file->empty()) *file = of_one(*file, place, name, word);
    if (!files.ids.empty()) files.ids = id_table_beside(files.image);
    if (!files.deep.empty()) files.deep = deep_image_beside(files.image);
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

std::vector<JobImage> images_of(const std::vector<Frame>& frames) {
    std::vector<JobImage> images;
    images.reserve(frames.size());
    for (const Frame& frame : frames) images.push_back(frame.image());
    return images;
}

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
        if (!names.deep.empty()) files.deep = deep_image_beside(files.image);
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
            if (!is_alone) continue;
            if (files.sensor.stem().extension() == k_sensor_ending)
                refuse(
                    "the camera has no sensor to make it with; add camera.sensor to the scene, "
                    "or give a name that ends in .exr or .png");
            files.preview = std::exchange(files.sensor, {});  // a JPEG to look at
            continue;
        }
        const DevelopmentDesc::Format format = camera.sensor->image.format;
        const bool is_png = format == DevelopmentDesc::Format::png;
        if (!is_alone)
            files.sensor = sensor_image_beside(files.main(), format);
        else if ((output_format(files.sensor)->library == OutputFormat::Library::libpng) != is_png)
            refuse(is_png ? "the camera's image is a PNG; give a name that ends in .sensor.png, or "
                            "set camera.sensor.image.format to jpeg"
                          : "the camera's image is a JPEG; give a name that ends in .jpg, or leave "
                            "out camera.sensor.image.format");
    }
}

std::optional<fs::file_time_type> time_rendered(const Frame& frame) {
    const OutputFiles& files = frame.files;
    for (const fs::path* file : {&files.image, &files.preview})
        if (!is_file(*file)) return std::nullopt;
    for (const fs::path* file : {&files.irradiance_vdb, &files.ids, &files.sensor, &files.deep})
        if (!file->empty() && !is_file(*file)) return std::nullopt;
    std::error_code error;
    const fs::file_time_type time = fs::last_write_time(files.image, error);
    return error ? std::nullopt : std::optional(time);
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

void check_frames(const FrameSequence& sequence, JobScenes& scenes) {
    OutputCheck outputs;
    outputs.take_inputs(check_inputs({scenes, images_of(sequence.frames)}));
    if (const fs::path config = config_of_environment(); !config.empty())
        outputs.take_inputs({{config, "the OpenColorIO config of the environment"}});
    for (const Frame& frame : sequence.frames) outputs.take_outputs(frame.files);
    OutputFiles about_all;
    about_all.stats = sequence.stats;
    about_all.numbers = sequence.numbers;
    about_all.contact_sheet = sequence.contact_sheet;
    about_all.manifest_csv = sequence.manifest_csv;
    about_all.manifest_json = sequence.manifest_json;
    outputs.take_outputs(about_all);
}

}  // namespace uw
