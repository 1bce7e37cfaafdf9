#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "core/geometry/geometry_scene.h"
#include "core/geometry/surfaces.h"

namespace uw::test {

/// Surfaces of `geometry` in three bands; warnings are dropped.
inline std::unique_ptr<Surfaces> build(const std::vector<GeometryDesc>& geometry) {
    std::vector<std::string> warnings;
    return build_surfaces(geometry, std::vector<double>{620, 540, 450}, warnings);
}

/// Origins and directions of rays, the same in every run.
class Random {
  public:
    double uniform(double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(engine_);
    }
    Point3 point(double size) {
        return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
    }
    Vector3 direction() {
        const double z = uniform(-1, 1), phi = uniform(0, 2 * std::numbers::pi);
        return {std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z};
    }

  private:
    std::mt19937_64 engine_{20240611};
};

}  // namespace uw::test
