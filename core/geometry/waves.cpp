#include "core/geometry/waves.h"

#include <fftw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <new>
#include <numbers>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "core/base/fourier.h"
#include "core/base/grid2d.h"
#include "core/base/numerics.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/image/image_file.h"
#include "core/image/pixel_image.h"

namespace uw {

namespace {

constexpr double k_full_turn = 2 * std::numbers::pi;

double squared(double x) {
    return x * x;
}

/// tanh(k depth), 1 where it is deep.
double depth_tangent(double wave_number, const std::optional<double>& depth) {
    return depth ? std::tanh(wave_number * *depth) : 1;
}

/// The wind at `height` as a multiple of that at 10 m.
double wind_profile(double height) {
    constexpr double k_drag = 0.0013, k_karman = 0.4;
    return 1 + std::sqrt(k_drag) / k_karman * std::log(height / 10);
}

double wind_at(const WaveSpectrumDesc& desc, double height) {
    return desc.wind * wind_profile(height) / wind_profile(desc.wind_height);
}

}  // namespace

double wave_frequency(double wave_number, const std::optional<double>& depth) {
    const double k = wave_number;
    return std::sqrt((k_gravity * k + k_surface_tension * k * k * k) * depth_tangent(k, depth));
}

double wave_group_velocity(double wave_number, const std::optional<double>& depth) {
    const double k = wave_number, tangent = depth_tangent(k, depth);
    double slope = (k_gravity + 3 * k_surface_tension * k * k) * tangent;
    if (depth)
        slope += (k_gravity * k + k_surface_tension * k * k * k) * *depth * (1 - squared(tangent));
    return slope / (2 * wave_frequency(k, depth));
}

double wave_spectrum(const WaveSpectrumDesc& desc, double angular_frequency) {
    const double omega = angular_frequency;
    const double tail = squared(k_gravity) / std::pow(omega, 5);
    if (desc.model == WaveSpectrumDesc::Model::pierson_moskowitz)
        return 0.0081 * tail *
               std::exp(-0.74 * std::pow(k_gravity / (wind_at(desc, 19.5) * omega), 4));
    const double wind = wind_at(desc, 10);
    const double alpha = 0.076 * std::pow(squared(wind) / (desc.fetch * k_gravity), 0.22);
    const double peak = 22 * std::cbrt(squared(k_gravity) / (wind * desc.fetch));
    const double width = omega <= peak ? 0.07 : 0.09;
    const double r = std::exp(-0.5 * squared((omega - peak) / (width * peak)));
    return alpha * tail * std::exp(-1.25 * std::pow(peak / omega, 4)) * std::pow(desc.gamma, r);
}

double shoaling_factor(double wave_number, double depth) {
    const double x = wave_number * depth;
    if (x > 50) return 1;  // sinh 2x would overflow later, and 1 - tanh x is below 1e-40
    return squared(std::tanh(x)) / (1 + 2 * x / std::sinh(2 * x));
}

double wave_spreading(double angle, double s) {
    // int cos^{2s}(a / 2) da over a full turn = 2 sqrt(pi) Gamma(s + 1/2) / Gamma(s + 1).
    const double log_integral =
        std::log(2 * std::sqrt(std::numbers::pi)) + std::lgamma(s + 0.5) - std::lgamma(s + 1);
    const double cosine = std::abs(std::cos(0.5 * angle));
    return cosine > 0 ? std::exp(2 * s * std::log(cosine) - log_integral) : 0;
}

SlopeVariance cox_munk_slopes(double wind) {
    return {0.00316 * wind, 0.003 + 0.00192 * wind};
}

double WaveStatistics::significant_height() const {
    return 4 * std::sqrt(height_variance);
}

/// What a surface consists of, with bounds by which a ray can advance without missing it.
class WaterWaves::Shape {
  public:
    Shape() = default;
    virtual ~Shape() = default;
    Shape(const Shape&) = delete;
    Shape& operator=(const Shape&) = delete;
    Shape(Shape&&) = delete;
    Shape& operator=(Shape&&) = delete;

    virtual WavePoint at(double u, double v) const = 0;
    virtual WaveStatistics statistics() const = 0;
    /// Bounds on a part of the surface.
    struct Bounds {
        double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
        double steepest = 0;    // of the slope
        double max_curved = 0;  // of the second derivative in any direction [1/m]

