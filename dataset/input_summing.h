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

/// Computes the checksums of the files from which images are rendered. A file is read once, unless
/// it changes, so that files common to all frames cost nothing from the second frame on.
class InputSummer {
  public:
    /// The sums of the files of an image as they are now. To be called before they are loaded: if a
    /// file changes in between, its sum is that of the old content, so that the view is rendered
    /// again. Throws as input_files does; IoError for a file that cannot be read.
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
