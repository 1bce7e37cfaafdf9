#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/image/film.h"
#include "core/passes/camera_radiance_cache.h"
#include "core/passes/pixel_renderer.h"
#include "core/passes/weight_lattice.h"
#include "core/paths/radiance_nodes.h"

namespace uw {

/// The light of a CameraRadianceCache in the pixels of an image, which is of the same moment or of
/// one shortly before or after it. Each pixel interpolates the nodes around its place: in-scattered
/// light by image position and distance, light on surfaces by position among the nodes that see the
/// same surface. It has its own reflectance, its own transmittance, and the halo of the surfaces
/// around it.
class MultipleScattering {
  public:
    /// The cache was traced for these pixels. `pixels` must outlive this object; its light
    /// transport must have paths. `window`: what is rendered.
    MultipleScattering(const PixelRenderer& pixels,
                       std::shared_ptr<const CameraRadianceCache> cache, const PixelWindow& window);
    /// The cache was traced at another moment; `halo`: CameraRadianceCache::halo_at(pixels).
    MultipleScattering(const PixelRenderer& pixels,
                       std::shared_ptr<const CameraRadianceCache> cache, const PixelWindow& window,
                       SurfaceHalo halo);

    /// Adds a pixel's light to multiple_volume, multiple_surface and the lamps of `result`, and
    /// sets its error. The samples of `view` begin at `first_sample` of `light`. Thread safe.
    void add(const PixelView& view, const SurfaceLight& light, std::size_t first_sample,
             PixelResult& result) const;

    /// Rendering::multiple_up_to. Thread safe.
    Spectrum light_of_water(const PixelView& view, double distance) const;

  private:
    struct Corner {
        const SmoothNode* node;
        double weight;
    };
    struct Errors;

    void find_corners(double x, double y, std::vector<Corner>& corners) const;
    void find_matches(double x, double y, const SurfaceHit& hit,
                      std::vector<Corner>& matches) const;
    void find_matches(double x, double y, const SurfaceHit& hit, double min_cosine,
                      std::vector<Corner>& matches) const;
    void add_water(const PixelView& view, std::span<double> light, Errors& errors) const;
    void add_volume(const PixelView& view, PixelResult& result, Errors& errors) const;
    void estimate_unmatched(const SurfaceSample& sample, SmoothNode& node) const;
    void add_surface(const SurfaceSample& sample, std::span<const double> to_camera,
                     PixelResult& result, Errors& errors) const;
    void add_to_lamp(std::size_t group, std::size_t band, double radiance,
                     PixelResult& result) const;

    const PixelRenderer& pixels_;
    std::shared_ptr<const CameraRadianceCache> cache_;
    std::size_t bands_;
    IntervalWeights weights_;
    RadianceEstimator estimator_;
    WeightLattice weight_lattice_;
    std::optional<SurfaceHalo> halo_;  // none: the cache's
};

}  // namespace uw
