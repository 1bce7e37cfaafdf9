#include "cli/calibration/calibration_command.h"

#include <fmt/format.h>

#include <fstream>
#include <iostream>
#include <memory>
#include <ostream>

#include "cli/calibration/calibration_json.h"
#include "cli/calibration/calibration_report.h"
#include "cli/console.h"
#include "cli/text_files.h"
#include "core/base/error.h"
#include "render/scene_loading.h"

namespace uw {
namespace {

/// Whether a file declares itself a scene: some line begins with "uwvdb:". A file that cannot be
/// read is left to the reader.
bool is_scene(const std::filesystem::path& file) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return false;
    constexpr std::streamsize k_look = 1 << 16;
    std::string text(k_look, '\0');
    std::ifstream stream(file, std::ios::binary);
    stream.read(text.data(), k_look);
    text.resize(static_cast<std::size_t>(stream.gcount()));
    return text.starts_with("uwvdb:") || text.find("\nuwvdb:") != std::string::npos;
}

Calibration read_subject(const CalibrationArguments& a) {
    if (!is_scene(a.file)) return read_calibration(a.file, a.camera);
    if (!a.camera.empty()) throw UsageError("--camera: a scene has one camera; leave --camera out");
    const SceneDesc scene = load_scene(a.file, {});
    Calibration result;
    result.format = CalibrationFormat::scene;
    result.model = scene.camera.distortion.model == DistortionDesc::Model::fisheye
                       ? "fisheye"
                       : "brown-conrady";
    result.desc = scene.camera;
    return result;
}

/// "cameras.txt" to "cameras-plain.txt".
std::filesystem::path plain_name(const std::filesystem::path& path) {
    std::filesystem::path name = path;
    return name.replace_filename(path.stem().string() + "-plain" + path.extension().string());
}

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code error;
    return std::filesystem::equivalent(a, b, error);
}

}  // namespace

void run_calibration(const CalibrationArguments& a, std::ostream& out) {
    if (a.json && a.format && a.output.empty())
        throw UsageError(
            "--json: --to already writes to standard output; give -o for the file, or leave one of "
            "them out");
    const Calibration calibration = read_subject(a);
    for (const std::string& warning : calibration.warnings)
        print_message(fmt::format("warning: {}\n", warning));
    if (a.format) {
        const std::string obstacle = calibration_obstacle(*a.format, calibration.desc);
        if (!obstacle.empty())
            throw UsageError(fmt::format("--to {}: {}", word_of(*a.format), obstacle));
        for (const std::string& line : calibration_omissions(*a.format, calibration.desc))
            print_message(fmt::format("warning: {}: {}\n", word_of(*a.format), line));
        const std::string text = write_calibration(*a.format, calibration.desc);
        if (a.output.empty()) {
            out << text << std::flush;
            if (!out) throw IoError("standard output: cannot write; is the disk full?");
            return;
        }
        const bool plain = *a.format == CalibrationFormat::colmap && calibration.desc.port;
        for (const auto& path : {a.output, plain ? plain_name(a.output) : a.output})
            if (same_file(path, a.file))
                throw UsageError(
                    fmt::format("{}: would replace the calibration being read; give another name",
                                path.string()));
        write_text(a.output, text);
        if (plain) {
            CameraDesc bare = calibration.desc;
            bare.port.reset();
            write_text(plain_name(a.output), write_calibration(*a.format, bare));
        }
    }
    const CalibrationReport report = report_on(a.file, calibration);
    out << (a.json ? calibration_json(report) : calibration_text(report)) << std::flush;
    if (!out) throw IoError("standard output: cannot write; is the disk full?");
}

Command calibration_command() {
    const auto arguments = std::make_shared<CalibrationArguments>();
    return {"calibration", "show what a camera calibration says, and convert it",
            k_calibration_examples, calibration_options(*arguments), [arguments] {
                run_calibration(*arguments, std::cout);
                return k_exit_done;
            }};
}

}  // namespace uw
