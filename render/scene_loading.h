#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/scene_context.h"
#include "core/scene/scene_desc.h"
#include "core/scene/variations.h"
#include "core/scene/yaml_document.h"

namespace uw {

/// Reads a scene with its overrides (core/scene/scene_desc.h), and the files of calibrations and
/// poses that it names, whose content is part of the scene's hash. The scene's variations are
/// checked, but not applied. Throws as read_scene, read_calibration, load_trajectory and
/// read_variations.
SceneDesc load_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides);

/// The same for the text of a scene (read_scene_text).
SceneDesc load_scene_text(std::string_view text, const std::filesystem::path& file);

/// The same for a scene's tree (scene_of_tree) whose variations have been read.
SceneDesc load_scene_tree(const ConfigNode& tree, const std::filesystem::path& file,
                          const SceneArrays* arrays = nullptr);

/// A scene with drawn values, as a tree and as the description read from it.
struct VariedScene {
    ConfigNode tree;
    SceneDesc desc;
};

/// The scenes that the section `variations` of a scene describes. Each is the scene with the drawn
/// values set as by --set, and has the same images.
class SceneVariations {
  public:
    /// Reads the scene file with its overrides. Throws as read_scene_tree and read_variations, and
    /// UsageError for an override of a drawn value.
    SceneVariations(const std::filesystem::path& file, const std::vector<std::string>& overrides);
    /// Reads the variations of a scene's tree. Throws as read_variations.
    SceneVariations(ConfigNode tree, std::filesystem::path file);

    /// The section; none if the scene has none.
    const std::optional<VariationsDesc>& desc() const { return desc_; }

    /// The values of one variation, and its scene. Throws InputError if the scene with these values
    /// is invalid, whose message names the variation and the value. Throws as load_scene.
    std::vector<DrawnValue> values(int variation) const { return draw(*desc_, variation); }
    SceneDesc scene(int variation) const { return varied(variation).desc; }
    /// The same with its tree, for a scene that refers to `arrays`.
    VariedScene varied(int variation, const SceneArrays* arrays = nullptr) const;

  private:
    std::filesystem::path file_;
    ConfigNode tree_;
    std::optional<VariationsDesc> desc_;
};

/// Settings of rendering that replace those of a scene: the command line's options of these names.
struct ImageRequest {
    std::string quality;     ///< empty: the scene's
    std::string integrator;  ///< likewise
    std::optional<int> samples;
    std::optional<double> error;             ///< replaces the number of samples
    std::optional<std::array<int, 2>> size;  ///< width, height [pixels]
};

/// Applies the settings of `request` to a scene. Drafts have the number of samples of the
/// integrator's drafts, unless another is requested. Throws UsageError, which names the option.
void apply_request(const ImageRequest& request, SceneDesc& scene);

/// A file that a scene is read from.
struct InputFile {
    std::filesystem::path file;
    std::string_view what;  // for messages: "a volume of the scene"
    /// Whether its content is part of SceneDesc::hash, which then shows a change without the file's
    /// date.
    bool is_hashed = false;
};

/// The files to which meshes, volumes and OpenColorIO configs refer, by the referring file; looked
/// up once for many frames.
using SideFiles = std::map<std::filesystem::path, std::vector<std::filesystem::path>>;

/// Returns every file from which an image of a scene is read, the scene file first. These are the
/// files that the scene's keys name (SceneDesc::files), and those to which these refer. Sequences
/// without a frame are listed by their own names. A file that serves two purposes is listed twice.
/// Missing or broken files are not an error. `known` is a cache of the files that others refer to.
/// Throws InputError for a frame that a trajectory does not have.
std::vector<InputFile> input_files(const SceneDesc& whole, const ImageChoice& choice,
                                   SideFiles& known);

}  // namespace uw
