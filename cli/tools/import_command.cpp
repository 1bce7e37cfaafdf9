#include "cli/tools/import_command.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera/calibration.h"
#include "cli/console.h"
#include "cli/process.h"
#include "cli/report.h"
#include "cli/tools/calibration_command.h"
#include "core/base/csv_table.h"
#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/output_files.h"
#include "core/base/parallel.h"
#include "core/base/text.h"
#include "core/geometry/gltf_writer.h"
#include "core/scene/key_path.h"
#include "dataset/rgbd.h"
#include "edit/document/scene_text.h"
#include "render/scene_loading.h"

namespace uw {

namespace {

namespace fs = std::filesystem;

const char* const k_import_examples = R"(Examples:
  uwvdb import rgbd --image rgb.png --depth depth.png --depth-scale tum --intrinsics 525,525,319.5,239.5
  uwvdb import rgbd --image left.png --depth disparity.png --depth-kind disparity --depth-scale kitti
      --baseline 0.54 --intrinsics 721.5,721.5,609.6,172.9 --depth-far 60 -o street.yaml
  uwvdb import rgbd --image rgb --depth depth --depth-scale tum --intrinsics camera.yaml -o room.yaml
  uwvdb render room.yaml --frames 0-99 --set water.preset=jerlov-3C

Makes a scene of a picture with depth, or of two folders of them: beside it a mesh (.glb) of each pair,
whose texture is the picture, sRGB undone. The camera stands at the origin, y up, looking along -z. The
surface is cut where depth jumps (--edge). Pixels without depth (0) are holes. Folders make meshes of
frames 0, 1, ... of one scene, for `uwvdb render --frames` and `uwvdb dataset --frames`, and a table of
them.
The colours are reflectance, under two lamps, or with --colours emission the light that leaves the
surface, as in formulas that fade a picture through water.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write.
More: docs/datasets.md)";

struct ImportArguments {
    std::string kind;
    fs::path picture, depth, output;
    std::string intrinsics;  // a file, or four numbers
    std::string camera;
    DepthReading reading;
    DepthMeshOptions mesh;
    PictureMeaning meaning = PictureMeaning::reflectance;
    std::vector<std::string> overrides;
    int threads = 0;
    bool json = false, quiet = false;
};

/// The data sets that say how their depths are scaled, all of z.
constexpr std::array<std::pair<std::string_view, double>, 3> k_depth_scales{
    {{"tum", 5000}, {"kitti", 256}, {"nyu", 1000}}};

template <class T, std::size_t N>
T value_of_word(const std::string& option, const std::string& word,
                const std::array<std::pair<std::string_view, T>, N>& table) {
    for (const auto& [known, value] : table)
        if (known == word) return value;
    const auto words = words_of(table);
    throw UsageError(
        fmt::format("{}: unknown word '{}'; {}", option, printable(word), suggestion(word, words)));
}

template <class T, std::size_t N>
void add_words(Option& option, const std::array<std::pair<std::string_view, T>, N>& table) {
    option.value = Option::Value::word;
    for (const std::string_view word : words_of(table)) option.words.emplace_back(word);
}

void take_depth_scale(const std::string& text, DepthReading& reading) {
    for (const auto& [name, scale] : k_depth_scales)
        if (name == text) {
            reading.scale = scale;
            if (!reading.kind) reading.kind = DepthKind::z;
            return;
        }
    double scale = 0;
    if (parse_number(text, scale) != NumberText::number || !(scale > 0))
        throw UsageError(
            fmt::format("--depth-scale: expected a number above 0, tum, kitti or nyu, found '{}'",
                        printable(text)));
    reading.scale = scale;
}

Options import_options(ImportArguments& a) {
    Options options;
    Option& kind = options.text("KIND", "", a.kind, "what is imported: rgbd, pictures with depth");
    kind.required = true;
    kind.value = Option::Value::word;
    kind.words = {"rgbd"};
    options.input("--image", "FILE|FOLDER", a.picture, "the picture: PNG, JPEG or linear OpenEXR")
        .required = true;
    options
        .input("--depth", "FILE|FOLDER", a.depth,
               "its depths, pixel by pixel: PNG, or OpenEXR, TIFF or HDR of floats")
        .required = true;
    options
        .text(
            "--intrinsics", "FILE|fx,fy,cx,cy", a.intrinsics,
            "the picture's camera: a calibration, a scene, or numbers in pixels, counted from the "
            "first pixel's centre, as data sets give them")
        .required = true;
    options.text("--camera", "NAME", a.camera, "which of several cameras in that file");
    options.parsed(
        "--depth-scale", "N|tum|kitti|nyu",
        [&a](const std::string& text) { take_depth_scale(text, a.reading); },
        "scale of whole numbers: N per metre, or per pixel of disparity; tum is 5000, kitti 256, "
        "nyu 1000, of z");
    add_words(options.parsed(
                  "--depth-kind", "KIND",
                  [&a](const std::string& word) {
                      a.reading.kind = value_of_word("--depth-kind", word, k_depth_kinds);
                  },
                  "z: along the optical axis; range: from the camera's centre; or disparity; known "
                  "of tum, kitti, nyu, and of the layers depth and range of uwvdb"),
              k_depth_kinds);
    options.number("--baseline", "B", a.reading.baseline, 0, 1e6,
                   "distance of the cameras in metres, for disparities");
    options.text("--channel", "NAME", a.reading.channel, "which channel of an OpenEXR has depths");
    options.number("--depth-far", "D", a.reading.farthest, 0, 1e9,
                   "leave out what is farther than D metres");
    options.number("--edge", "R", a.mesh.edge, 0, 10,
                   "cut where depth jumps by more than this fraction and no slope explains it; "
                   "default 0.03");
    options.integer("--normals", "N", a.mesh.normal_radius, 0, 50,
                    "take normals from the pixels up to N away; 0: flat triangles; default 3");
    add_words(options.parsed(
                  "--colours", "WORD",
                  [&a](const std::string& word) {
                      a.meaning = value_of_word("--colours", word, k_picture_meanings);
                  },
                  "what colours are: reflectance, the default, or emission"),
              k_picture_meanings);
    options.output("-o,--output", "SCENE.yaml", a.output,
                   "the scene; meshes go beside it; default: the picture's name with .yaml");
    options.set(a.overrides);
    options.threads(a.threads);
    options.flag("--json", a.json, "print what was found as JSON");
    options.flag("--quiet", a.quiet, "print nothing but warnings and errors");
    return options;
}

/// "525,525,319.5,239.5" as intrinsics; none if it is not four numbers.
std::optional<IntrinsicsDesc> intrinsics_in(const std::string& text) {
    std::array<double, 4> numbers{};
    const std::vector<std::string_view> parts = split(text, ',');
    if (parts.size() != numbers.size()) return std::nullopt;
    for (std::size_t i = 0; i < numbers.size(); ++i)
        if (parse_number(trimmed(parts[i]), numbers[i]) != NumberText::number) return std::nullopt;
    const auto [fx, fy, cx, cy] = numbers;
    if (!(fx > 0) || !(fy > 0))
        throw UsageError(fmt::format("--intrinsics {}: fx and fy are above 0", printable(text)));
    return IntrinsicsDesc{fx, fy, cx + k_half_pixel, cy + k_half_pixel};
}

CameraDesc camera_of_scene(const ImportArguments& a) {
    const SceneDesc scene = load_scene(a.intrinsics, {});
    if (scene.cameras.empty()) {
        if (!a.camera.empty())
            throw UsageError("--camera: the scene has one camera; leave --camera out");
        return scene.camera;
    }
    std::vector<std::string_view> names;
    for (const RigCameraDesc& entry : scene.cameras) {
        if (entry.name == a.camera) return entry.camera;
        names.emplace_back(entry.name);
    }
    throw UsageError(
        fmt::format("--camera: name one of the scene's cameras: {}", alternatives(names)));
}

/// The lens that took the pictures, without pose, port or sensor.
CameraDesc picture_camera(const ImportArguments& a, const fs::path& picture) {
    CameraDesc camera;
    if (const std::optional<IntrinsicsDesc> numbers = intrinsics_in(a.intrinsics)) {
        if (!a.camera.empty())
            throw UsageError("--camera: --intrinsics are numbers; leave --camera out");
        const std::array<int, 2> size = picture_size(picture);
        camera.width = size[0];
        camera.height = size[1];
        camera.intrinsics = *numbers;
        return camera;
    }
    CameraDesc found;
    if (is_scene(a.intrinsics)) {
        found = camera_of_scene(a);
    } else {
        const Calibration calibration = read_calibration(a.intrinsics, a.camera);
        for (const std::string& warning : calibration.warnings)
            print_message(fmt::format("warning: {}\n", warning));
        found = calibration.desc;
    }
    if (found.port)
        throw InputError(fmt::format(
            "{}: the camera is behind a port, which bends the rays to each depth differently; give "
            "the camera that took the picture in air",
            a.intrinsics));
    camera.width = found.width;
    camera.height = found.height;
    camera.intrinsics = found.intrinsics;
    camera.distortion = found.distortion;
    return camera;
}

/// The text of a scene with the changes by --set.
std::string changed(const std::string& text, const fs::path& file,
                    const std::vector<std::string>& overrides) {
    SceneText scene(text, file.filename().string());
    for (const std::string& change : overrides) {
        const std::size_t equals = end_of_path(change);
        if (equals == std::string::npos)
            throw UsageError(fmt::format("--set {}: expected KEY.PATH=VALUE", printable(change)));
        for (const std::string& path :
             expanded_paths(scene.tree(), change.substr(0, equals), "--set " + printable(change)))
            scene.set(path, change.substr(equals + 1));
    }
    return scene.text();
}

/// Writes a mesh, which is complete.
void write_mesh(const fs::path& file, const RgbdSurface& surface, const std::string& name,
                PictureMeaning meaning) {
    OutputFile out(file);
    write_glb(out, {.name = name,
                    .positions = surface.mesh.positions,
                    .normals = surface.mesh.normals,
                    .uvs = surface.mesh.uvs,
                    .triangles = surface.mesh.triangles,
                    .picture = surface.picture,
                    .picture_type = surface.picture_type,
                    .is_emission = meaning == PictureMeaning::emission});
    out.commit();
}

Report import_report(const RgbdPair& pair, const fs::path& mesh, const RgbdSurface& surface,
                     std::size_t pixels) {
    Report report;
    const DepthHoles& holes = surface.holes;
    std::string line =
        fmt::format("{}: depth {:.3g} to {:.3g} m, median {:.3g} m; cut along {}; ",
                    printable(mesh.filename().string(), 200), surface.nearest, surface.farthest,
                    surface.median, counted(surface.mesh.edges, "pixel"));
    if (holes.count == 0)
        line += "no holes";
    else
        line += fmt::format("{}, {:.3g} % of the pixels, the largest {} x {} at ({}, {})",
                            counted(holes.count, "hole"),
                            100.0 * static_cast<double>(holes.pixels) / static_cast<double>(pixels),
                            holes.largest[2], holes.largest[3], holes.largest[0], holes.largest[1]);
    report.say(line);
    report.set({{"image", pair.picture.string()},
                {"depth", pair.depth.string()},
                {"mesh", mesh.string()},
                {"nearest_m", surface.nearest},
                {"median_m", surface.median},
                {"farthest_m", surface.farthest},
                {"cut_pixels", surface.mesh.edges},
                {"holes", holes.count},
                {"pixels_without_depth", holes.pixels},
                {"largest_hole", holes.largest},
                {"triangles", surface.mesh.triangles.size() / 3}});
    return report;
}

void run_import(const ImportArguments& a) {
    if (a.kind != "rgbd")
        throw UsageError(fmt::format("import {}: unknown kind; use rgbd", printable(a.kind)));
    const ThreadLimit limit(a.threads);
    const std::vector<RgbdPair> pairs = rgbd_pairs(a.picture, a.depth);
    const bool is_sequence = fs::is_directory(a.picture);
    const CameraDesc camera = picture_camera(a, pairs.front().picture);
    const fs::path scene = !a.output.empty() ? a.output
                           : is_sequence
                               ? fs::path("rgbd.yaml")
                               : fs::path(a.picture.filename()).replace_extension(".yaml");
    const std::string name = scene.stem().string();
    const fs::path meshes =
        fs::path(scene).replace_filename(name + (is_sequence ? ".####.glb" : ".glb"));
    const fs::path table = fs::path(scene).replace_filename(name + ".frames.csv");
    check_outputs({scene, is_sequence ? table : fs::path()});

    std::vector<Report> reports;
    std::string text, frames = "frame,image,depth\n";
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const fs::path mesh = file_of_frame(meshes, static_cast<int>(i));
        const RgbdSurface surface = read_rgbd(pairs[i], a.reading, camera, a.mesh);
        if (i == 0)
            text = changed(
                rgbd_scene_text(camera, meshes.filename().string(), a.meaning, surface.median),
                scene, a.overrides);
        write_mesh(mesh, surface, name, a.meaning);
        reports.push_back(import_report(
            pairs[i], mesh, surface,
            static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height)));
        if (!a.quiet && !a.json) print_message(reports.back().text());
        frames += fmt::format("{},{},{}\n", i, csv_text(pairs[i].picture.string()),
                              csv_text(pairs[i].depth.string()));
        if (i > 0) continue;
        try {
            load_scene_text(text, scene);
        } catch (const InputError&) {
            std::error_code ignored;
            fs::remove(mesh, ignored);
            throw;
        }
    }
    TextFiles files;
    files.add(scene, text);
    if (is_sequence) files.add(table, frames);
    files.commit(a.quiet);
    if (a.json) {
        Report report;
        report.set({{"scene", scene.string()}});
        report.add("meshes", reports);
        print_output(report.json());
    } else if (is_sequence && !a.quiet) {
        print_message(fmt::format("render it with --frames 0-{}\n", pairs.size() - 1));
    }
}

}  // namespace

Command import_command() {
    const auto arguments = std::make_shared<ImportArguments>();
    return {"import", "make a scene of pictures with depth", k_import_examples,
            import_options(*arguments), [arguments] {
                install_stop_signal();
                run_import(*arguments);
                return k_exit_done;
            }};
}

}  // namespace uw
