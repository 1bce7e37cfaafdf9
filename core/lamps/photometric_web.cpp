#include "core/lamps/photometric_web.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace uw {

namespace {

constexpr double k_pi = std::numbers::pi;
constexpr double k_radians = k_pi / 180;

// Permitted deviation of the intensity between two breaks from a parabola, relative to its maximum
// there; intensities below the second fraction of the peak may deviate further.
constexpr double k_follow = 1e-3;
constexpr double k_dim = 1e-4;
constexpr double k_widest = 15 * k_radians;
constexpr std::size_t k_most_at_once = 64;

// A position between two of a table's angles.
struct Place {
    std::size_t i = 0;  // the one before it
    double t = 0;       // 0..1 to the next
};

Place find_place(const std::vector<double>& angles, double angle) {
    const auto above = std::upper_bound(angles.begin(), angles.end(), angle);
    const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
        above - angles.begin() - 1, 0, static_cast<std::ptrdiff_t>(angles.size()) - 2));
    return {i, (angle - angles[i]) / (angles[i + 1] - angles[i])};
}

// One row or column of the table: intensities over `angles`.
using Line = std::function<double(std::size_t)>;

// Whether a parabola through both ends and the midpoint of [first, last] approximates `line` there.
bool follows(const std::vector<double>& angles, const Line& line, std::size_t first,
             std::size_t last, double dim) {
    const auto at = [&](double angle) {
        const Place p = find_place(angles, angle);
        return line(p.i) + p.t * (line(p.i + 1) - line(p.i));
    };
    const double begin = angles[first], length = angles[last] - begin;
    const double f0 = line(first), f1 = at(begin + 0.5 * length), f2 = line(last);
    double most = dim;
    for (std::size_t i = first; i <= last; ++i) most = std::max(most, line(i));
    for (std::size_t i = first + 1; i < last; ++i) {
        // A parabola would miss where the light begins or ends.
        if ((line(i) > 0) != (line(i - 1) > 0) || (line(i) > 0) != (line(i + 1) > 0)) return false;
        const double t = (angles[i] - begin) / length;
        const double parabola =
            f0 * (1 - t) * (1 - 2 * t) + 4 * f1 * t * (1 - t) - f2 * t * (1 - 2 * t);
        if (std::abs(parabola - line(i)) > k_follow * most) return false;
    }
    return true;
}

// A greedy minimal subset of `angles` between which all lines are approximated.
std::vector<double> breaks_of(const std::vector<double>& angles, const std::vector<Line>& lines,
                              double dim) {
    std::vector<double> breaks{angles.front()};
    std::size_t first = 0;
    while (first + 1 < angles.size()) {
        std::size_t last = first + 1;
        while (last + 1 < angles.size() && last - first < k_most_at_once &&
               angles[last + 1] - angles[first] <= k_widest &&
               std::ranges::all_of(lines, [&](const Line& line) {
                   return follows(angles, line, first, last + 1, dim);
               }))
            ++last;
        breaks.push_back(angles[last]);
        first = last;
    }
    return breaks;
}

// A plane of the full circle and the file's plane with the same intensities.
struct UnfoldedPlane {
    double degrees = 0;
    std::size_t source = 0;
};

std::vector<UnfoldedPlane> unfolded(const std::vector<double>& planes) {
    const double first = planes.front(), last = planes.back();
    std::vector<UnfoldedPlane> all;
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const double at = planes[i];
        all.push_back({at, i});
        if (last == 90) {
            all.push_back({180 - at, i});
            all.push_back({180 + at, i});
            all.push_back({360 - at, i});
        } else if (first == 90) {
            if (at <= 180) all.push_back({180 - at, i});
            if (at >= 180) all.push_back({540 - at, i});
        } else if (last == 180) {
            all.push_back({360 - at, i});
        }
    }
    std::ranges::stable_sort(all, {}, &UnfoldedPlane::degrees);
    constexpr double k_same = 1e-9;
    const auto same = [](const UnfoldedPlane& a, const UnfoldedPlane& b) {
        return b.degrees - a.degrees < k_same;
    };
    all.erase(std::unique(all.begin(), all.end(), same), all.end());
    if (all.back().degrees - all.front().degrees < 360 - k_same)
        all.push_back({all.front().degrees + 360, all.front().source});
    return all;
}

}  // namespace

