#include "camera/lens_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

namespace uw {

namespace {

double evaluate(std::span<const double> c, double x) {
    double sum = 0;
    for (std::size_t i = c.size(); i-- > 0;) sum = sum * x + c[i];
    return sum;
}

/// The sign change between `low` and `high`, to the last bit.
double bisect(std::span<const double> c, double low, double high) {
    const bool low_positive = evaluate(c, low) > 0;
    for (;;) {
        const double middle = low + 0.5 * (high - low);
        if (middle <= low || middle >= high) return high;
        ((evaluate(c, middle) > 0) == low_positive ? low : high) = middle;
    }
}

/// Every sign change in (0, limit], ascending. Between two sign changes of its derivative the
/// polynomial is monotone, so it changes sign there at most once.
std::vector<double> sign_changes(std::span<const double> c, double limit) {
    if (c.size() < 2) return {};
    std::vector<double> derivative;
    for (std::size_t i = 1; i < c.size(); ++i) derivative.push_back(static_cast<double>(i) * c[i]);
    std::vector<double> ends = sign_changes(derivative, limit);
    ends.push_back(limit);

    std::vector<double> roots;
    double low = 0;
    for (const double high : ends) {
        if ((evaluate(c, low) > 0) != (evaluate(c, high) > 0))
            roots.push_back(bisect(c, low, high));
        low = high;
    }
    return roots;
}

}  // namespace

std::optional<double> first_positive_root(std::span<const double> coefficients, double limit) {
    const std::vector<double> roots = sign_changes(coefficients, limit);
    if (roots.empty()) return std::nullopt;
    return roots.front();
}

namespace {

/// Beyond tan(89.999 deg) no ray reaches a flat image.
constexpr double k_max_r2 = 1e10;
constexpr int k_brown_conrady_max_iterations = 100;
constexpr int k_max_halvings = 60;
/// Newton's last step bounds the remaining error; ten times smaller than promised.
constexpr double k_brown_conrady_tolerance = 1e-11;
/// Points closer than this are the same; allows for the inverse's error, which a fold magnifies.
constexpr double k_same_point = 1e-6;

/// Radius where d(r f)/dr changes sign or f has a pole. With u = r^2 and f = N/D,
/// d(r f)/dr = ((N + 2u N') D - 2u N D') / D^2, a polynomial of degree 6 over a square.
double radial_fold(const DistortionDesc& desc) {
    const std::array<double, 4> n{1, desc.k[0], desc.k[1], desc.k[2]};
    const std::array<double, 4> d{1, desc.k[3], desc.k[4], desc.k[5]};
    std::array<double, 7> growth{};
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            const double weight = 1 + 2 * static_cast<double>(i) - 2 * static_cast<double>(j);
            growth[i + j] += weight * n[i] * d[j];
        }
    }
    double r2 = std::numeric_limits<double>::infinity();
    for (const std::span<const double> c : {std::span<const double>(growth), {d}}) {
        if (const auto root = first_positive_root(c, k_max_r2)) r2 = std::min(r2, *root);
    }
    return std::sqrt(r2);
}

}  // namespace

Distortion::Distortion(const DistortionDesc& desc) : desc_(desc), fold_radius_(radial_fold(desc)) {
    const auto is_zero = [](double c) { return c == 0; };
    identity_ = std::ranges::all_of(desc.k, is_zero) && std::ranges::all_of(desc.p, is_zero);
}

Distortion::Radial Distortion::radial(double r2) const {
    const auto& k = desc_.k;
    const double n = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[2]));
    const double d = 1 + r2 * (k[3] + r2 * (k[4] + r2 * k[5]));
    const double n_slope = k[0] + r2 * (2 * k[1] + r2 * 3 * k[2]);
    const double d_slope = k[3] + r2 * (2 * k[4] + r2 * 3 * k[5]);
    return {n / d, (n_slope - n / d * d_slope) / d};
}

