#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>

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

}  // namespace uw
