#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/geometry/mesh.h"
#include "core/scene/geometry_desc.h"

namespace uw {

/// The surface of a level set in a VDB or NanoVDB file, where its values are 0, as triangles (dual
/// contouring, openvdb::tools::VolumeToMesh): about two for each voxel that it passes, with the
/// normals of the values' gradient, in the file's space turned upright [m]. Appends a line to
/// `warnings` for triangles that cannot be traced. Throws InputError starting with `where` if the
/// grid is not there, is no level set, has no surface, or cannot be read; IoError.
std::shared_ptr<const TriangleMesh> mesh_level_set(const std::filesystem::path& file,
                                                   const LevelSetDesc& desc,
                                                   const SourceLocation& where,
                                                   std::vector<std::string>& warnings);

}  // namespace uw
