// ctest labels: unit metamorphic slow
// A set is the same bytes however it is made: at once, in shards, on any number of threads, after
// being killed.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <map>
#include <thread>

#include "core/base/json.h"
#include "dataset/set_files.h"
#include "tests/support/dataset/dataset_scenes.h"
#include "tests/support/faults/failing_calls.h"
#include "tests/support/full_disk.h"

namespace uw {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_all_formats =
    "png,exr,depth,mask,ids,clean,npy,flow,kitti,colmap,nerfstudio,tum,euroc,calibration";

std::vector<std::string> all_formats_of(const std::string& folder) {
    return {"dataset", "moving.yaml", "-o", folder, "--format", k_all_formats, "--quiet"};
}

class DatasetCommand : public test::DatasetTest {
  protected:
    std::vector<std::string> command(const std::string& folder,
                                     const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments = all_formats_of(folder);
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }
    void expect_runs(const std::vector<std::string>& arguments) const {
        const test::ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(result.err, "");
    }
    /// The checksum of every file in a folder, by its name in it.
    std::map<std::string, std::string> sums(const std::string& folder) const {
        std::map<std::string, std::string> result;
        for (const auto& entry : fs::recursive_directory_iterator(folder_ / folder))
            if (entry.is_regular_file())
                result[fs::relative(entry.path(), folder_ / folder).string()] =
                    sha256_of_file(entry.path());
        return result;
    }
};

TEST_F(DatasetCommand, IsTheSameInShardsAndOnOneThread) {
    expect_runs(command("whole"));
    const auto whole = sums("whole");
    for (const char* file : {"README.md", "SHA256SUMS", "contact_sheet.png", "index.html",
                             "manifest.csv", "manifest.json", "images/000006.png"})
        EXPECT_TRUE(whole.contains(file)) << file;
    for (const char* shard : {"2/3", "3/3"})
        expect_runs(command("parts", {"--shard", shard, "--threads", "1"}));
    EXPECT_FALSE(exists("parts/SHA256SUMS"));
    expect_failure({"dataset", "--merge", "parts"}, 3, "2 of 7 views are missing");
    expect_runs(command("parts", {"--shard", "1/3", "--threads", "2"}));
    expect_runs({"dataset", "--merge", "parts", "--quiet"});
    EXPECT_EQ(sums("parts"), whole);
}

TEST_F(DatasetCommand, ShardsMayRunAtTheSameTime) {
    expect_runs(command("whole", {"--frames", "0-3"}));
    {
        test::Program first(command("parts", {"--frames", "0-3", "--shard", "1/2"}),
                            {.folder = folder_.path()});
        test::Program second(command("parts", {"--frames", "0-3", "--shard", "2/2"}),
                             {.folder = folder_.path()});
        EXPECT_EQ(first.wait().exit_code, 0);
        EXPECT_EQ(second.wait().exit_code, 0);
    }
    expect_runs({"dataset", "--merge", "parts", "--quiet"});
    EXPECT_EQ(sums("parts"), sums("whole"));
}

// Both find the folder empty and measure an exposure before either has written what the set is.
TEST_F(DatasetCommand, OfTwoSetsBegunInOneFolderOneIsMade) {
    const std::vector<std::string> frames{"--frames", "0-3"},
        other_frames{"--frames", "0-3", "--samples", "2"};
    expect_runs(command("one", frames));
    expect_runs(command("other", other_frames));
    std::map<int, int> codes;
    {
        test::Program first(command("both", frames), {.folder = folder_.path()});
        test::Program second(command("both", other_frames), {.folder = folder_.path()});
        ++codes[first.wait().exit_code];
        ++codes[second.wait().exit_code];
    }
    EXPECT_EQ(codes, (std::map<int, int>{{0, 1}, {2, 1}}));
    const auto made = sums("both");
    EXPECT_TRUE(made == sums("one") || made == sums("other"));
}

TEST_F(DatasetCommand, ShardsMayBeMoreThanFrames) {
    expect_runs(command("whole", {"--frames", "0-1"}));
    for (const char* shard : {"1/4", "2/4", "3/4", "4/4"})
        expect_runs(command("parts", {"--frames", "0-1", "--shard", shard}));
    expect_runs({"dataset", "--merge", "parts", "--quiet"});
    EXPECT_EQ(sums("parts"), sums("whole"));
}

TEST_F(DatasetCommand, IsTheSameAfterBeingKilled) {
    expect_runs(command("whole"));
    int killed = 0;
    for (int i = 0; i < 20; ++i) {
        test::Program program(command("killed"), {.folder = folder_.path()});
        std::this_thread::sleep_for(std::chrono::milliseconds(20 * (i + 1)));
        program.signal(SIGKILL);
        if (program.wait().exit_code != 0) ++killed;
    }
    EXPECT_GT(killed, 0);
    expect_runs(command("killed"));
    EXPECT_EQ(sums("killed"), sums("whole"));
}

class StoppedDataset : public test::FailingCallsTest {
  protected:
    StoppedDataset() { write("moving.yaml", test::k_moving_scene); }
};

TEST_F(StoppedDataset, IsContinued) {
    const std::vector<std::string> arguments = all_formats_of("set");
    // Ctrl-C as a later and later write begins, until the first view is whole by then. The views
    // take as many writes each, so that a third more of them never leads to the last.
    Outcome stopped;
    for (int n = 1; !exists("set/views/000000.json"); n += 1 + n / 3) {
        fs::remove_all(folder_ / "set");
        stopped = run_with("stop:" + std::to_string(n), arguments);
        ASSERT_TRUE(stopped.has_failed) << n;
    }
    EXPECT_EQ(stopped.result.exit_code, 130);
    EXPECT_EQ(test::line_count(stopped.result.err), 1) << stopped.result.err;
    EXPECT_TRUE(stopped.result.err.find(" of 7 views is done; the same command continues") !=
                    std::string::npos ||
                stopped.result.err.find(" of 7 views are done; the same command continues") !=
                    std::string::npos)
        << stopped.result.err;
    EXPECT_FALSE(exists("set/SHA256SUMS"));
    const auto kept = fs::last_write_time(folder_ / "set/views/000000.json");
    const test::ProgramResult continued = run(arguments);
    EXPECT_EQ(continued.exit_code, 0) << continued.err;
    EXPECT_EQ(continued.err, "");
    EXPECT_EQ(fs::last_write_time(folder_ / "set/views/000000.json"), kept);
    EXPECT_TRUE(exists("set/SHA256SUMS"));
}

TEST_F(DatasetCommand, RepairsWhatIsDamagedAndKeepsTheRest) {
    expect_runs(command("set"));
    const auto whole = sums("set");
    const auto kept = fs::last_write_time(folder_ / "set/images/000000.png");
    write("set/masks/000002.png", "x");
    fs::remove(folder_ / "set/flow/000003.flo");
    expect_failure({"dataset", "--merge", "set"}, 3, "2 of 7 views are missing or damaged");
    expect_runs(command("set"));
    EXPECT_EQ(sums("set"), whole);
    EXPECT_EQ(fs::last_write_time(folder_ / "set/images/000000.png"), kept);
}

constexpr const char* k_far_wall = "v -1 -1 3\nv 1 -1 3\nv 0 1 3\nf 1 2 3\n";
constexpr const char* k_near_wall = "v -1 -1 2\nv 1 -1 2\nv 0 1 2\nf 1 2 3\n";

TEST_F(DatasetCommand, RendersAgainWhatWasMadeOfOtherFiles) {
    write("wall.obj", k_far_wall);
    const std::vector<std::string> arguments =
        command("set", {"--set", "geometry=[{file: wall.obj}]", "--frames", "0-1"});
    expect_runs(arguments);
    const auto far = sums("set");
    write("wall.obj", k_near_wall);
    // However old it is said to be.
    fs::last_write_time(folder_ / "wall.obj",
                        fs::file_time_type::clock::now() - std::chrono::hours(1));
    expect_runs(arguments);
    EXPECT_NE(sums("set").at("depth/000000.png"), far.at("depth/000000.png"));
    // The same again, and only later: nothing has changed.
    write("wall.obj", k_far_wall);
    expect_runs(arguments);
    EXPECT_EQ(sums("set"), far);
    const auto kept = fs::last_write_time(folder_ / "set/views/000000.json");
    fs::last_write_time(folder_ / "wall.obj",
                        fs::file_time_type::clock::now() + std::chrono::seconds(5));
    expect_runs(arguments);
    EXPECT_EQ(fs::last_write_time(folder_ / "set/views/000000.json"), kept);
}

// As machines have it whose copies of the scene differ.
TEST_F(DatasetCommand, MergesNoShardsOfDifferentFiles) {
    const auto shard = [&](const std::string& number) {
        return command("set", {"--set", "geometry=[{file: wall.obj}]", "--frames", "0-3",
                               "--exposure", "1", "--shard", number});
    };
    write("wall.obj", k_near_wall);
    expect_runs(shard("1/2"));
    write("wall.obj", k_far_wall);
    expect_runs(shard("2/2"));
    expect_failure({"dataset", "--merge", "set"}, 3,
                   "000002 was rendered from another version of wall.obj");
    EXPECT_FALSE(exists("set/SHA256SUMS"));
    expect_runs(shard("1/2"));
    expect_runs({"dataset", "--merge", "set", "--quiet"});
    expect_runs(command(
        "whole", {"--set", "geometry=[{file: wall.obj}]", "--frames", "0-3", "--exposure", "1"}));
    auto merged = sums("set"), whole = sums("whole");
    // The light that is left out was looked at when the set was begun, before the other wall.
    for (const char* file : {"dataset.json", "README.md", "SHA256SUMS"}) {
        merged.erase(file);
        whole.erase(file);
    }
    EXPECT_EQ(merged, whole);
}

// Textures and what else a mesh names count as the mesh does; a comment in the scene changes
// nothing.
TEST_F(DatasetCommand, RecordsWhatAViewWasRenderedFrom) {
    write("wall.obj", "mtllib wall.mtl\nusemtl paint\n" + std::string(k_far_wall));
    write("wall.mtl", "newmtl paint\nKd 0.5 0.4 0.3\n");
    const std::vector<std::string> arguments =
        command("set", {"--set", "geometry=[{file: wall.obj}]", "--frames", "0-1"});
    expect_runs(arguments);
    const auto inputs = [&] { return Json::parse(read("set/views/000000.json")).at("inputs"); };
    EXPECT_EQ(inputs(), (Json{{"wall.mtl", sha256_of(read("wall.mtl"))},
                              {"wall.obj", sha256_of(read("wall.obj"))}}));
    const auto kept = fs::last_write_time(folder_ / "set/views/000000.json");
    write("moving.yaml", "# Mine.\n" + read("moving.yaml"));
    expect_runs(arguments);
    EXPECT_EQ(fs::last_write_time(folder_ / "set/views/000000.json"), kept);
    write("wall.mtl", "newmtl paint\nKd 0.5 0.4 0.2\n");
    expect_runs(arguments);
    EXPECT_EQ(inputs().at("wall.mtl"), sha256_of(read("wall.mtl")));
}

TEST_F(DatasetCommand, RefusesAFolderOfSomethingElse) {
    fs::create_directory(folder_ / "mine");
    write("mine/notes.txt", "keep me");
    expect_failure(command("mine"), 2, "the folder has other files");
    EXPECT_EQ(read("mine/notes.txt"), "keep me");
    expect_runs(command("set", {"--frames", "0-1"}));
    const auto before = sums("set");
    expect_failure(command("set", {"--frames", "0-2"}), 2, "its frames are 0-1 there, 0-2 here");
    expect_failure(command("set", {"--frames", "0-1", "--set", "render.samples=2"}), 2,
                   "its scene_hash is ");
    expect_failure(command("set", {"--frames", "0-1", "--size", "20x15"}), 2,
                   "its size is not given there, 20x15 here");
    EXPECT_EQ(sums("set"), before);
    // The scene itself is in the folder that would be written to.
    expect_failure(command("."), 2, "the folder has other files");
}

TEST_F(DatasetCommand, ChecksumsAreThoseOfSha256sum) {
    expect_runs(command("set", {"--frames", "0-1"}));
    const std::string check =
        "cd '" + (folder_ / "set").string() + "' && sha256sum --quiet -c SHA256SUMS";
    EXPECT_EQ(std::system(check.c_str()), 0);
    // Every file but the list itself is in it.
    EXPECT_EQ(static_cast<std::size_t>(test::line_count(read("set/SHA256SUMS"))),
              sums("set").size() - 1);
}

TEST_F(DatasetCommand, RefusesWhatMakesNoSense) {
    expect_failure({"dataset", "moving.yaml", "--format", "tun"}, 2, "did you mean 'tum'?");
    expect_failure({"dataset", "moving.yaml", "--shard", "4/3"}, 2, "1 <= I <= N");
    expect_failure({"dataset", "moving.yaml", "--merge", "set"}, 2, "--merge takes everything");
    expect_failure({"dataset", "--merge", "set"}, 4, "no data set is there");
    expect_failure({"dataset"}, 2, "SCENE: is missing");
    expect_failure({"dataset", "scene.yaml", "--format", "flow"}, 2, "the set has no frames");
    expect_failure({"dataset", "scene.yaml", "--format", "kitti"}, 2, "neither pairs of frames");
    expect_failure({"dataset", "scene.yaml", "--format", "disparity"}, 2, "a rig of two cameras");
    expect_failure({"dataset", "moving.yaml", "--layers", "normal"}, 2, "are those of exr and npy");
    expect_failure({"dataset", "moving.yaml", "--cameras", "left"}, 2, "which has no name");
    expect_failure(
        {"dataset", "moving.yaml", "--set", "camera.line_time=1e-5", "--format", "colmap"}, 2,
        "images have one pose each");
}

TEST_F(DatasetCommand, AFullDiskIsOneMessage) {
    test::limited(3000, [&] {
        expect_failure({"dataset", "moving.yaml", "-o", "set", "--format", "npy", "--quiet"}, 4,
                       "cannot write");
    });
    expect_runs({"dataset", "moving.yaml", "-o", "set", "--format", "npy", "--quiet"});
}

TEST_F(DatasetCommand, RefusesDepthsThat16BitsCannotHold) {
    expect_failure({"dataset", "scene.yaml", "-o", "set", "--format", "depth", "--depth-scale",
                    "20000", "--quiet"},
                   3, "do not fit into 16 bits at 20000 per metre");
    fs::remove_all(folder_ / "set");
    expect_runs({"dataset", "scene.yaml", "-o", "set", "--format", "depth", "--depth-scale",
                 "20000", "--depth-far", "3", "--quiet"});
}

}  // namespace
}  // namespace uw
