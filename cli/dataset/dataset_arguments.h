#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/render/render_arguments.h"

namespace uw {

/// Part `number` of `count`, from 1.
struct ShardArgument {
    std::size_t number = 1, count = 1;
};

/// `uwvdb dataset` as typed.
struct DatasetArguments {
    /// What is rendered, as `uwvdb render` takes it: scene, overrides, frames, size, quality,
    /// samples, threads. `output` is the set's folder, `layers` those of EXR and NumPy.
    RenderArguments image;
    std::string frames;                  // --frames as typed
    std::vector<std::string> formats;    // --format; empty: png and depth
    std::vector<std::string> cameras;    // --cameras; empty: all of a rig
    std::optional<double> exposure;      // --exposure; none: automatic
    std::optional<double> depth_scale;   // --depth-scale
    std::optional<double> depth_far;     // --depth-far
    std::string licence;                 // --licence
    std::optional<ShardArgument> shard;  // --shard
    std::optional<int> slurm_tasks;      // --slurm: of the array job; none: render here
    std::string slurm_options;           // --slurm-options
    bool slurm_dry_run = false;          // --slurm-dry-run
    std::filesystem::path merge;         // --merge: the folder to complete; empty: none
};

}  // namespace uw
