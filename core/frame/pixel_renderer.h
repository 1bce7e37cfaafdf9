#pragma once

#include <span>
#include <vector>

#include "core/base/ray_source.h"
#include "core/frame/pixel_view.h"
#include "core/frame/ray_in_scatter.h"
#include "core/image/film.h"
#include "core/integrators/integrator.h"
#include "core/integrators/lit_scene.h"
#include "core/integrators/sensor.h"
#include "core/integrators/slabs.h"

namespace uw {

/// Everything one pixel holds. Radiometric values are means over the pixel's samples; ground truth
/// (`hit` and the depths) belongs to the pixel's centre. W m^-2, metres, world space. Radiance
/// (direct, backscatter, clean, lamps) is that in water, W m^-2 sr^-1; in the paper's output light
/// has its factor by distance besides (SensorModel::surface_factor).
struct PixelResult {
    double alpha = 0;         // share of samples whose ray enters the water
    double pixel_factor = 1;  // what radiance is multiplied by in images: SensorModel::pixel_factor
    Spectrum direct{};
    Spectrum backscatter{};
    Spectrum backscatter_first{};  // of the first slab
    Spectrum irradiance{};         // on the surface, 0 where there is none
    Spectrum exitance{};           // of the surface: what it reflects of the irradiance
    Spectrum clean{};              // radiance of the surface without water
    Spectrum transmittance{};      // surface to port, mean over samples that meet a surface
    double lit = 0;                // mean fraction of lamps that see the surface
    /// Radiance due to each lamp: direct + backscatter. Empty unless InScatterParts::lamps.
    std::vector<Spectrum> lamps;
    bool has_hit = false;  // whether the centre's ray meets a surface
    SurfaceHit hit;
    double depth_z = 0;  // camera-frame z of the hit
    double range = 0;    // from the camera's centre to the hit
    double path = 0;     // in water, from the outer glass surface to the hit
};

/// Turns integrators into pixels: many samples for the edges of surfaces, one ray for the water.
class PixelRenderer {
  public:
    /// All references outlive the renderer. `samples` >= 1 per pixel; one lies at the centre. The
    /// first of `slabs` is the water of `backscatter_first`. `sensor` says what the image is to
    /// hold: the radiance itself if left out.
    PixelRenderer(const RaySource& rays, const LitScene& scene, const Integrator& integrator,
                  int samples, const Slabs& slabs, const SensorModel& sensor = {},
                  const InScatterParts& parts = {});

    int lamp_count() const { return static_cast<int>(scene_.lamps->size()); }
    int band_count() const { return scene_.medium->band_count(); }
    int samples() const { return samples_; }
    const RaySource& rays() const { return rays_; }
    const RayInScatter& water() const { return water_; }

    /// Traces the samples of pixel (x, y). Thread safe.
    void look(int x, int y, PixelView& view) const;
    /// Likewise of all pixels of a window, row by row: faster than one after another.
    void look(const PixelWindow& window, std::span<PixelView> views) const;
    /// Light on the surfaces that pixels look at: the samples of one view after those of another.
    /// Thread safe.
    void light_surfaces(std::span<const PixelView> views, SurfaceLight& light) const;
    /// What a pixel holds: `light` has its samples from `first_sample` on, and `water` is its row
    /// of in-scatter (RayInScatter). `result` is reused storage. Thread safe.
    void shade(const PixelView& view, const SurfaceLight& light, std::size_t first_sample,
               std::span<const double> water, PixelResult& result) const;
    /// All of it for one pixel, with its own water.
    void render(int x, int y, PixelResult& result) const;

  private:
    void add_surface(const SurfaceSample& surface, const SurfaceLight& light, std::size_t sample,
                     PixelResult& result) const;
    void add_water(std::span<const double> row, PixelResult& result) const;
    // Begins a view with the ray at the pixel's centre.
    void begin_view(int x, int y, PixelView& view) const;
    // Makes the ray's hit, if it has one, the view's ground truth.
    void finish_ground_truth(PixelView& view) const;
    // Makes the pixel's centre its only sample.
    static void add_center(PixelView& view);
    // Traces the samples: all but a single one, which is the pixel's centre.
    void add_samples(int x, int y, PixelView& view) const;

    const RaySource& rays_;
    LitScene scene_;
    const Integrator& integrator_;
    int samples_;
    SensorModel sensor_;
    RayInScatter water_;
    Affine camera_from_world_;
};

}  // namespace uw
