#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/integrator.h"
#include "core/lit_scene.h"
#include "core/sensor.h"
#include "core/slabs.h"
#include "core/water_ray.h"

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
    std::vector<Spectrum> lamps;   // radiance due to each lamp: direct + backscatter
    bool has_hit = false;          // whether the centre's ray meets a surface
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
                  int samples, const Slabs& slabs, const SensorModel& sensor = {});

    int lamp_count() const { return static_cast<int>(scene_.lamps->size()); }
    int band_count() const { return scene_.medium->band_count(); }

    /// Renders pixel (x, y); `result` is reused storage. Thread safe.
    void render(int x, int y, PixelResult& result) const;

    /// Told of a surface that one of a pixel's samples meets.
    using HitVisitor = std::function<void(const Ray& ray, const SurfaceHit& hit)>;
    /// The surfaces that `render` of pixel (x, y) takes the mean of, `samples()` at most.
    void visit_hits(int x, int y, const HitVisitor& visit) const;
    int samples() const { return samples_; }

    /// Where the water of a pixel ends [m along its water ray, ascending; k_far without a surface],
    /// and the shares of the samples that end there.
    struct WaterEnds {
        std::vector<double> ends, shares;
    };
    /// The water ray of pixel (x, y), if one enters the water, and its ends, as `render` has them.
    std::optional<Ray> water(int x, int y, WaterEnds& ends) const;

  private:
    struct Workspace;

    // Traces the samples of a pixel: fills result.alpha, its ground truth and w.distances. Returns
    // the water ray.
    std::optional<Ray> trace(int x, int y, Workspace& w, PixelResult& result,
                             const HitVisitor& on_hit) const;
    void add_surface_sample(const Ray& ray, const SurfaceHit& hit, Workspace& w,
                            PixelResult& result) const;
    void add_water(const Ray& ray, Workspace& w, PixelResult& result) const;
    // The first slab's stretch of `ray`; it may begin before the ray does.
    Interval first_slab(const Ray& ray) const;
    void record_ground_truth(const Ray& center, PixelResult& result) const;

    const RaySource& rays_;
    LitScene scene_;
    const Integrator& integrator_;
    int samples_;
    Slabs slabs_;
    SensorModel sensor_;
    Affine camera_from_world_;
};

}  // namespace uw
