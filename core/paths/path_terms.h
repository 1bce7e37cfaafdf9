#pragma once

#include <cstddef>
#include <limits>
#include <span>

namespace uw {

/// In place of a lamp's index: light emitted by surfaces.
inline constexpr std::size_t k_no_lamp = std::numeric_limits<std::size_t>::max();

/// The light that one light path, or one bundle of them, brings to the camera.
struct PathTerm {
    std::size_t lamp = k_no_lamp;  // where it comes from, by index
    int scatterings = 0;           // in the water, on the way
    int reflections = 0;           // by surfaces
    bool from_water = false;       // it was last scattered by the water, not reflected or emitted
    double distance = 0;           // from the ray's origin to where that happened [m]
    /// Estimate of the radiance, one value per band of the scene [W m^-2 sr^-1].
    std::span<const double> radiance;
};

/// Receives the terms of a path one by one. Their sum is an unbiased estimate.
class PathTerms {
  public:
    virtual ~PathTerms() = default;
    virtual void add(const PathTerm& term) = 0;
};

}  // namespace uw
