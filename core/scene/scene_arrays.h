#pragma once

#include <map>
#include <memory>
#include <string>

namespace uw {

struct LoadedGrid;    // media/vdb/loaded_grid.h
struct TriangleMesh;  // core/meshes/mesh.h

/// What a scene refers to by names instead of reading it from files: grids of volumes as `array`,
/// meshes of geometry as `mesh`.
struct SceneArrays {
    std::map<std::string, std::shared_ptr<const LoadedGrid>> grids;
    std::map<std::string, std::shared_ptr<const TriangleMesh>> meshes;
};

}  // namespace uw
