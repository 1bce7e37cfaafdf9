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

/// Light that was scattered or reflected more than once, at one image position.
struct NodeRadiance {
    /// By interval of distance, group and band: radiance from the water within it, at the camera.
    std::vector<float> water;
    /// By group and band: indirect irradiance / pi, what a white surface would reflect, and then
    /// what the surface's specular lobe reflects [W m^-2 sr^-1], but for what it mirrors
    /// (PathTracer::is_mirrored).
    std::vector<float> diffuse, glossy;
    // The sums over the groups, means over the bands:
    std::vector<float> water_mean;  // by interval
    double diffuse_mean = 0;
    // The variances of these as the estimate's own batches tell them, inverse to NodePaths' shares.
    std::vector<float> water_variance;
    double diffuse_variance = 0;
};

/// Standard errors of light on a surface, by band, as NodeRadiance has it.
struct SurfaceErrors {
    std::vector<float> diffuse, glossy;
};

/// Estimates of that light, and what they belong to.
struct RadianceNode {
    bool has_ray = false;
    std::optional<NodeSurface> surface;
    double reach = 0;  // of the water along its ray [m]
    /// IntervalWeights of its ray, by interval and band, and their means over the bands.
    std::vector<float> weights, mean_weights;
    double mean_light = 0;  // roughly that of the ray, mean over the bands
    /// The light of its water and what a white surface would show, as guessed before any path.
    double estimated_water = 0, estimated_surface = 0;
    /// The camera's radiance per light on a white surface, by band, and its mean over the bands.
    std::vector<float> seen_of_band;
    double surface_seen = 0;
    /// What of its water's light the indirect light on surfaces makes, by band.
    std::vector<float> lit_indirect;
    /// Two independent estimates: what is decided by one is applied to the other.
    std::array<NodeRadiance, 2> halves;
    double water_share = 1, surface_share = 1;  // NodePaths'
    /// What a path of one kind brings, as means over the bands, and its work.
    struct Moments {
        double mean = 0, variance = 0, work = 0;
    };
    Moments lit, water;       // NodePaths
    double surface_work = 0;  // of a path of the third kind
};

/// How many light paths of each kind a node gets: these where its light is guessed to be typical,
/// and the more the brighter it is, as noise is in proportion to the light.
struct NodePaths {
    int surface = 512;  // from its surface: indirect light on it
    int lit = 512;      // to surfaces that are seen through scattering
    int water = 512;    // in the water alone
    // The means of what nodes guess; 0: all of them get as many.
    double typical_water = 0, typical_surface = 0;

    /// The numbers for a node, relative to these: of paths in the water, and of those from its
    /// surface.
    double water_share(const RadianceNode& node) const;
    double surface_share(const RadianceNode& node) const;
};

/// Estimates nodes by light paths. Thread safe.
class RadianceEstimator {
  public:
    /// All references must outlive this object; `transport` has paths. `groups`: one for all light,
    /// or one per lamp and one for emission.
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

    /// What the ray of a node sees: in the image at (x, y) [pixels], with random numbers of `seed`.
    struct Place {
        double x = 0, y = 0;
        std::uint64_t seed = 0;
    };
    /// Begins a node with the indirect light on its surface, if it has one.
    void estimate_surface(const Place& place, const NodePaths& paths, RadianceNode& node) const;
    /// The surfaces that some paths from a node meet first (PathTracer::find_lit_surface), and
    /// where its ray begins in the water.
    Point3 find_lit_surfaces(const Place& place, int paths,
                             std::vector<SurfaceSample>& samples) const;
    /// Adds the light of the water to a node that was begun. `indirect`: on all surfaces, by group
    /// and band. `typical_light`: the mean of the begun nodes' `mean_light`; it guides paths.
    void estimate_water(const Place& place, const NodePaths& paths, const IrradianceCache& indirect,
                        double typical_light, RadianceNode& node) const;
    /// The light on one surface sample alone, by this many paths; and its errors, as far as two
    /// halves of the paths can tell.
    void estimate_surface(const SurfaceSample& sample, int paths, NodeRadiance& light,
                          SurfaceErrors& errors) const;
    /// What the sample's specular lobe mirrors (PathTracer::trace_mirrored), by this many paths:
    /// the radiance at the sample, by group and band, and the sum over the paths of the squares of
    /// theirs, by band.
    void estimate_mirrored(const SurfaceSample& sample, int paths, std::vector<double>& radiance,
                           std::vector<double>& squares) const;

  private:
    class WaterSum;
    class SurfaceSum;
    struct Workspace;

    static Workspace& workspace_of_thread();
    void begin(const SurfaceSample& sample, bool has_hit, Workspace& w, RadianceNode& node) const;
    void trace_surface(std::uint64_t seed, int paths, Workspace& w, RadianceNode& node) const;

    const RaySource& rays_;
    const LitScene& scene_;
    const LightTransport& transport_;
    const IntervalWeights& weights_;
    const DistanceIntervals& intervals_;
    std::size_t groups_;
};

/// The cosine of the largest angle between the normals at two places whose indirect light is
/// alike.
inline constexpr double k_min_node_cosine = 0.96;

/// How much of the water of an interval lies before a node's surface: of `enough` of it the node
/// tells what light there is, of `little` if no other node does.
enum class NodeReach : unsigned char { none, little, enough };
inline NodeReach reach_into(const RadianceNode& node, const DistanceIntervals& intervals,
                            std::size_t interval) {
    constexpr double k_min_share = 0.3;
    if (node.mean_weights.empty() || node.reach <= intervals.begin(interval))
        return NodeReach::none;
    return intervals.share(interval, 0, node.reach) >= k_min_share ? NodeReach::enough
                                                                   : NodeReach::little;
}

/// Whether two nodes tell of light on the same surface.
inline bool see_same_surface(const RadianceNode& a, const RadianceNode& b) {
    return a.surface && b.surface && a.surface->object_id == b.surface->object_id &&
           a.surface->is_glossy == b.surface->is_glossy &&
           glm::dot(a.surface->normal, b.surface->normal) >= k_min_node_cosine;
}

}  // namespace uw
