// ctest labels: unit slow
// Whatever a scene or a command line names is opened through one door: it is never replaced, never
// waited for, and lies where --confine allows. Every key and every option is walked over.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/fit/fit_command.h"
#include "cli/info/info_command.h"
#include "cli/pages/shell.h"
#include "cli/render/render_command.h"
#include "cli/runs/dataset_command.h"
#include "cli/runs/sweep_command.h"
#include "cli/tools/calibration_command.h"
#include "cli/tools/edit_command.h"
#include "cli/tools/measure_command.h"
#include "cli/tools/points_commands.h"
#include "cli/tools/record_command.h"
#include "cli/tools/water_command.h"
#include "cli/validate/validate_command.h"
#include "core/scene/scene_context.h"
#include "tests/support/cli_test.h"
#include "tests/support/named_files.h"

namespace uw {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

Words operator+(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

class Inputs : public test::CliTest {
  protected:
    /// Writes the files of a case, but that which it is about, to a folder of its own.
    void write_scene(const test::NamedFileCase& of, const std::string& name) const {
        fs::remove_all(folder_ / "given");
        fs::create_directories((folder_ / "given" / of.file).parent_path());
        write("given/s.yaml", of.scene(name));
        for (const auto& [file, text] : of.others) {
            fs::create_directories((folder_ / "given" / file).parent_path());
            write("given/" + file, test::NamedFileCase::with_name(text, name));
        }
    }
    Words render(const test::NamedFileCase& of, const std::string& name) const {
        return Words{"render", "given/s.yaml", "-o", "out.exr"} + of.arguments(name);
    }
    /// Nothing here takes as long as a minute, unless it waits for ever.
    test::ProgramResult run_soon(const Words& arguments) const {
        return test::run_program(arguments, {.folder = folder_.path(), .timeout_seconds = 60});
    }
    void expect_kept(const Words& command, const std::string& file, const std::string& bytes,
                     const std::string& part) const {
        const test::ProgramResult result = run_soon(command);
        EXPECT_TRUE(result.exit_code == 2 || result.exit_code == 4) << result.exit_code;
        EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
        EXPECT_EQ(read(file), bytes) << file;
    }
};

TEST_F(Inputs, AreAllThatKeysName) {
    std::set<std::string> tested;
    for (const test::NamedFileCase& of : test::named_file_cases()) tested.insert(of.key);
    for (const FileKey& key : k_file_keys)
        EXPECT_TRUE(tested.contains(std::string(key.path)))
            << key.path << " has no case in tests/support/named_files.h";
}

TEST_F(Inputs, AreNeverReplaced) {
    for (const test::NamedFileCase& of : test::named_file_cases()) {
        SCOPED_TRACE(of.key);
        write_scene(of, of.file);
        write("given/" + of.file, of.bytes);
        // Found out before anything is rendered, as "would replace" says.
        const bool is_of_variations = of.key == "variations.*table";
        expect_kept(render(of, of.file) + Words{"--stats", "given/" + of.file}, "given/" + of.file,
                    of.bytes, is_of_variations ? "a file that this run reads" : "would replace");
        EXPECT_FALSE(exists("out.exr"));
    }
}

TEST_F(Inputs, LieWhereTheyAreConfinedTo) {
    for (const test::NamedFileCase& of : test::named_file_cases()) {
        SCOPED_TRACE(of.key);
        const fs::path name = fs::path(of.file).filename();
        fs::create_directories(folder_ / "outside");
        write("outside" / name, of.bytes);
        const bool is_named_by_key =
            of.key.find(' ') == std::string::npos && of.file == name.string();
        if (is_named_by_key) {
            write_scene(of, ("../outside" / name).string());
            const test::ProgramResult result =
                run_soon(render(of, ("../outside" / name).string()) + Words{"--confine"});
            EXPECT_EQ(result.exit_code, 3) << result.err;
            EXPECT_NE(result.err.find(name.string() + ": lies outside '"), std::string::npos)
                << result.err;
        }
        write_scene(of, of.file);
        fs::create_symlink(folder_ / "outside" / name.string(), folder_ / "given" / of.file);
        const test::ProgramResult linked = run_soon(render(of, of.file) + Words{"--confine"});
        EXPECT_EQ(linked.exit_code, 3) << linked.err;
        EXPECT_NE(linked.err.find(name.string() + ": lies outside '"), std::string::npos)
            << linked.err;
        EXPECT_FALSE(exists("out.exr"));
        if (HasFailure()) return;
    }
}

TEST_F(Inputs, AreNeitherPipesNorDevices) {
    for (const test::NamedFileCase& of : test::named_file_cases()) {
        for (const char* const kind : {"pipe", "device"}) {
            SCOPED_TRACE(of.key + ", a " + kind);
            write_scene(of, of.file);
            const fs::path file = folder_ / "given" / of.file;
            if (kind == std::string("pipe"))
                ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
            else
                fs::create_symlink("/dev/zero", file);
            const test::ProgramResult result = run_soon(render(of, of.file));
            if (of.may_be_missing) {
                EXPECT_EQ(result.exit_code, 0) << result.err;
            } else {
                EXPECT_TRUE(result.exit_code == 3 || result.exit_code == 4) << result.exit_code;
                const bool is_named_by_key = of.key.find(' ') == std::string::npos;
                EXPECT_NE(result.err.find(is_named_by_key ? kind : "uwvdb: "), std::string::npos)
                    << result.err;
                EXPECT_FALSE(exists("out.exr"));
            }
            fs::remove(folder_ / "out.exr");
            if (HasFailure()) return;
        }
    }
}

/// The program's commands, in the order in which it lists them.
std::vector<Command> all_commands() {
    std::vector<Command> commands;
    commands.push_back(render_command());
    commands.push_back(dataset_command());
    commands.push_back(info_command());
    commands.push_back(water_command());
    commands.push_back(record_command());
    commands.push_back(measure_command());
    commands.push_back(fit_command());
    commands.push_back(sweep_command());
    commands.push_back(validate_command());
    commands.push_back(edit_command());
    commands.push_back(calibration_command());
    commands.push_back(project_command());
    commands.push_back(rays_command());
    commands.push_back(completion_command(commands));
    commands.push_back(manual_command(commands));
    return commands;
}

/// "render SCENE", "fit --points": all options whose value is of this kind.
std::set<std::string> options_of(Option::Value value) {
    std::set<std::string> names;
    for (const Command& command : all_commands())
        for (const Option& option : command.options.all())
            if (option.value == value) names.insert(command.name + " " + option.name());
    return names;
}

/// A command line on which an option names the file @.
struct OptionCase {
    std::string option;
    Words command;
};

std::set<std::string> names_of(const std::vector<OptionCase>& cases) {
    std::set<std::string> names;
    for (const OptionCase& of : cases) names.insert(of.option);
    return names;
}

Words with_file(Words words, const std::string& file) {
    for (std::string& word : words) word = test::NamedFileCase::with_name(std::move(word), file);
    return words;
}

/// The options that name inputs; where a command writes a file that the user names, to the same.
const std::vector<OptionCase> k_input_options{
    {"render SCENE", {"render", "@", "--stats", "@"}},
    {"dataset SCENE", {"dataset", "@", "-o", "set"}},
    {"info FILE|SCENE", {"info", "@", "--svg", "@"}},
    {"water PRESET|SCENE", {"water", "@", "--svg", "@"}},
    {"record SCENE", {"record", "@", "--to", "1", "-o", "log"}},
    {"measure SCENE", {"measure", "@", "--csv", "@"}},
    {"fit SCENE",
     {"fit", "@", "--points", "points.csv", "--unknown", "camera.intrinsics.fov_x", "--csv", "@"}},
    {"fit --points",
     {"fit", "scene.yaml", "--points", "@", "--unknown", "camera.intrinsics.fov_x", "--csv", "@"}},
    {"fit --images",
     {"fit", "scene.yaml", "--images", "@", "--unknown", "water.absorption", "--csv", "@"}},
    {"fit --poses",
     {"fit", "scene.yaml", "--images", "picture.png", "--poses", "@", "--unknown",
      "water.absorption", "--csv", "@"}},
    {"sweep SCENE", {"sweep", "@", "--set", "lamps.left.intensity=1:3:1", "-o", "@"}},
    {"validate SCENE", {"validate", "@", "--report", "@"}},
    {"edit SCENE", {"edit", "@", "--no-browser"}},
    {"calibration FILE", {"calibration", "@", "--to", "opencv", "-o", "@"}},
    {"project SCENE", {"project", "@", "points.csv", "-o", "@"}},
    {"project POINTS.csv", {"project", "scene.yaml", "@", "-o", "@"}},
    {"rays SCENE", {"rays", "@", "points.csv", "-o", "@"}},
    {"rays PIXELS.csv", {"rays", "scene.yaml", "@", "-o", "@"}},
};

TEST_F(Inputs, OfCommandLinesAreNeitherPipesNorDevices) {
    std::set<std::string> options = options_of(Option::Value::input);
    options.insert("water PRESET|SCENE");  // which may also be a word
    EXPECT_EQ(names_of(k_input_options), options);
    write("points.csv", "x,y,z\n0,0,3\n");
    write("picture.png", test::four_texel_png());
    for (const char* const kind : {"pipe", "device"}) {
        for (const OptionCase& of : k_input_options) {
            SCOPED_TRACE(of.option + ", a " + kind);
            fs::remove(folder_ / "given.json");
            if (kind == std::string("pipe"))
                ASSERT_EQ(::mkfifo((folder_ / "given.json").c_str(), 0600), 0);
            else
                fs::create_symlink("/dev/zero", folder_ / "given.json");
            const test::ProgramResult result = run_soon(with_file(of.command, "given.json"));
            EXPECT_TRUE(result.exit_code >= 2 && result.exit_code <= 4)
                << result.exit_code << result.err;
            EXPECT_TRUE(result.err.starts_with("uwvdb: ")) << result.err;
        }
    }
}

TEST_F(Inputs, OfCommandLinesAreNeverReplaced) {
    write("points.csv", "x,y,z\n0,0,3\n");
    write("picture.png", test::four_texel_png());
    const std::string scene =
        test::k_small_scene + std::string("sensors: [{name: a, position: [0, 0, 1]}]\n");
    const std::string pose = "pose: {position: [0, 0, 0], look_at: [0, 0, 1], up: [0, -1, 0]}";
    std::string moving = scene;
    moving.replace(moving.find(pose), pose.size(),
                   "trajectory: {keyframes: [{time: 0, position: [0, 0, 0], look_at: [0, 0, 1], "
                   "up: [0, -1, 0]}, {time: 9, position: [1, 0, 0], look_at: [1, 0, 1], up: [0, "
                   "-1, 0]}]}");
    const std::string transforms =
        R"({"frames": [{"file_path": "picture.png", "transform_matrix":
            [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}]})";
    for (const OptionCase& of : k_input_options) {
        if (of.option == "edit SCENE") continue;  // writes the scene itself, when it is told to
        SCOPED_TRACE(of.option);
        std::string name = "given.yaml", bytes = scene;
        if (of.option == "project POINTS.csv" || of.option == "fit --points")
            name = "given.csv", bytes = "image,point,pixel_x,pixel_y,x,y,z\n0,0,3,3,0,0,3\n";
        if (of.option == "rays PIXELS.csv") name = "given.csv", bytes = "x,y\n3,3\n";
        if (of.option == "info FILE|SCENE") bytes = moving;
        if (of.option == "sweep SCENE") name = "given.csv";
        if (of.option == "fit --images") name = "given.png", bytes = test::four_texel_png();
        if (of.option == "fit --poses") name = "given.json", bytes = transforms;
        write(name, bytes);
        const test::ProgramResult result = run_soon(with_file(of.command, name));
        if (of.option != "dataset SCENE" && of.option != "record SCENE") {
            EXPECT_TRUE(result.exit_code == 2 || result.exit_code == 4)
                << result.exit_code << result.err;
            EXPECT_TRUE(result.err.find("would replace") != std::string::npos ||
                        result.err.find("a file that this run reads") != std::string::npos)
                << result.err;
        }
        EXPECT_EQ(read(name), bytes);
    }
}

