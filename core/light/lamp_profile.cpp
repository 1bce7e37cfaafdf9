#include "core/light/lamp_profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

#include "core/base/numerics.h"
#include "core/light/photometric_files.h"

namespace uw {

namespace {

using Falloff = SpotProfileDesc::Falloff;

bool is_blenders(Falloff falloff) {
    return falloff == Falloff::blender || falloff == Falloff::blender_3_4;
}

double smoothstep(double x) {
    return x * x * (3.0 - 2.0 * x);
}

// 2 pi int smoothstep sin(theta) over the edge of a spot, from full (inner) to dark (outer).
double edge_solid_angle(double inner, double outer) {
    constexpr int k_steps = 256;  // Simpson on a cubic times a sine: accurate to 1e-9
    const double h = (outer - inner) / k_steps;
    double sum = 0;
    for (int i = 0; i <= k_steps; ++i) {
        const double simpson = (i == 0 || i == k_steps) ? 1.0 : (i % 2 == 1 ? 4.0 : 2.0);
        sum +=
            simpson * smoothstep(1.0 - static_cast<double>(i) / k_steps) * std::sin(inner + i * h);
    }
    return 2.0 * std::numbers::pi * sum * h / 3.0;
}

}  // namespace

SpotProfile::SpotProfile(const SpotProfileDesc& desc, const LampPlacement& placement)
    : axis_(placement.axis()),
      falloff_(desc.falloff),
      dark_angle_(glm::radians(
          std::min(is_blenders(falloff_) ? 90.0 : 180.0, 0.5 * (desc.beam + desc.edge)))),
      cos_dark_(std::cos(dark_angle_)),
      full_angle_(glm::radians(std::max(0.0, 0.5 * (desc.beam - desc.edge)))),
      cos_full_(std::cos(full_angle_)) {
    if (is_blenders(falloff_)) {
        // Blend is a fraction of the angle in Blender's cones, but of 1 - cos in its shading.
        const double blend = 1 - full_angle_ / dark_angle_;
        cos_full_ = cos_dark_ + (1 - cos_dark_) * blend;
        full_angle_ = std::acos(std::min(1.0, cos_full_));
    }
    core_cones_.push_back(cos_full_);
    if (falloff_ != Falloff::blender_3_4) return;
    for (const double level : {0.95, 0.75, 0.5, 0.25, 0.1})  // within the core it is a cosine
        if (level > cos_full_) core_cones_.push_back(level);
}

double SpotProfile::relative_intensity(const Vector3& v) const {
    return of_cosine(glm::dot(v, axis_) / glm::length(v));
}

double SpotProfile::of_cosine(double cosine) const {
    if (cosine <= cos_dark_) return 0.0;
    const double core = falloff_ == Falloff::blender_3_4 ? cosine : 1.0;
    if (cosine >= cos_full_) return core;
    const double ramp = (cosine - cos_dark_) / (cos_full_ - cos_dark_);
    if (falloff_ == Falloff::gltf) return ramp * ramp;
    if (is_blenders(falloff_)) return core * smoothstep(ramp);
    const double angle = std::acos(glm::clamp(cosine, -1.0, 1.0));
    return smoothstep((dark_angle_ - angle) / (dark_angle_ - full_angle_));
}

double SpotProfile::at(double angle) const {
    if (angle >= dark_angle_) return 0.0;
    if (falloff_ != Falloff::smooth) return of_cosine(std::cos(angle));
    if (angle <= full_angle_) return 1.0;
    return smoothstep((dark_angle_ - angle) / (dark_angle_ - full_angle_));
}

SpotProfile SpotProfile::with_an_edge() const {
    constexpr double k_min_width = 4e-6;
    SpotProfile spot = *this;
    if (dark_angle_ - full_angle_ >= k_min_width) return spot;
    spot.full_angle_ = std::max(0.0, dark_angle_ - k_min_width);
    spot.cos_full_ = std::cos(spot.full_angle_);
    return spot;
}

double SpotProfile::solid_angle() const {
    // Integrals over the cosine: of the core, and of the edge as a ramp from cos_dark_ on.
    const double width = cos_full_ - cos_dark_;
    const double full = 2.0 * std::numbers::pi * (1.0 - cos_full_);
    switch (falloff_) {
        case Falloff::gltf:  // int t^2 dt = 1/3
            return full + 2.0 * std::numbers::pi * width / 3.0;
        case Falloff::blender:  // int 3 t^2 - 2 t^3 dt = 1/2
            return full + std::numbers::pi * width;
        case Falloff::blender_3_4:  // and int 3 t^3 - 2 t^4 dt = 7/20
            return std::numbers::pi *
                   (1 - cos_full_ * cos_full_ + width * (cos_dark_ + 0.7 * width));
        case Falloff::smooth:
            break;
    }
    return full + edge_solid_angle(full_angle_, dark_angle_);
}

void SpotProfile::append_breaks(const Ray& ray, const Interval& interval, const Point3& apex,
                                std::vector<double>& s) const {
    for (const double cosine : core_cones_) append_cone_crossings(ray, apex, axis_, cosine, s);
    if (cos_dark_ == cos_full_) return;
    const AxisApproach nearest = approach_to_axis(ray, interval, apex, axis_);
    if (nearest.cosine <= cos_dark_) return;
    // The edge begins where the ray comes nearest to the axis: a ray that grazes the beam sees only
    // a narrow peak.
    double begin = full_angle_;
    if (nearest.cosine < cos_full_) {
        begin = std::acos(nearest.cosine);
        s.push_back(nearest.s);
    }
    for (const double part : {0.25, 0.5, 0.75, 1.0})
        append_cone_crossings(ray, apex, axis_, std::cos(begin + part * (dark_angle_ - begin)), s);
}

namespace {

constexpr int k_breaks = 8;  // to either side of where a ray is brightest: down to 4e-5 of it
// A ray whose greatest relative intensity is less than this gets no breaks.
constexpr double k_negligible = 1e-12;

}  // namespace

namespace {

// The greatest deflection of the edge by a part's extent, relative to the beam's mean angle (or to
// what remains of it to 180 degrees): close to its point the beam remains a beam. In reality the
// origin of the light is blurred there, not its direction, which strongly forward scattering water
// would show.
constexpr double k_max_deflection = 0.35;
constexpr int k_panels = 8;  // for moments of an edge or a core to rounding

// The sum of the variances along the axes, an upper bound on that in any direction [m^2].
double variance_of(const Matrix3& covariance) {
    return covariance[0][0] + covariance[1][1] + covariance[2][2];
}

}  // namespace

SoftSpotProfile::SoftSpotProfile(const SpotProfile& spot, const Vector3& offset,
                                 const Matrix3& covariance)
    : spot_(spot.with_an_edge()), offset_(offset), covariance_(covariance) {
    // The profile f as the probability that the light ends beyond an angle: it ends before dark - x
    // with the probability 1 - f(dark - x), so that the means of x and x^2 are the integrals of
    // that and of 2 x times that.
    const double dark = spot_.dark_angle();
    const double ramp = dark - spot_.full_angle();
    double first = 0, second = 0;
    const auto integrate = [&](double begin, double end) {
        const double width = (end - begin) / k_panels;
        for (int panel = 0; panel < k_panels; ++panel)
            for (const QuadratureNode& node : gauss_legendre(4)) {
                const double x = begin + (panel + node.position) * width;
                const double ended = node.weight * width * (1 - spot_.at(dark - x));
                first += ended;
                second += 2 * x * ended;
            }
    };
    integrate(0, ramp);
    integrate(ramp, dark);
    mean_ = dark - first;
    deviation_ = std::sqrt(second - first * first);
    dark_ = first / deviation_;
    full_ = (spot_.full_angle() - mean_) / deviation_;
    const double deflection = k_max_deflection * std::min(mean_, std::numbers::pi - mean_);
    max_displaced_ = deflection * deflection;
    const Edge widest = edge(max_displaced_);
    const double core = widest.mean + full_ * widest.deviation;
    if (spot_.has_even_core() && widest.peak == 1) cos_core_ = std::cos(core);
    cos_dark_ = std::cos(
        std::min(std::max(widest.mean, mean_) + dark_ * widest.deviation, std::numbers::pi));
}

// The mean of the cosine of an angle with mean m and variance V is nearly cos(m) (1 - V/2), which
// is 1 - flux / (2 pi).
SoftSpotProfile::Edge SoftSpotProfile::edge(double displaced) const {
    Edge blurred{mean_, std::sqrt(deviation_ * deviation_ + displaced), 1};
    const double left = std::cos(mean_) * (1 - 0.5 * deviation_ * deviation_);
    // Blurring the edge of a narrow beam adds more solid angle outside than it removes inside, so
    // that its mean has to move inwards.
    if (left > 0)
        blurred.mean = std::acos(
            std::min(1.0, left / std::max(1e-9, 1 - 0.5 * blurred.deviation * blurred.deviation)));
    // If the edge extends to the axis, the light is spread over more directions.
    if (blurred.mean + full_ * blurred.deviation < 0) {
        blurred.deviation = std::min(blurred.deviation, std::numbers::pi / (dark_ - full_));
        blurred.mean = -full_ * blurred.deviation;
        const double spread =
            std::cos(blurred.mean) * (1 - 0.5 * blurred.deviation * blurred.deviation);
        blurred.peak = std::min(1.0, (1 - left) / (1 - spread));
    }
    return blurred;
}

double SoftSpotProfile::relative_intensity(const Vector3& v) const {
    const Vector3 path = v - offset_, axis = spot_.axis();
    const double r2 = glm::dot(path, path);
    if (!(r2 > 0)) return 0;
    const double along = glm::dot(path, axis), cosine = along / std::sqrt(r2);
    if (cosine >= cos_core_) return 1;
    if (cosine <= cos_dark_) return 0;
    const Vector3 across = axis - along / r2 * path;
    const double across2 = glm::dot(across, across);
    const double variance =
        across2 > 1e-12 ? glm::dot(across, covariance_ * across) / across2
                        : 0.5 * (variance_of(covariance_) - glm::dot(axis, covariance_ * axis));
    const Edge blurred = edge(std::min(variance / r2, max_displaced_));
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
    return blurred.peak *
           spot_.at(std::max(0.0, mean_ + (angle - blurred.mean) * deviation_ / blurred.deviation));
}

// The edge is displaced from the spot's by at most the extent of the part, and thus lies between
// cones whose apexes lie before and behind the point. Further cones divide the space between them.
void SoftSpotProfile::append_breaks(const Ray& ray, const Interval& /*interval*/,
                                    const Point3& apex, std::vector<double>& s) const {
    const double deviation = std::sqrt(variance_of(covariance_));
    const double outwards = (dark_ - full_) * deviation, inwards = full_ * deviation;
    // Close to the point it is deflected no further than to these angles.
    const double widest = std::acos(cos_dark_), narrowest = std::acos(std::min(1.0, cos_core_));
    const Point3 middle = apex + offset_;
    for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        append_cone_crossings(ray, middle, spot_.axis(),
                              std::cos(std::lerp(widest, narrowest, part)), s);
        const double angle = std::lerp(spot_.dark_angle(), spot_.full_angle(), part);
        if (std::sin(angle) < 1e-3) continue;
        const double shift = std::lerp(outwards, inwards, part);
        append_cone_crossings(ray, middle - shift / std::sin(angle) * spot_.axis(), spot_.axis(),
                              std::cos(angle), s);
    }
    append_nearest_to_axis(ray, middle, spot_.axis(), s);
}

