#include "render/navigation/sensor_errors.h"

#include <algorithm>
#include <cmath>

namespace uw {

namespace {

constexpr std::uint64_t k_white = 0, k_walk = 1;

/// Three independent standard normal numbers of a reading.
Vector3 normals_of_reading(std::uint64_t key, std::uint64_t use, std::int64_t reading) {
    PathRandom random = numbers_of_reading(PathRandom::seed_of(key, use), reading);
    const auto [x, y] = standard_normals(random);
    return {x, y, standard_normals(random).first};
}

/// Rounded to the numbers of `bits` that span +-range, and clipped to these.
double digitised(double value, double range, int bits) {
    const double half = std::ldexp(1.0, bits - 1), step = range / half;
    return std::clamp(std::round(value / step), -half, half - 1) * step;
}

}  // namespace

std::uint64_t noise_key(const NavigationSensorDesc& sensor, std::uint64_t channel) {
    std::uint64_t key = PathRandom::seed_of(sensor.seed);
    for (const char c : sensor.name) key = PathRandom::seed_of(key, static_cast<unsigned char>(c));
    return PathRandom::seed_of(key, channel);
}

PathRandom numbers_of_reading(std::uint64_t key, std::int64_t reading) {
    // A seed for each reading, since those of one seed and successive indices are not independent.
    return {PathRandom::seed_of(key, static_cast<std::uint64_t>(reading)), 0};
}

TriadErrors::TriadErrors(const TriadDesc& desc, double rate, std::uint64_t key, std::int64_t first)
    : desc_(desc),
      noise_(desc.noise_density * std::sqrt(rate)),
      step_(desc.random_walk / std::sqrt(rate)),
      key_(key),
      at_(first),
      bias_(desc.bias) {}

TriadReading TriadErrors::read(const Vector3& truth, std::int64_t reading) {
    if (step_ > 0)
        while (at_ < reading) bias_ += step_ * normals_of_reading(key_, k_walk, at_++);
    const Vector3& x = truth;
    const Vector3& m = desc_.misalignment;
    Vector3 value = desc_.scale * x + Vector3(0, m.x * x.x, m.y * x.x + m.z * x.y) + bias_;
    if (noise_ > 0) value += noise_ * normals_of_reading(key_, k_white, reading);
    for (int axis = 0; axis < 3 && desc_.range; ++axis)
        value[axis] = desc_.bits ? digitised(value[axis], *desc_.range, *desc_.bits)
                                 : std::clamp(value[axis], -*desc_.range, *desc_.range);
    return {value, bias_};
}

double scalar_reading(double truth, const ScalarErrorDesc& error, PathRandom& random) {
    const double noise = standard_normals(random).first;
    const double value = truth + error.bias + error.noise * noise;
    return error.resolution > 0 ? std::round(value / error.resolution) * error.resolution : value;
}

}  // namespace uw