PhotometricWeb::PhotometricWeb(const IesFile& file) {
    for (const double degrees : file.polar) polar_.push_back(degrees * k_radians);
    if (file.planes.size() == 1)
        candelas_ = file.candelas;
    else
        unfold(file);
    peak_ = *std::ranges::max_element(candelas_);
    const std::size_t planes = candelas_.size() / polar_.size();
    std::size_t lit = 0;
    for (std::size_t p = 0; p < planes; ++p)
        for (std::size_t i = 0; i < polar_.size(); ++i)
            if (value(p, i) > 0) lit = std::max(lit, i);
    dark_angle_ = polar_[std::min(lit + 1, polar_.size() - 1)];
    find_breaks();
}

void PhotometricWeb::unfold(const IesFile& file) {
    const auto rows = static_cast<std::ptrdiff_t>(polar_.size());
    for (const UnfoldedPlane& plane : unfolded(file.planes)) {
        const auto begin = file.candelas.begin() + static_cast<std::ptrdiff_t>(plane.source) * rows;
        candelas_.insert(candelas_.end(), begin, begin + rows);
        azimuth_.push_back(plane.degrees * k_radians);
    }
}

void PhotometricWeb::find_breaks() {
    const double dim = k_dim * peak_;
    const std::size_t planes = candelas_.size() / polar_.size();
    std::vector<Line> over_polar, over_azimuth;
    for (std::size_t p = 0; p < planes; ++p)
        over_polar.emplace_back([this, p](std::size_t i) { return value(p, i); });
    polar_breaks_ = breaks_of(polar_, over_polar, dim);
    if (is_rotational()) return;
    for (std::size_t i = 0; i < polar_.size(); ++i)
        over_azimuth.emplace_back([this, i](std::size_t p) { return value(p, i); });
    azimuth_breaks_ = breaks_of(azimuth_, over_azimuth, dim);
    azimuth_breaks_.pop_back();  // equals the first
}

double PhotometricWeb::candelas(double polar, double azimuth) const {
    if (!(polar >= polar_.front() && polar <= polar_.back())) return 0;
    const Place p = find_place(polar_, polar);
    const auto on_plane = [&](std::size_t plane) {
        return value(plane, p.i) + p.t * (value(plane, p.i + 1) - value(plane, p.i));
    };
    if (is_rotational()) return on_plane(0);
    const Place a = find_place(azimuth_, azimuth < azimuth_.front() ? azimuth + 2 * k_pi : azimuth);
    return on_plane(a.i) + a.t * (on_plane(a.i + 1) - on_plane(a.i));
}

double PhotometricWeb::flux() const {
    // Between two polar angles the intensity is m + n theta, integrated with sin(theta) in closed
    // form. Between planes it is linear, so their mean is used.
    const auto zone = [&](std::size_t plane) {
        double sum = 0;
        for (std::size_t i = 0; i + 1 < polar_.size(); ++i) {
            const double slope =
                (value(plane, i + 1) - value(plane, i)) / (polar_[i + 1] - polar_[i]);
            sum += value(plane, i) * std::cos(polar_[i]) -
                   value(plane, i + 1) * std::cos(polar_[i + 1]) +
                   slope * (std::sin(polar_[i + 1]) - std::sin(polar_[i]));
        }
        return sum;
    };
    if (is_rotational()) return 2 * k_pi * zone(0);
    double sum = 0;
    for (std::size_t p = 0; p + 1 < azimuth_.size(); ++p)
        sum += 0.5 * (azimuth_[p + 1] - azimuth_[p]) * (zone(p) + zone(p + 1));
    return sum;
}

}  // namespace uw
