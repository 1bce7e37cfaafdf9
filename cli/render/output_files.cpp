#include "cli/render/output_files.h"

#include <fmt/format.h>

#include <system_error>
#include <vector>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/files/atomic_file.h"
#include "render/id_table.h"

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
    const fs::path ending = file.extension();
    return ending == ".jpg" || ending == ".jpeg" ||
           (ending == ".png" && file.stem().extension() == k_sensor_ending);
}

// What only an EXR can hold, or tell.
void refuse_exr_options(const RenderArguments& a) {
    const auto refuse = [&](bool is_given, const char* option) {
        if (is_given)
            throw UsageError(
                fmt::format("{}: is for the EXR, but -o {} is {} alone; give a name that ends "
                            "in .exr",
                            option, printable(a.output.string(), 300),
                            is_sensor_image(a.output) ? "the camera's image" : "a PNG"));
    };
    refuse(!a.layers.empty(), "--layers");
    refuse(a.orders.has_value(), "--orders");
    refuse(!a.precision.empty(), "--precision");
    refuse(!a.compression.empty(), "--compression");
    refuse(a.resume, "--resume");
}

}  // namespace

fs::path sensor_image_beside(const fs::path& image, DevelopmentDesc::Format format) {
    const char* const ending = format == DevelopmentDesc::Format::jpeg ? ".jpg" : ".png";
    fs::path beside = image;
    return beside.replace_extension(std::string(k_sensor_ending) + ending);
}

OutputFiles output_files(const RenderArguments& a) {
    OutputFiles files;
    const char* const ending = a.frames.empty() ? ".exr" : ".####.exr";
    files.image = a.output.empty() ? a.scene.filename().replace_extension(ending) : a.output;
    files.preview = files.image;
    files.preview.replace_extension(".png");
    if (is_sensor_image(files.image)) {
        refuse_exr_options(a);
        files.sensor = files.image;
        files.image.clear();
        files.preview.clear();
    } else if (files.image.extension() == ".png") {
        refuse_exr_options(a);
        files.image.clear();
    } else if (files.image.extension() != ".exr") {
        throw UsageError(
            fmt::format("-o {}: it is written as OpenEXR or PNG, a camera's image as PNG or JPEG; "
                        "give a name that ends in .exr or .png, or in .sensor.png or .jpg",
                        printable(files.image.string(), 300)));
    }
    if (!a.contact_sheet.empty()) {
        refuse_other_ending("--contact-sheet", a.contact_sheet, ".png", "PNG");
        files.contact_sheet = a.contact_sheet;
    }
    files.stats = a.stats;
    if (!a.numbers.empty() && !a.prints_numbers()) {
        refuse_other_ending("--numbers", a.numbers, ".csv", "CSV");
        files.numbers = a.numbers;
    }
    if (!files.image.empty() && requests_ids(a.layers)) files.ids = id_table_beside(files.image);
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

}  // namespace uw
