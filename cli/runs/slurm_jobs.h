#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace uw {

/// The cost of rendering a data set, measured on its first moments; a moment is all cameras of one
/// frame of one draw.
struct MeasuredWork {
    double first_seconds = 0;        // from the start of the program to the first moment's end
    double next_seconds = 0;         // of another moment
    std::uint64_t memory_bytes = 0;  // the largest that was resident
    std::uint64_t moment_bytes = 0;  // written for a moment
    int threads = 1;                 // that were used
};

/// A data set as an array job of Slurm.
struct SlurmRequest {
    std::string name;               // of the set
    std::string command;            // of a task but for its shard and threads, as a shell reads it
    std::string merge_command;      // of the last job
    std::filesystem::path folder;   // the set's, absolute
    std::filesystem::path working;  // where the commands run
    std::string options;            // further ones of sbatch
    int tasks = 1;
    std::size_t moments = 1;  // of the set
    MeasuredWork measured;
};

/// The resources requested: `k_time_margin` and `k_memory_margin` times those measured, rounded up.
inline constexpr double k_time_margin = 3;
inline constexpr double k_memory_margin = 1.5;
int task_minutes(const SlurmRequest& request);
int task_megabytes(const SlurmRequest& request);
int merge_minutes(const SlurmRequest& request);

/// The batch scripts of a task and of the job that merges and checks, and the shell script that
/// submits both.
std::string task_script(const SlurmRequest& request);
std::string merge_script(const SlurmRequest& request);
std::string submit_script(const SlurmRequest& request);

/// The folder of these scripts and the jobs' messages: beside the set, not part of it.
std::filesystem::path jobs_folder(const std::filesystem::path& set);

/// Writes the three scripts. Throws IoError.
void write_jobs(const SlurmRequest& request);

/// Submits the jobs by the script written; returns what it printed. Throws IoError where sbatch
/// cannot be run or refuses.
std::string submit_jobs(const SlurmRequest& request);

}  // namespace uw
