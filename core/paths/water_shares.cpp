#include "core/paths/water_shares.h"

#include <algorithm>
#include <cmath>

#include "core/integrators/integrator.h"
#include "core/paths/choice.h"

namespace uw {

namespace {

// The share of what a field may scatter, typically, in the choice of a phase function.
constexpr double k_field_share = 0.25;

}  // namespace

void WaterShares::find(const WaterOptics& optics, const ScatteringTables& tables,
                       const WaterSegment& segment, std::span<const double> weights,
                       const PathState& state) {
    const std::vector<Lamp>& lamps = *optics.scene().emitters;
    const std::size_t phases = tables.phase_count();
    // By the scattering of the whole segment: what is chosen need only resemble what it stands for.
    const Medium& medium = *optics.scene().medium;
    phase_weights_.assign(phases, 1.0);
    if (phases > 1) {
        const ConcentrationProfile& profile = segment.profile;
        const std::size_t count = optics.constituents();
        const double c = optics.attenuation().uniform[0];
        const double length = c > 0 ? std::min(segment.length, 1 / c) : segment.length;
        double total = 0;
        for (std::size_t m = 0; m < phases; ++m) {
            double sum = 0;
            for (std::size_t b = 0; b < optics.bands(); ++b) {
                double depth = medium.uniform.scattering[m][b] * length;
                if (!profile.s.empty())
                    for (std::size_t k = 0; k < count; ++k)
                        depth += medium.constituents[k].per_unit.scattering[m][b] *
                                 profile.column[profile.column.size() - count + k];
                sum += depth * state.throughput[b];
            }
            phase_weights_[m] = sum;
            total += sum;
        }
        // A field may scatter where its profile is not known, or where nothing else does.
        if (segment.has_field || !(total > 0))
            for (std::size_t m = 0; m < phases; ++m)
                phase_weights_[m] += tables.shares[m] * (total > 0 ? k_field_share * total : 1);
    }
    shares_.clear();
    cumulative_.clear();
    masses_.clear();
    const auto arriving = [&](std::size_t lamp, double length) {
        return optics.attenuated_sum(state.throughput, lamps[lamp].axis_intensity(), length);
    };
    double total = 0;
    for (std::size_t j = 0; j < lamps.size(); ++j) {
        const double own_weight = weights.empty() ? 1 : weights[j];
        if (!(own_weight > 0)) continue;
        const Interval lit = lamps[j].beam(segment.ray, {0, segment.length});
        if (!(lit.length() > 0)) continue;
        LampPassage passage(segment.ray, lamps[j]);
        if (passage.parallel) {
            Share share = parallel_share(optics, tables, segment, j, passage, lit);
            const double weight = own_weight * share.mass * share.stretch.effective_length() *
                                  arriving(j, lit.begin + passage.radius(lit.begin));
            if (!(weight > 0)) continue;
            total += weight;
            shares_.push_back(share);
            cumulative_.push_back(total);
            continue;
        }
        passage.distance = std::max(passage.distance, 1e-12 * (1 + std::abs(passage.foot)));
        Share share{.lamp = j,
                    .foot = passage.foot,
                    .distance = passage.distance,
                    .parts = {},
                    .first_masses = masses_.size(),
                    .stretch = {},
                    .passage = {}};
        const auto add_part = [&](double begin, double end) {
            if (!(end > begin)) return;
            const Share::HalfTangents part{passage.half_tangent(begin, passage.radius(begin)),
                                           passage.half_tangent(end, passage.radius(end))};
            double mass = 0;
            for (std::size_t m = 0; m < phases; ++m) {
                masses_.push_back(
                    {tables.lines[m].mass_to(part.begin), tables.lines[m].mass_to(part.end)});
                mass += phase_weights_[m] * (masses_.back().to - masses_.back().from);
            }
            if (!(mass > 0)) {
                masses_.resize(masses_.size() - phases);
                return;
            }
            share.parts[share.part_count++] = part;
            share.mass += mass;
        };
        if (passage.distance >= k_lamp_radius) {
            add_part(lit.begin, lit.end);
        } else {
            const double half =
                std::sqrt(k_lamp_radius * k_lamp_radius - passage.distance * passage.distance);
            add_part(lit.begin, std::min(lit.end, passage.foot - half));
            add_part(std::max(lit.begin, passage.foot + half), lit.end);
        }
        if (share.part_count == 0) continue;
        // The light path R + s of a lamp never shortens along the segment.
        const double weight = lamps.size() == 1
                                  ? 1
                                  : own_weight * share.mass / share.distance *
                                        arriving(j, lit.begin + passage.radius(lit.begin));
        if (!(weight > 0)) continue;
        total += weight;
        shares_.push_back(share);
        cumulative_.push_back(total);
    }
}

WaterShares::Share WaterShares::parallel_share(const WaterOptics& optics,
                                               const ScatteringTables& tables,
                                               const WaterSegment& segment, std::size_t lamp,
                                               const LampPassage& passage, const Interval& lit) {
    Share share;
    share.lamp = lamp;
    share.parallel = true;
    share.passage = passage;
    phase_.resize(tables.phase_count());
    tables.phase(passage.tangent, phase_);
    for (std::size_t m = 0; m < phase_.size(); ++m) share.mass += phase_weights_[m] * phase_[m];
    // Of the clearest band that scatters at all; if none does, only the field.
    const AttenuationTable& attenuation = optics.attenuation();
    double least = k_far;
    for (std::size_t b = 0; b < optics.bands(); ++b)
        if (attenuation.uniform[b] > 0) least = std::min(least, attenuation.uniform[b]);
    if (least < k_far) {
        share.stretch = {passage, lit, least};
        return share;
    }
    const Interval field = inside(segment.ray, optics.scene().field->bounds());
    const Interval both{std::max(lit.begin, field.begin), std::min(lit.end, field.end)};
    share.stretch = {passage, both.length() > 0 ? both : Interval{}, 0};
    return share;
}

std::optional<ScatterPlace> WaterShares::choose(const ScatteringTables& tables, double length,
                                                double of_lamp, double of_phase, double of_angle) {
    if (shares_.empty()) return std::nullopt;
    const Choice chosen = uw::choose(cumulative_, of_lamp);
    const Share& share = shares_[chosen.index];
    std::optional<ScatterPlace> place =
        share.parallel ? place_in_parallel(share, of_angle)
                       : place_around(tables, share, length, of_phase, of_angle);
    if (place) place->density *= chosen.probability;
    return place;
}

ScatterPlace WaterShares::place_in_parallel(const Share& share, double u) {
    const double s = share.stretch.draw(u);
    return {share.lamp, s, share.passage.tangent, share.passage.radius(s),
            share.stretch.density(s)};
}

std::optional<ScatterPlace> WaterShares::place_around(const ScatteringTables& tables,
                                                      const Share& share, double length,
                                                      double of_phase, double of_angle) {
    const std::size_t phases = tables.phase_count();
    // A part of the segment and a phase function, then an angle.
    const std::span<const Masses> masses =
        std::span(masses_).subspan(share.first_masses, share.part_count * phases);
    cumulative_.clear();
    double total = 0;
    for (std::size_t i = 0; i < masses.size(); ++i) {
        total += phase_weights_[i % phases] * (masses[i].to - masses[i].from);
        cumulative_.push_back(total);
    }
    const std::size_t pick = uw::choose(cumulative_, of_phase).index;
    const auto [from, to] = masses[pick];
    const Share::HalfTangents& part = share.parts[pick / phases];
    const double h = std::clamp(tables.lines[pick % phases].invert(from + of_angle * (to - from)),
                                part.begin, part.end);
    if (!(h > 0)) return std::nullopt;
    const double s = std::clamp(share.foot - share.distance * (1 - h * h) / (2 * h), 0.0, length);
    double density = 0;  // per unit of h
    for (std::size_t m = 0; m < phases; ++m)
        density += phase_weights_[m] * tables.lines[m].density(h);
    density /= total;
    if (!(density > 0)) return std::nullopt;
    // ds / R^2 = 2 dh / ((1 + h^2) D)
    return ScatterPlace{share.lamp, s, h, share.distance * (1 + h * h) / (2 * h),
                        0.5 * (1 + h * h) * share.distance * density};
}

}  // namespace uw
