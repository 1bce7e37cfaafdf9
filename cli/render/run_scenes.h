#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/render/frame_sequence.h"
#include "cli/render/render_arguments.h"
#include "core/scene/variations.h"
#include "render/run/job.h"
#include "render/scene_loading.h"

namespace uw {

/// The scenes of a run as the arguments request them: the scene itself, or its variations.
class RunScenes {
  public:
    /// Reads the scene, or what its variations draw. Throws as load_scene and SceneVariations;
    /// UsageError for a scene without variations, or one that is not among the set.
    explicit RunScenes(const RenderArguments& arguments);
    ~RunScenes() = default;
    RunScenes(const RunScenes&) = delete;
    RunScenes& operator=(const RunScenes&) = delete;
    RunScenes(RunScenes&&) = delete;
    RunScenes& operator=(RunScenes&&) = delete;

    /// The variations of the whole set, if one is requested, else those to render: in the order of
    /// their images. One that is none: the scene itself.
    const std::vector<std::optional<int>>& all() const { return all_; }
    /// Whether a variation of the set is to be rendered.
    bool is_wanted(std::optional<int> variation) const;

    /// These scenes with the arguments applied, by the numbers of the variations; the scene itself
    /// has the number 0. They throw as load_scene and SceneVariations::scene; UsageError for
    /// arguments that do not suit them.
    JobScenes& job() { return job_; }
    const SceneDesc& of(std::optional<int> variation) { return job_.of(variation.value_or(0)); }

    /// Only of variations.
    const SceneVariations& variations() const { return *variations_; }

  private:
    const RenderArguments& arguments_;
    std::optional<SceneVariations> variations_;
    std::vector<std::optional<int>> all_;
    JobScenes job_;
};

/// The manifest of a whole set: the values that its variations drew, and their images, as
/// SCENE.variations.csv, a row per image, and SCENE.variations.json, beside the images
/// (docs/command-line.md). It covers the whole set, whichever part is rendered, so that runs that
/// share a set write the same.
class VariationManifest {
  public:
    /// Writes nothing unless a whole set is requested. Refers to the arguments.
    explicit VariationManifest(const RenderArguments& arguments);

    /// Adds one of these variations: its scene's hash and its images.
    void add(int variation, const VariationsDesc& variations, std::string hash,
             const FrameSequence& images);

    /// Enters the manifest's files in the sequence, to be checked with the others.
    void name_files(FrameSequence& sequence) const;

    /// Writes both files, if there are to be any. Throws IoError.
    void write(bool quiet) const;

  private:
    struct Image {
        std::string file;  // relative to the manifest
        std::optional<int> frame;
        std::string camera;
    };
    struct Entry {
        int variation;
        std::vector<DrawnValue> values;
        std::string hash;
        std::vector<Image> images;
    };

    std::string csv() const;
    std::string json() const;

    const RenderArguments& arguments_;
    std::uint64_t seed_ = 0;
    std::filesystem::path csv_file_, json_file_;  // empty: none
    std::vector<Entry> entries_;
};

}  // namespace uw