/// The options that name outputs, with what else makes the command write them. The scene has a
/// panorama, volumes and meters, and moves.
const std::vector<OptionCase> k_output_options{
    {"render --output", {"render", "s.yaml", "-o", "@.exr"}},
    {"render --contact-sheet",
     {"render", "s.yaml", "-o", "a.#.exr", "--frames", "1,2", "--contact-sheet", "@.png"}},
    {"render --stats", {"render", "s.yaml", "-o", "a.exr", "--stats", "@.json"}},
    {"render --numbers", {"render", "s.yaml", "-o", "a.exr", "--numbers", "@.csv"}},
    {"render --irradiance-vdb", {"render", "s.yaml", "-o", "a.exr", "--irradiance-vdb", "@.vdb"}},
    {"dataset --output", {"dataset", "s.yaml", "-o", "@.json"}},
    {"dataset --merge", {"dataset", "--merge", "@.json"}},
    {"info --picture", {"info", "v.vdb", "--picture", "@.png"}},
    {"info --svg", {"info", "s.yaml", "--svg", "@.svg"}},
    {"water --csv", {"water", "s.yaml", "--csv", "@"}},
    {"water --svg", {"water", "s.yaml", "--svg", "@.svg"}},
    {"record --output", {"record", "s.yaml", "-o", "@.json"}},
    {"measure --csv", {"measure", "s.yaml", "--csv", "@.csv"}},
    {"measure --svg", {"measure", "s.yaml", "--svg", "@.svg"}},
    {"fit --corners",
     {"fit", "s.yaml", "--images", "p.png", "--board", "3x3x0.1", "--unknown",
      "camera.intrinsics.fov_x", "--corners", "@.csv"}},
    {"fit --found-poses",
     {"fit", "s.yaml", "--images", "p.png", "--board", "3x3x0.1", "--unknown",
      "camera.intrinsics.fov_x", "--found-poses", "@.json"}},
    {"fit --output",
     {"fit", "s.yaml", "--images", "p.png", "--unknown", "water.absorption", "-o", "@.yaml"}},
    {"fit --report",
     {"fit", "s.yaml", "--images", "p.png", "--unknown", "water.absorption", "--report", "@.html"}},
    {"fit --csv",
     {"fit", "s.yaml", "--images", "p.png", "--unknown", "water.absorption", "--csv", "@.csv"}},
    {"fit --target", {"fit", "--target", "@.obj"}},
    {"sweep --output", {"sweep", "s.yaml", "--set", "lamps.left.intensity=1:3:1", "-o", "@.csv"}},
    {"validate --report", {"validate", "s.yaml", "--report", "@.html"}},
    {"calibration --output", {"calibration", "s.yaml", "--to", "opencv", "-o", "@.yaml"}},
    {"project --output", {"project", "s.yaml", "points.csv", "-o", "@.csv"}},
    {"rays --output", {"rays", "s.yaml", "pixels.csv", "-o", "@.csv"}},
};

