#pragma once

#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/base/ray_source.h"
#include "core/frame/pixel_layers.h"
#include "core/frame/pixel_samples.h"
#include "core/frame/pixel_view.h"
#include "core/frame/point_matcher.h"
#include "core/frame/ray_in_scatter.h"
#include "core/image/film.h"
#include "core/integrators/light_transport.h"
#include "core/integrators/lit_scene.h"
#include "core/integrators/sensor.h"
#include "core/integrators/slabs.h"

namespace uw {

/// Turns light transport into pixels: many samples to antialias surfaces, one ray for the water.
class PixelRenderer {
  public:
    /// All references must outlive the renderer. The first of `slabs` is the water of
    /// `backscatter_first`. `sensor` determines the quantity that the image holds: by default
    /// radiance. `matchers` look for the points of the image in others.
    PixelRenderer(const RaySource& rays, const LitScene& scene, const LightTransport& transport,
                  const PixelSamples& samples, const Slabs& slabs, const SensorModel& sensor = {},
                  const InScatterParts& parts = {}, const PointMatchers& matchers = {});

    int lamp_count() const { return static_cast<int>(scene_.lamp_count()); }
    int band_count() const { return scene_.medium->band_count(); }
    int samples() const { return samples_.count; }
    /// PixelSamples::first: of light paths, too.
    int first_sample() const { return samples_.first; }
    const RaySource& rays() const { return rays_; }
    const RayInScatter& in_scatter() const { return in_scatter_; }
    const LightTransport& transport() const { return transport_; }
    const LitScene& scene() const { return scene_; }

    /// Traces the samples of pixel (x, y). Thread safe.
    void trace(int x, int y, PixelView& view) const;
    /// Traces the samples of all pixels of a window: faster than one pixel at a time.
    void trace(const PixelWindow& window, Grid2D<PixelView>& views) const;
    /// Light on the surfaces that pixels see; the samples of the views follow one another in
    /// `light`. Thread safe.
    void light_surfaces(std::span<const PixelView> views, SurfaceLight& light) const;
    /// Assembles a pixel from the samples of `light` from `first_sample` on and the in-scatter
    /// values `in_scatter` (RayInScatter). `result` is reused storage. Thread safe.
    void shade(const PixelView& view, const SurfaceLight& light, std::size_t first_sample,
               std::span<const double> in_scatter, PixelResult& result) const;
    /// The factor of a pixel's light in the image, PixelResult::pixel_factor; 1 without a ray.
    double pixel_factor(const PixelView& view) const;
    /// Only ground truth: where the ray of the pixel's centre hits, and where that is in other
    /// images. Thread safe.
    void find_truth(int x, int y, PixelResult& result) const;
    /// All of the above for a single pixel.
    void render(int x, int y, PixelResult& result) const;

  private:
    void add_surface(const SurfaceSample& surface, const SurfaceLight& light, std::size_t sample,
                     PixelResult& result) const;
    void add_water(std::span<const double> in_scatter, PixelResult& result) const;
    // Starts a view with the ray through the pixel's centre.
    void begin_view(int x, int y, PixelView& view) const;
    // Takes the ground truth from the ray's hit, if it has one.
    void finish_ground_truth(PixelView& view) const;
    void store_truth(const PixelView& view, PixelResult& result) const;
    // Makes the pixel's centre its only sample.
    static void add_center(PixelView& view);
    // Traces the samples, unless there is only one, which is the pixel's centre.
    void add_samples(int x, int y, PixelView& view) const;

    const RaySource& rays_;
    LitScene scene_;
    const LightTransport& transport_;
    PixelSamples samples_;
    SensorModel sensor_;
    RayInScatter in_scatter_;
    PointMatchers matchers_;
    Affine camera_from_world_;
};

}  // namespace uw
