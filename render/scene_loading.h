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

/// Reads a scene with its overrides (core/scene/scene_desc.h), and the files of calibrations
/// and poses that it names, whose content is part of the scene's hash. Throws as read_scene,
/// read_calibration and load_trajectory do, and as read_variations: what the scene's variations
/// draw changes nothing here, but is checked.
SceneDesc load_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides);

/// The same for a scene whose text is at hand (read_scene_text).
SceneDesc load_scene_text(std::string_view text, const std::filesystem::path& file);

/// The same for a scene's tree (scene_of_tree) whose variations have been read.
SceneDesc load_scene_tree(const ConfigNode& tree, const std::filesystem::path& file,
                          const SceneArrays* arrays = nullptr);

/// A scene with drawn values, as a tree and as what that describes.
struct VariedScene {
    ConfigNode tree;
    SceneDesc desc;
};

/// The scenes that a scene's section `variations` makes of it. Each is the scene with the values
/// drawn set as by --set, and has the same images.
class SceneVariations {
  public:
    /// Reads the scene file with its overrides. Throws as read_scene_tree and read_variations, and
    /// UsageError for an override of what is drawn.
    SceneVariations(const std::filesystem::path& file, const std::vector<std::string>& overrides);
    /// Reads the variations of a scene's tree. Throws as read_variations.
    SceneVariations(ConfigNode tree, std::filesystem::path file);

    /// What is drawn; none: the scene has no such section.
    const std::optional<VariationsDesc>& desc() const { return desc_; }

    /// The values of one variation, and its scene. Throws InputError where the scene with these
    /// values is none: the message says which variation and which value. Throws as load_scene.
    std::vector<DrawnValue> values(int variation) const { return draw(*desc_, variation); }
    SceneDesc scene(int variation) const { return varied(variation).desc; }
    /// The same with its tree, and of a scene that refers to `arrays`.
    VariedScene varied(int variation, const SceneArrays* arrays = nullptr) const;

  private:
    std::filesystem::path file_;
    ConfigNode tree_;
    std::optional<VariationsDesc> desc_;
};

/// How images are rendered where that is not left to their scene: the options of the command line
/// that have these names.
struct ImageRequest {
    std::string quality;     ///< empty: the scene's
    std::string integrator;  ///< likewise
    std::optional<int> samples;
    std::optional<double> error;             ///< instead of a number of samples
    std::optional<std::array<int, 2>> size;  ///< width, height [pixels]
};

/// Changes what `request` says about how a scene is rendered. Drafts have the samples that the
/// integrator's drafts have, unless others are requested. Throws UsageError, which names the
/// option.
void apply_request(const ImageRequest& request, SceneDesc& scene);

/// A file that a scene is read from.
struct InputFile {
    std::filesystem::path file;
    std::string_view what;  // for messages: "a volume of the scene"
    /// Whether its content is part of SceneDesc::hash: a change shows without its date.
    bool is_hashed = false;
};

/// The files that meshes, volumes and OpenColorIO configs refer to, by that file: looked up once
/// for many frames.
using SideFiles = std::map<std::filesystem::path, std::vector<std::filesystem::path>>;

/// Every file that an image of a scene is read from, the scene file itself first: the one answer to
/// which files it depends on. They are those that the scene's keys name (SceneDesc::files) and
/// those that these refer to. Sequences without a frame are listed by their own names. A file that
/// serves two purposes is listed twice. Missing or broken files are not an error here. `known` is
/// looked up and added to. Throws InputError for a frame that a trajectory does not have.
std::vector<InputFile> input_files(const SceneDesc& whole, const ImageChoice& choice,
                                   SideFiles& known);

}  // namespace uw
