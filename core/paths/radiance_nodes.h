#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/grid2d.h"
#include "core/base/ray.h"
#include "core/light/integrator.h"
#include "core/light/integrator_kind.h"
#include "core/paths/distance_intervals.h"
#include "core/paths/irradiance_cache.h"
#include "core/paths/path_tracer.h"

namespace uw {

/// The surface that a node's ray hits.
struct NodeSurface {
    std::uint32_t object_id = 0;
    Point3 position;
    Vector3 normal{0, 0, 1};
    bool is_glossy = false;
};

/// Light that was scattered or reflected more than once, at one position in the image.
struct NodeRadiance {
    /// Radiance at the camera from the water of each interval of distance, by interval, group and
    /// band.
    std::vector<float> water;
    /// By group and band: indirect irradiance / pi, as a white surface would reflect it, and what
    /// the surface's specular lobe reflects [W m^-2 sr^-1], except what it mirrors
    /// (PathTracer::is_mirrored).
    std::vector<float> diffuse, glossy;
    // Sums over the groups, means over the bands:
    std::vector<float> water_mean;  // by interval
    double diffuse_mean = 0;
    // The variances of these as estimated from the batches, inverse to the scales below.
    std::vector<float> water_variance;
    double diffuse_variance = 0;
};

/// Standard errors of the light on a surface, by band, as in NodeRadiance.
struct SurfaceErrors {
    std::vector<float> diffuse, glossy;
};

/// Cached radiance at a position in the image (Jarosz et al. 2008), as estimated by light paths.
struct RadianceNode {
    bool has_ray = false;
    std::optional<NodeSurface> surface;
    double max_distance = 0;  // of the water along its ray [m]
    /// IntervalWeights of its ray, by interval and band, and their means over the bands.
    std::vector<float> weights, mean_weights;
    double mean_light = 0;  // rough radiance of the ray, mean over the bands
    /// The expected light of its water, and of a white surface, as estimated before any path.
    double estimated_water = 0, estimated_surface = 0;
    /// The camera's radiance per radiance of a white surface, by band, and its mean over the bands.
    std::vector<float> surface_throughput_by_band;
    double surface_throughput = 0;
    /// The part of the water's light that comes from indirect light on surfaces, by band.
    std::vector<float> lit_indirect;
    /// Two independent estimates: decisions by one are applied to the other.
    std::array<NodeRadiance, 2> halves;
    // Its numbers of paths relative to the mean of all nodes.
    double water_scale = 1, surface_scale = 1;
    /// The light of a single path, as a mean over the bands, its variance, and its work.
    struct Moments {
        double mean = 0, variance = 0, work = 0;
    };
    Moments lit, water;       // of paths as in PathNumbers
    double surface_work = 0;  // of a path from the surface
};

/// The numbers of light paths of each kind at a node.
struct PathNumbers {
    double surface = 512;  // from the node's surface: indirect light on it
    double lit = 512;      // to surfaces that are visible through scattering
    double water = 512;    // in the water alone
};

/// Where in the image how many paths are traced.
class NodePaths {
  public:
    /// What holds in a part of the image: the numbers of a node whose expected light is that of the
    /// part, or less. Brighter nodes, which are few and lie around lamps, get more.
    struct Part {
        PathNumbers numbers;
        double estimated_water = 0, estimated_surface = 0;  // as RadianceNode's; 0: not known
    };

    /// The same numbers everywhere.
    explicit NodePaths(const PathNumbers& numbers);
    /// `parts`: of an image of this size [pixels], at their centres; linear in between.
    NodePaths(Grid2D<Part> parts, double width, double height);

    /// Those of the whole image.
    const PathNumbers& mean() const { return mean_; }
    /// Those of a node that was begun, at a position in the image [pixels].
    PathNumbers of(const RadianceNode& node, double x, double y) const;

  private:
    Part part_at(double x, double y) const;

