#include "media/water/phase_functions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <string_view>
#include <variant>

#include "core/base/csv_table.h"
#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/text.h"

namespace uw {

namespace {

constexpr double k_min_angle = TabulatedPhase::k_min_angle;

/// p = (1 - g^2) / (4 pi (1 + g^2 - 2 g cos psi)^1.5) (Henyey and Greenstein 1941), normalised
/// exactly.
class HenyeyGreenstein final : public PhaseFunction {
  public:
    /// `g`, the mean cosine, in (-1, 1); otherwise InputError.
    explicit HenyeyGreenstein(double g);

    using PhaseFunction::evaluate;
    void evaluate(std::span<const double> psi, std::span<double> p) const override;

    /// p is smooth, but its poles at psi = +-i ln(1/|g|) (from psi = 0, or pi for g < 0) lie so
    /// close to the real axis that one polynomial cannot follow the peak: splits at ratios of 3
    /// away from it, none for |g| < 0.5.
    std::vector<double> breakpoints() const override;

    std::string description() const override;

  private:
    double g_;
};

HenyeyGreenstein::HenyeyGreenstein(double g) : g_(g) {
    if (!(g > -1 && g < 1))
        throw InputError(
            fmt::format("Henyey-Greenstein g = {} is out of range; give -1 < g < 1", g));
}

void HenyeyGreenstein::evaluate(std::span<const double> psi, std::span<double> p) const {
    const double scale = (1 - g_) * (1 + g_) / (4 * std::numbers::pi);
    const double nearest = (1 - g_) * (1 - g_);
    for (std::size_t i = 0; i < psi.size(); ++i) {
        // 1 + g^2 - 2 g cos(psi), without cancellation at small psi
        const double s = std::sin(0.5 * psi[i]);
        const double q = nearest + 4 * g_ * s * s;
        p[i] = scale / (q * std::sqrt(q));
    }
}

std::vector<double> HenyeyGreenstein::breakpoints() const {
    std::vector<double> angles;
    if (std::abs(g_) < 0.5) return angles;
    for (double angle = -std::log(std::abs(g_)); angle < 0.5 * std::numbers::pi; angle *= 3)
        angles.push_back(g_ > 0 ? angle : std::numbers::pi - angle);
    if (g_ < 0) std::reverse(angles.begin(), angles.end());
    return angles;
}

std::string HenyeyGreenstein::description() const {
    return fmt::format("henyey-greenstein g={}", g_);
}

/// (x^q - 1) / (x - 1), q at x = 1, without cancellation.
double power_quotient(double x, double q) {
    const double e = x - 1;
    return e == 0 ? q : std::expm1(q * std::log1p(e)) / e;
}

/// Binomial coefficients C(q, 2), C(q, 3), ... into `c`.
void binomials_from_2(double q, std::span<double> c) {
    double binomial = q;
    for (std::size_t i = 0; i < c.size(); ++i) {
        const auto k = static_cast<double>(i + 2);
        binomial *= (q - k + 1) / k;
        c[i] = binomial;
    }
}

double horner(std::span<const double> c, double x) {
    double sum = 0;
    for (std::size_t i = c.size(); i-- > 0;) sum = sum * x + c[i];
    return sum;
}

/// The Fournier-Forand phase function of particles with index `n` relative to water and a
/// hyperbolic (Junge) size distribution of slope `mu`, in the form of Fournier and Jonasz (1999),
/// Mobley's "Light and Water" web book:
///
///     p = [nu(1-d) - (1-d^nu) + (d(1-d^nu) - nu(1-d)) / sin^2(psi/2)] / (4 pi (1-d)^2 d^nu)
///         + (1-d180^nu) (3 cos^2 psi - 1) / (16 pi (d180-1) d180^nu),
///     nu = (3-mu)/2,  d = 4 sin^2(psi/2) / (3 (n-1)^2),  d180 = d at psi = pi.
///
/// The first term is 0/0 at d = 1; near it the quotients are evaluated by their binomial series. p
/// is unbounded as psi approaches 0. Below `k_min_angle` it is continued linearly in sin^2(psi/2),
/// without a step and with the integral over that cone (known in closed form), so that it is finite
/// everywhere and the whole integral is still 1.
class FournierForand final : public PhaseFunction {
  public:
    /// `n` in (1, 10]; `mu` in (3, 5), where the total scattering of the size distribution is
    /// finite. Otherwise InputError.
    FournierForand(double n, double mu);

