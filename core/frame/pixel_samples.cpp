#include "core/frame/pixel_samples.h"

#include <cmath>
#include <cstdint>

#include "core/frame/aperture_samples.h"
#include "core/paths/path_random.h"

namespace uw {

namespace {

// Other numbers than for light paths.
constexpr std::uint64_t k_sampling_seed = 0x61706572;

// Base-2 radical inverse: 0, 1/2, 1/4, 3/4, ...; of other bases likewise.
template <unsigned base>
double radical_inverse(int number) {
    double result = 0, digit = 1.0 / base;
    for (auto i = static_cast<unsigned>(number); i != 0; i /= base, digit /= base)
        result += digit * (i % base);
    return result;
}

}  // namespace

PixelSampling::PixelSampling(const PixelSamples& samples, int x, int y) : samples_(samples) {
    const auto pixel = static_cast<std::uint64_t>(y) << 32U | static_cast<std::uint64_t>(x);
    PathRandom random(PathRandom::seed_of(k_sampling_seed, pixel), 0);
    shift_a_ = random.next();
    shift_b_ = random.next();
    shift_moment_ = random.next();
}

ImageOffset PixelSampling::offset(int i) const {
    if (samples_.total > 0) {
        const double half_step = 0.5 / samples_.total;
        const int number = samples_.first + i;
        return {radical_inverse<2>(number) + half_step, radical_inverse<3>(number) + half_step};
    }
    if (samples_.count == 1) return {0.5, 0.5};
    const double half_step = 0.5 / samples_.count;
    return {static_cast<double>(i) / samples_.count + half_step, radical_inverse<2>(i) + half_step};
}

AperturePoint PixelSampling::aperture(int i) const {
    const bool is_part = samples_.total > 0;
    const int number = samples_.first + i;
    const double a = (is_part ? radical_inverse<5>(number) : radical_inverse<3>(number)) + shift_a_;
    const double b = (is_part ? radical_inverse<7>(number) : radical_inverse<5>(number)) + shift_b_;
    return aperture_point(std::fmod(a, 1.0), std::fmod(b, 1.0));
}

}  // namespace uw
