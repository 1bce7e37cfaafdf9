#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/optics/concentration_field.h"
#include "media/light/column_face.h"
#include "media/light/face_rectangle.h"

namespace uw {

/// Column concentrations around one lamp: rays from the lamp over the directions that contain a
/// grid, each with its cumulative columns at equal steps of distance. The optical depth in every
/// band follows from them (physics section 1).
class ColumnMap {
  public:
    /// Marches the field once along each texel's ray. At the field's centre there are about
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
                    double reach, double reference, const DepthTolerance& tolerance);
    double texel_u(double u) const { return (u + 1) * 0.5 * resolution_ - 0.5; }

    Point3 lamp_;
    double per_voxel_;
    std::size_t constituents_;
    int resolution_ = 0;
    double step_ = 0;  // [m]
    std::array<Face, 6> faces_;
};

}  // namespace uw