        void include(const Bounds& other) {
            lowest = std::min(lowest, other.lowest);
            highest = std::max(highest, other.highest);
            steepest = std::max(steepest, other.steepest);
            max_curved = std::max(max_curved, other.max_curved);
        }
    };
    /// What is known of the surface ahead of a ray [m].
    struct Lookahead {
        double clear = 0;                // up to here the ray is known to stay below the surface
        double end = 0;                  // from there to here
        const Bounds* bounds = nullptr;  // these bounds are valid
    };
    /// `is_below`: the ray begins below the surface; else nothing is clear.
    virtual Lookahead look_ahead(const Point3& /*from*/, const Vector3& /*direction*/,
                                 bool /*is_below*/) const {
        return {0, std::numeric_limits<double>::infinity(), &bounds};
    }

    Bounds bounds;  // of all of it
};

namespace {

/// A sum of sines or trochoids.
class SineWaves : public WaterWaves::Shape {
  public:
    SineWaves(const std::vector<SineWaveDesc>& descs, const std::optional<double>& depth,
              double time) {
        double highest = 0, steepest = 0, curvature = 0, motion = 0, motion_curvature = 0;
        for (const SineWaveDesc& desc : descs) {
            const double k = k_full_turn / desc.wavelength, angle = desc.direction * k_degree;
            // Reduced to one turn before it is added, to keep precision.
            const double turned = std::fmod(wave_frequency(k, depth) * time, k_full_turn);
            waves_.push_back({desc.amplitude, desc.steepness * desc.amplitude, k, std::cos(angle),
                              std::sin(angle), desc.phase * k_degree - turned});
            highest += desc.amplitude;
            steepest += desc.amplitude * k;
            curvature += desc.amplitude * k * k;
            motion += desc.steepness * desc.amplitude * k;
            motion_curvature += desc.steepness * desc.amplitude * k * k;
        }
        // By the chain rule: water moves by a map whose derivative is at least 1 - motion.
        steepest /= 1 - motion;
        bounds = {-highest, highest, steepest,
                  (curvature + steepest * motion_curvature) / squared(1 - motion)};
        moves_ = motion > 0;
    }

    WavePoint at(double u, double v) const override {
        double a = u, b = v;
        if (moves_) find_calm_place(u, v, a, b);
        WavePoint point;
        Motion motion;
        for (const Wave& wave : waves_) {
            const double angle = wave.angle(a, b);
            const double sine = std::sin(angle), cosine = std::cos(angle);
            point.height += wave.amplitude * cosine;
            point.slope_u -= wave.amplitude * wave.k * wave.cos * sine;
            point.slope_v -= wave.amplitude * wave.k * wave.sin * sine;
            motion.add(wave, sine, cosine);
        }
        // Derivatives by the calm place become those by the place: the inverse of a symmetric
        // matrix.
        const double determinant = motion.uu * motion.vv - motion.uv * motion.uv;
        const double slope_a = point.slope_u, slope_b = point.slope_v;
        point.slope_u = (motion.vv * slope_a - motion.uv * slope_b) / determinant;
        point.slope_v = (motion.uu * slope_b - motion.uv * slope_a) / determinant;
        return point;
    }

    WaveStatistics statistics() const override {
        WaveStatistics sum;
        for (const Wave& wave : waves_) {
            const double variance = 0.5 * squared(wave.amplitude);
            sum.height_variance += variance;
            sum.slopes.along += variance * squared(wave.k * wave.cos);
            sum.slopes.across += variance * squared(wave.k * wave.sin);
            sum.slopes.covariance += variance * squared(wave.k) * wave.cos * wave.sin;
        }
        return sum;
    }

  private:
    struct Wave {
        double amplitude, to_and_fro;  // [m]
        double k, cos, sin;            // wave number [rad/m], and its direction
        double phase;                  // at this moment [rad]

        double angle(double u, double v) const { return k * (cos * u + sin * v) + phase; }
    };
    /// Where water has moved, relative to its calm place, and the derivative of its place by that.
    struct Motion {
        double u = 0, v = 0, uu = 1, uv = 0, vv = 1;

        void add(const Wave& wave, double sine, double cosine) {
            u -= wave.to_and_fro * wave.cos * sine;
            v -= wave.to_and_fro * wave.sin * sine;
            const double compression = wave.to_and_fro * wave.k * cosine;
            uu -= compression * wave.cos * wave.cos;
            uv -= compression * wave.cos * wave.sin;
            vv -= compression * wave.sin * wave.sin;
        }
    };

