#pragma once

#include <array>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/image/image_quantity.h"
#include "core/light/integrator.h"
#include "core/light/medium.h"
#include "core/light/slabs.h"
#include "core/passes/forward_scatter.h"
#include "core/passes/pixel_view.h"

namespace uw {

/// A path through the water, or a mean of paths: its length [m] and the column densities along it
/// [unit m].
struct WaterPath {
    double length = 0;
    std::vector<double> columns;  // one per constituent

    void reset(std::size_t constituents) {
        length = 0;
        columns.assign(constituents, 0.0);
    }
    /// Adds `weight` times another path.
    void add(double weight, double other_length, std::span<const double> other_columns) {
        length += weight * other_length;
        for (std::size_t k = 0; k < columns.size(); ++k) columns[k] += weight * other_columns[k];
    }
};

/// Computes the columns from the lamps to points in the water, and their means over the lamps.
class LampPaths {
  public:
    /// `column` computes the columns from one lamp to a point; `scene` must outlive this object.
    using PointColumn =
        std::function<void(std::size_t lamp, const Point3& x, std::span<double> column)>;
    LampPaths(const LitScene& scene, PointColumn column)
        : scene_(scene), column_(std::move(column)) {}

    /// Adds `weight` times the mean over all lamps of the path from a lamp to `x`, whether or not
    /// the lamp illuminates it: the paper's mean distance.
    void add_mean(double weight, const Point3& x, WaterPath& path) const;

  private:
    LitScene scene_;
    PointColumn column_;
};

/// The light scattered in by one slab of water along one ray.
struct SlabLight {
    bool visible = false;  // whether the ray reaches the slab; if not, all else is 0
    /// For each lamp, the mean light that the slab scatters towards the camera, over the part
    /// before the ray's end: E_s of the paper's equation 17 [W m^-3 sr^-1].
    std::vector<Spectrum> lamps;
    /// The radiance at the camera per E_s: int e^-tau ds over the whole slab [m]. In the paper's
    /// output, it is weighted by distance like the radiance (SensorModel::surface_factor).
    Spectrum weight;
    /// The paths from the lamps to the middle of the visible part of the slab, and from there to
    /// the glass.
    WaterPath to_lamps, to_camera;
};

/// Integrates in-scattering along camera rays slab by slab.
class InScatterSlabs {
  public:
    /// `faces`: camera z of the slab boundaries [m], ascending; or, if the slabs are `shells`,
    /// their distances along rays in the water, for views too wide for planes. `sensor` determines
    /// how `integrate` weights light by distance. All references must outlive this object.
    InScatterSlabs(const LitScene& scene, const Integrator& integrator, const LampPaths& paths,
                   const Affine& world_from_camera, std::vector<double> faces, bool shells,
                   const SensorModel& sensor);

    /// Joins pairs of slabs that lie before `end`, a camera z or distance, but not across the ends
    /// of `kept`.
    void join_pairs(double end, const Interval& kept);

    std::size_t count() const { return faces_.size() - 1; }
    /// The camera z, or distance, of face `i` and of the centre of slab `i` [m].
    double face(std::size_t i) const { return faces_[i]; }
    double middle(std::size_t i) const { return 0.5 * (faces_[i] + faces_[i + 1]); }
    /// Converts distances along a ray to the coordinate of the faces.
    RayDepth depth(const Ray& ray) const {
        return shells_ ? RayDepth::from_origin() : RayDepth(camera_from_world_, ray);
    }

    /// Integrates slabs `first` to `last` - 1 along `ray` up to the distance `end` [m]. Thread
    /// safe.
    void integrate(const Ray& ray, double end, std::size_t first, std::size_t last,
                   std::vector<SlabLight>& slabs) const;

  private:
    // Sets the weight and the paths of the slab between `begin` and `end`, and divides the light of
    // the lamps by the weight of the visible part.
    void fill_slab(const Ray& ray, double begin, double end, double behind, WaterPath& path,
                   SlabLight& slab) const;
    // Returns int e^-tau ds over `part`, which continues `path`.
    Spectrum weight(const WaterPath& path, const WaterPath& part) const;

    LitScene scene_;
    const Integrator& integrator_;
    const LampPaths& paths_;
    Affine camera_from_world_;
    std::vector<double> faces_;
    bool shells_;
    AttenuationTable attenuation_;
    SensorModel sensor_;
};

/// One value per pixel.
using ImagePlane = Grid2D<float>;

/// A path through the water for every pixel.
class PathImage {
  public:
    PathImage() = default;
    PathImage(int width, int height, std::size_t constituents)
        : length_(width, height), columns_(constituents, ImagePlane(width, height)) {}

