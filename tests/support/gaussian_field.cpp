#include "tests/support/gaussian_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace uw::test {

GaussianField::GaussianField(const Point3& center, double sigma, double peak, double pace)
    : center_(center), sigma_(sigma), peak_(peak), pace_(pace) {}

Bounds GaussianField::bounds() const {
    const Vector3 reach(6 * sigma_);
    return {center_ - reach, center_ + reach};
}

void GaussianField::sample(const Point3& x, std::span<double> concentration) const {
    const double r2 = glm::dot(x - center_, x - center_);
    concentration[0] =
        r2 > 36 * sigma_ * sigma_ ? 0 : peak_ * std::exp(-0.5 * r2 / sigma_ / sigma_);
}

void GaussianField::column(const Point3& a, const Point3& b, std::span<double> column) const {
    const double length = distance(a, b);
    column[0] = 0;
    if (length == 0) return;
    const Vector3 d = (b - a) / length;
    const double along = glm::dot(a - center_, d);
    const double miss2 = glm::dot(a - center_, a - center_) - along * along;
    const double k = sigma_ * std::numbers::sqrt2;
    column[0] = peak_ * std::exp(-miss2 / (k * k)) * sigma_ * std::sqrt(0.5 * std::numbers::pi) *
                (std::erf((along + length) / k) - std::erf(along / k));
}

void GaussianField::profile(const Ray& ray, double s_end, ConcentrationProfile& p) const {
    p.constituent_count = 1;
    p.s.assign({0.0});
    const double nearest = glm::dot(center_ - ray.origin, ray.direction);
    const double first = std::clamp(nearest - 6 * sigma_, 0.0, s_end);
    const double last = std::clamp(nearest + 6 * sigma_, 0.0, s_end);
    const int steps = static_cast<int>(std::ceil((last - first) / (0.5 * pace_)));
    for (int i = 0; i <= steps && steps > 0; ++i) {
        const double s = first + (last - first) * i / steps;
        if (s > p.s.back()) p.s.push_back(s);
    }
    if (p.s.back() < s_end) p.s.push_back(s_end);
    p.concentration.resize(p.s.size());
    p.column.resize(p.s.size());
    for (std::size_t i = 0; i < p.s.size(); ++i) {
        sample(ray.at(p.s[i]), std::span<double>(&p.concentration[i], 1));
        column(ray.origin, ray.at(p.s[i]), std::span<double>(&p.column[i], 1));
    }
}

}  // namespace uw::test
