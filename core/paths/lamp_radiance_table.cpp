#include "core/paths/lamp_radiance_table.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/base/parallel.h"

namespace uw {

/// Nodes with the same number of equal steps in each octave.
class OctaveNodes {
  public:
    constexpr OctaveNodes(double first, double last, int bits_of_octave)
        : bits_(52 - bits_of_octave),
          first_(cell_of(first)),
          count_(cell_of(last) - first_ + 1),
          per_cell_(1.0 / static_cast<double>(std::uint64_t{1} << bits_)) {}

    constexpr std::size_t count() const { return count_; }
    constexpr double operator[](std::size_t index) const {
        return std::bit_cast<double>((first_ + index) << bits_);
    }
    constexpr double front() const { return (*this)[0]; }
    constexpr double back() const { return (*this)[count_ - 1]; }

    struct At {
        std::size_t index;  // of the node before x; the last is never returned
        double t;           // 0..1 between that node and the next
    };
    At at(double x) const {
        if (!(x > front())) return {0, 0};
        if (!(x < back())) return {count_ - 2, 1};
        const std::uint64_t mask = (std::uint64_t{1} << bits_) - 1;
        return {cell_of(x) - first_,
                static_cast<double>(std::bit_cast<std::uint64_t>(x) & mask) * per_cell_};
    }

  private:
    constexpr std::uint64_t cell_of(double x) const {
        return std::bit_cast<std::uint64_t>(x) >> bits_;
    }

    int bits_;
    std::uint64_t first_, count_;
    double per_cell_;
};

namespace {

constexpr OctaveNodes k_radii(0x1p-8, 48, 3), k_angles(0x1p-10, 0x1p10, 2);
constexpr OctaveNodes k_coarse_radii(0x1p-8, 48, 2), k_coarse_angles(0x1p-10, 0x1p10, 1);
// Sampling densities are stored for one in so many radii.
constexpr std::size_t k_lobe_stride = 2;

constexpr std::size_t k_albedos = 3;
constexpr double k_min_albedo = 0.1, k_max_albedo = 0.99;
constexpr double k_min_value = 1e-30;

double sine_of(double h) {
    return 2 * h / (1 + h * h);
}

// tan(psi / 2) from the two legs of a right triangle with the angle psi and its hypotenuse, without
// cancellation.
double half_tangent_of(double opposite, double adjacent, double hypotenuse) {
    return adjacent > 0 ? opposite / (hypotenuse + adjacent) : (hypotenuse - adjacent) / opposite;
}

}  // namespace

/// Computes the radiance order by order. It is stored times radius and sine, which removes its
/// singularities: [radius * angles + angle].
class LampRadianceTable::Solver {
  public:
    Solver(const HalfTangentDensity& direction, const HalfTangentDensity& line, bool is_coarse);

    const std::vector<double>& order() const { return order_; }
    /// The mean over the phase function of the radiance of the order before.
    const std::vector<double>& source() const { return source_; }
    void find_next_order();

    std::size_t size() const { return order_.size(); }
    double radius_of(std::size_t node) const { return radii_[node / nh_]; }
    /// Interpolates such values at the nodes of the table, k_radii and k_angles.
    std::vector<double> at_nodes_of_field(const std::vector<double>& values) const;

  private:
    /// The contribution of one step along a ray: a constant source between its ends, interpolated
    /// from four nodes.
    struct Step {
        std::size_t node;
        std::array<float, 4> weight;
    };

    void make_matrix(const HalfTangentDensity& direction);
    double first_order(const HalfTangentDensity& line, double radius, double angle) const;
    void march(double radius, double h, std::vector<Step>& steps) const;

