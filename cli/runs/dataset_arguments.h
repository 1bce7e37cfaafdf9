#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/render/render_arguments.h"
#include "core/scene/scene_desc.h"
#include "dataset/definition.h"

namespace uw {

/// Part `number` of `count`, from 1.
struct ShardArgument {
    std::size_t number = 1, count = 1;
};

/// `uwvdb dataset` as typed.
struct DatasetArguments {
    /// The arguments shared with `uwvdb render`: scene, overrides, frames, size, quality, samples,
    /// threads. `output` is the set's folder, `layers` those of EXR and NumPy.
    RenderArguments image;
    std::string frames;                  // --frames as typed
    std::vector<std::string> formats;    // --format; empty: png and depth
    std::vector<std::string> cameras;    // --cameras; empty: all of a rig
    std::optional<double> exposure;      // --exposure; none: automatic
    std::optional<double> depth_scale;   // --depth-scale
    std::optional<double> depth_far;     // --depth-far
    bool pinhole_fit = false;            // --pinhole-fit
    std::string licence;                 // --licence
    std::optional<ShardArgument> shard;  // --shard
    std::optional<int> slurm_tasks;      // --slurm: of the array job; none: render here
    std::string slurm_options;           // --slurm-options
    bool slurm_dry_run = false;          // --slurm-dry-run
    std::filesystem::path merge;         // --merge: the folder to complete; empty: none
};

/// The options of `uwvdb dataset`.
Options dataset_options(DatasetArguments& arguments);

/// What its --help ends with: examples, the formats, exit codes.
std::string dataset_examples();

/// The values of each draw, as `--set` takes them: those of the variations of the set, or none of
/// one draw. With `check` the scenes of all draws are read. Throws as RunScenes.
std::vector<std::vector<std::string>> draws_of(const DatasetArguments& arguments, bool check);

/// The set that the arguments request, without its draws. `scene`: of its first draw. Throws
/// UsageError.
DatasetDefinition definition_of(const DatasetArguments& arguments, const SceneDesc& scene);

/// `text` as a shell reads it: in quotes if it has anything but plain characters.
std::string shell_word(const std::string& text);

/// The options that define the set, in a canonical spelling, each after a blank: without those that
/// do not change it (folder, shard and threads).
std::string set_options(const DatasetArguments& arguments, const DatasetDefinition& definition);

/// The scene of a draw, as the arguments ask for it. Throws as load_scene.
SceneDesc scene_of_draw(const DatasetArguments& arguments,
                        const std::vector<std::string>& overrides);

}  // namespace uw
