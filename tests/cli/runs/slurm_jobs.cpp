// ctest labels: unit
#include "cli/runs/slurm_jobs.h"

#include <gtest/gtest.h>

#include "tests/support/cli_test.h"

namespace uw {
namespace {

SlurmRequest request() {
    SlurmRequest r;
    r.name = "dive";
    r.command = "/usr/bin/uwvdb dataset /s/dive.yaml -o /s/dive";
    r.merge_command = "/usr/bin/uwvdb dataset --merge /s/dive";
    r.folder = "/s/dive";
    r.working = "/home/me";
    r.options = "--partition=long  --account=reef";
    r.tasks = 8;
    r.moments = 1001;
    r.measured = {30, 10, 700 * 1048576ULL, 1'000'000, 4};
    return r;
}

bool has_line(const std::string& text, const std::string& line) {
    return ("\n" + text).find("\n" + line + "\n") != std::string::npos;
}

TEST(SlurmJobs, AskForWhatWasMeasuredWithTheMargin) {
    // 1001 moments in 8 tasks: at most 126. 3 (30 s + 125 * 10 s) = 64 minutes; 1.5 * 700 MB, in
    // hundreds; the set is read twice, at 20 MB/s: 3 * 100.1 s, which is less than 10 minutes.
    EXPECT_EQ(task_minutes(request()), 64);
    EXPECT_EQ(task_megabytes(request()), 1100);
    EXPECT_EQ(merge_minutes(request()), 10);
    const std::string task = task_script(request());
    for (const char* line :
         {"#SBATCH --time=0-01:04:00", "#SBATCH --mem=1100M", "#SBATCH --cpus-per-task=4",
          "#SBATCH --array=1-8", "#SBATCH --requeue", "#SBATCH --partition=long",
          "#SBATCH --account=reef", "#SBATCH --output=/s/dive-slurm/%a.log"})
        EXPECT_TRUE(has_line(task, line)) << line << "\n" << task;
    EXPECT_TRUE(has_line(task,
                         "/usr/bin/uwvdb dataset /s/dive.yaml -o /s/dive --quiet --threads 4 "
                         "--shard \"$SLURM_ARRAY_TASK_ID/8\""))
        << task;
}

TEST(SlurmJobs, NamesAreWrittenAsShellAndSlurmReadThem) {
    SlurmRequest r = request();
    r.folder = "/s/it's 5% done";
    EXPECT_TRUE(has_line(task_script(r), "#SBATCH --output='/s/it'\\''s 5%% done-slurm/%a.log'"))
        << task_script(r);
    EXPECT_NE(submit_script(r).find("'/s/it'\\''s 5% done-slurm/tasks.sh'"), std::string::npos);
}

using SlurmDryRun = test::CliTest;

TEST_F(SlurmDryRun, BeginsTheSetAndWritesTheJobs) {
    const test::ProgramResult result = run({"dataset", "scene.yaml", "-o", "set", "--threads", "1",
                                            "--slurm", "3", "--slurm-dry-run"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(exists("set/dataset.json"));
    EXPECT_FALSE(exists("set/SHA256SUMS"));
    for (const char* name : {"set-slurm/tasks.sh", "set-slurm/merge.sh", "set-slurm/submit.sh"})
        EXPECT_TRUE(exists(name)) << name;
    expect_failure({"dataset", "scene.yaml", "--slurm-dry-run"}, 2, "--slurm");
    expect_failure({"dataset", "scene.yaml", "--slurm", "3", "--shard", "1/3"}, 2,
                   "--shard: the tasks of --slurm render all of them; leave it out");
}

TEST_F(SlurmDryRun, VariationsAreDrawsOfTheSet) {
    write("varied.yaml", std::string(test::k_small_scene) +
                             "variations: {keys: {lamps.left.intensity: {uniform: [10, 90]}}}\n");
    const test::ProgramResult result = run(
        {"dataset", "varied.yaml", "-o", "set", "--variations", "2", "--format", "exr", "--quiet"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const std::string manifest = read("set/manifest.csv");
    EXPECT_NE(manifest.find(",record,image,lamps.left.intensity\n"), std::string::npos) << manifest;
    const test::ProgramResult again =
        run({"render", "varied.yaml", "--variations", "2", "--quiet"});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    for (const char* number : {"0", "1"}) {
        const test::ImageFile of_set =
            test::read_exr(folder_ / (std::string("set/draw_0000") + number + "/exr/000000.exr"));
        const test::ImageFile alone =
            test::read_exr(folder_ / (std::string("varied.v000") + number + ".exr"));
        for (const char* channel : {"R", "G", "B"})  // half floats there, if they suffice
            for (std::size_t i = 0; i < alone.channels.at(channel).size(); ++i)
                ASSERT_NEAR(of_set.channels.at(channel)[i], alone.channels.at(channel)[i],
                            1e-3F * alone.channels.at(channel)[i]);
    }
}

}  // namespace
}  // namespace uw
