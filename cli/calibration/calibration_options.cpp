#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include "cli/command_options.h"
#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {
namespace {

constexpr const char* k_calibration_examples = R"(Examples:
  uwvdb calibration calibration.yaml                       what was understood of it
  uwvdb calibration camchain.yaml --camera cam1 --to scene  a scene's camera, to paste
  uwvdb calibration plume.yaml --to colmap -o cameras.txt   a scene's camera for COLMAP

Reads OpenCV and ROS YAML, Kalibr's camchain, Calibmar's calibration.yaml, COLMAP's cameras.txt
(stock and refractive) and scenes; which one is found out from the content. docs/calibration.md has
their models and conventions. Fields of view are through the image's principal point.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write.)";

struct Parsed {
    CalibrationArguments arguments;
    std::string format;
};

CalibrationFormat format_called(const std::string& word) {
    std::vector<std::string_view> words;
    for (const CalibrationFormat format : calibration_formats()) {
        words.push_back(word_of(format));
        if (words.back() == word) return format;
    }
    throw UsageError(
        fmt::format("--to {}: unknown format; {}", printable(word), suggestion(word, words)));
}

}  // namespace

Command add_calibration_command(CLI::App& app) {
    CLI::App& calibration =
        *app.add_subcommand("calibration", "what a camera calibration says; converts it");
    const auto p = std::make_shared<Parsed>();
    calibration.add_option("FILE", p->arguments.file, "a calibration, or a scene")->required();
    calibration.add_option("--camera", p->arguments.camera,
                           "which of several in the file: cam0, or COLMAP's number");
    calibration
        .add_option("--to", p->format,
                    "write it as opencv, ros, kalibr, calibmar, colmap or scene; to standard "
                    "output, or with -o to a file")
        ->type_name("FORMAT");
    calibration.add_option("-o,--output", p->arguments.output, "the file to write")->needs("--to");
    calibration.add_flag("--json", p->arguments.json, "print what was understood as JSON");
    calibration.footer(k_calibration_examples);
    return {&calibration, [p, &calibration]() -> Arguments {
                CalibrationArguments a = p->arguments;
                if (calibration.count("--to") > 0) a.format = format_called(p->format);
                if (a.json && a.format && a.output.empty())
                    throw UsageError(
                        "--json: --to takes standard output; give -o for the file, or leave one "
                        "of them out");
                return a;
            }};
}

}  // namespace uw
