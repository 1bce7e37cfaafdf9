// ctest labels: unit
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>

#include "tests/support/cli_test.h"
#include "tests/support/full_disk.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw {
namespace {

/// "smoke.yaml": the small scene with smoke_####.vdb, of which frames 1 to 3 are there.
class Frames : public test::CliTest {
  protected:
    Frames() {
        write_scene("smoke_####.vdb");
        for (int frame = 1; frame <= 3; ++frame) write_smoke(frame);
    }

    void write_scene(const std::string& file) const {
        write("smoke.yaml", std::string(test::k_small_scene) + "volumes: [{file: '" + file +
                                "', grids: {density: {large: 2}}}]\n");
    }
    static std::string name(int frame) { return "smoke_000" + std::to_string(frame) + ".vdb"; }
    static test::VdbFixture smoke(int frame) {
        test::VdbFixture fixture;
        fixture.min = {0, 0, 0};
        fixture.max = {7, 6 + frame, 7};
        fixture.value = [frame](int i, int j, int k) {
            return 0.3 * frame + 0.1 * (i + j * k % 3);
        };
        fixture.file_from_index =
            Affine::translation({-0.4, -0.4, 1}) * Affine::scale(Vector3(0.1));
        return fixture;
    }
    void write_smoke(int frame) const {
        test::write_fixture(folder_ / name(frame), {smoke(frame)});
    }