// By another name, a link, since each wants another ending.
TEST_F(Inputs, AreNotWhatAnyOptionWrites) {
    EXPECT_EQ(names_of(k_output_options), options_of(Option::Value::output));
    write("sky.exr", test::exr_bytes(8, 4));
    write("points.csv", "x,y,z\n0,0,3\n");
    write("pixels.csv", "x,y\n3,3\n");
    write("p.png", test::four_texel_png());
    test::VdbFixture box;
    box.boxes = {{{0, 0, 0}, {7, 7, 7}, 1.0}};
    test::write_fixture(folder_ / "v.vdb", {box});
    write("s.yaml",
          "uwvdb: 1\ncamera:\n  resolution: [8, 4]\n  intrinsics: {fov_x: 60}\n"
          "  trajectory: {keyframes: [{time: 0, position: [0, 0, 0], look_at: [0, 0, 1], up: [0, "
          "-1, 0]}, {time: 9, position: [1, 0, 0], look_at: [1, 0, 1], up: [0, -1, 0]}]}\n"
          "water: {absorption: 0.1, scattering: {b: 0.2, phase: {type: hg, g: 0}},\n"
          "  surface: {point: [0, -5, 0], normal: [0, -1, 0], n: 1.34}}\n"
          "sky: {model: panorama, file: sky.exr}\n"
          "geometry: [{type: plane, point: [0, 0, 4], normal: [0, 0, -1]}]\n"
          "lamps: [{name: left, position: [-0.5, 0, 0], direction: [0, 0, 1], intensity: 50}]\n"
          "sensors: [{name: a, from: [0, 0, 1], to: [0, 0, 2], count: 2}]\n");
    for (const OptionCase& of : k_output_options) {
        // --target reads nothing, and data sets and records are folders.
        const bool is_refused = !of.option.starts_with("dataset") &&
                                !of.option.starts_with("record") && of.option != "fit --target";
        const std::string input = of.option == "info --picture" ? "v.vdb" : "sky.exr";
        const std::string bytes = read(input);
        SCOPED_TRACE(of.option);
        for (const char* const ending :
             {"", ".exr", ".png", ".json", ".csv", ".vdb", ".svg", ".yaml", ".html", ".obj",
              "-coefficients.csv", "-vsf.csv"}) {
            fs::remove(folder_ / (std::string("link") + ending));
            fs::create_symlink(input, folder_ / (std::string("link") + ending));
        }
        const test::ProgramResult result = run_soon(with_file(of.command, "link"));
        if (is_refused) {
            EXPECT_TRUE(result.exit_code == 2 || result.exit_code == 4)
                << result.exit_code << result.err;
            EXPECT_TRUE(result.err.find("would replace") != std::string::npos ||
                        result.err.find("a file that this run reads") != std::string::npos)
                << result.err;
            EXPECT_EQ(read(input), bytes);
        }
        write(input, bytes);
    }
}

