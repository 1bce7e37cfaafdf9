#include "core/light/sky.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <variant>

#include "core/base/error.h"
#include "core/base/grid2d.h"
#include "core/base/numerics.h"
#include "core/base/refraction.h"
#include "core/geometry/mesh.h"
#include "core/image/image_file.h"
#include "core/image/spectral_bands.h"
#include "core/light/sky_quadrature.h"
#include "core/light/sun.h"

namespace uw {

double transmittance_into_water(double cosine, double n) {
    return fresnel_transmittance(cosine, 1, n).mean();
}

Matrix3 world_from_sky(const Vector3& up, const std::optional<Vector3>& north,
                       const SourceLocation& where) {
    const Vector3 usual =
        std::abs(up.z) < std::numbers::sqrt2 / 2 ? Vector3{0, 0, -1} : Vector3{0, 1, 0};
    const Vector3 given = north.value_or(usual);
    const Vector3 level = given - glm::dot(given, up) * up;
    if (glm::length(level) < 1e-6 * glm::length(given))
        throw InputError(fmt::format(
            "{}: north is perpendicular to the water's surface; give a direction along it", where));
    const Vector3 to_north = glm::normalize(level);
    return {glm::cross(to_north, up), to_north, up};
}

namespace {

/// The luminous efficacy of light at 555 nm [lm/W].
constexpr double k_lumens_per_watt_of_sky = 683;

/// The factors M1 and M2 of the daylight components (CIE 15:2004).
struct DaylightFactors {
    double m1, m2;

    DaylightFactors(double x, double y) {
        const double below = 0.0241 + 0.2562 * x - 0.7341 * y;
        m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / below;
        m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / below;
    }
    double of(const std::array<double, 3>& components) const {
        return components[0] + m1 * components[1] + m2 * components[2];
    }
};

std::array<SampledCurve, 3> daylight_components() {
    const CsvTable table = read_embedded_table("cie_daylight_components_5nm.csv");
    return {table.curve("wavelength_nm", "s0"), table.curve("wavelength_nm", "s1"),
            table.curve("wavelength_nm", "s2")};
}

}  // namespace

SampledCurve daylight_spectrum(double x, double y) {
    const std::array<SampledCurve, 3> components = daylight_components();
    const DaylightFactors factors(x, y);
    SampledCurve spectrum{components[0].x, {}};
    for (std::size_t i = 0; i < spectrum.x.size(); ++i)
        spectrum.y.push_back(
            factors.of({components[0].y[i], components[1].y[i], components[2].y[i]}));
    return spectrum;
}

/// The sky's radiance up to a factor per band.
class Sky::Distribution {
  public:
    Distribution() = default;
    virtual ~Distribution() = default;
    Distribution(const Distribution&) = delete;
    Distribution& operator=(const Distribution&) = delete;
    Distribution(Distribution&&) = delete;
    Distribution& operator=(Distribution&&) = delete;

    /// `towards`: the sky, in sky space, unit, z >= 0.
    virtual Spectrum radiance(const Vector3& towards) const = 0;
    /// Relative luminance; none if lux are converted to watts by a spectrum instead.
    virtual std::optional<double> luminance(const Vector3& /*towards*/) const { return {}; }
    /// A quadrature of the whole sky with its radiance; `sun`: the azimuth of the sun,
    /// counterclockwise from east.
    virtual SkyQuadrature quadrature(std::size_t bands, double sun) const {
        SkyQuadrature result = SkyQuadrature::even(sun);
        result.fill(bands, [&](const Vector3& towards) { return radiance(towards); });
        return result;
    }
};

namespace {

/// A grey sky: uniform, or the CIE's overcast sky.
class GreySky : public Sky::Distribution {
  public:
    /// `rise`: how much brighter the zenith is than the horizon, relative to the horizon.
    GreySky(double rise, std::size_t bands) : rise_(rise), bands_(bands) {}

    Spectrum radiance(const Vector3& towards) const override {
        return per_band(bands_, [&](std::size_t) { return 1 + rise_ * towards.z; });
    }

  private:
    double rise_;
    std::size_t bands_;
};

/// Perez' distribution with Preetham's coefficients, relative to the zenith.
struct PerezDistribution {
    double a, b, c, d, e;
    double at_zenith;  // F(0, theta_sun)

