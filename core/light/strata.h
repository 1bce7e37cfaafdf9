#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "core/base/ray.h"
#include "core/base/vector_math.h"

namespace uw {

/// Concentrations that depend only on the depth below a plane: linear between the depths of a
/// table, and constant above and below it. Their columns have a closed form everywhere. Above a
/// plane that is a mirror lies the image of what is below (core/light/submerged.h).
class Strata {
  public:
    /// Concentrations of one of the medium's constituents, >= 0 [in its unit], one per depth.
    struct Curve {
        std::size_t constituent = 0;
        std::vector<double> values;
    };

    /// `surface` is a point of the plane of depth 0, `up` its unit normal out of the water (world);
    /// `depths` ascend [m].
    Strata(const Point3& surface, const Vector3& up, std::vector<double> depths,
           std::vector<Curve> curves, bool is_mirror = false)
        : surface_(surface),
          up_(up),
          is_mirror_(is_mirror),
          depths_(std::move(depths)),
          curves_(std::move(curves)) {}

    const std::vector<double>& depths() const { return depths_; }
    const std::vector<Curve>& curves() const { return curves_; }
    /// The depth of `x` below the plane [m], or that of its image if the plane is a mirror.
    double depth(const Point3& x) const {
        const double below = -glm::dot(x - surface_, up_);
        return is_mirror_ ? std::abs(below) : below;
    }

    /// Adds the concentrations at `x` to those of all constituents.
    void add_sample(const Point3& x, std::span<double> concentration) const;
    /// Adds the integrals of the concentrations from `a` to `b` [unit m].
    void add_column(const Point3& a, const Point3& b, std::span<double> column) const;
    /// Appends the distances within (0, s_end) at which `ray` passes the table's depths, ascending:
    /// concentrations along it are linear between them.
    void append_breaks(const Ray& ray, double s_end, std::vector<double>& s) const;

  private:
    /// add_column on one side of a mirror.
    void add_straight_column(const Point3& a, const Point3& b, std::span<double> column) const;
    /// The interval of the table at a depth: 0 above its first depth, i between depths i - 1 and i.
    std::size_t interval(double depth) const;
    double value(const Curve& curve, double depth, std::size_t interval) const;

    Point3 surface_;
    Vector3 up_;
    bool is_mirror_;
    std::vector<double> depths_;
    std::vector<Curve> curves_;
};

}  // namespace uw
