#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <span>

namespace uw {

/// Maximum number of wavelength bands in a scene; the number in use is a run-time property of the
/// medium.
inline constexpr int k_max_bands = 32;

/// One value per wavelength band, in the order of `water.bands`; entries past the scene's band
/// count are zero and not read.
///
/// The operators work band by band on all k_max_bands entries, and zeros past the band count stay
/// zeros. Where that would be too slow, or a function does not map 0 to 0, work on the bands in
/// use: `per_band` makes a spectrum from them, `first` is a view of them, for `add` and similar
/// functions.
struct Spectrum {
    std::array<double, k_max_bands> values{};

    constexpr double& operator[](std::size_t band) { return values[band]; }
    constexpr const double& operator[](std::size_t band) const { return values[band]; }
    constexpr double* begin() { return values.data(); }
    constexpr const double* begin() const { return values.data(); }
    constexpr double* end() { return values.data() + values.size(); }
    constexpr const double* end() const { return values.data() + values.size(); }

    /// The first `bands` values: those of the scene's bands.
    constexpr std::span<double> first(std::size_t bands) { return std::span(values).first(bands); }
    constexpr std::span<const double> first(std::size_t bands) const {
        return std::span(values).first(bands);
    }
    /// The least and the greatest of the first `bands` values, bands > 0.
    constexpr double least(std::size_t bands) const { return std::ranges::min(first(bands)); }
    constexpr double greatest(std::size_t bands) const { return std::ranges::max(first(bands)); }

    constexpr Spectrum& operator+=(const Spectrum& other) {
        for (std::size_t b = 0; b < values.size(); ++b) values[b] += other.values[b];
        return *this;
    }
    constexpr Spectrum& operator-=(const Spectrum& other) {
        for (std::size_t b = 0; b < values.size(); ++b) values[b] -= other.values[b];
        return *this;
    }
    constexpr Spectrum& operator*=(const Spectrum& other) {
        for (std::size_t b = 0; b < values.size(); ++b) values[b] *= other.values[b];
        return *this;
    }
    constexpr Spectrum& operator*=(double factor) {
        for (double& value : values) value *= factor;
        return *this;
    }
    constexpr Spectrum& operator/=(double divisor) {
        for (double& value : values) value /= divisor;
        return *this;
    }

    friend constexpr bool operator==(const Spectrum&, const Spectrum&) = default;
    friend constexpr Spectrum operator+(const Spectrum& a, const Spectrum& b) {
        Spectrum result = a;
        result += b;
        return result;
    }
    friend constexpr Spectrum operator-(const Spectrum& a, const Spectrum& b) {
        Spectrum result = a;
        result -= b;
        return result;
    }
    friend constexpr Spectrum operator*(const Spectrum& a, const Spectrum& b) {
        Spectrum result = a;
        result *= b;
        return result;
    }
    friend constexpr Spectrum operator*(const Spectrum& a, double b) {
        Spectrum result = a;
        result *= b;
        return result;
    }
    friend constexpr Spectrum operator/(const Spectrum& a, double b) {
        Spectrum result = a;
        result /= b;
        return result;
    }
    friend constexpr Spectrum operator*(double a, const Spectrum& b) { return b * a; }
};

/// `value(band)` in each of the first `bands` bands, zero beyond.
template <class Function>
constexpr Spectrum per_band(std::size_t bands, const Function& value) {
    Spectrum result;
    for (std::size_t b = 0; b < bands; ++b) result[b] = value(b);
    return result;
}

/// sum += more, elementwise. Both have the same length, as in the functions below.
inline void add(std::span<double> sum, std::span<const double> more) {
    assert(sum.size() == more.size());
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += more[i];
}
/// sum -= less, elementwise.
inline void subtract(std::span<double> sum, std::span<const double> less) {
    assert(sum.size() == less.size());
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] -= less[i];
}
/// sum += factor * more, elementwise.
inline void add_scaled(std::span<double> sum, double factor, std::span<const double> more) {
    assert(sum.size() == more.size());
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += factor * more[i];
}

}  // namespace uw
