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

/// A linear map of the plane: a column is where it takes an axis.
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

/// What an image shows of a small sphere: its disk, blurred by the lens's aperture, which is an
/// ellipse, and drawn out by what moves while the shutter is open [pixels].
class Footprint {
  public:
    /// The position over the time that the shutter is open, t = -1 to 1: at + t linear + t^2
    /// quadratic.
    struct Path {
        std::array<double, 2> at{}, linear{}, quadratic{};
    };

    /// `disk` and `blur` take the unit disk to what the sphere and a point out of focus look like;
    /// a blur of 0 is a sharp image.
    Footprint(const Path& path, const PlaneMap& disk, const PlaneMap& blur);

    /// The area of the sphere's disk [pixels].
    double area() const { return area_; }
    /// The pixels that it touches, wherever the image ends.
    const PixelWindow& bounds() const { return bounds_; }

    /// Adds to each pixel of `window` the share of the footprint that falls into it, to
    /// shares(x - window.x0, y - window.y0); they add up to 1 over all pixels of the plane.
    void add_shares(const PixelWindow& window, Grid2D<double>& shares) const;

  private:
    std::array<double, 2> position(double t) const;
    std::array<double, 2> step_position(int step) const;
    void add_box(const std::array<double, 2>& at, const std::array<double, 2>& half, double weight,
                 const PixelWindow& window, Grid2D<double>& shares) const;
    void add_sharp(const std::array<double, 2>& at, double weight, const PixelWindow& window,
                   Grid2D<double>& shares) const;
    void add_soft(const std::array<double, 2>& at, double weight, const PixelWindow& window,
                  Grid2D<double>& shares) const;
    // How many samples of each pixel an ellipse holds; returns their sum.
    double count_samples(const std::array<double, 2>& at, const PixelWindow& window,
                         Grid2D<double>& counts) const;
    PixelWindow window_around(const std::array<double, 2>& at) const;

    Path path_;
    double area_ = 0;
    bool is_small_ = false;         // a path of it is drawn as boxes of the same extent
    bool is_sharp_ = false;         // an ellipse with a sharp edge
    int steps_ = 1;                 // positions along the path
    std::array<double, 2> half_{};  // of the box; of the box around the ellipse
    PlaneMap unit_from_plane_;      // of the sharp ellipse, or the greater of disk and blur
    double reach_ = 0;              // from the centre of a pixel to its corners, of the unit disk
    double ratio_ = 0;              // of the lesser to it
    int samples_ = 1;               // along each axis of a pixel
    double scale_ = 1;              // of the shares of an ellipse
    bool is_scaled_ = true;         // by scale_; else so that they add up to 1
    PixelWindow bounds_;
};

/// What an image shows of one particle.
struct SnowSplat {
    double distance = 0;   // in water [m]
    std::uint64_t id = 0;  // SnowParticle::id
    /// The share of the light that the water scatters towards the pixel which comes from behind.
    float hidden = 0;
    std::uint32_t radiance = 0;  // index of its first band among SnowSplats::radiance
    Footprint footprint;
};

struct SnowSplats {
    std::vector<SnowSplat> splats;
    std::vector<float> radiance;  // of each particle, by band [W m^-2 sr^-1]

    void append(const SnowSplats& more);
};

/// What the particles in front of a pixel add to it and hide from it.
struct SnowPixel {
    std::span<const float> radiance;  // by band, of all particles [W m^-2 sr^-1]
    double transparency = 1;          // the share of a surface that they leave
    double water = 1;                 // the share of the water's light that they leave
    double held = 0;  // distance of the first that covers at least half of the pixel [m]; 0: none
};

/// The particles of an image, each before those behind it.
class SnowImage {
  public:
    /// Draws `splats` into the pixels of `window`, on all threads. The same particles give the same
    /// pixels in any order and any window.
    SnowImage(const PixelWindow& window, std::size_t bands, const SnowSplats& splats);

    SnowPixel pixel(int x, int y) const;

  private:
    void draw(const SnowSplat& splat, std::span<const float> radiance, const PixelWindow& tile);
    std::span<float> values(int x, int y);

    PixelWindow window_;
    std::size_t bands_;
    Grid2D<float> values_;  // of each pixel: bands_ of radiance, then what is left and held
};

/// How much of the light that the water scatters towards a pixel comes from how far: on a lattice
/// over the image, as the mean over all bands. For what particles hide of it, which is little.
class WaterVeil {
  public:
    /// `depth`: of the particles drawn (SnowModel::drawn_depth).
    WaterVeil(const RaySource& rays, const Integrator& integrator,
              const std::function<double(double distance)>& depth);

    /// The share of the water's light at an image position that comes from beyond `distance`, if it
    /// ends at `end` [m]; 0 if there is none.
    double share_beyond(double x, double y, double distance, double end) const;
    /// e^-depth, as a mean over the water's light that ends at `end`; 1 if there is none.
    double mean_transmittance(double x, double y, double end) const;

  private:
    struct Light {
        double all = 0, transmitted = 0;
    };
    Light light_up_to(double x, double y, double distance) const;

    std::vector<double> distances_;
    Grid2D<std::vector<Light>> nodes_;  // up to each of the distances
};

/// What snow changes in the light of each pixel of an image: the particles' own light, and what
/// they hide.
///
/// The water's coefficients hold the mean of what the particles drawn take away on the light's way
/// to the camera. As the particles do so themselves, what lies behind a mean depth of them is
/// brightened by e^depth first: over many seeds nothing is taken away twice.
class SnowLayer {
  public:
    /// `depth`: of the particles drawn, up to a distance (SnowModel::drawn_depth).
    SnowLayer(SnowImage image, WaterVeil veil, std::function<double(double distance)> depth)
        : image_(std::move(image)), veil_(std::move(veil)), depth_(std::move(depth)) {}

    /// Radiance [W m^-2 sr^-1], negative where more is hidden than added, of a pixel whose water
    /// ends at `end` [m] and scatters `water` towards the camera, where `surface` is its other
    /// light.
    Spectrum radiance(int x, int y, double end, const Spectrum& surface,
                      const Spectrum& water) const;
    /// Distance of the particle that covers at least half of the pixel [m]; 0: none does.
    double held(int x, int y) const { return image_.pixel(x, y).held; }

  private:
    SnowImage image_;
    WaterVeil veil_;
    std::function<double(double distance)> depth_;
};

}  // namespace uw
