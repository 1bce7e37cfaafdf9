#include "media/water/tabulated_phase.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <string_view>

#include "core/base/error.h"

namespace uw {

namespace {

/// Gauss-Legendre rule of 8 nodes on [-1, 1], the positive half (Abramowitz and Stegun 25.4.30).
constexpr std::array<double, 4> k_gauss_node{0.1834346424956498, 0.5255324099163290,
                                             0.7966664774136267, 0.9602898564975363};
constexpr std::array<double, 4> k_gauss_weight{0.3626837833783620, 0.3137066458778873,
                                               0.2223810344533745, 0.1012285362903763};

/// int_a^b f(x) dx over panels narrow enough for the rule to be exact to rounding for e^(rate x).
template <class F>
double integrate(const F& f, double a, double b, double rate) {
    const double span = b - a;
    const auto panels = static_cast<int>(std::ceil(2 * span * std::max(1.0, std::abs(rate))));
    const double half = 0.5 * span / panels;
    double sum = 0;
    for (int i = 0; i < panels; ++i) {
        const double middle = a + (2 * i + 1) * half;
        for (std::size_t k = 0; k < k_gauss_node.size(); ++k) {
            const double offset = k_gauss_node[k] * half;
            sum += k_gauss_weight[k] * (f(middle - offset) + f(middle + offset));
        }
    }
    return sum * half;
}

/// Bucket of a positive angle: its exponent and the first five bits of its mantissa.
std::uint64_t key_of(double psi) {
    return std::bit_cast<std::uint64_t>(psi) >> 47;
}

}  // namespace

PiecewiseFunction::PiecewiseFunction(std::vector<double> psi, const std::vector<double>& value,
                                     const std::vector<Law>& laws)
    : psi_(std::move(psi)) {
    for (std::size_t i = 0; i < laws.size(); ++i) {
        const bool log_value = laws[i] != Law::linear;
        const bool log_angle = laws[i] == Law::power;
        const double x0 = log_angle ? std::log(psi_[i]) : psi_[i];
        const double x1 = log_angle ? std::log(psi_[i + 1]) : psi_[i + 1];
        const double y0 = log_value ? std::log(value[i]) : value[i];
        const double y1 = log_value ? std::log(value[i + 1]) : value[i + 1];
        const double m = (y1 - y0) / (x1 - x0);
        segments_.push_back({laws[i], x0, y0, m});
    }
    first_key_ = key_of(psi_[1]);
    const std::uint64_t last_key = key_of(psi_.back());
    std::uint32_t segment = 0;
    for (std::uint64_t key = first_key_; key <= last_key; ++key) {
        const auto lower_edge = std::bit_cast<double>(key << 47);
        while (segment + 1 < segments_.size() && psi_[segment + 1] <= lower_edge) ++segment;
        bucket_.push_back(segment);
    }
}

std::size_t PiecewiseFunction::segment_of(double psi) const {
    if (psi < psi_[1]) return 0;
    const std::size_t bucket = key_of(psi) - first_key_;
    const std::size_t lowest = bucket_[bucket];
    const std::size_t highest =
        bucket + 1 < bucket_.size() ? bucket_[bucket + 1] : segments_.size() - 1;
    // Knots inside the bucket: at most one, except in very dense tables.
    const auto begin = psi_.begin() + static_cast<std::ptrdiff_t>(lowest) + 1;
    const auto end = psi_.begin() + static_cast<std::ptrdiff_t>(highest) + 1;
    return lowest + static_cast<std::size_t>(std::upper_bound(begin, end, psi) - begin);
}

double PiecewiseFunction::eval(const Segment& segment, double psi) {
    switch (segment.law) {
        case Law::exponential:
            return std::exp(segment.y + segment.m * (psi - segment.x));
        case Law::power:
            return std::exp(segment.y + segment.m * (std::log(psi) - segment.x));
        case Law::linear:
            break;
    }
    return std::max(
        0.0,
        segment.y + segment.m * (psi - segment.x));  // rounding may fall below an end of 0
}

double PiecewiseFunction::eval(double psi) const {
    const double inside = std::clamp(psi, 0.0, psi_.back());
    return eval(segments_[segment_of(inside)], inside);
}

double PiecewiseFunction::integral(std::size_t first_knot, std::size_t last_knot) const {
    double sum = 0;
    for (std::size_t i = first_knot; i < last_knot; ++i) {
        const Segment& segment = segments_[i];
        const auto weighted = [&](double angle) { return eval(segment, angle) * std::sin(angle); };
        if (segment.law == Law::power)  // smooth in u = ln psi, where it is e^((m + 2) u)
            sum += integrate([&](double u) { return weighted(std::exp(u)) * std::exp(u); },
                             std::log(psi_[i]), std::log(psi_[i + 1]), segment.m + 2);
        else
            sum += integrate(weighted, psi_[i], psi_[i + 1],
                             segment.law == Law::exponential ? segment.m : 1.0);
    }
    return 2 * std::numbers::pi * sum;
}

void PiecewiseFunction::scale(double factor) {
    for (Segment& segment : segments_) {
        if (segment.law == Law::linear) {
            segment.y *= factor;
            segment.m *= factor;
        } else {
            segment.y += std::log(factor);
        }
    }
}

namespace {

using Law = PiecewiseFunction::Law;

double radians(double degrees) {
    return degrees == 180 ? std::numbers::pi : degrees * (std::numbers::pi / 180);
}

void check_phase_table(const SampledCurve& table, const std::string& name) {
    if (table.x.size() < 2)
        throw InputError(fmt::format("{}: a phase function needs two angles or more", name));
    for (std::size_t i = 0; i < table.x.size(); ++i) {
        if (!(table.x[i] >= 0 && table.x[i] <= 180))
            throw InputError(
                fmt::format("{}: scattering angle {} is out of range; angles are in degrees, 0 "
                            "(straight on) to 180",
                            name, table.x[i]));
        if (!(table.y[i] >= 0 && table.y[i] <= 1e100))
            throw InputError(
                fmt::format("{}: phase function {} at {} degrees is out of range; give values of 0 "
                            "or more, in 1/sr",
                            name, table.y[i], table.x[i]));
        // For closer angles the slope between them would be rounding noise.
        if (i > 0 && !(table.x[i] > table.x[i - 1] * (1 + 1e-9) && table.x[i] > 1e-7))
            throw InputError(
                fmt::format("{}: angles {} and {} degrees are too close to distinguish; "
                            "remove one",
                            name, table.x[i - 1], table.x[i]));
    }
}

Law law_between(double psi_0, double p_0, double p_1) {
    return psi_0 > 0 && p_0 > 0 && p_1 > 0 ? Law::power : Law::linear;
}

/// Knots of a table, extrapolated at both ends.
struct Knots {
    std::vector<double> psi, p;
    std::vector<Law> laws;

