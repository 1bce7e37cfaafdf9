#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/vector_math.h"
#include "core/light/medium.h"
#include "core/scene/volume_desc.h"
#include "media/volumes/grid_field.h"
#include "media/volumes/loaded_grid.h"
#include "media/volumes/vdb_file.h"

namespace uw {

/// The contribution of one grid to one constituent, in the constituent's unit (ppm).
struct ConstituentReport {
    int constituent = 0;
    double min = 0, mean = 0, max = 0;  // over active voxels
    std::array<double, 3> column{};     // as VolumeReport::column, in [unit m]
};

/// The report to the user on one grid in use.
struct VolumeReport {
    std::filesystem::path file;
    std::string grid;
    Vector3 metres_per_voxel{0};  // along index i, j, k, in the scene's scale
    Bounds bounds;                // world bounds of the nonzero voxels; empty if there are none
    Placement placement;
    GridStatistics statistics;
    /// Integral of the value through the centre of `bounds`, along world x, y, z [value m].
    std::array<double, 3> column{};
    std::vector<ConstituentReport> constituents;
    std::size_t bricks = 0, bytes = 0;  // memory usage
};

/// One volume of a scene, read. Copies share the voxels.
struct LoadedVolume {
    std::vector<GridVolume> grids;      // one per grid mapping, in that order
    std::vector<VolumeReport> reports;  // likewise
    std::vector<std::string> warnings;  // one line each
};

/// Reads one volume. `loads[g]` gives the meaning of its grid g. Throws InputError or IoError (see
/// vdb_file.h).
LoadedVolume load_volume(const VolumeDesc& desc, const std::vector<std::vector<GridLoad>>& loads,
                         std::size_t slab_bytes = k_default_slab_bytes);

/// Reads the grid of an emissive volume, `desc.emission`, as that of a constituent 0, in units of
/// its value, multiplied by the fraction that the water's motion stimulates. Throws as load_volume.
LoadedVolume load_light(const VolumeDesc& desc);

/// Reads the volumes. `loads[v][g]` gives the meaning of grid g of volume v. Fills one report per
/// grid in that order, and appends warnings of one line each. Throws as load_volume.
std::unique_ptr<ConcentrationField> load_volumes(
    const std::vector<VolumeDesc>& volumes,
    const std::vector<std::vector<std::vector<GridLoad>>>& loads, int constituent_count,
    std::vector<VolumeReport>& reports, std::vector<std::string>& warnings,
    std::size_t slab_bytes = k_default_slab_bytes);

/// Checks, from the files' headers alone, whether the frames of a volume are consistent.
class VolumeSequenceCheck {
  public:
    /// Takes the next frame. Throws InputError with the file's name if a grid that the scene uses,
    /// be it for concentrations, light or velocity, is missing or cannot be used (select_grid), or
    /// if its transform differs from that of the first frame: the same voxel would then lie
    /// elsewhere; IoError.
    void take(const VolumeDesc& frame);

  private:
    VolumeDesc first_;
    std::vector<Affine> transforms_;  // of the first frame's grids
};

/// A one-line warning about a grid whose voxels are so dense that lamps' light varies within them
/// more than interpolation between rays half a voxel apart can resolve; none for others. Beyond 4
/// optical depths light is 2 % off where it enters such a cloud, beyond 15 5 %, beyond 40 8 %.
std::optional<std::string> coarse_voxel_warning(const VolumeReport& report, const Medium& medium);

}  // namespace uw