    test::ProgramResult sequence(const std::vector<std::string>& more) const {
        std::vector<std::string> arguments{"render", "smoke.yaml"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }
    void expect_done(const test::ProgramResult& result) const {
        EXPECT_EQ(result.exit_code, 0) << result.err;
    }
};

TEST_F(Frames, AreToTheByteWhatEachIsByItself) {
    expect_done(sequence({"--frames", "1-3", "-o", "all_##.exr", "--layers", "all",
                          "--irradiance-vdb", "light_##.vdb"}));
    for (const std::string frame : {"1", "2", "3"}) {
        expect_done(sequence({"--frames", frame, "-o", "one.exr", "--layers", "all",
                              "--irradiance-vdb", "light.vdb"}));
        EXPECT_EQ(read("all_0" + frame + ".exr"), read("one.exr")) << frame;
        EXPECT_EQ(read("all_0" + frame + ".png"), read("one.png")) << frame;
        EXPECT_EQ(read("light_0" + frame + ".vdb").size(), read("light.vdb").size()) << frame;
        // And, but for what the header says, a scene that names the file.
        expect_done(sequence({"--set", "volumes[0].file=smoke_000" + frame + ".vdb", "-o",
                              "named.exr", "--layers", "all"}));
        const test::ImageFile in_sequence = test::read_exr(folder_ / ("all_0" + frame + ".exr"));
        EXPECT_EQ(in_sequence.channels, test::read_exr(folder_ / "named.exr").channels);
        EXPECT_EQ(in_sequence.metadata.at("uwvdb/frame"), frame);
        EXPECT_EQ(read("all_0" + frame + ".png").size() > 100, true);
    }
    EXPECT_NE(test::read_exr(folder_ / "all_01.exr").channels,
              test::read_exr(folder_ / "all_02.exr").channels);
}

TEST_F(Frames, KeepWhatDoesNotChange) {
    // A second volume that stays, and a mesh with a frame's number that the third frame changes.
    test::VdbFixture still = smoke(4);
    test::write_fixture(folder_ / "still.vdb", {still});
    for (int frame = 1; frame <= 3; ++frame)
        write(
            "wing" + std::to_string(frame) + ".obj",
            std::string("v -1 0 2\nv 0 0 2\nv 0 ") + (frame == 3 ? "1" : "0.5") + " 2\nf 1 2 3\n");
    write("smoke.yaml",
          std::string(test::k_small_scene) +
              "volumes:\n"
              "  - {file: smoke_%04d.vdb, grids: {density: {large: 2}}}\n"
              "  - {file: still.vdb, grids: {density: {small: 1}}, transform: {translate: [0.5, 0, "
              "0]}}\n");
    const std::string meshes = "geometry=[{file: 'wing{frame}.obj'}]";
    // Light that goes all around needs all of a shadow map.
    expect_done(sequence(
        {"--frames", "1-3", "--stats", "all.json", "--set", "lamps[0].profile={type: isotropic}"}));
    const nlohmann::json all = nlohmann::json::parse(read("all.json"));
    EXPECT_EQ(all.at("scene"), "smoke.yaml");
    ASSERT_EQ(all.at("frames").size(), 3U);
    EXPECT_GT(all.at("peak_memory_bytes"), 10'000'000);
    const auto figure = [&](int i, const char* of) { return all.at("frames").at(i).at(of); };
    EXPECT_EQ(figure(1, "frame"), 2);
    EXPECT_EQ(figure(1, "output"), "smoke.0002.exr");
    EXPECT_EQ(figure(1, "pixels"), 33 * 19);
    EXPECT_TRUE(figure(0, "seconds").contains("scene"));
    EXPECT_FALSE(figure(1, "seconds").contains("scene"));
    // 6 faces of 514^2 rays of the one lamp's shadow map are traced once.
    EXPECT_GT(figure(0, "splat_rays"), 6 * 514 * 514);
    EXPECT_LT(figure(1, "splat_rays"), 6 * 514 * 514);
    EXPECT_GT(figure(1, "splat_rays"), 0);

    expect_done(sequence(
        {"--frames", "1-3", "-o", "m{frame}.exr", "--set", meshes, "--stats", "m{frame}.json"}));
    for (const std::string frame : {"1", "2", "3"}) {
        const nlohmann::json one = nlohmann::json::parse(read("m" + frame + ".json"));
        EXPECT_EQ(one.at("frame"), std::stoi(frame));
        EXPECT_EQ(one.at("triangles"), 1);
        expect_done(sequence({"--frames", frame, "-o", "one.exr", "--set", meshes}));
        EXPECT_EQ(read("m" + frame + ".exr"), read("one.exr")) << frame;
    }
    EXPECT_NE(test::read_exr(folder_ / "m2.exr").channels.at("depth.Z"),
              test::read_exr(folder_ / "m3.exr").channels.at("depth.Z"));
}

TEST_F(Frames, ThatAreMissingAreNamedBeforeAnythingIsRendered) {
    write_smoke(7);
    expect_failure({"render", "smoke.yaml", "--frames", "1-9,20"}, 4,
                   "smoke.yaml:15:11: volumes[0].file: 'smoke_####.vdb' has no file for frames "
                   "4-6,8-9,20; choose --frames that exist");
    expect_failure({"render", "smoke.yaml", "--frames", "5"}, 4, "has no file for frame 5; ");
    std::filesystem::create_directory(folder_ / "smoke_0004.vdb");
    expect_failure({"render", "smoke.yaml", "--frames", "1-4"}, 4, "has no file for frame 4; ");
    EXPECT_EQ(file_count(), 7U);
}

TEST_F(Frames, ThatDoNotGoTogetherAreNamedBeforeAnythingIsRendered) {
    test::VdbFixture other = smoke(2);
    other.file_from_index = other.file_from_index * Affine::scale(Vector3(1.01));
    test::write_fixture(folder_ / name(2), {other});
    expect_failure({"render", "smoke.yaml", "--frames", "1-3"}, 3,
                   "smoke_0002.vdb' has voxels of 0.101 x 0.101 x 0.101");
    other = smoke(2);
    other.name = "dust";
    test::write_fixture(folder_ / name(2), {other});
    expect_failure({"render", "smoke.yaml", "--frames", "1-3"}, 3,
                   "no grid 'density' ('smoke_0002.vdb' has dust");
    write("smoke_0003.vdb", "broken");
    expect_failure({"render", "smoke.yaml", "--frames", "1,3"}, 3, "smoke_0003.vdb");
    EXPECT_EQ(file_count(), 5U);
}

TEST_F(Frames, HaveFoldersOfTheirOwn) {
    const test::ProgramResult result =
        run({"render", "smoke.yaml", "--frames", "1-2", "-o", "out/{frame}/a.exr"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(exists("out/1/a.exr"));
    EXPECT_TRUE(exists("out/2/a.png"));
}

TEST_F(Frames, NamesWithoutThemAreRefused) {
    expect_failure({"render", "smoke.yaml"}, 3,
                   "volumes[0].file: there is no 'smoke_####.vdb', and as the name of a sequence "
                   "it needs frames; render it with --frames 1-10, or name one file");
    expect_failure({"validate", "smoke.yaml"}, 3, "needs frames");
    expect_failure({"render", "smoke.yaml", "--frames", "1-2", "-o", "out.exr"}, 2,
                   "-o out.exr: all frames would be written to one file; put a placeholder for the "
                   "frame number in the name, such as out.####.exr");
    expect_failure({"render", "smoke.yaml", "--frames", "1-2", "--irradiance-vdb", "l.vdb"}, 2,
                   "--irradiance-vdb l.vdb: all frames would be");
    expect_failure({"render", "smoke.yaml", "--frames", "2-1"}, 2, "write 1-2");
    expect_failure({"render", "smoke.yaml", "--resume"}, 2, "give its --frames");
    expect_failure(
        {"render", "smoke.yaml", "--frames", "1-2", "--irradiance-vdb", "smoke_{frame:04d}.vdb"}, 2,
        "smoke_0001.vdb: --irradiance-vdb would replace a volume of the scene");
    EXPECT_EQ(file_count(), 5U);
}

TEST_F(Frames, NamesThatAreThereAreTakenAsTheyAreWritten) {
    std::filesystem::rename(folder_ / name(1), folder_ / "smoke_####.vdb");
    expect_done(sequence({"-o", "out.exr"}));
    const test::ProgramResult alike = sequence({"--frames", "1-2", "-o", "out#.exr"});
    expect_done(alike);
    EXPECT_NE(alike.err.find("warning: --frames: all frames are alike"), std::string::npos);
    EXPECT_EQ(test::read_exr(folder_ / "out1.exr").channels,
              test::read_exr(folder_ / "out.exr").channels);
    const test::ProgramResult literal = sequence({"-o", "C#.exr", "--size", "8x4"});
    expect_done(literal);
    EXPECT_TRUE(exists("C#.exr"));
    EXPECT_NE(literal.err.find("C#.exr: used as written"), std::string::npos);
}

TEST_F(Frames, WarningsAreGivenOnceAndProgressEachTime) {
    for (const int frame : {2, 3}) {
        test::VdbFixture empty = smoke(frame);
        empty.value = [](int, int, int) { return 0.0; };
        test::write_fixture(folder_ / name(frame), {empty});
    }
    const test::ProgramResult result =
        sequence({"--frames", "1-3", "--set", "lamps.left.intensity=0"});
    expect_done(result);
    const auto count = [&](const std::string& part) {
        int found = 0;
        for (std::size_t at = 0; (at = result.err.find(part, at)) != std::string::npos; ++at)
            ++found;
        return found;
    };
    EXPECT_EQ(count("warning: the image is black"), 1) << result.err;
    EXPECT_EQ(count("this lamp is dark"), 1) << result.err;
    EXPECT_EQ(count("warning: frame 2: "), 1) << result.err;
    EXPECT_EQ(count("smoke_0002.vdb"), 1) << result.err;
    EXPECT_EQ(count("warning: frame 3: "), 0) << result.err;
    EXPECT_EQ(count("optical depth through the middle along x"), 1);  // of the first frame
    EXPECT_EQ(count("wrote smoke.000"), 6);
    EXPECT_NE(result.err.find("frame 2 of 3: done in "), std::string::npos) << result.err;
    EXPECT_NE(result.err.find(" left\n"), std::string::npos);
}

TEST_F(Frames, ResumeRendersWhatIsMissingOrOfAnotherScene) {
    const std::vector<std::string> all{"--frames", "1-3", "-o", "out/{frame}.exr", "--resume"};
    const auto resumed = [&](std::vector<std::string> more) {
        more.insert(more.begin(), all.begin(), all.end());
        const test::ProgramResult result = sequence(more);
        expect_done(result);
        const std::size_t at = result.err.find("resume: ");
        if (at == std::string::npos) return std::string();
        return result.err.substr(at, result.err.find('\n', at) - at);
    };
    std::filesystem::create_directory(folder_ / "out");
    EXPECT_EQ(resumed({}), "");
    const std::string second = read("out/2.exr");
    EXPECT_EQ(resumed({}), "resume: frames 1-3 are there already, 0 left");
    std::filesystem::remove(folder_ / "out/2.exr");
    EXPECT_EQ(resumed({}), "resume: frames 1,3 are there already, 1 left");
    EXPECT_EQ(read("out/2.exr"), second);
    std::filesystem::remove(folder_ / "out/1.png");
    EXPECT_EQ(resumed({}), "resume: frames 2-3 are there already, 1 left");
    write("out/3.exr", second.substr(0, 100));  // not one of ours
    EXPECT_EQ(resumed({}), "resume: frames 1-2 are there already, 1 left");
    std::filesystem::copy_file(folder_ / "out/2.exr", folder_ / "out/1.exr",
                               std::filesystem::copy_options::overwrite_existing);
    EXPECT_EQ(resumed({}), "resume: frames 2-3 are there already, 1 left");

    // Whatever makes other pixels.
    for (const std::vector<std::string>& other :
         std::vector<std::vector<std::string>>{{"--samples", "2"},
                                               {"--size", "16x8"},
                                               {"--crop", "0,0,8,8"},
                                               {"--layers", "depth"},
                                               {"--layers", "direct"},
                                               {"--precision", "float"},
                                               {"--compression", "zips"},
                                               {"--integrator", "reference"},
                                               {"--set", "lamps.left.intensity=[1, 2, 3]"}}) {
        EXPECT_EQ(resumed(other), "") << other.front();
        EXPECT_EQ(resumed(other), "resume: frames 1-3 are there already, 0 left");
    }
    EXPECT_EQ(resumed({}), "");
    const auto later = std::filesystem::file_time_type::clock::now() + std::chrono::seconds(5);
    std::filesystem::last_write_time(folder_ / name(2), later);
    EXPECT_EQ(resumed({}), "resume: frames 1,3 are there already, 1 left");
    // What is there already needs no input.
    std::filesystem::remove(folder_ / name(1));
    EXPECT_NE(resumed({}).find("frames 1,3 are there"), std::string::npos);
}

// Written while the next is rendered: the fault is still that of the run.
TEST_F(Frames, ThatCannotBeWrittenEndTheRun) {
    const std::size_t files = file_count();
    test::ProgramResult result;
    test::limited(200, [&] { result = sequence({"--frames", "1-3", "--quiet"}); });
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_EQ(test::line_count(result.err), 1) << result.err;
    EXPECT_NE(result.err.find("smoke.0001.exr: cannot write: "), std::string::npos) << result.err;
    EXPECT_EQ(file_count(), files);
}

TEST_F(Frames, ThatAreDoneStayWhenInterrupted) {
    test::Program program({"render", "smoke.yaml", "--frames", "1-3", "--integrator", "reference",
                           "--size", "200x114", "--stats", "s.json"},
                          {.folder = folder_.path()});
    program.wait_for("frame 1 of 3: done in ");
    program.signal(SIGINT);
    const test::ProgramResult result = program.wait();
    EXPECT_EQ(result.exit_code, 130);
    EXPECT_TRUE(
        result.err.ends_with("uwvdb: interrupted; 1 of 3 frames is done; --resume continues\n"))
        << result.err;
    EXPECT_TRUE(exists("smoke.0001.exr"));
    EXPECT_FALSE(exists("smoke.0002.exr"));
    EXPECT_EQ(nlohmann::json::parse(read("s.json")).at("frames").size(), 1U);
    EXPECT_EQ(file_count(), 8U);
}

}  // namespace
}  // namespace uw