    void add(double angle, double value, Law law_before) {
        psi.push_back(angle);
        p.push_back(value);
        if (psi.size() > 1) laws.push_back(law_before);
    }
};

/// Adds knots from 0 up to, but excluding, the first angle of the table.
void add_low_end(Knots& knots, double psi, double p, double exponent) {
    const double smallest = TabulatedPhase::k_min_angle;
    const auto continued = [&](double angle) { return p * std::pow(angle / psi, exponent); };
    if (psi <= smallest || p == 0) {
        knots.add(0, p, Law::linear);
        return;
    }
    knots.add(0, continued(smallest), Law::linear);
    Law law = Law::linear;
    for (double angle = smallest; angle < 0.999 * psi; angle *= 4) {
        knots.add(angle, continued(angle), law);
        law = Law::power;
    }
}

double first_exponent(const SampledCurve& table) {
    if (table.y[0] <= 0 || table.y[1] <= 0 || table.x[0] <= 0) return 0;
    const double slope = std::log(table.y[1] / table.y[0]) / std::log(table.x[1] / table.x[0]);
    return std::clamp(slope, -1.9, 0.0);
}

PiecewiseFunction continued_table(const SampledCurve& table, const std::string& name,
                                  std::optional<double> low_exponent) {
    check_phase_table(table, name);
    Knots knots;
    const bool from_zero = table.x.front() == 0;
    if (!from_zero)
        add_low_end(knots, radians(table.x.front()), table.y.front(),
                    low_exponent.value_or(first_exponent(table)));
    for (std::size_t i = 0; i < table.x.size(); ++i) {
        const double before = knots.psi.empty() ? 0 : knots.psi.back();
        const double p_before = knots.p.empty() ? 0 : knots.p.back();
        knots.add(radians(table.x[i]), table.y[i], law_between(before, p_before, table.y[i]));
    }
    if (table.x.back() < 180) knots.add(std::numbers::pi, table.y.back(), Law::linear);
    return {std::move(knots.psi), knots.p, knots.laws};
}

/// Kopelevich's table: `law` between angles, p linear in psi in the first segment.
PiecewiseFunction kopelevich_table(std::string_view column, Law first, Law law) {
    const SampledCurve table = read_embedded_table("kopelevich_vsf.csv").curve("angle_deg", column);
    Knots knots;
    for (std::size_t i = 0; i < table.x.size(); ++i)
        knots.add(radians(table.x[i]), table.y[i], i == 1 ? first : law);
    return {std::move(knots.psi), knots.p, knots.laws};
}

}  // namespace

TabulatedPhase::TabulatedPhase(const SampledCurve& table, const std::string& name,
                               std::optional<double> low_exponent)
    : name_(name), f_(continued_table(table, name, low_exponent)) {
    normalise();
    const std::vector<double>& psi = f_.knots();
    const auto knot = [&](double degrees) {
        return static_cast<std::size_t>(std::lower_bound(psi.begin(), psi.end(), radians(degrees)) -
                                        psi.begin());
    };
    extrapolated_fraction_ =
        f_.integral(0, knot(table.x.front())) + f_.integral(knot(table.x.back()), psi.size() - 1);
}

TabulatedPhase::TabulatedPhase(PiecewiseFunction f, std::string name)
    : name_(std::move(name)), f_(std::move(f)) {
    normalise();
}

void TabulatedPhase::normalise() {
    table_integral_ = f_.integral(0, f_.knots().size() - 1);
    if (!(table_integral_ > 1e-200 && std::isfinite(table_integral_)))
        throw InputError(
            fmt::format("{}: the phase function is 0 everywhere; give its values in "
                        "1/sr",
                        name_));
    f_.scale(1 / table_integral_);
}

void TabulatedPhase::eval(std::span<const double> psi, std::span<double> p) const {
    for (std::size_t i = 0; i < psi.size(); ++i) p[i] = f_.eval(psi[i]);
}

std::vector<double> TabulatedPhase::breakpoints() const {
    const std::vector<double>& psi = f_.knots();
    return {psi.begin() + 1, psi.end() - 1};
}

KopelevichSmall::KopelevichSmall()
    : TabulatedPhase(kopelevich_table("beta_s_small", Law::exponential, Law::exponential),
                     "kopelevich small") {}

KopelevichLarge::KopelevichLarge()
    : TabulatedPhase(kopelevich_table("beta_l_large", Law::linear, Law::power),
                     "kopelevich large") {}

}  // namespace uw
