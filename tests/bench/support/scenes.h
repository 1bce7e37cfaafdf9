#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/base/output_files.h"
#include "core/scene/scene_desc.h"
#include "tests/bench/support/generated_files.h"

namespace uw::bench {

/// A scene to measure. All but S1 share one camera and one rig of spot lamps around it.
struct SceneCase {
    enum class Kind {
        s1,  // of docs/performance.md: a plane, a box, one isotropic lamp; other members are unused
        uniform,  // uniform water above write_seabed's mesh
        plume,    // the same with the Blender plume of 128^3 in it
        fog,      // the same with write_fog's box in it
    };
    Kind kind = Kind::uniform;
    int width = 640, height = 360;
    int lamps = 3;
    int bands = 3;
    int triangles = 100'000;
    int voxels = 0;  // of fog, along an edge
    Fog fog = Fog::dense;
    int threads = 1;

    /// "plume/640x360/lamps:3/bands:3/threads:1", and whatever else distinguishes the case.
    std::string name() const;
};

/// Where the inputs of scenes are kept once made: the environment variable UWVDB_BENCH_FILES, or
/// else a folder that is removed with the object.
class SceneFiles {
  public:
    SceneFiles();

    /// Makes the scene's inputs unless they exist, and reads the scene. Throws as read_scene.
    SceneDesc read(const SceneCase& scene) const;
    const std::filesystem::path& folder() const { return folder_; }

  private:
    std::unique_ptr<const ScratchFolder> scratch_;
    std::filesystem::path folder_;
};

}  // namespace uw::bench