    Motion motion_at(double a, double b) const {
        Motion motion;
        for (const Wave& wave : waves_) {
            const double angle = wave.angle(a, b);
            motion.add(wave, std::sin(angle), std::cos(angle));
        }
        return motion;
    }
    // Damped Newton's method: steps are halved until they help. The root is that of the gradient of
    // a strictly convex function, as the water does not fold, so that the method always converges.
    void find_calm_place(double u, double v, double& a, double& b) const {
        constexpr int k_max_steps = 100;
        const double accuracy = 1e-14 * (1 + std::abs(u) + std::abs(v));
        Motion motion = motion_at(a, b);
        double off_u = a + motion.u - u, off_v = b + motion.v - v;
        for (int i = 0; i < k_max_steps && std::hypot(off_u, off_v) > accuracy; ++i) {
            const double determinant = motion.uu * motion.vv - motion.uv * motion.uv;
            const double step_a = (motion.vv * off_u - motion.uv * off_v) / determinant;
            const double step_b = (motion.uu * off_v - motion.uv * off_u) / determinant;
            const double before = std::hypot(off_u, off_v);
            double damping = 1;
            for (;;) {
                const double to_a = a - damping * step_a, to_b = b - damping * step_b;
                const Motion there = motion_at(to_a, to_b);
                const double to_u = to_a + there.u - u, to_v = to_b + there.v - v;
                const bool helps = std::hypot(to_u, to_v) < before;
                if (!helps && damping > 1e-6) {
                    damping *= 0.5;
                    continue;
                }
                if (!helps) return;  // it is as near as rounding permits
                a = to_a;
                b = to_b;
                motion = there;
                off_u = to_u;
                off_v = to_v;
                break;
            }
        }
    }

    std::vector<Wave> waves_;
    bool moves_ = false;
};

/// Heights and their derivatives on a lattice that repeats, bicubic in between.
struct HeightLattice {
    struct Node {
        double h = 0, hu = 0, hv = 0, huv = 0;
    };
    double step = 0;     // [m]
    Grid2D<Node> nodes;  // x along u, y along v
    using Bounds = WaterWaves::Shape::Bounds;
    int block = 1;  // cells along the edge of a square whose bounds are known
    Grid2D<Bounds> blocks;

    WavePoint at(double u, double v) const {
        const double per_step = 1 / step;
        const Cell cell(nodes.width(), nodes.height(), u * per_step, v * per_step);
        const Hermite across(cell.x), along(cell.y);
        WavePoint point;
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 2; ++i) {
                const Node& node = nodes(cell.columns[i], cell.rows[j]);
                const double value = across.value[i] * node.h + across.slope[i] * step * node.hu;
                const double value_v =
                    step * (across.value[i] * node.hv + across.slope[i] * step * node.huv);
                const double by_u =
                    across.value_by[i] * node.h + across.slope_by[i] * step * node.hu;
                const double by_u_v =
                    step * (across.value_by[i] * node.hv + across.slope_by[i] * step * node.huv);
                point.height += along.value[j] * value + along.slope[j] * value_v;
                point.slope_u += along.value[j] * by_u + along.slope[j] * by_u_v;
                point.slope_v += along.value_by[j] * value + along.slope_by[j] * value_v;
            }
        point.slope_u *= per_step;
        point.slope_v *= per_step;
        return point;
    }

    /// As Shape::look_ahead: block by block, as long as the ray stays below all of each.
    WaterWaves::Shape::Lookahead look_ahead(double u, double v, double z, const Vector3& direction,
                                            bool is_below) const {
        constexpr int k_max_blocks = 256;
        constexpr double k_never = std::numeric_limits<double>::infinity();
        const double blocks_per_metre = 1 / (block * step);
        // Along one axis: the block, and where the ray leaves it.
        struct Axis {
            double index, to_next, per_block, sign;
            int count;

            Axis(double at, double rate, int blocks)
                : index(std::floor(at)),
                  to_next(rate > 0   ? (index + 1 - at) / rate
                          : rate < 0 ? (index - at) / rate
                                     : k_never),
                  per_block(rate != 0 ? 1 / std::abs(rate) : k_never),
                  sign(rate > 0 ? 1 : -1),
                  count(blocks) {}
            void advance() {
                index += sign;
                to_next += per_block;
            }
            int wrapped() const {
                const double turns = std::floor(index / count);
                return std::clamp(static_cast<int>(index - turns * count), 0, count - 1);
            }
        };
        Axis across(u * blocks_per_metre, direction.x * blocks_per_metre, blocks.width());
        Axis along(v * blocks_per_metre, direction.y * blocks_per_metre, blocks.height());
        double clear = 0;
        for (int i = 0; i < k_max_blocks; ++i) {
            const Bounds& bounds = blocks(across.wrapped(), along.wrapped());
            const double end = std::min(across.to_next, along.to_next);
            const double highest = z + direction.z * (direction.z > 0 ? end : clear);
            if (!is_below || end == k_never || !(highest < bounds.lowest))
                return {clear, end, &bounds};
            clear = end;
            (across.to_next < along.to_next ? across : along).advance();
        }
        return {clear, clear, &blocks(across.wrapped(), along.wrapped())};
    }

