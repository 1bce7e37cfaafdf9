#include "media/phase/tabulated_phase.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/tables/csv_table.h"

namespace uw {

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
    const double smallest = TabulatedPhase::k_smallest_angle;
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

void TabulatedPhase::evaluate(std::span<const double> psi, std::span<double> p) const {
    for (std::size_t i = 0; i < psi.size(); ++i) p[i] = f_.evaluate(psi[i]);
}

std::vector<double> TabulatedPhase::breakpoints() const {
    const std::vector<double>& psi = f_.knots();
    return {psi.begin() + 1, psi.end() - 1};
}

TabulatedPhase read_phase_table(std::string_view text, const std::string& name) {
    return {CsvTable(text, name).curve("angle_deg", "phase"), name};
}

PetzoldAverage::PetzoldAverage()
    : TabulatedPhase(read_embedded_table("petzold_average_particle_phase.csv")
                         .curve("angle_deg", "phase_per_sr"),
                     "petzold average particle", -1.346) {}

KopelevichSmall::KopelevichSmall()
    : TabulatedPhase(kopelevich_table("beta_s_small", Law::exponential, Law::exponential),
                     "kopelevich small") {}

KopelevichLarge::KopelevichLarge()
    : TabulatedPhase(kopelevich_table("beta_l_large", Law::linear, Law::power),
                     "kopelevich large") {}

}  // namespace uw