TEST_F(Inputs, OfTheEnvironmentAreNeverReplaced) {
    const std::string config =
        "ocio_profile_version: 1\nroles: {default: lin, scene_linear: lin}\ndisplays:\n  s:\n"
        "    - !<View> {name: V, colorspace: lin}\ncolorspaces:\n  - !<ColorSpace> {name: lin}\n";
    write("mine.ocio", config);
    const test::ProgramResult result =
        test::run_program({"OCIO=mine.ocio", UWVDB_PROGRAM, "render", "scene.yaml", "-o", "out.exr",
                           "--stats", "mine.ocio"},
                          {.folder = folder_.path(), .program = "/usr/bin/env"});
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_NE(result.err.find("would replace the OpenColorIO config"), std::string::npos)
        << result.err;
    EXPECT_EQ(read("mine.ocio"), config);
}

// What a run writes beside the file that it is told to write is no file of somebody else's.
TEST_F(Inputs, OfOtherProgramsAreNotReplacedBySideFiles) {
    write("board.mtl", "newmtl mine\n");
    expect_kept({"fit", "--target", "board.obj"}, "board.mtl", "newmtl mine\n",
                "board.mtl: cannot write: there is such a file");
    EXPECT_FALSE(exists("board.obj"));
    fs::remove(folder_ / "board.mtl");
    EXPECT_EQ(run({"fit", "--target", "board.obj"}).exit_code, 0);
    EXPECT_EQ(run({"fit", "--target", "board.obj"}).exit_code, 0);  // its own
    write("board.mtl", read("board.mtl") + "# as measured\n");
    expect_kept({"fit", "--target", "board.obj"}, "board.mtl", read("board.mtl"), "--target");
}

}  // namespace
}  // namespace uw