    PerezDistribution(const std::array<std::array<double, 2>, 5>& rows, double turbidity,
                      double sun_angle) {
        const auto linear = [&](std::size_t i) { return rows[i][0] * turbidity + rows[i][1]; };
        a = linear(0);
        b = linear(1);
        c = linear(2);
        d = linear(3);
        e = linear(4);
        at_zenith = value(1, sun_angle, std::cos(sun_angle));
    }
    // `cosine` of the angle from the zenith, >= 0; `gamma` from the sun.
    double value(double cosine, double gamma, double cos_gamma) const {
        // b < 0: the exponential vanishes at the horizon.
        const double gradient = cosine > 0 ? 1 + a * std::exp(b / cosine) : 1;
        return gradient * (1 + c * std::exp(d * gamma) + e * cos_gamma * cos_gamma);
    }
    double relative(double cosine, double gamma, double cos_gamma) const {
        return value(cosine, gamma, cos_gamma) / at_zenith;
    }
};

/// A polynomial in the sun's angle from the zenith whose coefficients are polynomials in turbidity.
double zenith_chromaticity(const std::array<std::array<double, 4>, 3>& rows, double turbidity,
                           double sun_angle) {
    double sum = 0;
    for (const std::array<double, 4>& row : rows) {
        double polynomial = 0;
        for (const double coefficient : row) polynomial = polynomial * sun_angle + coefficient;
        sum = sum * turbidity + polynomial;
    }
    return sum;
}

// clang-format off
constexpr std::array<std::array<double, 2>, 5> k_luminance_perez{{
    {0.1787, -1.4630}, {-0.3554, 0.4275}, {-0.0227, 5.3251}, {0.1206, -2.5771}, {-0.0670, 0.3703}}};
constexpr std::array<std::array<double, 2>, 5> k_x_perez{{
    {-0.0193, -0.2592}, {-0.0665, 0.0008}, {-0.0004, 0.2125}, {-0.0641, -0.8989}, {-0.0033, 0.0452}}};
constexpr std::array<std::array<double, 2>, 5> k_y_perez{{
    {-0.0167, -0.2608}, {-0.0950, 0.0092}, {-0.0079, 0.2102}, {-0.0441, -1.6537}, {-0.0109, 0.0529}}};
constexpr std::array<std::array<double, 4>, 3> k_x_zenith{{
    {0.00166, -0.00375, 0.00209, 0}, {-0.02903, 0.06377, -0.03202, 0.00394},
    {0.11693, -0.21196, 0.06052, 0.25886}}};
constexpr std::array<std::array<double, 4>, 3> k_y_zenith{{
    {0.00275, -0.00610, 0.00317, 0}, {-0.04214, 0.08970, -0.04153, 0.00516},
    {0.15346, -0.26756, 0.06670, 0.26688}}};
// clang-format on

/// The clear sky of Preetham, Shirley and Smits 1999.
class ClearSky : public Sky::Distribution {
  public:
    ClearSky(double turbidity, const Vector3& sun, std::span<const double> bands_nm)
        : sun_(sun),
          sun_angle_(std::acos(std::clamp(sun.z, 0.0, 1.0))),
          luminance_(k_luminance_perez, turbidity, sun_angle_),
          x_(k_x_perez, turbidity, sun_angle_),
          y_(k_y_perez, turbidity, sun_angle_),
          zenith_x_(zenith_chromaticity(k_x_zenith, turbidity, sun_angle_)),
          zenith_y_(zenith_chromaticity(k_y_zenith, turbidity, sun_angle_)) {
        const double chi = (4.0 / 9 - turbidity / 120) * (std::numbers::pi - 2 * sun_angle_);
        zenith_luminance_ =
            1000 * ((4.0453 * turbidity - 4.9710) * std::tan(chi) - 0.2155 * turbidity + 2.4192);
        set_bands(bands_nm);
    }

    Spectrum radiance(const Vector3& towards) const override {
        const Place place(towards, sun_);
        const DaylightFactors factors(zenith_x_ * place.of(x_), zenith_y_ * place.of(y_));
        const double per_density =
            zenith_luminance_ * place.of(luminance_) / factors.of(luminance_of_components_);
        return per_band(bands_.size(), [&](std::size_t band) {
            return std::max(0.0, per_density * factors.of(bands_[band]));
        });
    }
    std::optional<double> luminance(const Vector3& towards) const override {
        return zenith_luminance_ * Place(towards, sun_).of(luminance_);
    }

