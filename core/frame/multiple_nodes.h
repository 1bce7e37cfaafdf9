#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/grid2d.h"
#include "core/base/ray_source.h"
#include "core/integrators/light_transport.h"
#include "core/integrators/lit_scene.h"
#include "core/paths/path_tracer.h"

namespace uw {

/// The surface that a node's ray hits.
struct NodeSurface {
    std::uint32_t object_id = 0;
    Point3 position;
    Vector3 normal{0, 0, 1};
    bool is_glossy = false;
};

/// Estimates, at one image position, of the light that was scattered or reflected more than once.
struct MultipleNode {
    bool has_ray = false;
    std::optional<NodeSurface> surface;
    double reach = 0;       // of the water along its ray [m]
    double mean_light = 0;  // direct, scattered once and the rest, roughly: mean over the bands
    /// By interval of distance, group and band: radiance from the water within it, at the camera.
    std::vector<float> water;
    /// By group and band: indirect irradiance / pi, what a white surface would reflect, and then
    /// what the surface's specular lobe reflects [W m^-2 sr^-1].
    std::vector<float> diffuse, glossy;
    /// Means over bands and groups, and their variances.
    std::vector<float> water_mean, water_variance;  // by interval
    double diffuse_mean = 0, diffuse_variance = 0;
    double surface_seen = 0;  // the camera's radiance per diffuse_mean
};

/// How nodes are estimated.
struct MultipleNodeOptions {
    std::vector<double> distances;  // the ends of the intervals of the water [m], from 0
    std::size_t groups = 1;         // one for all light, or one per lamp and one for emission
    int paths = 512;                // per node, of each kind
};

/// Estimates nodes by light paths. Thread safe.
class MultipleNodes {
  public:
    /// All references must outlive this object; `transport` has paths.
    MultipleNodes(const RaySource& rays, const LitScene& scene, const LightTransport& transport,
                  MultipleNodeOptions options)
        : rays_(rays), scene_(scene), transport_(transport), options_(std::move(options)) {}

    const MultipleNodeOptions& options() const { return options_; }

    /// The node at image position (x, y) [pixels]. `seed`: of its random numbers.
    void estimate(double x, double y, std::uint64_t seed, MultipleNode& node) const;
    /// `diffuse` and `glossy` alone, of one surface sample by this many paths.
    void estimate_surface(const SurfaceSample& sample, int paths, MultipleNode& node) const;

  private:
    class WaterSum;
    class SurfaceSum;
    struct Workspace;

    static Workspace& workspace_of_thread();
    void begin(const SurfaceSample& sample, bool has_hit, Workspace& w, MultipleNode& node) const;
    void trace_water(std::uint64_t seed, Workspace& w, MultipleNode& node) const;
    void trace_surface(std::uint64_t seed, int paths, Workspace& w, MultipleNode& node) const;

    const RaySource& rays_;
    const LitScene& scene_;
    const LightTransport& transport_;
    MultipleNodeOptions options_;
};

}  // namespace uw
