#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/base/vector_math.h"
#include "core/scene/volume_desc.h"
#include "media/volumes/vdb_header.h"

namespace uw {

/// What Blender's fluid solver notes about a frame beside its grids, in the cache's folder config.
struct FluidConfig {
    std::array<std::int32_t, 3> resolution{};  // voxels of the frame's grids along each axis
    std::array<std::int32_t, 3> domain{};      // of the whole domain
    std::array<std::int32_t, 3> first{};       // voxel of the domain at which the grids begin
};

/// The configuration that belongs to the grids in `data_file`: config/config_0030.uni for
/// data/fluid_data_0030.vdb or noise/fluid_noise_0030.vdb. Empty if there is none, or if it is
/// inconsistent or of another layout (that of Blender 2.82 to 4 is known).
std::optional<FluidConfig> read_fluid_config(const std::filesystem::path& data_file);

/// What can be told of a cache that Blender's fluid solver has baked with Adaptive Domain. Each
/// frame then has a grid of its own, cut out of the domain around the smoke, and the voxel size
/// stored with it is the domain's longest side divided by the longest side of that cut, not by the
/// domain's resolution: it is too large, by a different factor in every frame. The true size, and
/// where the cut lies, are in the cache's folder config alone (fluid_config.h).
struct AdaptiveDomain {
    double longest_side = 0;  // of the whole domain [m]
    int most_voxels = 0;      // of any frame looked at: the domain has at least as many along it
    std::optional<double> voxel;  // the true size [m], if it is known
    Vector3 first{0};             // voxel of the domain at which the grid begins; 0 if not known

    /// The voxel size can be no larger [m].
    double largest_voxel() const { return longest_side / most_voxels; }
    /// What it is and what to do, to follow "...: ".
    std::string description() const;
};

/// Recognises a frame of such a cache by its configuration or, without one, by comparing it with
/// others of its sequence, which lie beside it and differ in their number: up to eight of them, by
/// their headers. Empty if it is no such cache, or if nothing tells.
std::optional<AdaptiveDomain> find_adaptive_domain(const VdbHeader& header);

/// A grid's transform, set right: scaled about the file's origin such that its voxels have edges of
/// VolumeDesc::voxel_size if the scene gives one, else of what is known of an adaptive `domain`, in
/// which it is moved to its place. Throws InputError if the voxels are to be scaled and are no
/// cubes.
Affine with_voxel_size(const Affine& file_from_index, const VolumeDesc& desc,
                       const std::optional<AdaptiveDomain>& domain);

}  // namespace uw