    /// Bounds of blocks and of all, by the convex hull of cells' Bezier points.
    Bounds bound() {
        block = 16;
        while (nodes.width() % block != 0 || nodes.height() % block != 0) block /= 2;
        blocks.assign(nodes.width() / block, nodes.height() / block);
        parallel_for(static_cast<std::size_t>(blocks.height()), [&](std::size_t line) {
            const int first_row = static_cast<int>(line) * block;
            for (int row = first_row; row < first_row + block; ++row)
                for (int column = 0; column < nodes.width(); ++column)
                    blocks(column / block, static_cast<int>(line))
                        .include(bounds_of_cell(column, row));
        });
        Bounds all;
        for (const Bounds& bounds : blocks) all.include(bounds);
        return all;
    }

  private:
    Bounds bounds_of_cell(int column, int row) const {
        const Bezier p = bezier(column, row);
        Bounds bounds;
        for (const auto& line : p) {
            bounds.lowest = std::min(bounds.lowest, *std::ranges::min_element(line));
            bounds.highest = std::max(bounds.highest, *std::ranges::max_element(line));
        }
        double u = 0, v = 0, uu = 0, uv = 0, vv = 0;
        for (std::size_t j = 0; j < 4; ++j)
            for (std::size_t i = 0; i < 4; ++i) {
                if (i < 3) u = std::max(u, std::abs(p[j][i + 1] - p[j][i]));
                if (j < 3) v = std::max(v, std::abs(p[j + 1][i] - p[j][i]));
                if (i < 2) uu = std::max(uu, std::abs(p[j][i + 2] - 2 * p[j][i + 1] + p[j][i]));
                if (j < 2) vv = std::max(vv, std::abs(p[j + 2][i] - 2 * p[j + 1][i] + p[j][i]));
                if (i < 3 && j < 3)
                    uv = std::max(uv,
                                  std::abs(p[j + 1][i + 1] - p[j + 1][i] - p[j][i + 1] + p[j][i]));
            }
        bounds.steepest = 3 / step * std::hypot(u, v);
        // The norm of a matrix is at most the root of the sum of its squares.
        bounds.max_curved =
            std::sqrt(squared(6 * uu) + squared(6 * vv) + 2 * squared(9 * uv)) / squared(step);
        return bounds;
    }

    /// The four nodes around a place, given in steps, and where it is between them, 0..1.
    struct Cell {
        std::array<int, 2> columns, rows;
        double x, y;

        Cell(int width, int height, double u, double v)
            : columns(neighbours(width, u, x)), rows(neighbours(height, v, y)) {}

      private:
        static std::array<int, 2> neighbours(int count, double at, double& within) {
            const double floor = std::floor(at);
            within = at - floor;
            int first = 0;
            if (floor >= 0 && floor < count) {  // in the tile itself
                first = static_cast<int>(floor);
            } else {
                const double turns = std::floor(floor / count);
                first = std::clamp(static_cast<int>(floor - turns * count), 0, count - 1);
            }
            return {first, first + 1 == count ? 0 : first + 1};
        }
    };
    /// The cubic functions that belong to the values and slopes at both ends of 0..1, and their
    /// derivatives.
    struct Hermite {
        std::array<double, 2> value, slope, value_by, slope_by;

        explicit Hermite(double x)
            : value{(1 + 2 * x) * (1 - x) * (1 - x), x * x * (3 - 2 * x)},
              slope{x * (1 - x) * (1 - x), x * x * (x - 1)},
              value_by{6 * x * (x - 1), 6 * x * (1 - x)},
              slope_by{(1 - x) * (1 - 3 * x), x * (3 * x - 2)} {}
    };
    using Bezier = std::array<std::array<double, 4>, 4>;

