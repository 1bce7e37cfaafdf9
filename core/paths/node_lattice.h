#pragma once

#include "core/base/grid2d.h"
#include "core/base/progress.h"
#include "core/paths/irradiance_cache.h"
#include "core/paths/node_smoothing.h"
#include "core/paths/radiance_nodes.h"

namespace uw {

/// Nodes at even steps all over an image (RadianceEstimator), and the indirect light on the
/// surfaces that they see. They depend on the whole image, whatever part of it is rendered.
class NodeLattice {
  public:
    struct Positions {
        int columns = 0, rows = 0;
        double step_x = 1, step_y = 1, offset = 0;  // [pixels], [steps]
        std::uint64_t seed = 0;                     // of the random numbers

        /// At the multiples of `spacing` pixels, up to the image's last edges or beyond.
        static Positions over(const RaySource& rays, int spacing);
        /// At the middles of so many parts of the image in each direction.
        static Positions amid(const RaySource& rays, int parts);
    };

    /// `estimator` must outlive this object.
    NodeLattice(const RadianceEstimator& estimator, const Positions& positions);

    NodeWindow all() const { return {0, 0, raw_.width(), raw_.height()}; }
    RadianceEstimator::Place place(int i, int j) const;

    /// Begins all nodes, and returns the light on all surfaces: on those that nodes see, smoothed,
    /// and on those that only paths from them meet.
    IrradianceCache light_surfaces(const NodePaths& paths, const ShareCallback& progress);
    /// Adds the water's light to the nodes of a window.
    void light_water(const NodeWindow& window, const NodePaths& paths,
                     const IrradianceCache& indirect, const ShareCallback& progress);
    /// The nodes as they were estimated.
    Grid2D<RadianceNode>& raw() { return raw_; }
    /// The nodes with the surfaces' light smoothed, and in `window` the water's.
    Grid2D<SmoothNode> smoothed(const NodeWindow& window, const DistanceIntervals& intervals) const;
    /// Finds the standard errors of these smoothed nodes in a window. They count the noise of the
    /// nodes, what smoothing takes from features as far as both halves show it, and the noise of
    /// the light on surfaces in what the water shows of them.
    void find_errors(const NodeWindow& window, Grid2D<SmoothNode>& nodes) const;

  private:
    template <class Visit>
    void for_each(const NodeWindow& window, const ShareCallback& progress,
                  const Visit& visit) const;
    std::vector<SurfaceSample> find_unseen_surfaces(const IrradianceCache& seen) const;

    const RadianceEstimator& estimator_;
    Positions positions_;
    Grid2D<RadianceNode> raw_;
    Grid2D<SmoothNode> smooth_;  // from light_surfaces on, without the water
};

/// What the paths of all nodes may take.
struct NodeEffort {
    double paths = 0;  // of each kind, at all nodes together, at most
    int nodes = 0;
    double error = 0;  // standard error for which fewer will do, relative to all light; 0: none
};

/// The numbers of paths that leave the least error for the effort, from a few nodes all over the
/// image.
NodePaths plan_paths(const RadianceEstimator& estimator, const NodeEffort& effort);

}  // namespace uw
