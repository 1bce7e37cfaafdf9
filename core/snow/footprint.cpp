#include "core/snow/footprint.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace uw {
namespace {

// Smaller footprints [pixels, radius] are boxes with the same second moments, whose overlap with
// each pixel is exact: within a pixel nothing else of a shape is seen.
constexpr double k_small = 0.7;
// Of a box: of a point in one pixel.
constexpr double k_least_half = 1e-6;
// The steps of a path [pixels, or of the radius]: their spread, step^2 / 12, is less than 3 % of
// that of a disk.
constexpr double k_step = 0.5, k_step_of_radius = 0.25;
constexpr double k_most_steps = 4096;
// Wider edges [pixels, half] need no samples within pixels.
constexpr double k_soft = 1.5;
// Larger footprints hold so many samples that the shares add up to their area by themselves, to
// 1 %: the edge of a disk of radius r, sampled n times per pixel, is off by less than 1/(n r)^1.5.
constexpr double k_large = 16;
// So do those, long and thin, that are looked for in more pixels than this.
constexpr double k_most_pixels = 1 << 20;

/// The standard deviations along x and y of the unit disk's image.
std::array<double, 2> deviations(const PlaneMap& disk, const PlaneMap& blur) {
    return {0.5 * std::sqrt(disk.xx * disk.xx + disk.xy * disk.xy + blur.xx * blur.xx +
                            blur.xy * blur.xy),
            0.5 * std::sqrt(disk.yx * disk.yx + disk.yy * disk.yy + blur.yx * blur.yx +
                            blur.yy * blur.yy)};
}

/// Half the extent along x and y.
std::array<double, 2> extents(const PlaneMap& disk, const PlaneMap& blur) {
    return {std::hypot(disk.xx, disk.xy) + std::hypot(blur.xx, blur.xy),
            std::hypot(disk.yx, disk.yy) + std::hypot(blur.yx, blur.yy)};
}

double overlap(double begin, double end, int pixel) {
    return std::max(0.0, std::min(end, pixel + 1.0) - std::max(begin, static_cast<double>(pixel)));
}

int floor_of(double value) {
    constexpr double k_most = 1e9;
    return static_cast<int>(std::floor(std::clamp(value, -k_most, k_most)));
}

PixelWindow around(const std::array<double, 2>& at, const std::array<double, 2>& half) {
    return {floor_of(at[0] - half[0]), floor_of(at[1] - half[1]), floor_of(at[0] + half[0]) + 1,
            floor_of(at[1] + half[1]) + 1};
}

/// How much of a disk of radius `ratio`, at most 1, lies in the unit disk, `radius` between their
/// centres: the lens between two circles.
double share_within(double ratio, double radius) {
    const double r = ratio, d = radius;
    if (d <= 1 - r) return 1;
    if (d >= 1 + r) return 0;
    const auto acos_of = [](double x) { return std::acos(std::clamp(x, -1.0, 1.0)); };
    const double root = (-d + r + 1) * (d + r - 1) * (d - r + 1) * (d + r + 1);
    const double lens = r * r * acos_of((d * d + r * r - 1) / (2 * d * r)) +
                        acos_of((d * d + 1 - r * r) / (2 * d)) -
                        0.5 * std::sqrt(std::max(0.0, root));
    return lens / (std::numbers::pi * r * r);
}

/// share_within between 1 - ratio and 1 + ratio, from a table: to 2e-3.
class SoftEdge {
  public:
    explicit SoftEdge(double ratio)
        : begin_(1 - ratio),
          per_distance_(ratio > 0 ? 0.5 * k_steps / ratio : 0),
          shares_(table()[static_cast<std::size_t>(std::lround(ratio * k_ratios))]) {}

    double operator()(double radius) const {
        const double at = std::clamp((radius - begin_) * per_distance_, 0.0, k_steps - 1e-9);
        const auto i = static_cast<std::size_t>(at);
        const double share = at - static_cast<double>(i);
        return (1 - share) * shares_[i] + share * shares_[i + 1];
    }

  private:
    static constexpr int k_ratios = 128, k_steps = 32;
    using Table = std::array<std::array<double, k_steps + 1>, k_ratios + 1>;

    static const Table& table() {
        static const Table shares = [] {
            Table all{};
            for (std::size_t r = 0; r <= k_ratios; ++r)
                for (std::size_t i = 0; i <= k_steps; ++i) {
                    // The edge of a sharp disk is a step, which only the ends of its table show.
                    const double ratio = std::max(1e-3, static_cast<double>(r) / k_ratios);
                    const double at = static_cast<double>(i) / k_steps;
                    all[r][i] = share_within(ratio, 1 - ratio + 2 * ratio * at);
                }
            return all;
        }();
        return shares;
    }

    double begin_, per_distance_;
    const std::array<double, k_steps + 1>& shares_;
};

}  // namespace

