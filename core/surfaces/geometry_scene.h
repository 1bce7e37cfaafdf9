#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/scene/geometry_desc.h"
#include "core/surfaces/mesh_store.h"
#include "core/surfaces/surfaces.h"

namespace uw {

/// Reads the mesh files of `geometry` and prepares everything for ray tracing, in world space [m].
/// Every shape honours its `world_from_object`. `wavelengths_nm`: one per band of the reflectances;
/// RGB colours in files are converted to bands by ReflectanceBands. A given `reflectance` replaces
/// a file's colours. Meshes that several objects of a file show are kept once (MeshFile::shared).
///
/// Every surface is opaque and diffuse on both sides: a single-sided glTF face is shaded from
/// behind as well, since light does not pass through it either.
///
/// Appends the warnings of read_mesh to `warnings`. Throws InputError for invalid files, a singular
/// transform, or reflectances with a different band count; IoError; std::runtime_error if Embree
/// fails.
std::unique_ptr<Surfaces> build_surfaces(const std::vector<GeometryDesc>& geometry,
                                         const std::vector<double>& wavelengths_nm,
                                         std::vector<std::string>& warnings);
/// The same with the meshes of `meshes`, as far as they are there, which becomes those of this
/// scene.
std::unique_ptr<Surfaces> build_surfaces(const std::vector<GeometryDesc>& geometry,
                                         const std::vector<double>& wavelengths_nm,
                                         std::vector<std::string>& warnings, MeshStore& meshes);

}  // namespace uw
