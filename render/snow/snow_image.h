#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/base/ray.h"
#include "core/base/spectrum.h"
#include "core/image/film.h"
#include "core/light/integrator.h"

namespace uw {

/// A linear map of the plane; its columns are the images of the axes.
struct PlaneMap {
    double xx = 0, yx = 0;  // first column
    double xy = 0, yy = 0;  // second

    double determinant() const { return xx * yy - xy * yx; }
    PlaneMap inverse() const {
        const double d = determinant();
        return {yy / d, -yx / d, -xy / d, xx / d};
    }
    friend PlaneMap operator*(double a, const PlaneMap& m) {
        return {a * m.xx, a * m.yx, a * m.xy, a * m.yy};
    }
    friend PlaneMap operator*(const PlaneMap& a, const PlaneMap& b) {
        return {a.xx * b.xx + a.xy * b.yx, a.yx * b.xx + a.yy * b.yx, a.xx * b.xy + a.xy * b.yy,
                a.yx * b.xy + a.yy * b.yy};
    }
};

/// The image of a small sphere [pixels]: its disk, an ellipse, blurred by the lens's aperture and
/// by motion while the shutter is open.
class Footprint {
  public:
    /// The position while the shutter is open, t = -1 to 1: at + t linear + t^2 quadratic.
    struct Path {
        std::array<double, 2> at{}, linear{}, quadratic{};
    };

    /// `disk` and `blur` map the unit disk to the sharp image of the sphere and to that of a point
    /// out of focus; a blur of 0 is a sharp image.
    Footprint(const Path& path, const PlaneMap& disk, const PlaneMap& blur);

    /// The area of the sphere's disk [pixels^2].
    double area() const { return area_; }
    /// The pixels that the footprint touches, including those outside the image.
    const PixelWindow& bounds() const { return bounds_; }

    /// Adds the fraction of the footprint that lies in each pixel of `window` to fractions(x -
    /// window.x0, y - window.y0). The fractions sum to 1 over all pixels of the plane.
    void add_fractions(const PixelWindow& window, Grid2D<double>& fractions) const;

  private:
    std::array<double, 2> position(double t) const;
    std::array<double, 2> step_position(int step) const;
    void add_box(const std::array<double, 2>& at, const std::array<double, 2>& half, double weight,
                 const PixelWindow& window, Grid2D<double>& fractions) const;
    void add_sharp(const std::array<double, 2>& at, double weight, const PixelWindow& window,
                   Grid2D<double>& fractions) const;
    void add_soft(const std::array<double, 2>& at, double weight, const PixelWindow& window,
                  Grid2D<double>& fractions) const;
    // Counts the samples of each pixel that lie in an ellipse; returns their sum.
    double count_samples(const std::array<double, 2>& at, const PixelWindow& window,
                         Grid2D<double>& counts) const;
    PixelWindow window_around(const std::array<double, 2>& at) const;

    Path path_;
    double area_ = 0;
    bool is_small_ = false;  // if it moves, it is drawn as boxes with the same second moments
    bool is_sharp_ = false;  // an ellipse with a sharp edge
    int steps_ = 1;          // positions along the path
    std::array<double, 2> half_{};  // half extents of the box, or of the box around the ellipse
    PlaneMap unit_from_plane_;      // of the sharp ellipse, or of the greater one of disk and blur
    double pixel_radius_ = 0;  // from a pixel's centre to its corners, in the unit disk's plane
    double ratio_ = 0;       // radius of the smaller one of disk and blur, relative to the greater
    int samples_ = 1;        // number along each axis of a pixel
    double scale_ = 1;       // fraction per area of an ellipse
    bool is_scaled_ = true;  // by scale_; if not, the fractions are normalized to sum to 1
    PixelWindow bounds_;
};

/// The image of one particle.
struct SnowSplat {
    double distance = 0;   // in water [m]
    std::uint64_t id = 0;  // SnowParticle::id
    /// The fraction of the light scattered in along the pixel's ray that comes from behind the
    /// particle.
    float hidden = 0;
    std::uint32_t radiance = 0;  // index of its first band in SnowSplats::radiance
    Footprint footprint;
};

struct SnowSplats {
    std::vector<SnowSplat> splats;
    std::vector<float> radiance;  // of each particle, by band [W m^-2 sr^-1]

