#pragma once

#include <cstdint>
#include <string_view>

#include "core/base/random.h"
#include "core/scene/navigation_sensor_desc.h"

namespace uw {

/// The key of a sensor's random numbers: those of another channel, seed or name are independent.
std::uint64_t noise_key(const NavigationSensorDesc& sensor, std::uint64_t channel);

/// The random numbers of one reading, which depend on the key and its number alone.
PathRandom numbers_of_reading(std::uint64_t key, std::int64_t reading);

/// A reading of three axes.
struct TriadReading {
    Vector3 value{0.0}, bias{0.0};
};

/// The errors of a sensor with three axes, reading by reading (TriadDesc). White noise of the
/// density s has the standard deviation s sqrt(rate) in a reading; the bias changes by
/// w / sqrt(rate) from one reading to the next (Woodman 2007, "An introduction to inertial
/// navigation", section 3).
class TriadErrors {
  public:
    /// `first`: the number of the sensor's first reading, at which the bias is that of the desc.
    TriadErrors(const TriadDesc& desc, double rate, std::uint64_t key, std::int64_t first);

    /// The reading of number `reading`, whose truth is `truth`. Precondition: not before that of
    /// the last call, or the first.
    TriadReading read(const Vector3& truth, std::int64_t reading);

  private:
    const TriadDesc& desc_;
    double noise_, step_;  // standard deviations
    std::uint64_t key_;
    std::int64_t at_;  // the reading that the bias is of
    Vector3 bias_;
};

/// A reading of one number (ScalarErrorDesc). `random` are the numbers of the reading.
double scalar_reading(double truth, const ScalarErrorDesc& error, PathRandom& random);

}  // namespace uw
