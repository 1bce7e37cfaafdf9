#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/base/grid2d.h"
#include "core/base/progress.h"
#include "core/image/film.h"
#include "core/passes/pixel_renderer.h"
#include "core/paths/distance_intervals.h"
#include "core/paths/irradiance_cache.h"
#include "core/paths/node_lattice.h"
#include "core/paths/node_smoothing.h"
#include "core/paths/surface_halo.h"

namespace uw {

/// The effort for the light of a CameraRadianceCache.
struct RadianceCacheOptions {
    int paths = 0;     // maximum of each kind, over all nodes of the image
    double error = 0;  // target, relative to the light of each node; 0: none, all paths are traced
    int nodes = 0;     // approximate number in the whole image
    int cells = 0;     // maximum number of cells of SurfaceHalo
    bool lamps = false;  // whether to separate the light by lamp
};

/// The light that was scattered or reflected more than once, as the camera of one moment sees it
/// (Ward et al. 1988; Jarosz et al. 2008). Light paths estimate it at the nodes of a lattice over
/// the image (RadianceEstimator), and it is smoothed over the nodes around each. The halo of the
/// surfaces, which is a part of it, has edges as sharp as theirs: the nodes hold the rest.
class CameraRadianceCache {
  public:
    /// Traces the nodes that the pixels of `window` need, and smooths them. `pixels` is used only
    /// during construction; its light transport must have paths. Throws Interrupted if the work is
    /// to stop, InputError if the nodes do not fit into free memory.
    CameraRadianceCache(const PixelRenderer& pixels, const RadianceCacheOptions& options,
                        const PixelWindow& window, const ProgressCallback& progress);

    const DistanceIntervals& intervals() const { return intervals_; }
    /// One for all light, or one per lamp and one for emission.
    std::size_t groups() const { return groups_; }
    /// The distance from the cell of a pixel to the farthest nodes that serve it [cells].
    static constexpr int k_search_radius = 3;
    /// The distance of the nodes [pixels]; the first lies at the image's corner.
    int spacing() const { return spacing_; }
    const Grid2D<SmoothNode>& nodes() const { return nodes_; }
    /// The indirect light on all surfaces.
    const IrradianceCache& indirect() const { return *indirect_; }
    /// The halo that the nodes leave out.
    const SurfaceHalo& halo() const { return *halo_; }
    /// The halo as `pixels` sees the surfaces at another moment, with the same indirect light.
    SurfaceHalo halo_at(const PixelRenderer& pixels) const;

  private:
    SurfaceHalo make_halo(const PixelRenderer& pixels,
                          std::span<const SurfaceHalo::Position> nodes) const;
    void subtract_halo(const PixelRenderer& pixels, NodeLattice& lattice);
    void distribute_halo(const RadianceNode& node, std::span<float> halo) const;

    std::size_t bands_, groups_;
    int cells_, spacing_;
    DistanceIntervals intervals_;
    std::optional<IrradianceCache> indirect_;
    std::optional<SurfaceHalo> halo_;
    Grid2D<SmoothNode> nodes_;
};

}  // namespace uw