    Grid2D<Part> parts_;
    double width_ = 1, height_ = 1;
    PathNumbers mean_;
};

/// Estimates the radiance at nodes by light paths. Thread safe.
class RadianceEstimator {
  public:
    /// All references must outlive this object; `transport` must have paths. `groups`: one for all
    /// light, or one per lamp and one for emission.
    RadianceEstimator(const RaySource& rays, const LitScene& scene, const LightTransport& transport,
                      const IntervalWeights& weights, std::size_t groups)
        : rays_(rays),
          scene_(scene),
          transport_(transport),
          weights_(weights),
          intervals_(weights.intervals()),
          groups_(groups) {}

    std::size_t groups() const { return groups_; }
    std::size_t bands() const { return static_cast<std::size_t>(scene_.medium->band_count()); }
    const RaySource& rays() const { return rays_; }

    /// The position of a node in the image [pixels], and the seed of its random numbers.
    struct Place {
        double x = 0, y = 0;
        std::uint64_t seed = 0;
    };
    /// Begins a node with the indirect light on its surface, if it has one.
    void estimate_surface(const Place& place, const NodePaths& paths, RadianceNode& node) const;
    /// Finds the surfaces that some paths from a node meet first (PathTracer::find_lit_surface);
    /// returns the origin of its ray in the water.
    Point3 find_lit_surfaces(const Place& place, int paths,
                             std::vector<SurfaceSample>& samples) const;
    /// Adds the light of the water to a node that was begun. `indirect`: the cache of all surfaces,
    /// by group and band. `typical_light`: the mean of the begun nodes' `mean_light`, for guiding.
    void estimate_water(const Place& place, const NodePaths& paths, const IrradianceCache& indirect,
                        double typical_light, RadianceNode& node) const;
    /// Estimates the light on a single surface sample, by this many paths, and its errors from the
    /// difference of two halves of the paths.
    void estimate_surface(const SurfaceSample& sample, int paths, NodeRadiance& light,
                          SurfaceErrors& errors) const;
    /// Estimates what the sample's specular lobe mirrors (PathTracer::trace_mirrored), by this many
    /// paths: the radiance at the sample, by group and band, and the sum of the paths' squares, by
    /// band.
    void estimate_mirrored(const SurfaceSample& sample, int paths, std::vector<double>& radiance,
                           std::vector<double>& squares) const;

  private:
    class WaterSum;
    class SurfaceSum;
    struct Workspace;

    void begin(const SurfaceSample& sample, bool has_hit, Workspace& w, RadianceNode& node) const;
    void trace_surface(std::uint64_t seed, int paths, Workspace& w, RadianceNode& node) const;

    const RaySource& rays_;
    const LitScene& scene_;
    const LightTransport& transport_;
    const IntervalWeights& weights_;
    const DistanceIntervals& intervals_;
    std::size_t groups_;
};

/// The minimum cosine between the normals at two places whose indirect light counts as alike.
inline constexpr double k_min_node_cosine = 0.96;

/// How much of the water of an interval lies before a node's surface: `enough` to estimate its
/// light, or `little`, which is used if no other node has more.
enum class NodeReach : unsigned char { none, little, enough };
inline NodeReach reach_into(const RadianceNode& node, const DistanceIntervals& intervals,
                            std::size_t interval) {
    constexpr double k_min_fraction = 0.3;
    if (node.mean_weights.empty() || node.max_distance <= intervals.begin(interval))
        return NodeReach::none;
    return intervals.fraction_before(interval, 0, node.max_distance) >= k_min_fraction
               ? NodeReach::enough
               : NodeReach::little;
}

/// Whether two nodes see the same surface, under similar normals.
inline bool see_same_surface(const RadianceNode& a, const RadianceNode& b) {
    return a.surface && b.surface && a.surface->object_id == b.surface->object_id &&
           a.surface->is_glossy == b.surface->is_glossy &&
           glm::dot(a.surface->normal, b.surface->normal) >= k_min_node_cosine;
}

}  // namespace uw