    // The points of a cell: at each corner its value, and a third of its slopes further on.
    Bezier bezier(int column, int row) const {
        Bezier points{};
        const int next_column = column + 1 == nodes.width() ? 0 : column + 1;
        const int next_row = row + 1 == nodes.height() ? 0 : row + 1;
        for (std::size_t j = 0; j < 2; ++j)
            for (std::size_t i = 0; i < 2; ++i) {
                const Node& node = nodes(i == 0 ? column : next_column, j == 0 ? row : next_row);
                const double du = (i == 0 ? 1 : -1) * step / 3, dv = (j == 0 ? 1 : -1) * step / 3;
                const std::size_t x = 3 * i, y = 3 * j, x1 = i == 0 ? 1 : 2, y1 = j == 0 ? 1 : 2;
                points[y][x] = node.h;
                points[y][x1] = node.h + du * node.hu;
                points[y1][x] = node.h + dv * node.hv;
                points[y1][x1] = node.h + du * node.hu + dv * node.hv + du * dv * node.huv;
            }
        return points;
    }
};

/// Waves with the wave vectors of a tile.
class RandomSea : public WaterWaves::Shape {
  public:
    RandomSea(const WaveSpectrumDesc& desc, const std::optional<double>& depth, double time)
        : count_(desc.resolution), step_k_(k_full_turn / desc.tile) {
        set_amplitudes(desc, depth);
        lattice_.step = desc.tile / count_;
        lattice_.nodes.assign(count_, count_);
        set_heights(desc.seed, depth, time);
        bounds = lattice_.bound();
    }

    WavePoint at(double u, double v) const override { return lattice_.at(u, v); }
    Lookahead look_ahead(const Point3& from, const Vector3& direction,
                         bool is_below) const override {
        return lattice_.look_ahead(from.x, from.y, from.z, direction, is_below);
    }

    WaveStatistics statistics() const override {
        WaveStatistics sum;
        for (int j = -last(); j <= last(); ++j)
            for (int i = -last(); i <= last(); ++i) {
                const double variance = 0.5 * squared(amplitude(i, j));
                sum.height_variance += variance;
                sum.slopes.along += variance * squared(i * step_k_);
                sum.slopes.across += variance * squared(j * step_k_);
                sum.slopes.covariance += variance * squared(step_k_) * i * j;
            }
        return sum;
    }

  private:
    // Waves at the Nyquist frequency would have no slopes, and are left out.
    int last() const { return count_ / 2 - 1; }
    double amplitude(int i, int j) const { return amplitudes_(i + last(), j + last()); }

    // A wave's energy is that of the wave vectors around it, by Gauss's rule: S dk_u dk_v =
    // S(omega) D(angle) / k (d omega / dk) dk_u dk_v.
    void set_amplitudes(const WaveSpectrumDesc& desc, const std::optional<double>& depth) {
        amplitudes_.assign(2 * last() + 1, 2 * last() + 1);
        const double wind = desc.direction * k_degree;
        const double max_spreading = wave_spreading(0, desc.spreading);
        const auto density = [&](double k_u, double k_v) {
            const double k = std::hypot(k_u, k_v);
            const double shoaling = depth ? shoaling_factor(k, *depth) : 1;
            const double cosine = std::abs(std::cos(0.5 * (std::atan2(k_v, k_u) - wind)));
            return wave_spectrum(desc, wave_frequency(k, depth)) * shoaling * max_spreading *
                   std::pow(cosine, 2 * desc.spreading) * wave_group_velocity(k, depth) / k;
        };
        parallel_for(static_cast<std::size_t>(amplitudes_.height()), [&](std::size_t row) {
            const int j = static_cast<int>(row) - last();
            for (int i = -last(); i <= last(); ++i) {
                if (i == 0 && j == 0) continue;  // the mean height is 0
                double variance = 0;
                for (const QuadratureNode& y : gauss_legendre(2))
                    for (const QuadratureNode& x : gauss_legendre(2))
                        variance += x.weight * y.weight *
                                    density((i + x.position - 0.5) * step_k_,
                                            (j + y.position - 0.5) * step_k_);
                amplitudes_(i + last(), static_cast<int>(row)) = std::sqrt(2 * variance) * step_k_;
            }
        });
    }

