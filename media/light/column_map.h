#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/light/medium.h"
#include "media/light/light_projection.h"

namespace uw {

/// Columns along the rays through a rectangle of a cube face's texels, looked up bilinearly between
/// rays and linearly along them. The spacing of rays, in powers of two of texels, and that of their
/// samples are as wide as a tolerance permits: squares of 16 texels begin with a ray every four
/// texels and are refined until rays halfway confirm the interpolation.
class ColumnFace {
  public:
    /// The field along the ray through texel (u, v), counted from the rectangle's first.
    using March = std::function<void(int u, int v, ConcentrationProfile& profile)>;

    ColumnFace() = default;
    /// Marches the rays of a rectangle of `width` times `height` texels, its border included.
    /// `step`: the least distance between samples [m]. `reference`: a distance from the lamp [m];
    /// at shorter distances d the tolerance is multiplied by (d / reference)^2.
    ColumnFace(int width, int height, int constituents, double step, double reference,
               const DepthTolerance& tolerance, const March& march);

    /// The bytes that each texel takes, in addition to its samples.
    static constexpr std::size_t k_bytes_per_texel = 4 * sizeof(float);

    bool empty() const { return spacing_.empty(); }

    /// Adds the columns up to `distance` in the direction of (u, v) [texels]; nothing outside the
    /// rectangle.
    void add(double u, double v, double distance, std::span<double> column) const;

    /// How far apart the rays around (u, v) are [texels]; 0 where none of them meets particles, or
    /// outside the rectangle.
    int spacing(double u, double v) const;

    std::size_t bytes() const;
    std::uint64_t rays_traced() const;

  private:
    static constexpr int k_square = 16;  // texels along its edge

    struct TexelRay {
        float begin = 0;           // distance at which columns become non-zero [m]
        float step = -1;           // between samples [m]; negative: not traced
        std::uint32_t count = 0;   // samples, at least 2; 0: nothing in this direction
        std::uint32_t offset = 0;  // of the first in its row's samples
        bool traced() const { return step >= 0; }
    };
    static_assert(sizeof(TexelRay) == k_bytes_per_texel);

    void trace(int apart, const DepthTolerance& tolerance, const March& march);
    bool wanted(int u, int v, int apart) const;
    void store(const ConcentrationProfile& profile, const DepthTolerance& tolerance,
               std::vector<float>& samples, TexelRay& ray) const;
    bool confirmed(int square_u, int square_v, int apart, const DepthTolerance& tolerance) const;
    bool agree(int u, int v, int apart, const DepthTolerance& tolerance) const;
    void add_corners(double u, double v, int apart, double distance,
                     std::span<double> column) const;
    void add_ray(int u, int v, double distance, double weight, std::span<double> column) const;

    int width_ = 0, height_ = 0;  // of the rectangle; beyond it lie the last squares' ends
    std::size_t constituents_ = 0;
    double reference_ = 0;                  // [m]
    double step_ = 0;                       // the least between samples [m]
    Grid2D<std::uint8_t> spacing_;          // of each square; 0: not yet known
    Grid2D<TexelRay> rays_;                 // of each texel
    std::vector<std::vector<float>> rows_;  // [v][ray offset + sample * constituents + k]
};

/// Column concentrations around one lamp: rays from the lamp over the directions that contain a
/// grid, each with its cumulative columns at equal steps of distance, and the closed form of what
/// depends on depth alone. The optical depth in every band follows from them (physics section 1).
class ColumnMap {
  public:
    /// Marches the field's grids once along each texel's ray. At the grids' centre there are about
    /// `per_voxel` texels across the finest voxel, and as many steps along it; fewer if a field
    /// that fills its bounds would exceed `memory_budget` [bytes]. `field` is not kept. Columns
    /// have kinks where their rays pass from voxel to voxel: two texels per voxel keep the
    /// interpolation error below 0.2 % of the image for plumes with edges of a voxel or two. Where
    /// `tolerance` permits, rays and steps are fewer (ColumnFace).
    ColumnMap(const ConcentrationField& field, const Point3& lamp, double per_voxel,
              std::size_t memory_budget, const DepthTolerance& tolerance = {});

    /// As DeepShadow::columns: bilinear in direction, linear in distance.
    void columns(std::span<const Point3> x, std::span<double> column) const;

    /// As DeepShadow::append_column_breaks: one break every two of the map's rays where the ray
    /// crosses directions whose rays hit particles.
    void append_breaks(const Ray& ray, const Interval& interval, std::vector<double>& s) const;

    std::size_t bytes() const;
    std::uint64_t rays_traced() const;

  private:
    struct Face {
        int u0 = 0, v0 = 0;  // the first texel that is stored
        ColumnFace columns;
    };

    void trace_face(const ConcentrationField& field, int face, const FaceRectangle& rectangle,
                    double max_distance, double reference, const DepthTolerance& tolerance);
    double texel_u(double u) const { return (u + 1) * 0.5 * resolution_ - 0.5; }

    Point3 lamp_;
    double per_voxel_;
    std::size_t constituents_;
    int resolution_ = 0;
    double step_ = 0;  // [m]
    std::array<Face, 6> faces_;
    std::shared_ptr<const Strata> strata_;  // its columns are exact
};

/// Column concentrations in a sun's light: what a ColumnMap is for a lamp, with parallel rays over
/// a rectangle across the light that contains the field.
class SunColumnMap {
  public:
    /// As the constructor of ColumnMap: about `per_voxel` rays across the finest voxel and as many
    /// steps along it, fewer as the memory or the tolerance permits. `field` is not kept.
    SunColumnMap(const ConcentrationField& field, const Sunlight& sun, double per_voxel,
                 std::size_t memory_budget, const DepthTolerance& tolerance = {});

    /// As DeepShadow::columns: bilinear across the light, linear along it.
    void columns(std::span<const Point3> x, std::span<double> column) const;

    /// As DeepShadow::append_column_breaks: one break every two of the map's rays.
    void append_breaks(const Ray& ray, const Interval& interval, std::vector<double>& s) const;

    std::size_t bytes() const { return face_.bytes(); }
    std::uint64_t rays_traced() const { return face_.rays_traced(); }

  private:
    LightFrame frame_;
    double per_voxel_;
    std::size_t constituents_;
    double texel_ = 0;  // [m]
    LightPoint first_;  // the first texel's ray; its depth is that from which distances count
    int width_ = 0, height_ = 0;
    ColumnFace face_;
    std::shared_ptr<const Strata> strata_;  // as in ColumnMap
};

}  // namespace uw