LampProfile softened(const LampProfile& profile, const Vector3& offset, const Matrix3& covariance) {
    if (const auto* spot = std::get_if<SpotProfile>(&profile))
        return SoftSpotProfile(*spot, offset, covariance);
    return profile;
}

CosineProfile::CosineProfile(const CosineProfileDesc& desc, const LampPlacement& placement)
    : axis_(placement.axis()),
      exponent_(std::log(0.5) / std::log(std::cos(glm::radians(0.5 * desc.fwhm)))) {
    // A cosine beam is smooth but may be narrow: along a ray across it the intensity is very nearly
    // a Gaussian, of the same relative width wherever the ray passes. Break it at odd multiples of
    // 0.3 standard deviations.
    for (int i = 0; i < k_breaks; ++i) {
        const double deviations = 0.3 * (2 * i + 1);
        break_ratios_.push_back(std::exp(-0.5 * deviations * deviations / exponent_));
    }
}

double CosineProfile::relative_intensity(const Vector3& v) const {
    const double cosine = glm::dot(v, axis_) / glm::length(v);
    return cosine <= 0 ? 0.0 : std::pow(cosine, exponent_);
}

double CosineProfile::solid_angle() const {
    return 2.0 * std::numbers::pi / (exponent_ + 1.0);
}

