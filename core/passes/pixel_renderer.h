#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
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
#include "core/light/medium.h"
#include "core/light/slabs.h"
#include "core/passes/pixel_layers.h"
#include "core/passes/pixel_view.h"

namespace uw {

class TexturedSurfaces;

/// Maps a point of the unit square to the aperture by the concentric map, which preserves area and
/// keeps neighbours close (Shirley and Chiu 1997).
inline AperturePoint aperture_point(double a, double b) {
    const double x = 2 * a - 1, y = 2 * b - 1;
    if (x == 0 && y == 0) return {};
    const bool is_wide = std::abs(x) > std::abs(y);
    const double radius = is_wide ? x : y;
    const double quarter = std::numbers::pi / 4;
    const double angle = is_wide ? quarter * (y / x) : 2 * quarter - quarter * (x / y);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// The number of samples of every pixel.
struct PixelSamples {
    int count = 1;  ///< >= 1; a single sample lies at the pixel's centre
    /// If the image is a part of an exposure, whose parts together cover the pixel: the number of
    /// samples in all parts, and in those before this one. `total` is 0 otherwise.
    int total = 0, first = 0;
};

/// A position in a pixel, from its corner [pixels].
struct ImageOffset {
    double x, y;
};

/// The samples of a pixel: positions in it, points of the aperture and times, stratified in each
/// and in all of them together. All pixels have the same positions, but different aperture points
/// and times: if these were the same, a blur would consist of several sharp images.
class PixelSampling {
  public:
    /// Makes the samples of pixel (x, y).
    PixelSampling(const PixelSamples& samples, int x, int y);

    /// The position of sample `i` < count, a Hammersley point: every sample has its own row and
    /// column of the pixel, and a single one has the centre. In a part of an exposure, whose
    /// samples are ordered by time, it is a Halton point, so that successive samples cover the
    /// pixel, too.
    ImageOffset offset(int i) const;
    AperturePoint aperture(int i) const;
    /// The time of sample `i` in the exposure or its part, 0 to 1: one in each of `count` equal
    /// intervals.
    double moment(int i) const { return (i + shift_moment_) / samples_.count; }

  private:
    PixelSamples samples_;
    double shift_a_, shift_b_, shift_moment_;
};

/// Finds the points at the pixels' centres in the other images: sets PixelView::matches of the
/// views that have a point.
void find_matches(const PointMatchers& matchers, std::span<PixelView> views);

/// Derives flow and disparity from the matches of a view. Precondition: the view has a point, and
/// find_matches was called.
void store_matches(const PointMatchers& matchers, const PixelView& view, PixelResult& result);

/// Renders pixels by single scattering: many samples antialias the surfaces, and a single ray
/// integrates in-scattering.
class PixelRenderer {
  public:
    /// All references must outlive the renderer. The first of `slabs` is that of
    /// `backscatter_first`. `sensor` determines the quantity that the image contains: by default
    /// radiance. `matchers` find the points of the image in others.
    PixelRenderer(const RaySource& rays, const LitScene& scene, const LightTransport& transport,
                  const PixelSamples& samples, const Slabs& slabs, const SensorModel& sensor = {},
                  const InScatterParts& parts = {}, const PointMatchers& matchers = {});

    /// Finds the ground truth of the volumes' particles, too (PixelResult::plume_opacity and so
    /// on).
    void find_plume();

    /// weight(x, y) is the factor, by band, on the light of a pixel before it is stored.
    using PixelWeight = std::function<Spectrum(int x, int y)>;
    void set_weight(PixelWeight weight) { weight_ = std::move(weight); }
    /// Multiplies the light of a pixel by its weight, if there is one.
    void weigh(int x, int y, PixelResult& result) const {
        if (weight_ && result.alpha > 0) result.dim(weight_(x, y));
    }

    int lamp_count() const { return static_cast<int>(scene_.lamp_count()); }
    int band_count() const { return scene_.medium->band_count(); }
    int samples() const { return samples_.count; }
    /// PixelSamples::first, which holds for light paths, too.
    int first_sample() const { return samples_.first; }
    const RaySource& rays() const { return rays_; }
    const RayInScatter& in_scatter() const { return in_scatter_; }
    /// The same in parts that add up to it. Each is interpolated between pixels by itself.
    std::span<const RayInScatter> in_scatter_parts() const {
        return parts_.empty() ? std::span(&in_scatter_, 1) : std::span(parts_);
    }
    const LightTransport& transport() const { return transport_; }
    const LitScene& scene() const { return scene_; }
    const PointMatchers& matchers() const { return matchers_; }
    const LampsInView& lamps_in_view() const { return lamps_in_view_; }

    /// Traces the samples of pixel (x, y). Thread safe.
    void trace(int x, int y, PixelView& view) const;
    /// Traces the samples of all pixels of a window, which is faster than one pixel at a time.
    void trace(const PixelWindow& window, Grid2D<PixelView>& views) const;
    /// Evaluates the light on the surfaces that pixels see. `light` has the samples of the views
    /// one after another. Thread safe.
    void light_surfaces(std::span<const PixelView> views, SurfaceLight& light) const;
    /// Assembles a pixel from the samples of `light`, beginning at `first_sample`, and the values
    /// `in_scatter` (RayInScatter). `result` is reused storage. Thread safe.
    void shade(const PixelView& view, const SurfaceLight& light, std::size_t first_sample,
               std::span<const double> in_scatter, PixelResult& result) const;
    /// Adds the light of one of a pixel's samples, `sample` of `light`, to what shade() makes of
    /// all.
    void add_surface(const SurfaceSample& surface, const SurfaceLight& light, std::size_t sample,
                     PixelResult& result) const;
    /// The same for a lamp that one of them sees.
    void add_lamp(const SeenLamp& lamp, PixelResult& result) const;
    /// Returns the factor on a pixel's light in the image, PixelResult::pixel_factor; 1 without a
    /// ray.
    double pixel_factor(const PixelView& view) const;
    /// Finds ground truth alone: where the ray through the pixel's centre hits, and where that
    /// point is in other images. Thread safe.
    void find_truth(int x, int y, PixelResult& result) const;
    /// Does all of the above for a single pixel.
    void render(int x, int y, PixelResult& result) const;

  private:
    // Records the objects and materials that the samples see, for mattes.
    void add_mattes(const PixelView& view, PixelResult& result) const;
    void add_water(std::span<const double> in_scatter, PixelResult& result) const;
    // Finds the ground truth of a view.
    void trace_center(int x, int y, PixelView& view) const;
    // Begins a view with the ray through the pixel's centre.
    void begin_view(int x, int y, PixelView& view) const;
    // Sets the ground truth from the ray's hit, if there is one.
    void finish_ground_truth(PixelView& view) const;
    void store_truth(const PixelView& view, PixelResult& result) const;
    void store_plume(const PixelView& view, PixelResult& result) const;
    Point3 in_camera(const PixelView& view, const Point3& point) const;
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
    const TexturedSurfaces* textures_;  // null: no surface has textures
    PointMatchers matchers_;
    PixelWeight weight_;                                  // null: 1
    std::optional<AttenuationTable> plume_;               // of the particles; none: not wanted
    std::vector<float> object_mattes_, material_mattes_;  // by SurfaceHit's ids
    Affine camera_from_world_;
};

}  // namespace uw