    // The complex amplitude of the wave i, j at this moment: A e^{i (phase - omega t)}.
    std::complex<double> wave(int i, int j, std::uint64_t seed, const std::optional<double>& depth,
                              double time) const {
        const auto bits = [](int n) {
            return static_cast<std::uint64_t>(static_cast<std::int64_t>(n));
        };
        const double phase =
            k_full_turn * PathRandom(PathRandom::seed_of(seed, bits(i), bits(j)), 0).next();
        const double omega = wave_frequency(step_k_ * std::hypot(i, j), depth);
        return std::polar(amplitude(i, j), phase - std::fmod(omega * time, k_full_turn));
    }

    // h = Re sum A e^{i (k.x + ...)} as the transform of a spectrum whose other half is conjugate.
    void set_heights(std::uint64_t seed, const std::optional<double>& depth, double time) {
        const int columns = count_ / 2 + 1;
        Grid2D<std::complex<double>> half(columns, count_);
        parallel_for(static_cast<std::size_t>(count_), [&](std::size_t row) {
            const int j = signed_index(static_cast<int>(row));
            if (std::abs(j) > last()) return;
            for (int i = 0; i <= last(); ++i)
                if (i != 0 || j != 0)
                    half(i, static_cast<int>(row)) =
                        0.5 * (wave(i, j, seed, depth, time) +
                               std::conj(wave(-i, -j, seed, depth, time)));
        });
        using Factor = std::complex<double> (*)(double k_u, double k_v);
        using Node = HeightLattice::Node;
        const std::array<std::pair<Factor, double Node::*>, 4> fields{{
            {[](double, double) { return std::complex<double>(1, 0); }, &Node::h},
            {[](double k_u, double) { return std::complex<double>(0, k_u); }, &Node::hu},
            {[](double, double k_v) { return std::complex<double>(0, k_v); }, &Node::hv},
            {[](double k_u, double k_v) { return std::complex<double>(-k_u * k_v, 0); },
             &Node::huv},
        }};
        const Transform transform(count_);
        for (const std::pair<Factor, double Node::*>& field : fields) {
            throw_if_stopped();
            const std::span<const double> values = transform([&](int i, int row) {
                return half(i, row) * field.first(i * step_k_, signed_index(row) * step_k_);
            });
            for (std::size_t n = 0; n < values.size(); ++n)
                lattice_.nodes[n].*field.second = values[n];
        }
    }
    int signed_index(int row) const { return row <= count_ / 2 ? row : row - count_; }

    /// The in-place transform from half of a square spectrum to real values.
    class Transform {
      public:
        explicit Transform(int count)
            : columns_(count / 2 + 1),
              spectrum_(columns_, count),
              values_(static_cast<std::size_t>(count) * static_cast<std::size_t>(count)) {
            const std::lock_guard lock(fourier_planner());
            // Estimated, not measured, so that the plan, and thus the rounding, is the same in
            // every run.
            plan_ = fftw_plan_dft_c2r_2d(count, count,
                                         reinterpret_cast<fftw_complex*>(spectrum_.values().data()),
                                         values_.data(), FFTW_ESTIMATE);
            if (plan_ == nullptr) throw std::bad_alloc();
        }
        ~Transform() {
            const std::lock_guard lock(fourier_planner());
            fftw_destroy_plan(plan_);
        }
        Transform(const Transform&) = delete;
        Transform& operator=(const Transform&) = delete;
        Transform(Transform&&) = delete;
        Transform& operator=(Transform&&) = delete;

        template <class Value>
        std::span<const double> operator()(const Value& value) const {
            for (int row = 0; row < spectrum_.height(); ++row)
                for (int i = 0; i < columns_; ++i) spectrum_(i, row) = value(i, row);
            fftw_execute(plan_);
            return values_;
        }

      private:
        int columns_;
        mutable Grid2D<std::complex<double>> spectrum_;
        mutable std::vector<double> values_;
        fftw_plan_s* plan_ = nullptr;
    };