  private:
    struct Place {
        double cosine, gamma, cos_gamma;

        Place(const Vector3& towards, const Vector3& sun) : cosine(towards.z) {
            cos_gamma = std::clamp(glm::dot(towards, sun), -1.0, 1.0);
            // Computed from the chord, as an arc cosine loses half of the digits at the sun.
            gamma = 2 * std::asin(std::min(1.0, 0.5 * glm::length(towards - sun)));
        }
        double of(const PerezDistribution& perez) const {
            return perez.relative(cosine, gamma, cos_gamma);
        }
    };

    // Sets the mean of each component over each band times the bands' width, and its luminance.
    void set_bands(std::span<const double> bands_nm) {
        const std::array<SampledCurve, 3> components = daylight_components();
        const std::vector<BandInterval> intervals = band_intervals(bands_nm);
        const double width = bands_nm.size() > 1 ? mean_band_width(intervals) : 1;
        bands_.resize(bands_nm.size());
        for (std::size_t i = 0; i < 3; ++i) {
            const SampledCurve& component = components[i];
            for (std::size_t b = 0; b < bands_.size(); ++b) {
                const BandInterval& interval = intervals[b];
                double mean = component.covers(bands_nm[b]) ? component.value(bands_nm[b]) : 0;
                if (interval.width() > 0)
                    mean = integral(component, interval.begin, interval.end) / interval.width();
                bands_[b][i] = mean * width;
            }
            luminance_of_components_[i] = luminance_of(component);
        }
    }
    // Simpson's rule, exact for two functions that are linear in between.
    static double luminance_of(const SampledCurve& component) {
        double sum = 0;
        for (std::size_t i = 0; i + 1 < component.x.size(); ++i) {
            const double begin = component.x[i], end = component.x[i + 1];
            const auto product = [&](double nm) {
                return component.value(nm) * cie1931_matching_functions(nm).y;
            };
            sum += (end - begin) / 6 *
                   (product(begin) + 4 * product(0.5 * (begin + end)) + product(end));
        }
        return k_lumens_per_watt_of_sky * sum;
    }

    Vector3 sun_;
    double sun_angle_;
    PerezDistribution luminance_, x_, y_;
    double zenith_x_, zenith_y_;
    double zenith_luminance_ = 0;  // [cd/m^2]
    std::vector<std::array<double, 3>> bands_;
    std::array<double, 3> luminance_of_components_{};
};

/// A sky given by an image of all directions.
class PanoramaSky : public Sky::Distribution {
  public:
    PanoramaSky(const SkyDesc& desc, std::span<const double> bands_nm)
        : to_bands_({bands_nm.begin(), bands_nm.end()}), rotate_(desc.rotate * k_degree) {
        const PixelImage image = read_linear_image(desc.file);
        if (image.width != 2 * image.height || image.height < 2 || image.height % 2 != 0)
            throw InputError(
                fmt::format("{}: {}: {} x {} pixels; a panorama of all directions is twice as wide "
                            "as high, and "
                            "an even number of pixels high",
                            desc.where, desc.file.string(), image.width, image.height));
        pixels_.assign(image.width, image.height / 2);  // above the horizon
        const auto channels = static_cast<std::size_t>(image.channels);
        for (std::size_t i = 0; i < pixels_.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c) {
                // Grey ones have one channel, or two with alpha.
                const float value = image.pixels[i * channels + (channels < 3 ? 0 : c)];
                if (!std::isfinite(value))
                    throw InputError(fmt::format(
                        "{}: {}: has a value that is not a finite number; save it again",
                        desc.where, desc.file.string()));
                pixels_[i][c] = std::max(0.0, static_cast<double>(value));
            }
    }

    Spectrum radiance(const Vector3& towards) const override {
        const double azimuth = std::atan2(towards.x, towards.y);  // from north, clockwise
        const double elevation = std::asin(std::clamp(towards.z, -1.0, 1.0));
        const double pixel = 2 * std::numbers::pi / pixels_.width();
        const double x = (azimuth - rotate_ + std::numbers::pi) / pixel - 0.5;
        const double y = std::clamp((0.5 * std::numbers::pi - elevation) / pixel - 0.5, 0.0,
                                    static_cast<double>(pixels_.height() - 1));
        const auto column = static_cast<int>(std::floor(x)), row = static_cast<int>(y);
        const double across = x - column, down = y - row;
        const int right = wrapped(column + 1), lower = std::min(row + 1, pixels_.height() - 1);
        const int left = wrapped(column);
        Rgb sum{};
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] =
                (1 - down) *
                    ((1 - across) * pixels_(left, row)[c] + across * pixels_(right, row)[c]) +
                down * ((1 - across) * pixels_(left, lower)[c] + across * pixels_(right, lower)[c]);
        return to_bands_.from_rgb(sum);
    }

