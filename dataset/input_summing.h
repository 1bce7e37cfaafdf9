#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "core/base/input_files.h"
#include "core/scene/scene_desc.h"
#include "dataset/view.h"
#include "render/scene_loading.h"

namespace uw {

/// Finds the checksums of the files that images are rendered from. A file is read once, unless it
/// changes: what all frames have in common costs nothing from the second on.
class InputSummer {
  public:
    /// The sums of the files of an image as they are now. To be called before they are loaded: of a
    /// file that changes in between it is the sum of what was there before, so that the view is
    /// rendered again. Throws as input_files does; IoError for a file that cannot be read.
    InputSums sums_of(const SceneDesc& whole, const ImageChoice& choice);

  private:
    struct Known {
        std::optional<FileStamp> stamp;
        std::string sum;
    };
    std::map<std::filesystem::path, Known> known_;
    SideFiles side_files_;
};

}  // namespace uw