Footprint::Footprint(const Path& path, const PlaneMap& disk, const PlaneMap& blur)
    : path_(path), area_(std::numbers::pi * std::abs(disk.determinant())) {
    const double disk_radius = std::sqrt(std::abs(disk.determinant()));
    const double blur_radius = std::sqrt(std::abs(blur.determinant()));
    const double radius = std::hypot(disk_radius, blur_radius);
    is_small_ = radius < k_small;
    const double length = std::hypot(path.linear[0], path.linear[1]) +
                          std::hypot(path.quadratic[0], path.quadratic[1]);
    const double step = std::max(k_step, k_step_of_radius * radius);
    steps_ = static_cast<int>(std::clamp(std::ceil(2 * length / step), 1.0, k_most_steps));
    if (is_small_) {
        half_ = deviations(disk, blur);
        for (double& half : half_) half = std::max(k_least_half, std::sqrt(3.0) * half);
    } else {
        const bool is_sharp = disk_radius >= blur_radius;
        unit_from_plane_ = (is_sharp ? disk : blur).inverse();
        ratio_ = is_sharp ? blur_radius / disk_radius : disk_radius / blur_radius;
        half_ = extents(disk, blur);
        const double softness = std::min(disk_radius, blur_radius);
        samples_ = softness >= k_soft && radius > 2 ? 1 : (radius < 4 ? 3 : 2);
        scale_ = 1 / (std::numbers::pi * std::max(disk_radius, blur_radius) *
                      std::max(disk_radius, blur_radius));
    }
    bounds_ = window_around(step_position(0));
    for (int i = 1; i < steps_; ++i) {
        const PixelWindow more = window_around(step_position(i));
        bounds_ = {std::min(bounds_.x0, more.x0), std::min(bounds_.y0, more.y0),
                   std::max(bounds_.x1, more.x1), std::max(bounds_.y1, more.y1)};
    }
    is_scaled_ = radius >= k_large || 4 * half_[0] * half_[1] > k_most_pixels;
}

std::array<double, 2> Footprint::position(double t) const {
    return {path_.at[0] + t * (path_.linear[0] + t * path_.quadratic[0]),
            path_.at[1] + t * (path_.linear[1] + t * path_.quadratic[1])};
}

std::array<double, 2> Footprint::step_position(int step) const {
    return position(2 * (step + 0.5) / steps_ - 1);
}

/// Of one position, with what it moves during its step.
PixelWindow Footprint::window_around(const std::array<double, 2>& at) const {
    std::array<double, 2> half = half_;
    if (steps_ > 1)
        for (std::size_t axis = 0; axis < 2; ++axis)
            half[axis] +=
                (std::abs(path_.linear[axis]) + 2 * std::abs(path_.quadratic[axis])) / steps_;
    return around(at, half);
}

void Footprint::add_shares(const PixelWindow& window, Grid2D<double>& shares) const {
    for (int i = 0; i < steps_; ++i) {
        const std::array<double, 2> at = step_position(i);
        if (!is_small_) {
            add_ellipse(at, 1.0 / steps_, window, shares);
            continue;
        }
        if (steps_ == 1) {
            add_box(at, half_, 1, window, shares);
            continue;
        }
        // The box is as long as what it passes in the step: those of all steps join.
        const std::array<double, 2> begin = position(2.0 * i / steps_ - 1),
                                    end = position(2.0 * (i + 1) / steps_ - 1);
        const std::array<double, 2> half{std::hypot(half_[0], 0.5 * (end[0] - begin[0])),
                                         std::hypot(half_[1], 0.5 * (end[1] - begin[1]))};
        add_box(at, half, 1.0 / steps_, window, shares);
    }
}

void Footprint::add_box(const std::array<double, 2>& at, const std::array<double, 2>& half,
                        double weight, const PixelWindow& window, Grid2D<double>& shares) const {
    const PixelWindow inside = intersection(window, around(at, half));
    const double per_area = weight / (4 * half[0] * half[1]);
    for (int y = inside.y0; y < inside.y1; ++y) {
        const double height = overlap(at[1] - half[1], at[1] + half[1], y);
        for (int x = inside.x0; x < inside.x1; ++x)
            shares(x - window.x0, y - window.y0) +=
                per_area * height * overlap(at[0] - half[0], at[0] + half[0], x);
    }
}

void Footprint::add_ellipse(const std::array<double, 2>& at, double weight,
                            const PixelWindow& window, Grid2D<double>& shares) const {
    const PixelWindow whole = around(at, half_), inside = intersection(window, whole);
    if (inside.x0 >= inside.x1 || inside.y0 >= inside.y1) return;
    const PixelWindow& drawn = is_scaled_ ? inside : whole;
    thread_local Grid2D<double> samples;
    samples.assign(drawn.width(), drawn.height());
    const double sum = count_samples(at, drawn, samples);
    if (!(sum > 0)) return;
    const double per_sample = weight * (is_scaled_ ? scale_ / (samples_ * samples_) : 1 / sum);
    for (int y = inside.y0; y < inside.y1; ++y)
        for (int x = inside.x0; x < inside.x1; ++x)
            shares(x - window.x0, y - window.y0) +=
                per_sample * samples(x - drawn.x0, y - drawn.y0);
}

double Footprint::count_samples(const std::array<double, 2>& at, const PixelWindow& window,
                                Grid2D<double>& counts) const {
    const double pitch = 1.0 / samples_;
    const double full = (1 - ratio_) * (1 - ratio_), none = (1 + ratio_) * (1 + ratio_);
    const SoftEdge edge(ratio_);
    double all = 0;
    for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x) {
            double sum = 0;
            for (int j = 0; j < samples_; ++j)
                for (int i = 0; i < samples_; ++i) {
                    const double u = x + (i + 0.5) * pitch - at[0];
                    const double v = y + (j + 0.5) * pitch - at[1];
                    const double a = unit_from_plane_.xx * u + unit_from_plane_.xy * v;
                    const double b = unit_from_plane_.yx * u + unit_from_plane_.yy * v;
                    const double square = a * a + b * b;
                    if (square <= full)
                        sum += 1;
                    else if (square < none)
                        sum += edge(std::sqrt(square));
                }
            counts(x - window.x0, y - window.y0) = sum;
            all += sum;
        }
    return all;
}

}  // namespace uw
