#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/vector_math.h"
#include "core/scene/volume_desc.h"
#include "media/volumes/vdb_header.h"

namespace uw {

/// The metadata of a frame that Blender's fluid solver stores in the cache's folder config.
struct FluidConfig {
    std::array<std::int32_t, 3> resolution{};  // voxels of the frame's grids along each axis
    std::array<std::int32_t, 3> domain{};      // of the whole domain
    std::array<std::int32_t, 3> first{};       // voxel of the domain at which the grids begin
    Vector3 sides{0};  // of the domain in Blender's world [m]; 0 if they are not stated
    /// Blender's world from the domain's own axes, in metres from its corner; empty if it is not
    /// stated. Its columns are unit vectors: not perpendicular for a domain that is sheared by its
    /// parents, and left-handed for one that is mirrored.
    std::optional<Affine> blender_from_domain;
    double time = 0;  // that the solver has simulated, in its own unit of 0.4 s
};

/// The configuration that belongs to the grids in `data_file`: config/config_0030.uni for
/// data/fluid_data_0030.vdb or noise/fluid_noise_0030.vdb. Empty if there is none, or if it is
/// inconsistent or of another layout (that of Blender 2.82 to 4 is known).
std::optional<FluidConfig> read_fluid_config(const std::filesystem::path& data_file);

/// The files from which a volume is read besides its own: that configuration, if there is one.
std::vector<std::filesystem::path> files_named_by_volume(const std::filesystem::path& data_file);

/// The frames a second at which the cache that `data_file` belongs to was baked, from the times
/// that this frame's configuration and a neighbour's state; right if the solver's Time Scale was 1.
std::optional<double> fluid_frame_rate(const std::filesystem::path& data_file);

/// The domain in which Blender's fluid solver has baked a frame, as far as it is known.
///
/// Blender divides the domain's longest side by its resolution, each other side into the nearest
/// number of whole voxels, and stretches these to fill the domain's box. The file states cubes.
///
/// With Adaptive Domain each frame has a grid of its own, cut out of the domain around the smoke,
/// and the voxel size stored with it is the domain's longest side divided by the longest side of
/// that cut, not by the domain's resolution: it is too large, by a different factor in every frame.
///
/// The true size, and where the cut lies, are in the cache's folder config alone.
struct FluidDomain {
    bool is_adaptive = false;
    double longest_side = 0;  // of the whole domain [m]
    int max_voxels = 0;       // of the inspected frames: a lower bound on those along that side
    std::optional<Vector3> voxel;  // the true edges [m], if they are known
    Vector3 first{0};              // voxel of the domain at which the grid begins; 0 if not known
    std::optional<Affine> blender_from_domain;  // as in FluidConfig

    /// The voxel size can be no larger [m].
    double max_voxel() const { return longest_side / max_voxels; }
    /// What an adaptive domain is and what to do, to follow "...: ".
    std::string description() const;
};

/// Reads a frame's domain from its configuration. Without one, recognises a frame of an adaptive
/// domain by comparing it with others of its sequence, which lie beside it and differ in their
/// number: up to eight of them, by their headers. Empty if there is no evidence.
std::optional<FluidDomain> find_fluid_domain(const VdbHeader& header);

/// A grid's corrected transform: scaled about the file's origin such that its voxels have edges of
/// VolumeDesc::voxel_size if the scene gives one, else of those known from the `domain`, in which
/// it is moved to its place. Throws InputError if the scene gives one and the voxels are no cubes.
Affine with_voxel_size(const Affine& file_from_index, const VolumeDesc& desc,
                       const std::optional<FluidDomain>& domain);

}  // namespace uw
