#include "render/snow/snow_image.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>

#include "core/base/parallel.h"

namespace uw {

namespace {

// Footprints with a smaller radius [pixels], or with edges of a smaller half width [pixels], are
// drawn as ellipses with the second moments of disk and blur, whose area in each pixel is exact. An
// image does not resolve more of such an edge.
constexpr double k_small = 0.7, k_sharp = 0.25;
// The minimum radius of an ellipse and half width of a box, which represent a point.
constexpr double k_min_radius = 1e-3, k_min_half = 1e-6;
// The steps along a path [pixels, or relative to the radius]. The variance that they leave out,
// step^2 / 12, is less than 3 % of that of a disk.
constexpr double k_step = 0.5, k_step_of_radius = 0.25;
constexpr double k_max_steps = 4096;
// Edges with a larger half width [pixels] need only one sample per pixel.
constexpr double k_soft = 1.5;
// Larger footprints contain so many samples that the fractions need no normalization: they sum to 1
// within 1 %, as the area of a disk of radius r, sampled n times per pixel, is off by less than
// 1/(n r)^1.5.
constexpr double k_large = 16;
// Neither do long and thin ones, whose bounding box has more pixels than this; it may be cropped.
constexpr double k_max_pixels = 1 << 20;

/// Returns the standard deviations along x and y of the blurred disk.
std::array<double, 2> deviations(const PlaneMap& disk, const PlaneMap& blur) {
    return {0.5 * std::sqrt(disk.xx * disk.xx + disk.xy * disk.xy + blur.xx * blur.xx +
                            blur.xy * blur.xy),
            0.5 * std::sqrt(disk.yx * disk.yx + disk.yy * disk.yy + blur.yx * blur.yx +
                            blur.yy * blur.yy)};
}

/// Returns half of the extents along x and y.
std::array<double, 2> extents(const PlaneMap& disk, const PlaneMap& blur) {
    return {std::hypot(disk.xx, disk.xy) + std::hypot(blur.xx, blur.xy),
            std::hypot(disk.yx, disk.yy) + std::hypot(blur.yx, blur.yy)};
}

/// Returns the map from the plane to the unit disk of the ellipse with the second moments of both
/// disks.
PlaneMap unit_from_ellipse(const PlaneMap& disk, const PlaneMap& blur) {
    const double xx = disk.xx * disk.xx + disk.xy * disk.xy + blur.xx * blur.xx + blur.xy * blur.xy;
    const double yy = disk.yx * disk.yx + disk.yy * disk.yy + blur.yx * blur.yx + blur.yy * blur.yy;
    const double xy = disk.xx * disk.yx + disk.xy * disk.yy + blur.xx * blur.yx + blur.xy * blur.yy;
    // The Cholesky decomposition of that matrix.
    const double x = std::max(k_min_radius, std::sqrt(xx)), skew = xy / x;
    const double y = std::max(k_min_radius, std::sqrt(std::max(0.0, yy - skew * skew)));
    return PlaneMap{x, skew, 0, y}.inverse();
}

using PlanePoint = std::array<double, 2>;

PlanePoint operator*(const PlaneMap& map, const PlanePoint& p) {
    return {map.xx * p[0] + map.xy * p[1], map.yx * p[0] + map.yy * p[1]};
}
double cross(const PlanePoint& a, const PlanePoint& b) {
    return a[0] * b[1] - a[1] * b[0];
}
double dot(const PlanePoint& a, const PlanePoint& b) {
    return a[0] * b[0] + a[1] * b[1];
}

/// Returns the signed area of the part of the triangle 0, a, b that lies in the unit disk.
double area_in_disk(const PlanePoint& a, const PlanePoint& b) {
    const auto sector = [](const PlanePoint& from, const PlanePoint& to) {
        return 0.5 * std::atan2(cross(from, to), dot(from, to));
    };
    const PlanePoint edge{b[0] - a[0], b[1] - a[1]};
    const double length = dot(edge, edge), middle = -dot(a, edge);
    const double square = middle * middle - length * (dot(a, a) - 1);
    if (!(square > 0)) return sector(a, b);
    const double root = std::sqrt(square);
    const double begin = (middle - root) / length, end = (middle + root) / length;
    if (begin >= 1 || end <= 0) return sector(a, b);
    const auto at = [&](double t) { return PlanePoint{a[0] + t * edge[0], a[1] + t * edge[1]}; };
    const PlanePoint enters = at(std::max(begin, 0.0)), leaves = at(std::min(end, 1.0));
    return (begin > 0 ? sector(a, enters) : 0) + 0.5 * cross(enters, leaves) +
           (end < 1 ? sector(leaves, b) : 0);
}

double overlap(double begin, double end, int pixel) {
    return std::max(0.0, std::min(end, pixel + 1.0) - std::max(begin, static_cast<double>(pixel)));
}

int floor_of(double value) {
    constexpr double k_max = 1e9;
    return static_cast<int>(std::floor(std::clamp(value, -k_max, k_max)));
}

PixelWindow around(const std::array<double, 2>& at, const std::array<double, 2>& half) {
    return {floor_of(at[0] - half[0]), floor_of(at[1] - half[1]), floor_of(at[0] + half[0]) + 1,
            floor_of(at[1] + half[1]) + 1};
}

/// Returns the fraction of a disk of radius `ratio` <= 1 that lies in the unit disk, at the
/// distance `radius` between their centres: the lens between two circles.
double fraction_within(double ratio, double radius) {
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

/// fraction_within between 1 - ratio and 1 + ratio, from a table: accurate to 2e-3.
class SoftEdge {
  public:
    explicit SoftEdge(double ratio)
        : begin_(1 - ratio),
          per_distance_(ratio > 0 ? 0.5 * k_steps / ratio : 0),
          table_(table()[static_cast<std::size_t>(std::lround(ratio * k_ratios))]) {}

    double operator()(double radius) const {
        const double at = std::clamp((radius - begin_) * per_distance_, 0.0, k_steps - 1e-9);
        const auto i = static_cast<std::size_t>(at);
        const double t = at - static_cast<double>(i);
        return (1 - t) * table_[i] + t * table_[i + 1];
    }

  private:
    static constexpr int k_ratios = 128, k_steps = 32;
    using Table = std::array<std::array<double, k_steps + 1>, k_ratios + 1>;

    static const Table& table() {
        static const Table fractions = [] {
            Table all{};
            for (std::size_t r = 0; r <= k_ratios; ++r)
                for (std::size_t i = 0; i <= k_steps; ++i) {
                    // The edge of a sharp disk is a step: only the ends of its table matter.
                    const double ratio = std::max(1e-3, static_cast<double>(r) / k_ratios);
                    const double at = static_cast<double>(i) / k_steps;
                    all[r][i] = fraction_within(ratio, 1 - ratio + 2 * ratio * at);
                }
            return all;
        }();
        return fractions;
    }

    double begin_, per_distance_;
    const std::array<double, k_steps + 1>& table_;
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
    steps_ = static_cast<int>(std::clamp(std::ceil(2 * length / step), 1.0, k_max_steps));
    const double softness = std::min(disk_radius, blur_radius);
    is_sharp_ = softness < k_sharp || is_small_;
    if (is_small_ && steps_ > 1) {
        half_ = deviations(disk, blur);
        for (double& half : half_) half = std::max(k_min_half, std::sqrt(3.0) * half);
    } else if (is_sharp_) {
        unit_from_plane_ = unit_from_ellipse(disk, blur);
        const PlaneMap ellipse = unit_from_plane_.inverse();
        half_ = {std::abs(ellipse.xx), std::hypot(ellipse.yx, ellipse.yy)};
        for (const double side : {-0.5, 0.5}) {
            const PlanePoint corner = unit_from_plane_ * PlanePoint{0.5, side};
            pixel_radius_ = std::max(pixel_radius_, std::hypot(corner[0], corner[1]));
        }
    } else {
        const bool is_of_disk = disk_radius >= blur_radius;
        unit_from_plane_ = (is_of_disk ? disk : blur).inverse();
        ratio_ = is_of_disk ? blur_radius / disk_radius : disk_radius / blur_radius;
        half_ = extents(disk, blur);
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
    is_scaled_ = radius >= k_large || 4 * half_[0] * half_[1] > k_max_pixels;
}

std::array<double, 2> Footprint::position(double t) const {
    return {path_.at[0] + t * (path_.linear[0] + t * path_.quadratic[0]),
            path_.at[1] + t * (path_.linear[1] + t * path_.quadratic[1])};
}

std::array<double, 2> Footprint::step_position(int step) const {
    return position(2 * (step + 0.5) / steps_ - 1);
}

/// Returns the window of one position, extended by the motion during its step.
PixelWindow Footprint::window_around(const std::array<double, 2>& at) const {
    std::array<double, 2> half = half_;
    if (steps_ > 1)
        for (std::size_t axis = 0; axis < 2; ++axis)
            half[axis] +=
                (std::abs(path_.linear[axis]) + 2 * std::abs(path_.quadratic[axis])) / steps_;
    return around(at, half);
}

void Footprint::add_fractions(const PixelWindow& window, Grid2D<double>& fractions) const {
    for (int i = 0; i < steps_; ++i) {
        const std::array<double, 2> at = step_position(i);
        if (!is_sharp_) {
            add_soft(at, 1.0 / steps_, window, fractions);
            continue;
        }
        if (!is_small_ || steps_ == 1) {
            add_sharp(at, 1.0 / steps_, window, fractions);
            continue;
        }
        // The box is as long as the motion in its step, so that the boxes of successive steps join.
        const std::array<double, 2> begin = position(2.0 * i / steps_ - 1),
                                    end = position(2.0 * (i + 1) / steps_ - 1);
        const std::array<double, 2> half{std::hypot(half_[0], 0.5 * (end[0] - begin[0])),
                                         std::hypot(half_[1], 0.5 * (end[1] - begin[1]))};
        add_box(at, half, 1.0 / steps_, window, fractions);
    }
}

void Footprint::add_box(const std::array<double, 2>& at, const std::array<double, 2>& half,
                        double weight, const PixelWindow& window, Grid2D<double>& fractions) const {
    const PixelWindow inside = intersection(window, around(at, half));
    const double per_area = weight / (4 * half[0] * half[1]);
    for (int y = inside.y0; y < inside.y1; ++y) {
        const double height = overlap(at[1] - half[1], at[1] + half[1], y);
        for (int x = inside.x0; x < inside.x1; ++x)
            fractions(x - window.x0, y - window.y0) +=
                per_area * height * overlap(at[0] - half[0], at[0] + half[0], x);
    }
}

void Footprint::add_sharp(const std::array<double, 2>& at, double weight, const PixelWindow& window,
                          Grid2D<double>& fractions) const {
    const PixelWindow whole = around(at, half_), inside = intersection(window, whole);
    if (whole.width() == 1 && whole.height() == 1 && inside.width() == 1 && inside.height() == 1) {
        fractions(inside.x0 - window.x0, inside.y0 - window.y0) += weight;
        return;
    }
    const double per_area = weight / std::numbers::pi;  // of the unit disk
    const double pixel_area = unit_from_plane_.determinant();
    for (int y = inside.y0; y < inside.y1; ++y)
        for (int x = inside.x0; x < inside.x1; ++x) {
            const double u = x - at[0], v = y - at[1];
            const PlanePoint centre = unit_from_plane_ * PlanePoint{u + 0.5, v + 0.5};
            const double distance = std::hypot(centre[0], centre[1]);
            if (distance - pixel_radius_ >= 1) continue;
            double area = pixel_area;
            if (distance + pixel_radius_ > 1) {
                const std::array<PlanePoint, 4> corners{unit_from_plane_ * PlanePoint{u, v},
                                                        unit_from_plane_ * PlanePoint{u + 1, v},
                                                        unit_from_plane_ * PlanePoint{u + 1, v + 1},
                                                        unit_from_plane_ * PlanePoint{u, v + 1}};
                area = 0;
                for (std::size_t i = 0; i < corners.size(); ++i)
                    area += area_in_disk(corners[i], corners[(i + 1) % corners.size()]);
            }
            fractions(x - window.x0, y - window.y0) += per_area * std::max(0.0, area);
        }
}

void Footprint::add_soft(const std::array<double, 2>& at, double weight, const PixelWindow& window,
                         Grid2D<double>& fractions) const {
    const PixelWindow whole = around(at, half_), inside = intersection(window, whole);
    if (inside.x0 >= inside.x1 || inside.y0 >= inside.y1) return;
    const PixelWindow& drawn = is_scaled_ ? inside : whole;
    Grid2D<double> samples(drawn.width(), drawn.height());
    const double sum = count_samples(at, drawn, samples);
    if (!(sum > 0)) return;
    const double per_sample = weight * (is_scaled_ ? scale_ / (samples_ * samples_) : 1 / sum);
    for (int y = inside.y0; y < inside.y1; ++y)
        for (int x = inside.x0; x < inside.x1; ++x)
            fractions(x - window.x0, y - window.y0) +=
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

namespace {

constexpr int k_snow_tile = 32;  // pixels along an edge
// Values of a pixel after its bands: the fractions of surfaces and of in-scattered light that are
// hidden, and the distance of a particle.
enum : std::size_t { k_covered, k_hidden, k_particle_distance, k_others };
// A particle that covers this fraction of a pixel counts as visible in ground truth.
constexpr double k_min_cover_of_truth = 0.5;

/// Indices of the splats that touch each tile of a window; tiles are in row order.
class TileLists {
  public:
    explicit TileLists(const PixelWindow& window)
        : window_(window),
          columns_((window.width() + k_snow_tile - 1) / k_snow_tile),
          lists_(static_cast<std::size_t>(columns_ *
                                          ((window.height() + k_snow_tile - 1) / k_snow_tile))) {}

    void add(std::uint32_t index, const PixelWindow& bounds) {
        const PixelWindow inside = intersection(bounds, window_);
        if (inside.width() <= 0 || inside.height() <= 0) return;
        for (int j = (inside.y0 - window_.y0) / k_snow_tile;
             j <= (inside.y1 - 1 - window_.y0) / k_snow_tile; ++j)
            for (int i = (inside.x0 - window_.x0) / k_snow_tile;
                 i <= (inside.x1 - 1 - window_.x0) / k_snow_tile; ++i)
                lists_[static_cast<std::size_t>(j * columns_ + i)].push_back(index);
    }
    std::size_t count() const { return lists_.size(); }
    std::vector<std::uint32_t>& list(std::size_t tile) { return lists_[tile]; }
    PixelWindow window(std::size_t tile) const {
        const int x0 = window_.x0 + static_cast<int>(tile) % columns_ * k_snow_tile;
        const int y0 = window_.y0 + static_cast<int>(tile) / columns_ * k_snow_tile;
        return intersection({x0, y0, x0 + k_snow_tile, y0 + k_snow_tile}, window_);
    }

  private:
    PixelWindow window_;
    int columns_;
    std::vector<std::vector<std::uint32_t>> lists_;
};

}  // namespace

void SnowSplats::append(const SnowSplats& more) {
    const auto first = static_cast<std::uint32_t>(radiance.size());
    radiance.insert(radiance.end(), more.radiance.begin(), more.radiance.end());
    for (SnowSplat splat : more.splats) {
        splat.radiance += first;
        splats.push_back(splat);
    }
}

SnowImage::SnowImage(const PixelWindow& window, std::size_t bands, const SnowSplats& all)
    : window_(window),
      bands_(bands),
      values_(window.width() * static_cast<int>(bands + k_others), window.height()) {
    TileLists tiles(window);
    for (std::size_t i = 0; i < all.splats.size(); ++i)
        tiles.add(static_cast<std::uint32_t>(i), all.splats[i].footprint.bounds());
    parallel_for(tiles.count(), [&](std::size_t tile) {
        std::vector<std::uint32_t>& list = tiles.list(tile);
        std::ranges::sort(list, {}, [&](std::uint32_t i) {
            return std::tuple(all.splats[i].distance, all.splats[i].id);
        });
        for (const std::uint32_t i : list) {
            const SnowSplat& splat = all.splats[i];
            draw(splat, std::span(all.radiance).subspan(splat.radiance, bands_),
                 tiles.window(tile));
        }
    });
}

std::span<float> SnowImage::values(int x, int y) {
    const std::size_t count = bands_ + k_others;
    return values_.row(y - window_.y0)
        .subspan(static_cast<std::size_t>(x - window_.x0) * count, count);
}

void SnowImage::draw(const SnowSplat& splat, std::span<const float> radiance,
                     const PixelWindow& tile) {
    const PixelWindow inside = intersection(splat.footprint.bounds(), tile);
    Grid2D<double> fractions(inside.width(), inside.height());
    splat.footprint.add_fractions(inside, fractions);
    for (int y = inside.y0; y < inside.y1; ++y)
        for (int x = inside.x0; x < inside.x1; ++x) {
            const double cover =
                std::min(1.0, splat.footprint.area() * fractions(x - inside.x0, y - inside.y0));
            if (cover == 0) continue;
            const std::span<float> pixel = values(x, y);
            const std::span<float> others = pixel.subspan(bands_);
            // The fraction of the pixel in which this particle is visible behind those before it.
            const double visible = cover * (1 - static_cast<double>(others[k_covered]));
            for (std::size_t b = 0; b < bands_; ++b)
                pixel[b] += static_cast<float>(visible * static_cast<double>(radiance[b]));
            others[k_covered] += static_cast<float>(visible);
            others[k_hidden] += static_cast<float>(visible * static_cast<double>(splat.hidden));
            if (cover >= k_min_cover_of_truth && others[k_particle_distance] == 0)
                others[k_particle_distance] = static_cast<float>(splat.distance);
        }
}

SnowPixel SnowImage::pixel(int x, int y) const {
    const std::size_t count = bands_ + k_others;
    const std::span<const float> values =
        values_.row(y - window_.y0)
            .subspan(static_cast<std::size_t>(x - window_.x0) * count, count);
    const auto other = [&](std::size_t i) { return static_cast<double>(values[bands_ + i]); };
    return {values.first(bands_), 1 - other(k_covered), 1 - other(k_hidden),
            other(k_particle_distance)};
}

namespace {

// Spacing of the nodes [pixels], which cover the whole image: a particle outside a crop may extend
// into it.
constexpr int k_spacing = 32;
constexpr int k_distances = 24;
constexpr double k_nearest = 0.02, k_last = 200;  // m

double mean_of(const Spectrum& light) {
    return std::accumulate(light.begin(), light.end(), 0.0);
}

}  // namespace

WaterVeil::WaterVeil(const RaySource& rays, const Integrator& integrator,
                     const std::function<double(double distance)>& depth) {
    for (int i = 0; i < k_distances; ++i)
        distances_.push_back(k_nearest * std::pow(k_last / k_nearest, i / (k_distances - 1.0)));
    const int columns = rays.width() / k_spacing + 2;
    const int rows = rays.height() / k_spacing + 2;
    nodes_.assign(columns, rows, std::vector<Light>(distances_.size()));
    parallel_for(nodes_.size(), [&](std::size_t node) {
        const int i = static_cast<int>(node) % columns;
        const int j = static_cast<int>(node) / columns;
        const auto ray = rays.refracted_ray(std::min(i * k_spacing, rays.width()),
                                            std::min(j * k_spacing, rays.height()));
        if (!ray) return;
        InScatter light;
        integrator.in_scatter(*ray, distances_, light);
        Light sum;
        double before = 0, from = 0;
        for (std::size_t d = 0; d < distances_.size(); ++d) {
            double all = 0;
            for (std::size_t lamp = 0; lamp < light.lamp_count(); ++lamp)
                all += mean_of(light.at(d, lamp));
            sum.all = all;
            sum.transmitted +=
                std::max(0.0, all - before) * std::exp(-depth(0.5 * (from + distances_[d])));
            nodes_[node][d] = sum;
            before = all;
            from = distances_[d];
        }
    });
}

WaterVeil::Light WaterVeil::light_up_to(double x, double y, double distance) const {
    const double u = std::clamp(x / k_spacing, 0.0, nodes_.width() - 1.001);
    const double v = std::clamp(y / k_spacing, 0.0, nodes_.height() - 1.001);
    const int i = static_cast<int>(u), j = static_cast<int>(v);
    const auto next = std::ranges::upper_bound(distances_, distance);
    const auto at = static_cast<std::size_t>(next - distances_.begin());
    // Interpolate linearly between two distances, from 0 before the first.
    const double begin = at == 0 ? 0 : distances_[at - 1];
    const double t = at == distances_.size() ? 0 : (distance - begin) / (distances_[at] - begin);
    Light sum;
    for (const int dy : {0, 1})
        for (const int dx : {0, 1}) {
            const double weight = (dx == 0 ? i + 1 - u : u - i) * (dy == 0 ? j + 1 - v : v - j);
            const std::vector<Light>& node = nodes_(i + dx, j + dy);
            const Light before = at == 0 ? Light{} : node[at - 1];
            const Light after = at == node.size() ? before : node[at];
            sum.all += weight * ((1 - t) * before.all + t * after.all);
            sum.transmitted += weight * ((1 - t) * before.transmitted + t * after.transmitted);
        }
    return sum;
}

double WaterVeil::fraction_beyond(double x, double y, double distance, double end) const {
    const double all = light_up_to(x, y, end).all;
    if (!(all > 0)) return 0;
    return std::clamp(1 - light_up_to(x, y, distance).all / all, 0.0, 1.0);
}

double WaterVeil::mean_transmittance(double x, double y, double end) const {
    const Light light = light_up_to(x, y, end);
    return light.all > 0 && light.transmitted > 0 ? light.transmitted / light.all : 1;
}

Spectrum SnowLayer::radiance(int x, int y, double end, const Spectrum& surface,
                             const Spectrum& water) const {
    const SnowPixel snow = image_.pixel(x, y);
    const double left = snow.transparency * std::exp(depth_(end)) - 1;
    const double water_left = snow.water / veil_.mean_transmittance(x + 0.5, y + 0.5, end) - 1;
    return per_band(snow.radiance.size(), [&](std::size_t b) {
        return static_cast<double>(snow.radiance[b]) + left * surface[b] + water_left * water[b];
    });
}

}  // namespace uw