    /// A quadrature over its pixels, or squares of them, so that a sun of a single pixel is not
    /// missed.
    SkyQuadrature quadrature(std::size_t bands, double /*sun*/) const override {
        const int square = square_of_pixels();
        const int columns = pixels_.width() / square;
        const double pixel = 2 * std::numbers::pi / pixels_.width();
        SkyQuadrature result;
        result.bands = bands;
        // The left edge is the azimuth -180 + rotate; the columns of a quadrature go the other way.
        result.set_columns(static_cast<std::size_t>(columns), -0.5 * std::numbers::pi - rotate_);
        for (int top = 0; top < pixels_.height(); top += square) {
            const int bottom = std::min(top + square, pixels_.height());
            const double upper = std::cos(top * pixel), lower = std::cos(bottom * pixel);
            const double horizon = bottom == pixels_.height() ? 0 : lower;
            // With the mean cosine, cos theta dOmega of a row is exact.
            result.rows.push_back(
                {0.5 * (upper + horizon), (upper - horizon) * result.column_width});
            for (int column = columns - 1; column >= 0; --column) {
                const Spectrum mean =
                    to_bands_.from_rgb(mean_of(column * square, square, top, bottom));
                result.radiance.insert(result.radiance.end(), mean.begin(),
                                       mean.begin() + static_cast<std::ptrdiff_t>(bands));
            }
        }
        result.set_edges();
        return result;
    }

  private:
    int wrapped(int column) const {
        return (column % pixels_.width() + pixels_.width()) % pixels_.width();
    }
    // The side of the smallest square of pixels that divides the width into at most k_max_columns;
    // 1 if that would leave too few columns.
    int square_of_pixels() const {
        constexpr int k_max_columns = 1024, k_fewest_columns = 256;
        for (int side = 1; pixels_.width() / side >= k_fewest_columns; ++side)
            if (pixels_.width() % side == 0 && pixels_.width() / side <= k_max_columns) return side;
        return 1;
    }
    // Weighted by cos theta dOmega.
    Rgb mean_of(int left, int width, int top, int bottom) const {
        const double pixel = 2 * std::numbers::pi / pixels_.width();
        Rgb sum{};
        double weights = 0;
        for (int row = top; row < bottom; ++row) {
            const double weight = std::sin((2 * row + 1) * pixel);  // of sin^2 over the row
            weights += weight * width;
            for (int column = left; column < left + width; ++column)
                for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * pixels_(column, row)[c];
        }
        for (double& value : sum) value /= weights;
        return sum;
    }

    ReflectanceBands to_bands_;
    double rotate_;
    Grid2D<Rgb> pixels_;
};

Vector3 sun_in_sky(const SkyDesc& desc, const Matrix3& world_from_sky) {
    struct Find {
        const Matrix3& world_from_sky;

        Vector3 operator()(const SunAnglesDesc& angles) const {
            const double azimuth = angles.azimuth * k_degree;
            const double elevation = angles.elevation * k_degree;
            return {std::cos(elevation) * std::sin(azimuth),
                    std::cos(elevation) * std::cos(azimuth), std::sin(elevation)};
        }
        Vector3 operator()(const SunTimeDesc& moment) const {
            const SunPosition sun =
                sun_position(moment.unix_time, moment.latitude, moment.longitude);
            return (*this)(SunAnglesDesc{sun.azimuth, sun.apparent_elevation()});
        }
        Vector3 operator()(const SunDirectionDesc& light) const {
            return glm::transpose(world_from_sky) * -light.direction;
        }
    };
    const Vector3 sun = std::visit(Find{world_from_sky}, *desc.sun);
    if (sun.z < 0)
        throw InputError(fmt::format(
            "{}: the sun stands {:.1f} degrees below the horizon, where the model of a clear sky "
            "says nothing; raise it, or take another model",
            desc.where, std::asin(std::min(1.0, -sun.z)) / k_degree));
    return sun;
}

}  // namespace

