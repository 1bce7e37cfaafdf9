#pragma once

#include "core/base/grid2d.h"
#include "core/base/progress.h"
#include "core/paths/irradiance_cache.h"
#include "core/paths/node_smoothing.h"
#include "core/paths/radiance_nodes.h"

namespace uw {

/// Nodes of a RadianceEstimator in even steps all over an image, and the indirect light on the
/// surfaces that they see. They depend on the whole image, whatever part of it is rendered.
class NodeLattice {
  public:
    struct Positions {
        int columns = 0, rows = 0;
        double step_x = 1, step_y = 1, offset = 0;  // [pixels], [steps]
        std::uint64_t seed = 0;                     // of the random number sequences

        /// Nodes at the multiples of `spacing` pixels, up to the image's last edges or beyond.
        static Positions over(const RaySource& rays, int spacing);
        /// Nodes at the centres of `parts` x `parts` equal parts of the image.
        static Positions amid(const RaySource& rays, int parts);
    };

    /// `estimator` must outlive this object.
    NodeLattice(const RadianceEstimator& estimator, const Positions& positions);

    NodeWindow all() const { return {0, 0, raw_.width(), raw_.height()}; }
    RadianceEstimator::Place place(int i, int j) const;

    /// Begins all nodes, and returns a cache of the indirect light on all surfaces: smoothed on
    /// those that nodes see, and estimated anew on those that only paths from the nodes meet.
    IrradianceCache light_surfaces(const NodePaths& paths, const ProgressCallback& progress);
    /// Adds the light of the water to the nodes of a window.
    void light_water(const NodeWindow& window, const NodePaths& paths,
                     const IrradianceCache& indirect, const ProgressCallback& progress);
    /// The nodes as estimated, not smoothed.
    Grid2D<RadianceNode>& raw() { return raw_; }
    /// The nodes with the light on their surfaces smoothed, and within `window` that of the water.
    Grid2D<SmoothNode> smoothed(const NodeWindow& window, const DistanceIntervals& intervals) const;
    /// Computes standard errors of these smoothed nodes in a window. They include the noise of the
    /// nodes, the bias of smoothing as far as both halves agree on it, and the noise of the light
    /// on surfaces in the halo that the water shows of them.
    void find_errors(const NodeWindow& window, Grid2D<SmoothNode>& nodes) const;

  private:
    template <class Visit>
    void for_each(const NodeWindow& window, const ProgressCallback& progress,
                  const Visit& visit) const;
    std::vector<SurfaceSample> find_unseen_surfaces(const IrradianceCache& visible) const;

    const RadianceEstimator& estimator_;
    Positions positions_;
    Grid2D<RadianceNode> raw_;
    Grid2D<SmoothNode> smooth_;  // after light_surfaces, without the water
};

/// The effort for the paths of all nodes.
struct NodeEffort {
    double paths = 0;  // maximum of each kind, over all nodes
    int nodes = 0;
    double error = 0;  // target standard error, relative to the light of each node; 0: none
};

/// The numbers of paths of each kind that minimise the error for the effort, planned by a pilot of
/// a few nodes all over the image.
NodePaths plan_paths(const RadianceEstimator& estimator, const NodeEffort& effort);

}  // namespace uw