    bool is_coarse_;
    OctaveNodes radii_, angles_;
    std::size_t nr_, nh_;                   // numbers of radii and angles
    std::vector<double> growth_of_radius_;  // e^(k_decay r), against the decay of the source
    std::vector<double> matrix_;            // of scattering: [from * angles + to]
    std::vector<std::vector<Step>> steps_;  // from each node
    std::vector<double> order_, source_;
};

namespace {

constexpr double k_decay = 0.15;  // rough decay of the source with the distance from the lamp

}  // namespace

LampRadianceTable::Solver::Solver(const HalfTangentDensity& direction,
                                  const HalfTangentDensity& line, bool is_coarse)
    : is_coarse_(is_coarse),
      radii_(is_coarse ? k_coarse_radii : k_radii),
      angles_(is_coarse ? k_coarse_angles : k_angles),
      nr_(radii_.count()),
      nh_(angles_.count()),
      steps_(nr_ * nh_),
      order_(nr_ * nh_),
      source_(nr_ * nh_) {
    for (std::size_t i = 0; i < nr_; ++i)
        growth_of_radius_.push_back(std::exp(k_decay * radii_[i]));
    make_matrix(direction);
    parallel_for(steps_.size(), [&](std::size_t n) {
        order_[n] = first_order(line, radii_[n / nh_], angles_[n % nh_]);
        march(radii_[n / nh_], angles_[n % nh_], steps_[n]);
    });
}

std::vector<double> LampRadianceTable::Solver::at_nodes_of_field(
    const std::vector<double>& values) const {
    if (!is_coarse_) return values;
    std::vector<double> finer;
    for (std::size_t i = 0; i < k_radii.count(); ++i)
        for (std::size_t j = 0; j < k_angles.count(); ++j) {
            const OctaveNodes::At r = radii_.at(k_radii[i]), a = angles_.at(k_angles[j]);
            const double* near = &values[r.index * nh_ + a.index];
            const double* far = near + nh_;
            finer.push_back((1 - r.t) * ((1 - a.t) * near[0] + a.t * near[1]) +
                            r.t * ((1 - a.t) * far[0] + a.t * far[1]));
        }
    return finer;
}

// Interpolates between angles by a parabola through three nodes: linear interpolation would blur
// the radiance once more.
void LampRadianceTable::Solver::make_matrix(const HalfTangentDensity& direction) {
    // Polar angles are sampled the more densely the less is scattered beyond them: radiance from
    // behind was scattered far from the bright light around the lamp.
    constexpr int k_polar = 96, k_azimuths = 16;
    constexpr double k_min_sine = 0.3 / k_azimuths;  // relative: half an azimuthal step
    matrix_.resize(nh_ * nh_);
    parallel_for(nh_, [&](std::size_t i) {
        std::vector<double> row(nh_, 0.0);
        const double psi = 2 * std::atan(angles_[i]);
        for (int a = 0; a < k_polar; ++a) {
            const double beyond = 1 - (a + 0.5) / k_polar, probability = 2 * beyond / k_polar;
            const double theta = 2 * std::atan(direction.sample(1 - beyond * beyond));
            for (int b = 0; b < k_azimuths; ++b) {
                const double phi = std::numbers::pi * (b + 0.5) / k_azimuths;
                const double along = std::cos(psi) * std::cos(theta) +
                                     std::sin(psi) * std::sin(theta) * std::cos(phi);
                const double across =
                    std::hypot(std::sin(psi) * std::cos(theta) -
                                   std::cos(psi) * std::sin(theta) * std::cos(phi),
                               std::sin(theta) * std::sin(phi));
                const double h = std::clamp(along > -1 ? across / (1 + along) : angles_.back(),
                                            angles_.front(), angles_.back());
                const double sine =
                    std::max({across, k_min_sine * std::sin(theta), sine_of(angles_.front())});
                const OctaveNodes::At at = angles_.at(h);
                const std::size_t m =
                    std::clamp(at.index + (at.t > 0.5 ? 1 : 0), std::size_t{1}, nh_ - 2);
                const double h0 = angles_[m - 1], h1 = angles_[m], h2 = angles_[m + 1];
                const double weight = probability / (sine * k_azimuths);
                row[m - 1] += weight * (h - h1) * (h - h2) / ((h0 - h1) * (h0 - h2));
                row[m] += weight * (h - h0) * (h - h2) / ((h1 - h0) * (h1 - h2));
                row[m + 1] += weight * (h - h0) * (h - h1) / ((h2 - h0) * (h2 - h1));
            }
        }
        for (std::size_t j = 0; j < nh_; ++j) matrix_[j * nh_ + i] = row[j];
    });
}

// Single scattering: (1 / D) int p e^-(s + R) dpsi, with D the lamp's distance from the ray.
double LampRadianceTable::Solver::first_order(const HalfTangentDensity& line, double radius,
                                              double angle) const {
    constexpr int k_points = 32;  // quadrature points of equal mass
    const double distance = radius * sine_of(angle);
    const double foot = radius * std::cos(2 * std::atan(angle));
    const double from = line.mass_to(angle), mass = line.mass() - from;
    double sum = 0;
    for (int k = 0; k < k_points; ++k) {
        const double h = line.invert(from + (k + 0.5) / k_points * mass);
        const double to_lamp = distance / sine_of(std::max(h, 1e-12));
        const double s = std::max(0.0, foot - to_lamp * (1 - h * h) / (1 + h * h));
        sum += std::exp(-(s + to_lamp)) / k_points;
    }
    return mass * sum;
}

// Between radii the source is interpolated linearly after most of its decay is removed.
void LampRadianceTable::Solver::march(double radius, double h, std::vector<Step>& steps) const {
    constexpr double k_march_depth = 20;
    const double min_step = is_coarse_ ? 0.004 : 0.002, max_step = is_coarse_ ? 0.8 : 0.4;
    const double growth = is_coarse_ ? 0.6 : 0.3;
    const auto to_lamp_at = [](double across, double along) {
        return std::sqrt(across * across + along * along);
    };
    const double distance = radius * sine_of(h), foot = radius * std::cos(2 * std::atan(h));
    double s = 0, transmittance = 1;
    while (s < k_march_depth) {
        double step = std::clamp(growth * to_lamp_at(distance, s - foot), min_step, max_step);
        if (s < foot && s + step > foot) step = std::max(foot - s, min_step);
        const double middle = s + 0.5 * step;
        const double to_lamp = to_lamp_at(distance, middle - foot);
        const double lost = -std::expm1(-step);
        if (to_lamp < radii_.back()) {
            const OctaveNodes::At r = radii_.at(to_lamp);
            const OctaveNodes::At a = angles_.at(half_tangent_of(distance, foot - middle, to_lamp));
            const double source = transmittance * std::exp(-k_decay * to_lamp) * lost /
                                  std::max(to_lamp, radii_.front());
            const double near = source * (1 - r.t) * growth_of_radius_[r.index];
            const double far = source * r.t * growth_of_radius_[r.index + 1];
            steps.push_back({r.index * nh_ + a.index,
                             {static_cast<float>(near * (1 - a.t)), static_cast<float>(near * a.t),
                              static_cast<float>(far * (1 - a.t)), static_cast<float>(far * a.t)}});
        }
        transmittance *= 1 - lost;
        s += step;
    }
}

void LampRadianceTable::Solver::find_next_order() {
    parallel_for(nr_, [&](std::size_t i) {
        double* source = &source_[i * nh_];
        std::fill(source, source + nh_, 0.0);
        for (std::size_t k = 0; k < nh_; ++k) {
            const double value = order_[i * nh_ + k];
            const double* column = &matrix_[k * nh_];
            for (std::size_t j = 0; j < nh_; ++j) source[j] += value * column[j];
        }
        for (std::size_t j = 0; j < nh_; ++j) source[j] = std::max(source[j], 0.0);
    });
    parallel_for(order_.size(), [&](std::size_t n) {
        double sum = 0;
        for (const Step& step : steps_[n]) {
            const double* near = &source_[step.node];
            const double* far = near + nh_;
            sum += static_cast<double>(step.weight[0]) * near[0] +
                   static_cast<double>(step.weight[1]) * near[1] +
                   static_cast<double>(step.weight[2]) * far[0] +
                   static_cast<double>(step.weight[3]) * far[1];
        }
        order_[n] = sum * radii_[n / nh_] * sine_of(angles_[n % nh_]);
    });
}

LampRadianceTable::LampRadianceTable(const HalfTangentDensity& direction,
                                     const HalfTangentDensity& line, double min_albedo,
                                     double max_albedo, const Fineness& fineness)
    : phase_(direction), line_(line), line_in_table_(line.mass() - line.mass_to(k_angles.front())) {
    // The series ends at an order that adds less than k_enough everywhere but near the end of the
    // table.
    constexpr double k_enough = 1e-2, k_counting = 0.5;
    const std::size_t nr = k_radii.count(), nh = k_angles.count();
    min_albedo_ = std::clamp(min_albedo, k_min_albedo, k_max_albedo - 1e-3);
    albedo_step_ =
        (std::clamp(max_albedo, min_albedo_ + 1e-3, k_max_albedo) - min_albedo_) / (k_albedos - 1);
    std::array<double, k_albedos> albedo{}, power{};
    for (std::size_t k = 0; k < k_albedos; ++k)
        power[k] = albedo[k] = min_albedo_ + albedo_step_ * static_cast<double>(k);
    Solver solver(direction, line, fineness.is_coarse);
    std::vector<double> once = solver.order();
    std::vector<std::vector<double>> all(k_albedos), sources(k_albedos);
    for (std::size_t k = 0; k < k_albedos; ++k) {
        sources[k].assign(solver.size(), 0.0);
        for (const double value : once) all[k].push_back(albedo[k] * value);
    }
    for (int count = 1; count < fineness.orders; ++count) {
        solver.find_next_order();
        double largest = 0;
        for (std::size_t k = 0; k < k_albedos; ++k) {
            for (std::size_t q = 0; q < solver.size(); ++q)
                sources[k][q] += power[k] * solver.source()[q];
            power[k] *= albedo[k];
            for (std::size_t q = 0; q < solver.size(); ++q) {
                const double value = power[k] * solver.order()[q];
                all[k][q] += value;
                if (solver.radius_of(q) < k_counting * k_radii.back())
                    largest = std::max(largest, value / std::max(all[k][q], k_min_value));
            }
        }
        if (largest < k_enough) break;
    }
    once = solver.at_nodes_of_field(once);
    for (std::vector<std::vector<double>>* const fields : {&all, &sources})
        for (std::vector<double>& values : *fields) values = solver.at_nodes_of_field(values);
    const auto log_of = [](double value) {
        return static_cast<float>(std::log(std::max(value, k_min_value)));
    };
    for (std::size_t k = 0; k < k_albedos; ++k) {
        for (std::size_t q = 0; q < once.size(); ++q) {
            constexpr double k_min_multiple = 1e-3;  // fraction of all orders
            const double value = all[k][q];
            all_.push_back(log_of(value));
            multiple_.push_back(
                log_of(std::max(value - albedo[k] * once[q], k_min_multiple * value)));
            source_.push_back(log_of(sources[k][q]));
        }
        for (std::size_t i = 0; i < nr; ++i) {
            double scattered = 0;
            const auto along = [&](std::size_t j) {
                const double square = k_angles[j] * k_angles[j], norm = 1 / (1 + square);
                return all[k][i * nh + j] * (1 - square) * norm * 2 * norm;
            };
            for (std::size_t j = 0; j + 1 < nh; ++j)
                scattered += 0.5 * (along(j) + along(j + 1)) * (k_angles[j + 1] - k_angles[j]);
            const double flux = std::exp(-k_radii[i]) +
                                std::max(0.0, 2 * std::numbers::pi * k_radii[i] * scattered);
            // The flux must not increase with the radius, whatever the errors of the tables.
            const float before = i == 0 ? 0.0F : flux_.back();
            flux_.push_back(std::min(before, log_of(flux)));
        }
        const auto at = [&](std::size_t from_end) { return flux_[(k + 1) * nr - from_end]; };
        decay_.push_back((at(6) - at(3)) / static_cast<float>(k_radii[nr - 3] - k_radii[nr - 6]));
    }
    for (std::size_t i = 0; i < nr; i += k_lobe_stride) {
        std::vector<double> values;
        for (const double h : HalfTangentDensity::nodes()) {
            const OctaveNodes::At a = k_angles.at(h);
            const float* of_angle = &all_[(k_albedos / 2 * nr + i) * nh + a.index];
            values.push_back(std::exp((1 - a.t) * static_cast<double>(of_angle[0]) +
                                      a.t * static_cast<double>(of_angle[1])) *
                             below_table(h) * 2 / (1 + h * h));
        }
        lobes_.emplace_back(values);
    }
}

LampRadianceTable::Place LampRadianceTable::at(double radius, double albedo) const {
    const std::size_t nr = k_radii.count(), nh = k_angles.count();
    const OctaveNodes::At r = k_radii.at(radius);
    const double x = std::clamp((albedo - min_albedo_) / albedo_step_, 0.0, k_albedos - 1.0);
    const std::size_t k = std::min(static_cast<std::size_t>(x), k_albedos - 2);
    const double u = x - static_cast<double>(k);
    Place place;
    place.radius = std::max(radius, k_radii.front());
    place.row = {(k * nr + r.index) * nh, (k * nr + r.index + 1) * nh,
                 ((k + 1) * nr + r.index) * nh, ((k + 1) * nr + r.index + 1) * nh};
    place.weight = {static_cast<float>((1 - u) * (1 - r.t)), static_cast<float>((1 - u) * r.t),
                    static_cast<float>(u * (1 - r.t)), static_cast<float>(u * r.t)};
    place.lobe = (r.index + (r.t > 0.5 ? 1 : 0)) / k_lobe_stride;
    if (radius > k_radii.back())
        place.beyond =
            static_cast<float>(radius - k_radii.back()) *
            (static_cast<float>(1 - u) * decay_[k] + static_cast<float>(u) * decay_[k + 1]);
    return place;
}

double LampRadianceTable::look_up(const std::vector<float>& table, const Place& place,
                                  double h) const {
    const OctaveNodes::At a = k_angles.at(h);
    const auto t = static_cast<float>(a.t);
    float sum = -place.beyond;
    for (std::size_t i = 0; i < 4; ++i) {
        const float* of_angle = &table[place.row[i] + a.index];
        sum += place.weight[i] * (of_angle[0] + t * (of_angle[1] - of_angle[0]));
    }
    return static_cast<double>(std::exp(sum));
}

double LampRadianceTable::below_table(double h) const {
    if (!(h < k_angles.front()) || !(line_in_table_ > 0)) return 1;
    return (line_.mass() - line_.mass_to(h)) / line_in_table_;
}

double LampRadianceTable::flux(const Place& place) const {
    float sum = -place.beyond;
    for (std::size_t i = 0; i < 4; ++i)
        sum += place.weight[i] * flux_[place.row[i] / k_angles.count()];
    return static_cast<double>(std::exp(sum));
}

}  // namespace uw