    using PhaseFunction::evaluate;
    void evaluate(std::span<const double> psi, std::span<double> p) const override;

    /// The edge of the constant cone, then splits at ratios of 4: p is nearly a power of psi there,
    /// which no polynomial can follow over decades.
    std::vector<double> breakpoints() const override;

    std::string description() const override;

  private:
    static constexpr std::size_t k_series_terms = 12;

    double value(double sin2_half) const;

    double n_, mu_, nu_;
    double delta_180_;
    double back_;  // factor of (3 cos^2 psi - 1)
    // p at sin^2(psi/2) = s2 inside k_min_angle is core_ - core_slope_ s2.
    double core_, core_slope_;
    std::array<double, k_series_terms> series_a_{}, series_b_{};
};

FournierForand::FournierForand(double n, double mu)
    : n_(n), mu_(mu), nu_(0.5 * (3 - mu)), delta_180_(4 / (3 * (n - 1) * (n - 1))) {
    if (!(n > 1 && n <= 10))
        throw InputError(
            fmt::format("Fournier-Forand n = {} is out of range; give the particles' refractive "
                        "index relative to water, 1 < n <= 10 (1.02 to 1.2 in nature)",
                        n));
    if (!(mu > 3 && mu < 5))
        throw InputError(
            fmt::format("Fournier-Forand mu = {} is out of range; give the slope of the size "
                        "distribution, 3 < mu < 5",
                        mu));
    binomials_from_2(nu_, series_a_);
    binomials_from_2(nu_ + 1, series_b_);
    back_ = -power_quotient(delta_180_, nu_) / (16 * std::numbers::pi * std::pow(delta_180_, nu_));

    // Fraction scattered below k_min_angle (Mobley, from Fournier and Jonasz 1999), over the
    // cone's solid angle 4 pi sin^2(psi/2): the mean of p there, halfway between both ends.
    const double s = std::sin(0.5 * k_min_angle);
    const double s2 = s * s;
    const double delta = delta_180_ * s2;
    const double fraction =
        (power_quotient(delta, nu_ + 1) - power_quotient(delta, nu_) * s2) / std::pow(delta, nu_) +
        2 * std::numbers::pi * back_ * (1 - 2 * s2) * 4 * s2 * (1 - s2);
    const double mean = fraction / (4 * std::numbers::pi * s2), edge = value(s2);
    core_ = 2 * mean - edge;
    core_slope_ = (core_ - edge) / s2;
}

double FournierForand::value(double sin2_half) const {
    const double delta = delta_180_ * sin2_half;
    const double e = delta - 1;
    const double power_less_1 = std::expm1(nu_ * std::log(delta));  // accurate for small nu too
    const double power = 1 + power_less_1;
    double a = 0;  // (nu(1-d) - (1-d^nu)) / (1-d)^2
    double b = 0;  // (d(1-d^nu) - nu(1-d)) / (1-d)^2
    if (std::abs(e) < 0.05) {
        a = horner(series_a_, e);
        b = -horner(series_b_, e);
    } else {
        a = (power_less_1 - nu_ * e) / (e * e);
        b = (nu_ * e - delta * power_less_1) / (e * e);
    }
    const double cosine = 1 - 2 * sin2_half;
    return (a + b / sin2_half) / (4 * std::numbers::pi * power) + back_ * (3 * cosine * cosine - 1);
}

void FournierForand::evaluate(std::span<const double> psi, std::span<double> p) const {
    for (std::size_t i = 0; i < psi.size(); ++i) {
        const double s = std::sin(0.5 * psi[i]);
        p[i] = psi[i] < k_min_angle ? core_ - core_slope_ * s * s : value(s * s);
    }
}

std::vector<double> FournierForand::breakpoints() const {
    std::vector<double> angles;
    for (double angle = k_min_angle; angle < 0.5 * std::numbers::pi; angle *= 4)
        angles.push_back(angle);
    return angles;
}

std::string FournierForand::description() const {
    return fmt::format("fournier-forand n={} mu={}", n_, mu_);
}

}  // namespace

void MolecularPhase::evaluate(std::span<const double> psi, std::span<double> p) const {
    constexpr double k_scale = 1 / (4 * std::numbers::pi * (1 + k_anisotropy / 3));
    for (std::size_t i = 0; i < psi.size(); ++i) {
        const double cosine = std::cos(psi[i]);
        p[i] = k_scale * (1 + k_anisotropy * cosine * cosine);
    }
}

std::string MolecularPhase::description() const {
    return "einstein-smoluchowski";
}

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

double PiecewiseFunction::evaluate(const Segment& segment, double psi) {
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

double PiecewiseFunction::evaluate(double psi) const {
    const double inside = std::clamp(psi, 0.0, psi_.back());
    return evaluate(segments_[segment_of(inside)], inside);
}

double PiecewiseFunction::integral(std::size_t first_knot, std::size_t last_knot) const {
    double sum = 0;
    for (std::size_t i = first_knot; i < last_knot; ++i) {
        const Segment& segment = segments_[i];
        const auto weighted = [&](double angle) {
            return evaluate(segment, angle) * std::sin(angle);
        };
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
    const double smallest = k_min_angle;
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

KopelevichSmall::KopelevichSmall()
    : TabulatedPhase(kopelevich_table("beta_s_small", Law::exponential, Law::exponential),
                     "kopelevich small") {}

KopelevichLarge::KopelevichLarge()
    : TabulatedPhase(kopelevich_table("beta_l_large", Law::linear, Law::power),
                     "kopelevich large") {}

namespace {

/// A phase table is a few kilobytes; anything larger is some other file.
constexpr std::size_t k_max_table_file = std::size_t{4} << 20;

std::shared_ptr<const PhaseFunction> table_phase(const TabulatedPhaseDesc& desc,
                                                 const SourceLocation& where,
                                                 std::vector<std::string>& warnings) {
    const std::string name = desc.file.filename().string();
    const std::string text =
        read_text_file(desc.file, fmt::format("{}: {}", where, printable(desc.file.string(), 300)),
                       k_max_table_file, "phase function table (CSV with columns angle_deg,phase)");
    auto phase =
        std::make_shared<TabulatedPhase>(CsvTable(text, name).curve("angle_deg", "phase"), name);
    // Published tables integrate to 1 within a few per cent.
    const double integral = phase->table_integral();
    if (integral < 0.9 || integral > 1.1)
        warnings.push_back(
            fmt::format("{}: {} integrates to {:.4g}, not 1; its shape is used, "
                        "scaled to 1",
                        where, name, integral));
    if (phase->extrapolated_fraction() > 0.1)
        warnings.push_back(
            fmt::format("{}: {:.0f} % of the scattering lies outside the angles of "
                        "{}; add smaller and larger angles",
                        where, 100 * phase->extrapolated_fraction(), name));
    return phase;
}

/// One overload for each alternative of PhaseFunctionDesc.
struct MakePhaseFunction {
    using Made = std::shared_ptr<const PhaseFunction>;
    const SourceLocation& where;
    std::vector<std::string>& warnings;

    Made operator()(const HenyeyGreensteinDesc& desc) const {
        return std::make_shared<HenyeyGreenstein>(desc.g);
    }
    Made operator()(const FournierForandDesc& desc) const {
        return std::make_shared<FournierForand>(desc.n, desc.mu);
    }
    /// Petzold's average particle phase function (Mobley, Gentili and Stavn 1993, table 2),
    /// continued below 0.1 degrees as psi^-1.346. With log-log interpolation its table integrates
    /// to 0.9926; here it is normalised to 1.
    Made operator()(const PetzoldDesc& /*desc*/) const {
        return std::make_shared<TabulatedPhase>(
            read_embedded_table("petzold_average_particle_phase.csv")
                .curve("angle_deg", "phase_per_sr"),
            "petzold average particle", -1.346);
    }
    Made operator()(const TabulatedPhaseDesc& desc) const {
        return table_phase(desc, where, warnings);
    }
    Made operator()(const MolecularPhaseDesc& /*desc*/) const {
        return std::make_shared<MolecularPhase>();
    }
};

}  // namespace

std::shared_ptr<const PhaseFunction> make_phase_function(const PhaseDesc& desc,
                                                         std::vector<std::string>& warnings) {
    try {
        return std::visit(MakePhaseFunction{desc.where, warnings}, desc.function);
    } catch (const InputError& error) {
        const std::string_view message = error.what();
        if (message.starts_with(desc.where)) throw;
        throw InputError(fmt::format("{}: {}", desc.where, message));
    }
}

}  // namespace uw
