#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "core/base/grid2d.h"
#include "core/base/ray.h"
#include "core/image/film.h"
#include "core/image/image_quantity.h"
#include "core/light/integrator.h"
#include "core/light/integrator_kind.h"
#include "core/light/lamps_in_view.h"
#include "core/light/slabs.h"
#include "core/passes/pixel_layers.h"
#include "core/passes/pixel_view.h"

namespace uw {

class TexturedSurfaces;

/// The point of the aperture that belongs to a point of the unit square, evenly, by squares that
/// become rings (Shirley and Chiu 1997): neighbours stay neighbours.
inline AperturePoint aperture_point(double a, double b) {
    const double x = 2 * a - 1, y = 2 * b - 1;
    if (x == 0 && y == 0) return {};
    const bool is_wide = std::abs(x) > std::abs(y);
    const double radius = is_wide ? x : y;
    const double quarter = std::numbers::pi / 4;
    const double angle = is_wide ? quarter * (y / x) : 2 * quarter - quarter * (x / y);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// The samples of every pixel.
struct PixelSamples {
    int count = 1;  ///< >= 1; a single one lies at the pixel's centre
    /// The samples of an exposure whose parts cover the pixel together: how many there are in all
    /// parts, and how many in those before this one. 0: the image is no part.
    int total = 0, first = 0;
};

/// A place in a pixel, from its corner [pixels].
struct ImageOffset {
    double x, y;
};

/// Where in a pixel, through which point of the aperture and when its samples are taken: evenly in
/// each, and in all of them together. Places are the same in all pixels, points and moments differ,
/// as the same ones in all would show as many sharp images.
class PixelSampling {
  public:
    /// The samples are those of pixel (x, y).
    PixelSampling(const PixelSamples& samples, int x, int y);

    /// The place of sample `i` < count. They are Hammersley points: every sample has its own row
    /// and column of the pixel, and a single one has the centre. In a part of an exposure, whose
    /// samples are in the order of time, they are Halton points: those that follow each other cover
    /// the pixel, too.
    ImageOffset offset(int i) const;
    AperturePoint aperture(int i) const;
    /// The moment of the exposure or of its part, 0 to 1: one in each of `count` equal spans.
    double moment(int i) const { return (i + shift_moment_) / samples_.count; }

  private:
    PixelSamples samples_;
    double shift_a_, shift_b_, shift_moment_;
};

/// Looks for the points at the centres of neighbouring pixels in the other images: sets
/// PixelView::matches of the views that have one.
void find_matches(const PointMatchers& matchers, std::span<PixelView> views);

/// Makes of them flow and disparity. Precondition: the view has a point, and its matches were
/// found.
void store_matches(const PointMatchers& matchers, const PixelView& view, PixelResult& result);

/// Turns light transport into pixels: many samples to antialias surfaces, one ray for the water.
class PixelRenderer {
  public:
    /// All references must outlive the renderer. The first of `slabs` is the water of
    /// `backscatter_first`. `sensor` determines the quantity that the image holds: by default
    /// radiance. `matchers` look for the points of the image in others.
    PixelRenderer(const RaySource& rays, const LitScene& scene, const LightTransport& transport,
                  const PixelSamples& samples, const Slabs& slabs, const SensorModel& sensor = {},
                  const InScatterParts& parts = {}, const PointMatchers& matchers = {});

    /// By what the light of a pixel is multiplied, by band, before it is stored: weight(x, y).
    using PixelWeight = std::function<Spectrum(int x, int y)>;
    void set_weight(PixelWeight weight) { weight_ = std::move(weight); }
    /// Does so.
    void weigh(int x, int y, PixelResult& result) const {
        if (weight_ && result.alpha > 0) result.dim(weight_(x, y));
    }

    int lamp_count() const { return static_cast<int>(scene_.lamp_count()); }
    int band_count() const { return scene_.medium->band_count(); }
    int samples() const { return samples_.count; }
    /// PixelSamples::first: of light paths, too.
    int first_sample() const { return samples_.first; }
    const RaySource& rays() const { return rays_; }
    const RayInScatter& in_scatter() const { return in_scatter_; }
    /// The same in parts that add up to it, each to be interpolated between pixels by itself.
    std::span<const RayInScatter> in_scatter_parts() const {
        return parts_.empty() ? std::span(&in_scatter_, 1) : std::span(parts_);
    }
    const LightTransport& transport() const { return transport_; }
    const LitScene& scene() const { return scene_; }
    const PointMatchers& matchers() const { return matchers_; }
    const LampsInView& lamps_in_view() const { return lamps_in_view_; }

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
    // For mattes: notes what the samples see.
    void add_seen(const PixelView& view, PixelResult& result) const;
    void add_lamp(const SeenLamp& lamp, PixelResult& result) const;
    void add_water(std::span<const double> in_scatter, PixelResult& result) const;
    // Starts a view with the ray through the pixel's centre.
    void begin_view(int x, int y, PixelView& view) const;
    // Takes the ground truth from the ray's hit, if it has one.
    void finish_ground_truth(PixelView& view) const;
    void store_truth(const PixelView& view, PixelResult& result) const;
    // Makes the pixel's centre its only sample.
    void add_center(PixelView& view) const;
    // Traces the samples, unless there is only one, which is the pixel's centre.
    void add_samples(int x, int y, PixelView& view) const;

    const RaySource& rays_;
    LitScene scene_;
    const LightTransport& transport_;
    PixelSamples samples_;
    SensorModel sensor_;
    RayInScatter in_scatter_;
    std::vector<RayInScatter> parts_;  // of LightTransport::parts
    LampsInView lamps_in_view_;
    const TexturedSurfaces* textures_;  // null: no surface has any
    PointMatchers matchers_;
    PixelWeight weight_;                                  // null: 1
    std::vector<float> object_mattes_, material_mattes_;  // by SurfaceHit's ids
    Affine camera_from_world_;
};

}  // namespace uw
