#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/base/output_files.h"
#include "core/scene/scene_desc.h"

namespace uw {

/// The built-in scenes of `uwvdb validate`: lamps beside, far from, behind and in view of the
/// camera, both kinds of phase function, a port, a shadow, a spot, and a plume in a grid that is
/// written to a folder of its own for as long as the suite exists. The last three scatter forward,
/// with both kernels.
class ValidationSuite {
  public:
    ValidationSuite();

    /// Name and description of each.
    const std::vector<std::pair<std::string, SceneDesc>>& scenes() const { return scenes_; }

    /// Those whose light of all orders is compared.
    const std::vector<std::pair<std::string, SceneDesc>>& all_light() const { return all_light_; }

  private:
    ScratchFolder folder_;
    std::vector<std::pair<std::string, SceneDesc>> scenes_, all_light_;
};

}  // namespace uw
