#include "cli/runs/slurm_jobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "cli/console.h"
#include "cli/runs/dataset_arguments.h"
#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

namespace {

namespace fs = std::filesystem;

constexpr int k_min_minutes = 10;  // of a job: nodes differ, and file systems wait
constexpr int k_min_megabytes = 500;
constexpr double k_bytes_per_s = 20e6;  // that a merging job reads and checks at least
constexpr int k_max_restarts = 20;      // of a task that was killed

int whole_minutes(double seconds) {
    return std::max(k_min_minutes, static_cast<int>(std::ceil(k_time_margin * seconds / 60)));
}

/// "0-01:40:00".
std::string time_limit(int minutes) {
    return fmt::format("{}-{:02}:{:02}:00", minutes / 1440, minutes / 60 % 24, minutes % 60);
}

std::string directives(const SlurmRequest& r, const std::string& suffix, int minutes,
                       const std::string& log) {
    // A % in a name would be a placeholder in the names of logs.
    std::string folder = jobs_folder(r.folder).string();
    for (std::size_t at = 0; (at = folder.find('%', at)) != std::string::npos; at += 2)
        folder.insert(at, "%");
    std::string text = "#!/bin/bash\n";
    const auto add = [&](const std::string& option) { text += "#SBATCH " + option + "\n"; };
    add("--job-name=" + shell_word("uwvdb-" + r.name + suffix));
    add("--chdir=" + shell_word(r.working.string()));
    add("--output=" + shell_word(folder + "/" + log));
    add("--open-mode=append");
    add("--requeue");
    add("--nodes=1 --ntasks=1");
    add(fmt::format("--cpus-per-task={}", r.measured.threads));
    add(fmt::format("--mem={}M", task_megabytes(r)));
    add("--time=" + time_limit(minutes));
    std::istringstream options(r.options);
    for (std::string option; options >> option;) add(option);
    return text;
}

/// Runs a command, and puts the job back into the queue if it was killed or told to stop: what it
/// has written is kept, and found when it runs again.
std::string restarting(const std::string& command) {
    return fmt::format(R"({}
status=$?
# Killed (128 + the signal), or told to stop: again, from where it was.
if [ "$status" -ge 128 ] && [ "${{SLURM_RESTART_COUNT:-0}}" -lt {} ]; then
    scontrol requeue "$SLURM_JOB_ID" && sleep 60
fi
exit "$status"
)",
                       command, k_max_restarts);
}

}  // namespace

fs::path jobs_folder(const fs::path& set) {
    return set.string() + "-slurm";
}

int task_minutes(const SlurmRequest& r) {
    const auto tasks = static_cast<std::size_t>(r.tasks);
    const std::size_t most = (r.moments + tasks - 1) / tasks;
    return whole_minutes(r.measured.first_seconds +
                         static_cast<double>(most - 1) * r.measured.next_seconds);
}

int task_megabytes(const SlurmRequest& r) {
    const double wanted = k_memory_margin * static_cast<double>(r.measured.memory_bytes) / 1048576;
    return std::max(k_min_megabytes, static_cast<int>(std::ceil(wanted / 100)) * 100);
}

int merge_minutes(const SlurmRequest& r) {
    // Read twice: by the program and by sha256sum.
    return whole_minutes(2 * static_cast<double>(r.moments) *
                         static_cast<double>(r.measured.moment_bytes) / k_bytes_per_s);
}

std::string task_script(const SlurmRequest& r) {
    const MeasuredWork& m = r.measured;
    return directives(r, "", task_minutes(r), "%a.log") +
           fmt::format(
               "#SBATCH --array=1-{}\n"
               "# Measured on {}: {:.3g} s to the end of the first moment (all "
               "cameras of a frame), {:.3g} s for\n"
               "# another, {:.0f} MB. At most {} of {} in a task. Asked for: {:g} times that time, "
               "at\n"
               "# least {} minutes, and {:g} times that memory, at least {} MB.\n",
               r.tasks, counted(static_cast<std::size_t>(m.threads), "thread"), m.first_seconds,
               m.next_seconds, static_cast<double>(m.memory_bytes) / 1048576,
               (r.moments + static_cast<std::size_t>(r.tasks) - 1) /
                   static_cast<std::size_t>(r.tasks),
               counted(r.moments, "moment"), k_time_margin, k_min_minutes, k_memory_margin,
               k_min_megabytes) +
           restarting(fmt::format("{} --quiet --threads {} --shard \"$SLURM_ARRAY_TASK_ID/{}\"",
                                  r.command, m.threads, r.tasks));
}

std::string merge_script(const SlurmRequest& r) {
    return directives(r, "-merge", merge_minutes(r), "merge.log") +
           restarting(
               fmt::format("{} --quiet &&\n    (cd {} && sha256sum --check --quiet SHA256SUMS)",
                           r.merge_command, shell_word(r.folder.string())));
}

std::string submit_script(const SlurmRequest& r) {
    const std::string folder = jobs_folder(r.folder).string();
    return fmt::format(R"(#!/bin/sh
# Submits the tasks, and after all of them the job that merges and checks.
set -e
tasks=$(sbatch --parsable {})
merge=$(sbatch --parsable --dependency="afterok:${{tasks%%;*}}" --kill-on-invalid-dep=yes {}) || {{
    scancel "${{tasks%%;*}}"
    exit 1
}}
echo "submitted job ${{tasks%%;*}} of {}, and ${{merge%%;*}}, which merges and checks"
)",
                       shell_word(folder + "/tasks.sh"), shell_word(folder + "/merge.sh"),
                       counted(static_cast<std::size_t>(r.tasks), "task"));
}

void write_jobs(const SlurmRequest& r) {
    const fs::path folder = jobs_folder(r.folder);
    TextFiles files;
    files.add(folder / "tasks.sh", task_script(r));
    files.add(folder / "merge.sh", merge_script(r));
    files.add(folder / "submit.sh", submit_script(r));
    files.commit(true);
}

std::string submit_jobs(const SlurmRequest& r) {
    const std::string script = (jobs_folder(r.folder) / "submit.sh").string();
    const std::string command = "sh " + shell_word(script) + " 2>&1";
    FILE* const pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) throw IoError(fmt::format("{}: cannot be run", printable(script, 300)));
    std::string output;
    std::array<char, 512> part{};
    while (fgets(part.data(), static_cast<int>(part.size()), pipe) != nullptr)
        output += part.data();
    while (!output.empty() && output.back() == '\n') output.pop_back();
    const int status = pclose(pipe);
    if (status != 0)
        throw IoError(fmt::format("{}: {}; run it where jobs can be submitted",
                                  printable(script, 300), printable(output, 300)));
    return output;
}

}  // namespace uw
