#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "core/base/grid2d.h"
#include "core/optics/concentration_field.h"
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
    /// interpolation error below 0.2 % of the image for plumes with edges of a voxel or two.
    ColumnMap(const ConcentrationField& field, const Point3& lamp, double per_voxel,
              std::size_t memory_budget);

    /// As DeepShadow::columns: bilinear in direction, linear in distance.
    void columns(std::span<const Point3> x, std::span<double> column) const;

    /// As DeepShadow::append_column_breaks: one break every two texels where the ray crosses
    /// directions whose rays hit particles.
    void append_breaks(const Ray& ray, const Interval& interval, std::vector<double>& s) const;

    std::size_t bytes() const;
    std::uint64_t rays_traced() const;

  private:
    struct TexelRay {
        float begin = 0;           // distance at which columns become non-zero [m]
        std::uint32_t count = 0;   // samples; 0: nothing in this direction
        std::uint32_t offset = 0;  // of the first in its row's samples
    };
    struct Face {
        int u0 = 0, v0 = 0;                    // the first texel that is stored
        Grid2D<TexelRay> rays;                 // of the texels that are stored
        std::vector<std::vector<float>> rows;  // [v][ray offset + step * constituents + k]
    };

    void crop(const FaceRectangle& rectangle, Face& out) const;
    void trace_face(const ConcentrationField& field, int face, const FaceRectangle& rectangle,
                    double reach);
    static void append_samples(const ConcentrationProfile& profile, double step,
                               std::vector<float>& samples, TexelRay& ray);
    void add_texel(const Face& face, int u, int v, double distance, double weight,
                   std::span<double> column) const;
    bool any_particles(const Face& face, double u, double v) const;
    double texel_u(double u) const { return (u + 1) * 0.5 * resolution_ - 0.5; }

    Point3 lamp_;
    double per_voxel_;
    std::size_t constituents_;
    int resolution_ = 0;
    double step_ = 0;  // [m]
    std::array<Face, 6> faces_;
};

}  // namespace uw
