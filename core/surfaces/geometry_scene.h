#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/scene/geometry_desc.h"
#include "core/surfaces/surfaces.h"

namespace uw {

/// Reads the mesh files of `geometry` and makes all of it traceable, in world space [m]. Every
/// shape honours its `world_from_object`. `wavelengths_nm`: one per band of the reflectances; RGB
/// colours of files become bands as ReflectanceBands says. A given `reflectance` replaces a file's
/// colours.
///
/// Every surface is opaque and diffuse from both sides: a one-sided glTF face seen from behind is
/// shaded as well, for light does not pass through it either.
///
/// Appends to `warnings` what read_mesh does. Throws InputError for wrong files, a transform
/// without inverse, or reflectances of another band count; IoError; std::runtime_error if Embree
/// fails.
std::unique_ptr<Surfaces> build_surfaces(const std::vector<GeometryDesc>& geometry,
                                         const std::vector<double>& wavelengths_nm,
                                         std::vector<std::string>& warnings);

}  // namespace uw
