#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/numerics.h"
#include "core/light/lamp_profile.h"

namespace uw {

namespace {

// How far at most a part's extent deflects the edge, relative to the beam's mean angle (or what is
// left of it to 180 degrees): close to its point the beam stays a beam. In truth it is the place
// from which the light comes that is blurred there, and its directions stay in the beam, which
// strongly forward scattering water would show.
constexpr double k_max_deflection = 0.35;
constexpr int k_panels = 8;  // for moments of an edge or a core to rounding

// The sum of the variances in three directions, which that in no direction exceeds [m^2].
double variance_of(const Matrix3& covariance) {
    return covariance[0][0] + covariance[1][1] + covariance[2][2];
}

}  // namespace

SoftSpotProfile::SoftSpotProfile(const SpotProfile& spot, const Vector3& offset,
                                 const Matrix3& covariance)
    : spot_(spot.with_an_edge()), offset_(offset), covariance_(covariance) {
    // The light ends before the angle dark - x with the probability 1 - f(dark - x), so that the
    // means of x and x^2 are the integrals of that and of 2 x times that.
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

DirectionCone SoftSpotProfile::cone() const {
    // The middle of the part lies beside the point.
    constexpr double k_room = 1.1;
    const double dark = k_room * std::acos(cos_dark_);
    return {spot_.axis(), dark < std::numbers::pi ? std::cos(dark) : -1};
}

// In the mean over an angle of mean m and variance V, cos is nearly cos(m) (1 - V/2), which is 1 -
// flux / (2 pi).
SoftSpotProfile::Edge SoftSpotProfile::edge(double displaced) const {
    Edge seen{mean_, std::sqrt(deviation_ * deviation_ + displaced), 1};
    const double left = std::cos(mean_) * (1 - 0.5 * deviation_ * deviation_);
    // An edge of a narrow beam that is blurred goes farther out than in, and has to move inwards.
    if (left > 0)
        seen.mean = std::acos(
            std::min(1.0, left / std::max(1e-9, 1 - 0.5 * seen.deviation * seen.deviation)));
    // Where it comes as far as the axis the light is spread over more directions.
    if (seen.mean + full_ * seen.deviation < 0) {
        seen.deviation = std::min(seen.deviation, std::numbers::pi / (dark_ - full_));
        seen.mean = -full_ * seen.deviation;
        const double spread = std::cos(seen.mean) * (1 - 0.5 * seen.deviation * seen.deviation);
        seen.peak = std::min(1.0, (1 - left) / (1 - spread));
    }
    return seen;
}

double SoftSpotProfile::relative_intensity(const Vector3& v) const {
    const Vector3 way = v - offset_, axis = spot_.axis();
    const double r2 = glm::dot(way, way);
    if (!(r2 > 0)) return 0;
    const double along = glm::dot(way, axis), cosine = along / std::sqrt(r2);
    if (cosine >= cos_core_) return 1;
    if (cosine <= cos_dark_) return 0;
    const Vector3 across = axis - along / r2 * way;
    const double across2 = glm::dot(across, across);
    const double variance =
        across2 > 1e-12 ? glm::dot(across, covariance_ * across) / across2
                        : 0.5 * (variance_of(covariance_) - glm::dot(axis, covariance_ * axis));
    const Edge seen = edge(std::min(variance / r2, max_displaced_));
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
    return seen.peak *
           spot_.at(std::max(0.0, mean_ + (angle - seen.mean) * deviation_ / seen.deviation));
}

// Its edge lies at most that far from the spot's as its part reaches, and thus between the cones
// whose apexes lie before and behind the point. Between them further ones divide it.
void SoftSpotProfile::append_breaks(const Ray& ray, const Interval& /*stretch*/, const Point3& apex,
                                    std::vector<double>& s) const {
    const double deviation = std::sqrt(variance_of(covariance_));
    const double outwards = (dark_ - full_) * deviation, inwards = full_ * deviation;
    const Point3 middle = apex + offset_;
    for (const double part : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        const double angle = spot_.dark_angle() + part * (spot_.full_angle() - spot_.dark_angle());
        if (std::sin(angle) < 1e-3) continue;
        const double shift = std::lerp(outwards, inwards, part);
        append_cone_crossings(ray, middle - shift / std::sin(angle) * spot_.axis(), spot_.axis(),
                              std::cos(angle), s);
    }
    const DirectionCone all = cone();
    append_cone_crossings(ray, apex, all.axis, all.cosine, s);
    append_nearest_to_axis(ray, middle, spot_.axis(), s);
}

LampProfile softened(const LampProfile& profile, const Vector3& offset, const Matrix3& covariance) {
    if (const auto* spot = std::get_if<SpotProfile>(&profile))
        return SoftSpotProfile(*spot, offset, covariance);
    return profile;
}

}  // namespace uw