    void append(const SnowSplats& more);
};

/// The light of the particles in front of a pixel, and what they hide.
struct SnowPixel {
    std::span<const float> radiance;  // by band, of all particles [W m^-2 sr^-1]
    double transparency = 1;          // fraction of a surface that stays visible
    double water = 1;                 // fraction of the in-scattered light that stays visible
    /// The distance of the first particle that covers at least half of the pixel [m]; 0: none does.
    double particle_distance = 0;
};

/// The particles of an image, composited from front to back.
class SnowImage {
  public:
    /// Draws `splats` into the pixels of `window`, on all threads. The pixels depend neither on the
    /// order of the splats nor on the window.
    SnowImage(const PixelWindow& window, std::size_t bands, const SnowSplats& splats);

    SnowPixel pixel(int x, int y) const;

  private:
    void draw(const SnowSplat& splat, std::span<const float> radiance, const PixelWindow& tile);
    std::span<float> values(int x, int y);

    PixelWindow window_;
    std::size_t bands_;
    Grid2D<float> values_;  // per pixel: bands_ of radiance, then fractions hidden and distance
};

/// The in-scattered light up to each distance, on a lattice over the image, as the mean over all
/// bands. It determines how much of that light particles hide, for which this accuracy is enough.
class WaterVeil {
  public:
    /// `depth`: the optical depth of the drawn particles up to a distance (SnowModel::drawn_depth).
    WaterVeil(const RaySource& rays, const Integrator& integrator,
              const std::function<double(double distance)>& depth);

    /// Returns the fraction of the in-scattered light at an image position that comes from beyond
    /// `distance`, if the water ends at `end` [m]; 0 if there is none.
    double fraction_beyond(double x, double y, double distance, double end) const;
    /// Returns the mean of e^-depth over the in-scattered light, if the water ends at `end`; 1 if
    /// there is none.
    double mean_transmittance(double x, double y, double end) const;

  private:
    struct Light {
        double all = 0, transmitted = 0;
    };
    Light light_up_to(double x, double y, double distance) const;

    std::vector<double> distances_;
    Grid2D<std::vector<Light>> nodes_;  // up to each of the distances
};

/// Computes the change that snow makes to the light of each pixel of an image: the light of the
/// particles minus what they hide.
///
/// The water's coefficients contain the mean attenuation of the drawn particles along the path to
/// the camera. As the particles also hide what lies behind them, that light is first multiplied by
/// e^depth, where depth is the mean optical depth of the particles: on average over seeds, they
/// attenuate only once.
class SnowLayer {
  public:
    /// `depth`: the optical depth of the drawn particles up to a distance (SnowModel::drawn_depth).
    SnowLayer(SnowImage image, WaterVeil veil, std::function<double(double distance)> depth)
        : image_(std::move(image)), veil_(std::move(veil)), depth_(std::move(depth)) {}

    /// Returns the radiance [W m^-2 sr^-1] that snow adds to a pixel; it is negative where snow
    /// hides more than it adds. The pixel's water ends at `end` [m], its in-scattered light is
    /// `water`, and all its other light is `surface`.
    Spectrum radiance(int x, int y, double end, const Spectrum& surface,
                      const Spectrum& water) const;
    /// The distance of the first particle that covers at least half of the pixel [m]; 0 if none
    /// does.
    double particle_distance(int x, int y) const { return image_.pixel(x, y).particle_distance; }

  private:
    SnowImage image_;
    WaterVeil veil_;
    std::function<double(double distance)> depth_;
};

}  // namespace uw
