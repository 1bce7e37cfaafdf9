#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/base/vector_math.h"
#include "core/geometry/surfaces.h"
#include "core/light/integrator.h"
#include "core/light/lamps_in_view.h"
#include "core/light/slabs.h"
#include "core/light/surface_lighting.h"

namespace uw {

/// The position in another image of a point that one image sees.
struct PointMatch {
    /// Image position [pixels], perhaps outside the image; NaN where the camera cannot image it.
    double x = std::numeric_limits<double>::quiet_NaN();
    double y = std::numeric_limits<double>::quiet_NaN();
    bool is_occluded = true;  ///< hidden by a surface, or not within the image
};

/// Finds the surface points of one image in another image of the scene: of another frame, or of
/// another camera. Thread safe.
class PointMatcher {
  public:
    virtual ~PointMatcher() = default;

    /// Sets `matches[i]` to the match of `hits[i]`, none for a point without a counterpart. A
    /// single call for neighbouring points is faster than one for each.
    virtual void match(std::span<const SurfaceHit* const> hits,
                       std::span<std::optional<PointMatch>> matches) const = 0;
};

/// Finds in the next frame's image what drifts with the water of volumes. Thread safe.
class PlumeMatcher {
  public:
    virtual ~PlumeMatcher() = default;

    /// The position in the next frame of what is at `point` (world) now; none if no volume's
    /// velocity is known there or it leaves what the camera can image.
    virtual std::optional<PointMatch> match(const Point3& point) const = 0;
};

/// The matches of a point in the images of PointMatchers.
struct PointMatches {
    std::optional<PointMatch> next, previous, other_camera;
};

/// The images in which the points of an image are searched; null: not wanted, or there is none.
struct PointMatchers {
    const PointMatcher* next = nullptr;      ///< frame
    const PointMatcher* previous = nullptr;  ///< frame
    const PointMatcher* other_camera = nullptr;
    const PlumeMatcher* plume = nullptr;  ///< in the next frame
    bool is_first_camera = true;          ///< whether this image is that of the pair's first camera
};

/// What the rays of one pixel hit, before any lighting. Reused storage.
struct PixelView {
    double alpha = 0;        // fraction of the samples whose ray enters the water
    std::optional<Ray> ray;  // for in-scattering; none if no ray enters the water
    double x = 0, y = 0;     // image position of that ray
    bool is_central = true;  // whether that is the pixel's centre
    /// The distances up to which in-scattering is integrated [m along `ray`, ascending; k_far
    /// without a surface], and the fraction of the samples that each stands for. Empty without a
    /// ray.
    std::vector<double> distances, weights;

    std::vector<SurfaceSample> samples;  // those that hit a surface
    std::vector<SeenLamp> lamps;         // one for each sample that sees a lamp

    // Ground truth at the pixel's centre:
    bool has_hit = false;
    SurfaceHit hit;
    double depth_z = 0;  // camera-frame z of the hit
    double range = 0;    // from the camera's centre to the hit
    double path = 0;     // in water, from the outer glass surface to the hit
    PointMatches matches;
};

/// The parts into which an image needs in-scattered light to be separated.
struct InScatterParts {
    bool lamps = true;       // each lamp, not only their sum
    bool first_slab = true;  // the first slab
};

/// Integrates the in-scattered radiance along a ray up to given distances. The result for each is a
/// list of values that can be interpolated [W m^-2 sr^-1]: the bands of each lamp (or of all lamps
/// together), followed by those of the first slab, if requested.
class RayInScatter {
  public:
    /// `integrator` must outlive this object.
    RayInScatter(const Integrator& integrator, const Affine& world_from_camera, const Slabs& slabs,
                 int lamps, int bands, const InScatterParts& parts);

    /// Number of values in a list.
    std::size_t value_count() const { return (groups_ + (parts_.first_slab ? 1 : 0)) * bands_; }
    std::size_t band_count() const { return bands_; }
    const InScatterParts& parts() const { return parts_; }
    const Slabs& slabs() const { return slabs_; }
    /// Number of lamp groups: one per lamp, or one for all lamps.
    std::size_t group_count() const { return groups_; }
    /// The bands of one group's light in a list.
    std::span<const double> group(std::span<const double> values, std::size_t group) const {
        return values.subspan(group * bands_, bands_);
    }
    /// The bands of the first slab's light in a list. Precondition: parts().first_slab.
    std::span<const double> first_slab(std::span<const double> values) const {
        return values.subspan(groups_ * bands_, bands_);
    }

    /// Integrates up to each of `distances` [m, > 0] and writes the lists consecutively. Thread
    /// safe.
    void integrate(const Ray& ray, std::span<const double> distances,
                   std::span<double> values) const;

    /// Writes the list of a pixel: the weighted mean over its distances, zeros without a ray.
    /// Thread safe.
    void integrate(const PixelView& view, std::span<double> values) const;

    /// The part of the ray within the first slab [m]; empty if it does not pass it.
    Interval first_slab_along(const Ray& ray) const;

  private:
    const Integrator& integrator_;
    Affine camera_from_world_;
    Slabs slabs_;
    std::size_t lamps_, bands_, groups_;
    InScatterParts parts_;
};

}  // namespace uw