    int count_;
    double step_k_;  // of wave vectors [rad/m]
    Grid2D<double> amplitudes_;
    HeightLattice lattice_;
};

/// Heights of an image.
class ImageHeights : public WaterWaves::Shape {
  public:
    ImageHeights(const HeightImageDesc& desc, const SourceLocation& where) {
        const PixelImage image = read_linear_image(desc.file);
        const int width = image.width, height = image.height;
        if (width < 2 || height < 2 || std::int64_t{width} * height > k_max_heights)
            throw InputError(fmt::format("{}: {}: {} times {} heights; give 2 times 2 to {} in all",
                                         where, desc.file.string(), width, height, k_max_heights));
        step_ = desc.width / width;
        lattice_.step = step_;
        lattice_.nodes.assign(width, height);
        const auto channels = static_cast<std::size_t>(image.channels);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                lattice_.nodes(x, height - 1 - y).h = static_cast<double>(
                    image.pixels[channels *
                                 (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                  static_cast<std::size_t>(x))]);
        for (const HeightLattice::Node& node : lattice_.nodes)
            if (!std::isfinite(node.h))
                throw InputError(fmt::format("{}: {}: has a height that is not a finite number",
                                             where, desc.file.string()));
        difference();
        bounds = lattice_.bound();
    }

    // Heights are those at the centres of pixels.
    WavePoint at(double u, double v) const override {
        return lattice_.at(u - 0.5 * step_, v - 0.5 * step_);
    }
    Lookahead look_ahead(const Point3& from, const Vector3& direction,
                         bool is_below) const override {
        return lattice_.look_ahead(from.x - 0.5 * step_, from.y - 0.5 * step_, from.z, direction,
                                   is_below);
    }

    WaveStatistics statistics() const override {
        double mean = 0;
        const auto count = static_cast<double>(lattice_.nodes.size());
        for (const HeightLattice::Node& node : lattice_.nodes) mean += node.h / count;
        WaveStatistics sum;
        for (const HeightLattice::Node& node : lattice_.nodes) {
            sum.height_variance += squared(node.h - mean) / count;
            sum.slopes.along += squared(node.hu) / count;
            sum.slopes.across += squared(node.hv) / count;
            sum.slopes.covariance += node.hu * node.hv / count;
        }
        return sum;
    }

  private:
    static constexpr std::int64_t k_max_heights = std::int64_t{1} << 24;

    void difference() {
        Grid2D<HeightLattice::Node>& nodes = lattice_.nodes;
        const int width = nodes.width(), height = nodes.height();
        const auto wrapped = [](int i, int count) { return (i + count) % count; };
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const int left = wrapped(x - 1, width), right = wrapped(x + 1, width);
                const int below = wrapped(y - 1, height), above = wrapped(y + 1, height);
                HeightLattice::Node& node = nodes(x, y);
                node.hu = (nodes(right, y).h - nodes(left, y).h) / (2 * step_);
                node.hv = (nodes(x, above).h - nodes(x, below).h) / (2 * step_);
                node.huv = (nodes(right, above).h - nodes(left, above).h - nodes(right, below).h +
                            nodes(left, below).h) /
                           squared(2 * step_);
            }
    }

    double step_ = 0;
    HeightLattice lattice_;
};

}  // namespace

namespace {

// A ray approaches a surface in steps that get shorter with its greatest slope: at most some twenty
// times this number of steps. Water breaks at a slope of 0.6.
constexpr double k_steepest = 30;

const char* hint_for_slopes(const WavesDesc& desc) {
    if (std::holds_alternative<HeightImageDesc>(desc.shape))
        return "give the image a greater width, or lower heights in metres";
    if (std::holds_alternative<WaveSpectrumDesc>(desc.shape))
        return "give a longer fetch, less wind or a lower resolution";
    return "lower the amplitudes, or give longer waves";
}

}  // namespace

WaterWaves::WaterWaves(const WavesDesc& desc, double time) {
    shape_ = std::visit(
        [&](const auto& shape) -> std::shared_ptr<const Shape> {
            using Desc = std::decay_t<decltype(shape)>;
            if constexpr (std::is_same_v<Desc, WaveSpectrumDesc>)
                return std::make_shared<RandomSea>(shape, desc.depth, time);
            else if constexpr (std::is_same_v<Desc, HeightImageDesc>)
                return std::make_shared<ImageHeights>(shape, desc.where);
            else
                return std::make_shared<SineWaves>(shape, desc.depth, time);
        },
        desc.shape);
    if (!(steepest() <= k_steepest))
        throw InputError(
            fmt::format("{}: its slopes are up to {:.3g}, and must not be above {}; {}", desc.where,
                        steepest(), k_steepest, hint_for_slopes(desc)));
}

WavePoint WaterWaves::at(double u, double v) const {
    return shape_->at(u, v);
}

