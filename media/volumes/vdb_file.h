#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "core/base/error.h"
#include "core/base/vector_math.h"
#include "core/scene/volume_desc.h"
#include "media/volumes/loaded_grid.h"

namespace uw {

inline constexpr std::size_t k_default_slab_bytes = std::size_t{256} << 20;

/// Reads one grid of `header.file`. Voxels are processed in slabs of at most about `slab_bytes` of
/// 32-bit values (but no less than an eighth of the grid); the result is 16-bit. Throws InputError
/// starting with `where` if it cannot be used (see select_grid), is an undeclared level set, or
/// cannot be decoded. With LevelSets::fog, a level set is read whole and its interior becomes fog,
/// as openvdb::tools::sdfToFogVolume does; other grids are then rejected.
LoadedGrid load_grid(const VdbHeader& header, const std::string& name, const SourceLocation& where,
                     std::size_t slab_bytes = k_default_slab_bytes,
                     LevelSets level_sets = LevelSets::refused);

/// Only the transform of a grid (LoadedGrid::file_from_index). Throws as load_grid.
Affine read_file_from_index(const VdbHeader& header, const std::string& name,
                            const SourceLocation& where, LevelSets level_sets = LevelSets::refused);

/// Light of a grid that the water's motion stimulates.
struct StimulatedLight {
    EmissionDesc::Stimulus stimulus;
    Matrix3 world_from_file;  // of lengths and velocities
};

/// Reads one grid as load_grid does. If it is light that motion sets off, each voxel's value is
/// multiplied by the fraction of its light that the velocity there stimulates. Then it is averaged
/// over the exposure time, if that is not 0: every voxel's value is the mean of those advected
/// there from -shutter/2 to +shutter/2 ("Eulerian Motion Blur", Kim and Ko 2007: traced back along
/// the velocity at the frame's time, evaluated at the midpoint). The grid is enlarged accordingly.
/// `centering`: of both grids. All of them are in memory at once, with 32 bits. Throws as
/// load_grid, and also if a velocity grid is missing or unusable, or if it moves the grid by more
/// than 128 voxels.
LoadedGrid load_moving_grid(const VdbHeader& header, const std::string& name,
                            const SourceLocation& where, const MotionDesc& motion,
                            Centering centering, LevelSets level_sets = LevelSets::refused,
                            const std::optional<StimulatedLight>& light = {});

}  // namespace uw