void CosineProfile::append_breaks(const Ray& ray, const Interval& interval, const Point3& apex,
                                  std::vector<double>& s) const {
    const double greatest = approach_to_axis(ray, interval, apex, axis_).cosine;
    if (greatest <= 0 || std::pow(greatest, exponent_) < k_negligible) return;
    for (const double ratio : break_ratios_)
        append_cone_crossings(ray, apex, axis_, greatest * ratio, s);
    append_plane_crossing(ray, apex, axis_, s);
}

namespace {

// Lumens in a file are those of the bare lamps: the luminaire may absorb much of them, but emits no
// more.
constexpr double k_flux_tolerance = 0.01;
constexpr double k_min_efficiency = 0.1;

std::shared_ptr<const PhotometricWeb> read_web(const IesProfileDesc& profile,
                                               std::vector<std::string>& warnings) {
    const IesFile file = read_ies(profile.file);
    for (const std::string& warning : file.warnings)
        warnings.push_back(profile.where + ": " + warning);
    auto web = std::make_shared<const PhotometricWeb>(file);
    const double flux = web->flux();
    if (file.lumens > 0 && flux > (1 + k_flux_tolerance) * file.lumens)
        warnings.push_back(fmt::format(
            "{}: the candelas of {} add up to {:.4g} lm, more than the {:.4g} lm of its "
            "lamps; check its multiplier and its lumens",
            profile.where, profile.file.filename().string(), flux, file.lumens));
    if (file.lumens > 0 && flux < k_min_efficiency * file.lumens)
        warnings.push_back(
            fmt::format("{}: the candelas of {} add up to {:.4g} lm, {:.2g} % of the {:.4g} lm of "
                        "its lamps; check its multiplier (candelas may be per 1000 lm)",
                        profile.where, profile.file.filename().string(), flux,
                        100 * flux / file.lumens, file.lumens));
    return web;
}

}  // namespace