namespace {

std::shared_ptr<const Sky::Distribution> make_distribution(const SkyDesc& desc,
                                                           const std::optional<Vector3>& sun,
                                                           std::span<const double> bands_nm) {
    switch (desc.model) {
        case SkyDesc::Model::overcast:
            return std::make_shared<GreySky>(2, bands_nm.size());
        case SkyDesc::Model::clear:
            return std::make_shared<ClearSky>(desc.turbidity, *sun, bands_nm);
        case SkyDesc::Model::panorama:
            return std::make_shared<PanoramaSky>(desc, bands_nm);
        case SkyDesc::Model::uniform:
        case SkyDesc::Model::black:
            break;
    }
    return std::make_shared<GreySky>(0, bands_nm.size());
}

// The irradiance per band that the description asks for [W/m^2]; none: the model has its own units,
// and is scaled as a whole if lux are given.
std::optional<PerBand> wanted_irradiance(const SkyDesc& desc, std::span<const double> bands_nm) {
    if (desc.model == SkyDesc::Model::black) return PerBand(bands_nm.size(), 0.0);
    if (desc.irradiance && !desc.spectrum) return desc.irradiance;
    if (desc.model == SkyDesc::Model::panorama && !desc.spectrum) return std::nullopt;
    if (bands_nm.size() < 2)
        throw InputError(
            fmt::format("{}: how much of a spectrum falls into a single band is undefined, as it "
                        "has no neighbours; give the sky's irradiance in that band",
                        desc.where));
    if (!desc.spectrum) return std::nullopt;
    const LampSpectrum spectrum = make_lamp_spectrum(*desc.spectrum);
    double watts = 0;
    if (desc.irradiance) {
        watts = desc.irradiance->front();
    } else {
        const double efficacy = luminous_efficacy(spectrum);
        if (!(efficacy > 0))
            throw InputError(
                fmt::format("{}: nothing of this spectrum is visible (360 to 830 nm), so lux do "
                            "not determine it; give irradiance in W/m2",
                            desc.where));
        watts = *desc.lux / efficacy;
    }
    PerBand values = band_values(spectrum, watts, band_intervals(bands_nm));
    if (watts > 0 && *std::ranges::max_element(values) <= 0)
        throw InputError(fmt::format(
            "{}: has no light in any band of the scene; check its wavelengths and water.bands",
            desc.where));
    return values;
}

}  // namespace

Sky::Sky(const SkyDesc& desc, const Vector3& up, std::span<const double> bands_nm)
    : world_from_sky_(uw::world_from_sky(up, desc.north, desc.where)), bands_(bands_nm.size()) {
    const std::optional<PerBand> wanted = wanted_irradiance(desc, bands_nm);
    if (desc.sun) sun_ = sun_in_sky(desc, world_from_sky_);
    distribution_ = make_distribution(desc, sun_, bands_nm);
    SkyQuadrature quadrature =
        distribution_->quadrature(bands_, sun_ ? std::atan2(sun_->y, sun_->x) : 0);
    double whole = 1;
    if (desc.lux && !wanted)
        whole = *desc.lux / quadrature.irradiance([&](std::size_t row, std::size_t column) {
            return *distribution_->luminance(quadrature.towards(row, column));
        });
    scale_ = per_band(bands_, [&](std::size_t band) {
        if (!wanted) return whole;
        if ((*wanted)[band] == 0) return 0.0;
        const double relative = quadrature.irradiance_in(band);
        if (!(relative > 0))
            throw InputError(
                fmt::format("{}: the sky has no light of {:g} nm that could be scaled to {:g} "
                            "W/m2; give 0 for this band, or another model",
                            desc.where, bands_nm[band], (*wanted)[band]));
        return (*wanted)[band] / relative;
    });
    for (std::size_t i = 0; i < quadrature.radiance.size(); ++i)
        quadrature.radiance[i] *= scale_[i % bands_];
    quadrature_ = std::make_shared<const SkyQuadrature>(std::move(quadrature));
}

Spectrum Sky::radiance(const Vector3& towards) const {
    if (towards.z < 0) return {};
    return scale_ * distribution_->radiance(towards);
}

Spectrum Sky::irradiance() const {
    return per_band(bands_, [&](std::size_t band) { return quadrature_->irradiance_in(band); });
}

}  // namespace uw