    void set(std::size_t pixel, const WaterPath& path) {
        length_[pixel] = static_cast<float>(path.length);
        for (std::size_t k = 0; k < columns_.size(); ++k)
            columns_[k][pixel] = static_cast<float>(path.columns[k]);
    }
    const ImagePlane& length() const { return length_; }
    const ImagePlane& column(std::size_t constituent) const { return columns_[constituent]; }
    /// Calls `change` with each plane of `from` and the corresponding one of this image.
    template <class Change>
    void fill_from(const PathImage& from, const Change& change) {
        change(from.length_, length_);
        for (std::size_t k = 0; k < columns_.size(); ++k) change(from.columns_[k], columns_[k]);
    }

  private:
    ImagePlane length_;
    std::vector<ImagePlane> columns_;
};

/// Blurs images by the paths of their pixels, one band at a time (ForwardScatter). In water that
/// varies, a path is characterized by its blur length, int b/b_0 ds, and its optical depth, both of
/// which are linear in its columns.
class PathScatter {
  public:
    PathScatter(const ForwardScatterDesc& desc, const ScatterPlane& plane, const Medium& medium)
        : PathScatter(ForwardScatter(desc, plane), medium, plane.width, plane.height) {}
    /// The same for light at the nodes of a grid. Precondition: desc.K > 0.
    PathScatter(const ForwardScatterDesc& desc, const ScatterPlane& plane, const Medium& medium,
                double spacing);

    /// Spreads the light of a band along its paths. Paths of dark pixels are not read. `means`: as
    /// ForwardScatter::add.
    void add(std::size_t band, const ImagePlane& light, const PathImage& paths, bool means = false);
    /// Writes the sum of all light that was spread, and resets it to zero: ForwardScatter::finish
    /// and finish_pixels.
    void finish(ImagePlane& added) { scatter_.finish(added.values()); }
    void finish_pixels(ImagePlane& added) { scatter_.finish_pixels(added.values()); }

  private:
    PathScatter(ForwardScatter scatter, const Medium& medium, int width, int height);

    ForwardScatter scatter_;
    AttenuationTable attenuation_;
    Spectrum uniform_b_{};                 // b_0 [1/m]
    std::vector<Spectrum> constituent_b_;  // [1/m per unit]
    ImagePlane blur_length_, optical_depth_;
};

/// Throws InputError at `where` unless `medium` defines blur lengths: water that varies needs a
/// uniform part that scatters.
void check_blur_length(const Medium& medium, const SourceLocation& where);

/// The depth to which each pixel sees into the water, in the coordinate of the slabs' faces. If the
/// samples of a pixel end at several depths, those in front of the widest gap form one part of the
/// pixel, and those behind it another.
class VisibleWater {
  public:
    VisibleWater() = default;
    VisibleWater(int width, int height) : fractions_(width, height) {
        for (ImagePlane& depth : depths_) depth.assign(width, height);
    }

    /// Stores a pixel; `depth` is that along its ray. To be called once per pixel, from any thread;
    /// pixels that are not stored see no water.
    void set(std::size_t pixel, const PixelView& view, const RayDepth& depth);

    /// `alpha` is the fraction of a pixel that sees any water, and `beyond` that which sees beyond
    /// `z`.
    double alpha(std::size_t pixel) const {
        return static_cast<double>(fractions_[pixel][0]) +
               static_cast<double>(fractions_[pixel][1]);
    }
    double beyond(std::size_t pixel, double z) const {
        double sum = 0;
        for_each(pixel, [&](double fraction, double end) {
            if (end > z) sum += fraction;
        });
        return sum;
    }
    /// Calls `body(fraction, end)` for each part of a pixel.
    template <class Body>
    void for_each(std::size_t pixel, const Body& body) const {
        for (std::size_t n = 0; n < 2; ++n)
            if (fractions_[pixel][n] > 0)
                body(static_cast<double>(fractions_[pixel][n]),
                     static_cast<double>(depths_[n][pixel]));
    }
    /// The greatest depth at which the pixel's water ends, 0 without water.
    double end(std::size_t pixel) const {
        return static_cast<double>(depths_[fractions_[pixel][1] > 0 ? 1 : 0][pixel]);
    }
    std::size_t size() const { return fractions_.size(); }
    int width() const { return fractions_.width(); }
    int height() const { return fractions_.height(); }

    /// The least and the greatest depth of all pixels. The least is -infinity if any sample of a
    /// pixel sees no water.
    struct Extent {
        double nearest = std::numeric_limits<double>::infinity();
        double farthest = 0;
    };
    Extent extent() const;

  private:
    Grid2D<std::array<float, 2>> fractions_;
    std::array<ImagePlane, 2> depths_;  // near, far
};

}  // namespace uw