IesProfile::IesProfile(const IesProfileDesc& desc, const LampPlacement& placement,
                       std::shared_ptr<const PhotometricWeb> web)
    : web_(std::move(web)), cos_dark_(std::cos(web_->dark_angle())) {
    const Vector3& direction = placement.direction;
    const Vector3 towards = placement.across();
    // The zenith, the opposite end of the luminaire's axis, is z of a right-handed system.
    const Vector3 across = glm::cross(-direction, towards);
    const double turn = glm::radians(desc.rotate), tilt = glm::radians(desc.tilt);
    const Vector3 turned = std::cos(turn) * towards + std::sin(turn) * across;
    const auto in_world = [&](const Vector3& v) {
        return glm::normalize(placement.world_from_frame.apply_to_vector(v));
    };
    axis_ = in_world(std::cos(tilt) * direction + std::sin(tilt) * turned);
    zero_ = in_world(std::cos(tilt) * turned - std::sin(tilt) * direction);
    quarter_ = glm::cross(-axis_, zero_);
    constexpr double k_flat = 1e-6;  // a cone this close to 90 degrees is treated as a plane
    if (std::abs(cos_dark_) < k_flat) cos_dark_ = -1e-3;
    for (const double azimuth : web_->azimuth_breaks())
        half_planes_.push_back(std::cos(azimuth) * zero_ + std::sin(azimuth) * quarter_);
    for (const double angle : web_->polar_breaks()) {
        const double cosine = std::cos(angle);
        if (std::abs(cosine) < k_flat)
            breaks_at_equator_ = true;
        else if (std::abs(cosine) < 1)
            cones_.push_back(cosine);
    }
}

double IesProfile::relative_intensity(const Vector3& v) const {
    const double x = glm::dot(v, zero_), y = glm::dot(v, quarter_), along = glm::dot(v, axis_);
    const double polar = std::atan2(std::sqrt(x * x + y * y), along);
    const double azimuth = web_->is_rotational() ? 0.0 : std::atan2(y, x);
    return web_->candelas(polar, azimuth) / web_->peak();
}

void IesProfile::append_breaks(const Ray& ray, const Interval& /*interval*/, const Point3& apex,
                               std::vector<double>& s) const {
    for (const double cosine : cones_) append_cone_crossings(ray, apex, axis_, cosine, s);
    if (breaks_at_equator_) append_plane_crossing(ray, apex, axis_, s);
    append_nearest_to_axis(ray, apex, axis_, s);
    for (const Vector3& side : half_planes_)
        append_half_plane_crossing(ray, apex, side, glm::cross(axis_, side), s);
}

IesProfile make_profile(const IesProfileDesc& desc, const LampPlacement& placement,
                        std::vector<std::string>& warnings) {
    return {desc, placement, read_web(desc, warnings)};
}

namespace {

IesFile rotational(const TableProfileDesc& desc) {
    IesFile file;
    file.polar = desc.angles;
    file.planes = {0};
    file.candelas = desc.values;
    return file;
}

}  // namespace

TableProfile::TableProfile(const TableProfileDesc& desc, const LampPlacement& placement)
    : angles_(desc.angles),
      values_(desc.values),
      greatest_(std::ranges::max(desc.values)),
      of_greatest_({}, placement, std::make_shared<const PhotometricWeb>(rotational(desc))) {}

namespace {

template <class... Profiles>
constexpr bool all_are_profiles(const std::variant<Profiles...>* /*type*/) {
    return (IsALampProfile<Profiles> && ...);
}
static_assert(all_are_profiles(static_cast<const LampProfile*>(nullptr)));
static_assert(std::variant_size_v<LampProfile> ==
              std::variant_size_v<LampProfileDesc> + 1);  // SoftSpotProfile has no description

}  // namespace

LampProfile make_lamp_profile(const LampProfileDesc& desc, const LampPlacement& placement,
                              std::vector<std::string>& warnings) {
    const auto make = [&](const auto& described) -> LampProfile {
        return make_profile(described, placement, warnings);
    };
    return std::visit(make, desc);
}

}  // namespace uw
