#include "camera/lens/fisheye.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "camera/lens/polynomial.h"

namespace uw {
namespace {

constexpr int k_fisheye_max_iterations = 100;
/// Angles closer than this [rad] are the same: a thousandth of the promised 1e-10.
constexpr double k_fisheye_tolerance = 1e-14;

}  // namespace

Fisheye::Fisheye(const DistortionDesc& desc)
    : k_{desc.k[0], desc.k[1], desc.k[2], desc.k[3]}, largest_angle_(std::numbers::pi) {
    // dr/d theta as a polynomial in theta^2.
    const std::array<double, 5> growth{1, 3 * k_[0], 5 * k_[1], 7 * k_[2], 9 * k_[3]};
    constexpr double k_limit = std::numbers::pi * std::numbers::pi;
    if (const auto fold = first_positive_root(growth, k_limit)) largest_angle_ = std::sqrt(*fold);
    largest_radius_ = radius(largest_angle_);
}

double Fisheye::radius(double theta) const {
    const double t2 = theta * theta;
    return theta * (1 + t2 * (k_[0] + t2 * (k_[1] + t2 * (k_[2] + t2 * k_[3]))));
}

double Fisheye::slope(double theta) const {
    const double t2 = theta * theta;
    return 1 + t2 * (3 * k_[0] + t2 * (5 * k_[1] + t2 * (7 * k_[2] + t2 * 9 * k_[3])));
}

double Fisheye::angle(double r) const {
    // Newton's method, kept between angles that are imaged below and above r.
    double low = 0, high = largest_angle_;
    double theta = std::min(r, high);
    for (int iteration = 0; iteration < k_fisheye_max_iterations; ++iteration) {
        const double excess = radius(theta) - r;
        (excess > 0 ? high : low) = theta;
        double next = theta - excess / slope(theta);
        if (!(next >= low && next <= high)) next = 0.5 * (low + high);
        if (std::abs(next - theta) <= k_fisheye_tolerance) return next;
        theta = next;
    }
    return theta;
}

std::optional<Vector3> Fisheye::direction(const NormalizedPoint& image) const {
    const double r = std::hypot(image.x, image.y);
    if (!(r <= largest_radius_)) return std::nullopt;
    if (r == 0) return Vector3(0, 0, 1);
    const double theta = angle(r);
    const double across = std::sin(theta) / r;
    return Vector3(across * image.x, across * image.y, std::cos(theta));
}

std::optional<NormalizedPoint> Fisheye::image(const Vector3& direction) const {
    const double across = std::hypot(direction.x, direction.y);
    const double theta = std::atan2(across, direction.z);
    // The backward direction is imaged all around the circle: at no particular point.
    if (theta > largest_angle_ || (across == 0 && direction.z < 0)) return std::nullopt;
    if (across == 0) return NormalizedPoint{};
    const double scale = radius(theta) / across;
    return NormalizedPoint{scale * direction.x, scale * direction.y};
}

double Fisheye::falloff(const Vector3& direction) const {
    const double across = std::hypot(direction.x, direction.y);
    if (across == 0) return 1;
    const double theta = std::atan2(across, direction.z);
    return across / (radius(theta) * slope(theta));
}

}  // namespace uw
