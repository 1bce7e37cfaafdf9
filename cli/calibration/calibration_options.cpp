#include "cli/calibration/calibration_options.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

const char* const k_calibration_examples = R"(Examples:
  uwvdb calibration calibration.yaml                       what was understood of it
  uwvdb calibration camchain.yaml --camera cam1 --to scene  a scene's camera, to paste
  uwvdb calibration plume.yaml --to colmap -o cameras.txt   a scene's camera for COLMAP

Reads OpenCV and ROS YAML, Kalibr's camchain, Calibmar's calibration.yaml, COLMAP's cameras.txt
(stock and refractive) and scenes; the format is detected from the content. docs/calibration.md has
their models and conventions. Fields of view are through the image's principal point.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write.)";

namespace {

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

Options calibration_options(CalibrationArguments& a) {
    Options options;
    options.path("FILE", "", a.file, "a calibration, or a scene").required = true;
    options.text("--camera", "NAME", a.camera,
                 "which of several in the file: cam0, or COLMAP's number");
    Option& to = options.parsed(
        "--to", "FORMAT", [&a](const std::string& word) { a.format = format_called(word); },
        "write it as opencv, ros, kalibr, calibmar, colmap or scene; to standard output, or with "
        "-o to a file");
    to.value = Option::Value::word;
    for (const CalibrationFormat format : calibration_formats())
        to.words.emplace_back(word_of(format));
    options.path("-o,--output", "FILE", a.output, "the file to write").needs = "--to";
    options.flag("--json", a.json, "print what was understood as JSON");
    return options;
}

}  // namespace uw
