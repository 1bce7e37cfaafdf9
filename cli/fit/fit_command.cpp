#include "cli/fit/fit_command.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "cli/console.h"
#include "cli/fit/fit_report.h"
#include "cli/process.h"
#include "core/base/csv_table.h"
#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "core/scene/key_path.h"
#include "edit/document/scene_text.h"
#include "fit/board_corners.h"
#include "fit/picture_poses.h"
#include "fit/picture_residuals.h"
#include "fit/point_residuals.h"
#include "fit/robust_fit.h"
#include "fit/target_sheet.h"
#include "fit/unknowns.h"

namespace uw {

namespace {

const char* const k_fit_examples = R"(Examples:
  uwvdb fit rig.yaml --points corners.csv --unknown camera.port.distance,camera.port.normal
  uwvdb fit rig.yaml --points corners.csv --unknown camera.port.thickness \
        --prior camera.port.thickness=0.01+-0.0005 -o fitted.yaml --report fit.html
  uwvdb fit rig.yaml --images 'boards/%03d.png' --board 9x6x0.03 --corners corners.csv \
        --unknown camera.port.distance,camera.port.normal
  uwvdb fit dive.yaml --images 'dive/%04d.png' -o fitted.yaml \
        --unknown water.absorption,water.scattering.b,lamps.*.intensity
  uwvdb fit --target board.pdf --paper a3

Finds numbers of a scene, each with its standard error, by robust least squares, and says what the
observations cannot tell. CORNERS.csv has the columns image, x, y, z, u, v and perhaps medium: the
points of boards or other rigid things [m], in axes that all points of an image share, and where
the image shows them [pixels; the image's upper left corner is (0, 0), the first pixel's centre
(0.5, 0.5), u to the right, v down], in water, in air beyond the same port, or bare, without a port. Poses are found with the rest. With --board OpenCV finds the corners of a
checkerboard in photographs. Without, pictures are held against the images of the
scene, frame by frame, cell by cell: raw numbers if its camera has a sensor, else light (OpenEXR) or
what sRGB makes of it (PNG, JPEG). --target writes a sheet with a board to print, and needs no scene;
--found-poses of pictures of that board are the --poses by which its surface (--target board.obj) is
held against the same pictures.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write,
130 interrupted.)";

/// "camera.port.thickness=0.01+-0.0005" or "water.absorption=0.01..2".
struct Assumption {
    std::string key;
    double first = 0, second = 0;
};

Assumption read_assumption(const std::string& option, const std::string& text,
                           const std::string& between, const char* form) {
    const std::size_t equals = end_of_path(text);
    const std::size_t middle = text.find(between, equals == std::string::npos ? 0 : equals);
    Assumption read;
    if (equals == std::string::npos || middle == std::string::npos ||
        parse_number(text.substr(equals + 1, middle - equals - 1), read.first) !=
            NumberText::number ||
        parse_number(text.substr(middle + between.size()), read.second) != NumberText::number)
        throw UsageError(fmt::format("{} {}: give {}", option, printable(text), form));
    read.key = text.substr(0, equals);
    return read;
}

struct FitArguments {
    std::filesystem::path scene, points, images, poses, corners, found_poses, output, page, csv,
        target;
    std::optional<Paper> paper;
    std::optional<BoardDesc> board;
    std::vector<std::string> overrides, unknowns;
    std::vector<Assumption> priors, bounds;
    int cells = 64, starts = 1;
    bool keeps_outliers = false;
    int threads = 0;
    bool json = false, quiet = false;
    ProgressForm progress = ProgressForm::text;
};

Options fit_options(FitArguments& a) {
    Options options;
    options.input("SCENE", "", a.scene, "scene file, with values from where to begin");
    options.input("--points", "CORNERS.csv", a.points,
                  "points x, y, z [m], and where images show them: u to the right and v down from "
                  "the corner (0, 0) at the upper left, so that the first pixel's centre is "
                  "(0.5, 0.5); OpenCV's positions are these less 0.5");
    options.input("--images", "PICTURE", a.images,
                  "photographs of the scene; %04d is the frame's number");
    options.input("--poses", "MODEL", a.poses,
                  "a COLMAP model or transforms.json with the camera's poses, by the pictures' "
                  "names; --images may then be their folder");
    options.parsed(
        "--board", "COLUMNSxROWSxSIDE",
        [&a](const std::string& text) { a.board = read_board(text); },
        "the photographs show a checkerboard with so many inner corners, whose squares have this "
        "side [m]: its corners are what is observed");
    options.output("--corners", "FILE.csv", a.corners, "write the corners found with --board");
    options.output("--found-poses", "POSES.json|POSES.csv", a.found_poses,
                   "write where the camera was in each picture, in the board's axes, with standard "
                   "errors, as --poses reads it, or as a table");
    options.integer("--cells", "N", a.cells, 4, 4096,
                    "about so many cells across a picture, whose mean light is compared: squares "
                    "of whole pixels, of a mosaic an odd number of them, at least three");
    Option& unknown = options.parsed(
        "--unknown", "KEY[,KEY...]",
        [&a](const std::string& text) {
            for (const std::string_view path : split(text, ',')) a.unknowns.emplace_back(path);
        },
        "what to find: paths as of --set; * stands for every entry; exposure and response of "
        "pictures");
    unknown.repeatable = true;
    options
        .parsed(
            "--prior", "KEY=VALUE+-ERROR",
            [&a](const std::string& text) {
                const Assumption read = read_assumption("--prior", text, "+-",
                                                        "KEY=VALUE+-ERROR, such as "
                                                        "camera.port.thickness=0.01+-0.0005");
                if (!(read.second > 0))
                    throw UsageError(
                        fmt::format("--prior {}: the error must be above 0", printable(text)));
                a.priors.push_back(read);
            },
            "what is known of an unknown beforehand, with its standard error")
        .repeatable = true;
    options
        .parsed(
            "--bounds", "KEY=LOW..HIGH",
            [&a](const std::string& text) {
                const Assumption read = read_assumption(
                    "--bounds", text, "..", "KEY=LOW..HIGH, such as camera.port.distance=0..0.1");
                if (!(read.first < read.second))
                    throw UsageError(fmt::format("--bounds {}: the first must be below the second",
                                                 printable(text)));
                a.bounds.push_back(read);
            },
            "where an unknown lies in any case")
        .repeatable = true;
    options.flag("--keep-outliers", a.keeps_outliers,
                 "let every observation count, by plain least squares");
    options.integer("--starts", "N", a.starts, 1, 1000,
                    "places to begin from, all but the first at random; the best is kept");
    options.set(a.overrides);
    options.output("-o,--output", "FITTED.yaml", a.output,
                   "write the scene with what was found, all else as it is");
    options.output("--report", "PAGE.html", a.page, "write a page with tables and plots");
    options.output("--csv", "FILE", a.csv, "write all residuals as a table");
    options.output(
        "--target", "SHEET.pdf|SHEET.obj", a.target,
        "write a sheet to print, with a checkerboard, or its surface for scenes, and end");
    Option& paper = options.parsed(
        "--paper", "SIZE", [&a](const std::string& text) { a.paper = read_paper(text); },
        "paper of --target: a4 (as it is if omitted), a3 or letter");
    paper.value = Option::Value::word;
    paper.words = {"a4", "a3", "letter"};
    options.flag("--json", a.json, "print everything as JSON instead of a table");
    options.threads(a.threads);
    options.messages(a.quiet, a.progress);
    return options;
}

std::vector<Prior> priors_of(const FitArguments& a, const SceneUnknowns& unknowns) {
    std::vector<Prior> priors(unknowns.size());
    const auto of = [&](const char* option, const std::string& key) {
        try {
            return unknowns.within(key);
        } catch (const UsageError& fault) {
            throw UsageError(fmt::format("{} {}", option, fault.what()));
        }
    };
    for (const Assumption& prior : a.priors)
        for (const std::size_t i : of("--prior", prior.key)) {
            priors[i].mean = prior.first;
            priors[i].deviation = prior.second;
        }
    for (const Assumption& bounds : a.bounds)
        for (const std::size_t i : of("--bounds", bounds.key)) {
            priors[i].lower = bounds.first;
            priors[i].upper = bounds.second;
        }
    return priors;
}

/// Sets the initial values of unknown exposures so that the pictures are as bright as the scene.
void begin_exposures(SceneUnknowns& unknowns, PictureResiduals& pictures) {
    std::vector<double> start;
    bool has_exposures = false;
    for (const SceneUnknown& unknown : unknowns.all()) {
        start.push_back(unknown.start);
        has_exposures = has_exposures || unknown.of == SceneUnknown::Of::exposure;
    }
    if (!has_exposures) return;
    const std::vector<double> exposures = pictures.exposures_at(start);
    for (std::size_t i = 0; i < unknowns.size(); ++i)
        if (unknowns.all()[i].of == SceneUnknown::Of::exposure)
            unknowns.begin_at(i, exposures[unknowns.all()[i].picture]);
}

/// The scene's text with the changes by --set and the values found, and otherwise unchanged.
std::string fitted_text(const FitArguments& a, const SceneUnknowns& unknowns,
                        const FitResult& result) {
    SceneText text(
        read_text_file(a.scene, a.scene.filename().string(), YamlLimits{}.bytes, "scene"),
        a.scene.filename().string());
    for (const std::string& change : a.overrides) {
        const std::size_t equals = end_of_path(change);
        for (const std::string& path :
             expanded_paths(text.tree(), change.substr(0, equals), "--set " + printable(change)))
            text.set(path, change.substr(equals + 1));
    }
    std::vector<double> values;
    for (const FoundValue& found : result.values) values.push_back(found.value);
    for (const auto& [path, value] : unknowns.settings(values)) text.set(path, value);
    return text.text();
}

/// Refuses to replace a file that the command line does not name, unless it has the same contents,
/// as after the same command.
void refuse_other_file(const std::filesystem::path& file, const std::string& content) {
    std::error_code error;
    if (!std::filesystem::exists(std::filesystem::symlink_status(file, error))) return;
    std::ifstream in = open_own_file(file);
    if (in && content == std::string(std::istreambuf_iterator<char>(in), {})) return;
    throw IoError(fmt::format(
        "{}: cannot write: there is such a file, and --target names only the mesh; move it, or "
        "give the mesh another name",
        printable(file.string())));
}

void write_target(const FitArguments& a) {
    if (!a.scene.empty())
        throw UsageError(
            "--target: writes a sheet to print, and fits nothing; leave the scene out");
    const Paper paper = a.paper ? *a.paper : read_paper("a4");
    TextFiles files;
    const BoardDesc board = a.board ? *a.board : board_for(paper);
    if (a.target.extension() == ".obj") {
        std::filesystem::path materials = a.target;
        materials.replace_extension(".mtl");
        const TargetMesh mesh = target_mesh(board, paper, materials.filename().string());
        refuse_other_file(materials, mesh.mtl);
        files.add(a.target, mesh.obj);
        files.add(materials, mesh.mtl);
    } else if (a.target.extension() == ".pdf") {
        files.add(a.target, target_pdf(board, paper));
    } else {
        throw UsageError(fmt::format(
            "--target {}: name a sheet to print SHEET.pdf, or its surface for scenes SHEET.obj",
            printable(a.target.string())));
    }
    files.commit(a.quiet);
}

void run_fit(const FitArguments& a) {
    if (a.scene.empty())
        throw UsageError(
            "fit: give the scene, as in 'uwvdb fit SCENE.yaml'; see 'uwvdb fit --help'");
    if (a.unknowns.empty())
        throw UsageError(
            "--unknown: give what to find, such as camera.port.distance; see 'uwvdb fit --help'");
    if (a.paper) throw UsageError("--paper: is that of a sheet to print; give --target SHEET.pdf");
    if (a.points.empty() == a.images.empty())
        throw UsageError("give either --points, a table of corners, or --images, photographs");
    if (a.board && a.images.empty())
        throw UsageError("--board: is looked for in --images; give these instead of --points");
    if (!a.corners.empty() && !a.board)
        throw UsageError("--corners: are those of a board; give its --board, such as 9x6x0.03");
    if (!a.found_poses.empty() && a.points.empty() && !a.board)
        throw UsageError(
            "--found-poses: are found from corners; give --board, or a table of --points");
    if (!a.poses.empty() && (a.board || a.images.empty()))
        throw UsageError(
            "--poses: are those of --images without --board; of corners poses are found");
    const auto warn = [](const std::string& line) {
        print_message(fmt::format("warning: {}\n", line));
    };
    std::vector<ObservedPicture> seen_pictures;
    std::vector<std::string> names;
    if (!a.images.empty())
        seen_pictures =
            a.poses.empty() ? pictures_called(a.images) : posed_pictures(a.images, a.poses, warn);
    if (!a.board)
        for (const ObservedPicture& picture : seen_pictures)
            names.push_back(picture.file.filename().string());
    for (const ObservedPicture& picture : seen_pictures)
        admit_input(picture.file, printable(picture.file.string(), 300), "picture");
    SceneUnknowns unknowns(read_scene_tree(a.scene, a.overrides), a.scene, a.unknowns, names);
    if (!a.points.empty()) admit_input(a.points, printable(a.points.string(), 300), "table");
    check_outputs({a.corners, a.found_poses, a.output, a.page, a.csv});
    FitOptions options;
    options.priors = priors_of(a, unknowns);
    options.starts = a.starts;
    options.keeps_outliers = a.keeps_outliers;
    std::unique_ptr<Observations> observations;
    const PictureResiduals* pictures = nullptr;
    const PointResiduals* points = nullptr;
    TextFiles files;
    if (!a.points.empty()) {
        auto seen = std::make_unique<PointResiduals>(
            unknowns, read_seen_points(read_csv_file(a.points, "--points")));
        points = seen.get();
        observations = std::move(seen);
    } else if (a.board) {
        std::vector<std::filesystem::path> pictures_of_it;
        pictures_of_it.reserve(seen_pictures.size());
        for (const ObservedPicture& picture : seen_pictures) pictures_of_it.push_back(picture.file);
        PointTable corners = find_board_corners(pictures_of_it, *a.board, warn);
        if (!a.corners.empty()) files.add(a.corners, point_csv(corners));
        auto seen = std::make_unique<PointResiduals>(unknowns, std::move(corners));
        points = seen.get();
        observations = std::move(seen);
    } else {
        auto seen = std::make_unique<PictureResiduals>(unknowns, std::move(seen_pictures), a.cells);
        begin_exposures(unknowns, *seen);
        pictures = seen.get();
        observations = std::move(seen);
    }
    FitResult result;
    with_threads(a.threads, [&] {
        options.threads = permitted_threads();
        Progress progress("fit", "", 1, a.quiet ? ProgressForm::none : a.progress);
        double done = 0;
        options.progress = [&](const std::string& stage, double) {
            done += (1 - done) * 0.05;  // the number of steps is not known
            progress.update(done, stage);
        };
        result = robust_fit(*observations, unknowns, options);
    });
    std::vector<FoundPose> poses;
    std::vector<std::string> questions;
    if (points != nullptr) {
        poses = points->found_poses(result);
        with_threads(a.threads, [&] { questions = points->questions(result, options); });
    }
    const FitReport report(*observations, pictures, result, poses, std::move(questions));
    if (!a.csv.empty()) files.add(a.csv, report.csv());
    if (!a.page.empty()) files.add(a.page, report.page(a.scene.filename().string()));
    if (!a.found_poses.empty())
        files.add(a.found_poses, a.found_poses.extension() == ".csv"
                                     ? pose_csv(points->images(), poses)
                                     : transforms_json(points->images(), poses));
    if (!a.output.empty()) files.add(a.output, fitted_text(a, unknowns, result));
    files.commit(a.quiet);
    print_output(report.printed(a.json));
}

}  // namespace

Command fit_command() {
    const auto arguments = std::make_shared<FitArguments>();
    return {"fit", "find numbers of a scene from what photographs show", k_fit_examples,
            fit_options(*arguments), [arguments] {
                install_stop_signal();
                if (arguments->target.empty())
                    run_fit(*arguments);
                else
                    write_target(*arguments);
                return k_exit_done;
            }};
}

}  // namespace uw