double WaterWaves::lowest() const {
    return shape_->bounds.lowest;
}

double WaterWaves::highest() const {
    return shape_->bounds.highest;
}

double WaterWaves::steepest() const {
    return shape_->bounds.steepest;
}

WaveStatistics WaterWaves::statistics() const {
    return shape_->statistics();
}

std::optional<double> WaterWaves::intersect(const Point3& origin, const Vector3& direction,
                                            double farthest) const {
    const Shape& shape = *shape_;
    // The gap between ray and surface, positive on the side of the origin, and its derivative.
    struct Gap {
        double value, slope;
    };
    double side = 1;
    const auto gap_at = [&](double s) {
        const Point3 p = origin + s * direction;
        const WavePoint point = shape.at(p.x, p.y);
        return Gap{side * (p.z - point.height), side * (direction.z - point.slope_u * direction.x -
                                                        point.slope_v * direction.y)};
    };
    // No crossing is where the ray is below or above all heights.
    const Shape::Bounds& all = shape.bounds;
    double s = 0, end = farthest;
    if (direction.z != 0) {
        const double to_lowest = (all.lowest - origin.z) / direction.z;
        const double to_highest = (all.highest - origin.z) / direction.z;
        s = std::max(0.0, std::min(to_lowest, to_highest));
        end = std::min(end, std::max(to_lowest, to_highest));
    } else if (origin.z < all.lowest || origin.z > all.highest) {
        return std::nullopt;
    }
    // Surfaces that are flat touch their bounds.
    constexpr double k_min_step = 1e-8;
    end += k_min_step;
    if (s > end) return std::nullopt;

    const double level = std::hypot(direction.x, direction.y);
    if (!(std::abs(direction.z) + all.steepest * level > 0))
        return std::nullopt;  // along calm water, in it
    Gap gap = gap_at(s);
    // A ray that begins on the surface counts as being on the side towards which it travels.
    if (gap.value < 0 || (gap.value == 0 && gap.slope < 0)) {
        side = -1;
        gap = {-gap.value, -gap.slope};
    }
    double bounded = s, max_slope = 0, max_curvature = 0;  // up to there, of the gap
    while (s <= end) {
        if (s >= bounded) {
            const Shape::Lookahead ahead =
                shape.look_ahead(origin + s * direction, direction, side < 0);
            bounded = s + ahead.end + k_min_step;
            max_slope = std::abs(direction.z) + ahead.bounds->steepest * level;
            max_curvature = ahead.bounds->max_curved * level * level;
            if (ahead.clear > 0) {
                s += ahead.clear;
                if (s > end) break;
                gap = gap_at(s);
                if (gap.value <= 0) return s;  // by rounding
            }
        }
        // The bounds on slope and curvature both give a distance before which the gap cannot close.
        const double root = std::sqrt(gap.slope * gap.slope + 2 * max_curvature * gap.value);
        const double by_curvature =
            gap.slope < 0 ? 2 * gap.value / (root - gap.slope)
                          : (max_curvature > 0 ? (gap.slope + root) / max_curvature : farthest);
        const double by_slope = max_slope > 0 ? gap.value / max_slope : farthest;
        const double step =
            std::max(k_min_step, std::min(bounded - s, std::max(by_slope, by_curvature)));
        const Gap next = gap_at(s + step);
        if (next.value <= 0) {
            const double crossing = s + step * gap.value / (gap.value - next.value);
            return crossing <= farthest ? std::optional(crossing) : std::nullopt;
        }
        s += step;
        gap = next;
    }
    return std::nullopt;
}

std::string compare_with_cox_munk(const WaveSpectrumDesc& desc, const WaterWaves& waves) {
    const double wind = wind_at(desc, 12.5);
    const double measured = cox_munk_slopes(wind).total();
    const double resolved = waves.statistics().slopes.total();
    const char* const rest = resolved < measured
                                 ? "the slopes of shorter ones are missing"
                                 : "the spectrum's tail has more of short ones than a clean sea: a "
                                   "lower resolution leaves them out";
    return fmt::format(
        "these slopes are {:.0f} % of the {:.3g} of Cox and Munk at this wind ({:.1f} m/s at 12.5 "
        "m); the waves have lengths of {:.3g} to {:.3g} m, and {}",
        100 * resolved / measured, measured, wind, 2 * desc.tile / desc.resolution, desc.tile,
        rest);
}

}  // namespace uw