NormalizedPoint Distortion::distort(const NormalizedPoint& undistorted) const {
    const auto [x, y] = undistorted;
    const auto [p1, p2] = desc_.p;
    const double r2 = x * x + y * y;
    const double f = radial(r2).factor;
    return {f * x + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
            f * y + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

Distortion::Jacobian Distortion::jacobian(const NormalizedPoint& p) const {
    const auto [x, y] = p;
    const auto [p1, p2] = desc_.p;
    const Radial f = radial(x * x + y * y);
    return {f.factor + 2 * f.slope * x * x + 2 * p1 * y + 6 * p2 * x,
            2 * f.slope * x * y + 2 * p1 * x + 2 * p2 * y,
            f.factor + 2 * f.slope * y * y + 6 * p1 * y + 2 * p2 * x};
}

bool Distortion::in_domain(const NormalizedPoint& p, const Jacobian& j) const {
    // Where its Jacobian is positive definite the model is the gradient of a convex potential, so
    // no two points of a convex region are imaged at the same position. The radius excludes the
    // regions beyond the fold where that holds again.
    const bool definite = j.xx + j.yy > 0 && j.xx * j.yy > j.xy * j.xy;
    return definite && std::hypot(p.x, p.y) < fold_radius_;
}

std::optional<NormalizedPoint> Distortion::undistort(const NormalizedPoint& distorted) const {
    if (!std::isfinite(distorted.x) || !std::isfinite(distorted.y)) return std::nullopt;
    if (identity_) return distorted;

    // Newton's method from the axis, where the Jacobian is 1. A step is halved until it stays in
    // the domain and reduces the residual; for a target outside the lens's image it stalls at the
    // fold.
    NormalizedPoint p;
    Jacobian j = jacobian(p);
    NormalizedPoint missing = distorted;
    for (int iteration = 0; iteration < k_brown_conrady_max_iterations; ++iteration) {
        const double determinant = j.xx * j.yy - j.xy * j.xy;
        const double dx = (j.yy * missing.x - j.xy * missing.y) / determinant;
        const double dy = (j.xx * missing.y - j.xy * missing.x) / determinant;
        if (std::hypot(dx, dy) <= k_brown_conrady_tolerance) {
            const NormalizedPoint last{p.x + dx, p.y + dy};
            if (in_domain(last, jacobian(last))) return last;
            return std::nullopt;
        }
        bool closer = false;
        double fraction = 1;
        for (int halving = 0; halving < k_max_halvings && !closer; ++halving, fraction *= 0.5) {
            const NormalizedPoint next{p.x + fraction * dx, p.y + fraction * dy};
            const Jacobian next_j = jacobian(next);
            if (!in_domain(next, next_j)) continue;
            const NormalizedPoint shown = distort(next);
            const NormalizedPoint left{distorted.x - shown.x, distorted.y - shown.y};
            closer = std::hypot(left.x, left.y) < std::hypot(missing.x, missing.y);
            if (closer) {
                p = next;
                j = next_j;
                missing = left;
            }
        }
        if (!closer) return std::nullopt;
    }
    return std::nullopt;
}

std::optional<Vector3> Distortion::direction(const NormalizedPoint& image) const {
    const auto undistorted = undistort(image);
    if (!undistorted) return std::nullopt;
    return glm::normalize(Vector3(undistorted->x, undistorted->y, 1));
}

std::optional<NormalizedPoint> Distortion::image(const Vector3& direction) const {
    if (!(direction.z > 0)) return std::nullopt;
    const NormalizedPoint p{direction.x / direction.z, direction.y / direction.z};
    if (identity_) return p;
    if (!in_domain(p, jacobian(p))) return std::nullopt;
    const NormalizedPoint shown = distort(p);
    const bool radial_only = desc_.p[0] == 0 && desc_.p[1] == 0;
    if (radial_only) return shown;
    // With tangential terms parts beyond the fold may look like the one around the axis.
    const auto back = undistort(shown);
    if (!back || std::hypot(back->x - p.x, back->y - p.y) > k_same_point) return std::nullopt;
    return shown;
}

double Distortion::falloff(const Vector3& direction) {
    const double cosine_squared = direction.z * direction.z;
    return cosine_squared * cosine_squared;
}

namespace {

constexpr int k_fisheye_max_iterations = 100;
/// Angles closer than this [rad] are the same: a thousandth of the promised 1e-10.
constexpr double k_fisheye_tolerance = 1e-14;

}  // namespace

Fisheye::Fisheye(const DistortionDesc& desc)
    : k_{desc.k[0], desc.k[1], desc.k[2], desc.k[3]}, max_angle_(std::numbers::pi) {
    // dr/d theta as a polynomial in theta^2.
    const std::array<double, 5> growth{1, 3 * k_[0], 5 * k_[1], 7 * k_[2], 9 * k_[3]};
    constexpr double k_limit = std::numbers::pi * std::numbers::pi;
    if (const auto fold = first_positive_root(growth, k_limit)) max_angle_ = std::sqrt(*fold);
    max_radius_ = radius(max_angle_);
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
    double low = 0, high = max_angle_;
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
    if (!(r <= max_radius_)) return std::nullopt;
    if (r == 0) return Vector3(0, 0, 1);
    const double theta = angle(r);
    const double across = std::sin(theta) / r;
    return Vector3(across * image.x, across * image.y, std::cos(theta));
}

std::optional<NormalizedPoint> Fisheye::image(const Vector3& direction) const {
    const double across = std::hypot(direction.x, direction.y);
    const double theta = std::atan2(across, direction.z);
    // The backward direction is imaged at the whole circle, not at a single point.
    if (theta > max_angle_ || (across == 0 && direction.z < 0)) return std::nullopt;
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
