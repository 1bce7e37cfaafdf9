#include "core/paths/lamp_gathering.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/integrators/ray_panels.h"
#include "core/paths/choice.h"
#include "core/surfaces/surface_reflection.h"

namespace uw {

namespace {

// The share of what a field may scatter, typically, in the choice of a phase function.
constexpr double k_field_share = 0.25;

}  // namespace

/// One lamp's part in the light along a segment.
struct LampGathering::Share {
    // An interval of h = tan(psi / 2).
    struct HalfTangents {
        double begin = 0, end = 0;
    };

    std::size_t lamp = 0;
    double foot = 0, distance = 0;      // LampPassage
    std::array<HalfTangents, 2> parts;  // outside the lamp's sphere and within its beam
    std::size_t part_count = 0;
    double mass = 0;               // of the weighted phase functions on them
    std::size_t first_masses = 0;  // of Workspace::masses
};

struct LampGathering::Workspace {
    // HalfTangentDensity::mass_to at both ends of a part.
    struct Masses {
        double from = 0, to = 0;
    };

    std::vector<double> phase_weights;  // of the phase functions on this segment
    std::vector<Share> shares;
    std::vector<Masses> masses;  // by share, part and phase function
    std::vector<double> cumulative;
    std::vector<double> column, p;
    WaterPoint point;
    Spectrum radiance, brdf;
};

LampGathering::LampGathering(const WaterOptics& optics, const ScatteringTables& tables,
                             std::vector<std::shared_ptr<const DeepShadow>> deep_shadows)
    : optics_(optics), tables_(tables), deep_shadows_(std::move(deep_shadows)) {}

void LampGathering::column_to_lamp(std::size_t lamp, const Point3& x,
                                   std::span<double> column) const {
    if (column.empty()) return;
    if (deep_shadows_.empty())
        optics_.scene().field->column((*optics_.scene().emitters)[lamp].position(), x, column);
    else
        deep_shadows_[lamp]->columns(std::span(&x, 1), column);
}

void LampGathering::find_water_shares(const WaterSegment& segment, std::span<const double> weights,
                                      const PathState& state, Workspace& w) const {
    const std::vector<Lamp>& lamps = *optics_.scene().emitters;
    const std::size_t phases = tables_.phase_count();
    // By the scattering of the whole segment: what is chosen need only resemble what it stands for.
    const Medium& medium = *optics_.scene().medium;
    w.phase_weights.assign(phases, 1.0);
    if (phases > 1) {
        const ConcentrationProfile& profile = segment.profile;
        const std::size_t count = optics_.constituents();
        const double c = optics_.attenuation().uniform[0];
        const double length = c > 0 ? std::min(segment.length, 1 / c) : segment.length;
        double total = 0;
        for (std::size_t m = 0; m < phases; ++m) {
            double sum = 0;
            for (std::size_t b = 0; b < optics_.bands(); ++b) {
                double depth = medium.uniform.scattering[m][b] * length;
                if (!profile.s.empty())
                    for (std::size_t k = 0; k < count; ++k)
                        depth += medium.constituents[k].per_unit.scattering[m][b] *
                                 profile.column[profile.column.size() - count + k];
                sum += depth * state.throughput[b];
            }
            w.phase_weights[m] = sum;
            total += sum;
        }
        // A field may scatter where its profile is not known, or where nothing else does.
        if (segment.has_field || !(total > 0))
            for (std::size_t m = 0; m < phases; ++m)
                w.phase_weights[m] += tables_.shares[m] * (total > 0 ? k_field_share * total : 1);
    }
    w.shares.clear();
    w.cumulative.clear();
    w.masses.clear();
    double total = 0;
    for (std::size_t j = 0; j < lamps.size(); ++j) {
        const double own_weight = weights.empty() ? 1 : weights[j];
        if (!(own_weight > 0)) continue;
        const Interval lit = lamps[j].beam(segment.ray, {0, segment.length});
        if (!(lit.length() > 0)) continue;
        LampPassage passage(segment.ray, lamps[j].position());
        passage.distance = std::max(passage.distance, 1e-12 * (1 + std::abs(passage.foot)));
        Share share{j, passage.foot, passage.distance, {}, 0, 0, w.masses.size()};
        const auto add_part = [&](double begin, double end) {
            if (!(end > begin)) return;
            const Share::HalfTangents part{passage.half_tangent(begin, passage.radius(begin)),
                                           passage.half_tangent(end, passage.radius(end))};
            double mass = 0;
            for (std::size_t m = 0; m < phases; ++m) {
                w.masses.push_back(
                    {tables_.lines[m].mass_to(part.begin), tables_.lines[m].mass_to(part.end)});
                mass += w.phase_weights[m] * (w.masses.back().to - w.masses.back().from);
            }
            if (!(mass > 0)) {
                w.masses.resize(w.masses.size() - phases);
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
        // The light path R + s never shortens along the segment.
        const double weight =
            lamps.size() == 1
                ? 1
                : own_weight * share.mass / share.distance *
                      optics_.attenuated_sum(state.throughput, lamps[j].axis_intensity(),
                                             lit.begin + passage.radius(lit.begin));
        if (!(weight > 0)) continue;
        total += weight;
        w.shares.push_back(share);
        w.cumulative.push_back(total);
    }
}

void LampGathering::gather_from_water(const WaterSegment& segment, std::span<const double> weights,
                                      const PathState& state, PathRandom& random,
                                      PathTerms& terms) const {
    thread_local Workspace w;
    double of_lamp = random.next(), of_phase = random.next(), of_angle = random.next();
    const std::size_t phases = tables_.phase_count();
    if (phases == 0) return;
    find_water_shares(segment, weights, state, w);
    if (w.shares.empty()) return;
    const Choice lamp_choice = choose(w.cumulative, of_lamp);
    const Share& share = w.shares[lamp_choice.index];

    // A part of the segment and a phase function, then an angle.
    const std::span<const Workspace::Masses> masses =
        std::span(w.masses).subspan(share.first_masses, share.part_count * phases);
    w.cumulative.clear();
    double total = 0;
    for (std::size_t i = 0; i < masses.size(); ++i) {
        total += w.phase_weights[i % phases] * (masses[i].to - masses[i].from);
        w.cumulative.push_back(total);
    }
    const std::size_t pick = choose(w.cumulative, of_phase).index;
    const auto [from, to] = masses[pick];
    const Share::HalfTangents& part = share.parts[pick / phases];
    const double h = std::clamp(tables_.lines[pick % phases].invert(from + of_angle * (to - from)),
                                part.begin, part.end);
    if (!(h > 0)) return;
    const double s =
        std::clamp(share.foot - share.distance * (1 - h * h) / (2 * h), 0.0, segment.length);
    double density = 0;  // per unit of h
    for (std::size_t m = 0; m < phases; ++m)
        density += w.phase_weights[m] * tables_.lines[m].density(h);
    density *= lamp_choice.probability / total;
    if (!(density > 0)) return;

    const Lamp& lamp = (*optics_.scene().emitters)[share.lamp];
    const Point3 x = segment.ray.at(s);
    const double relative = lamp.relative_intensity(x - lamp.position());
    if (!(relative > 0) || optics_.scene().surfaces->occluded(lamp.position(), x)) return;
    const double radius = share.distance * (1 + h * h) / (2 * h);
    optics_.look_up(segment, s, w.point);
    optics_.find_scattering(w.point);
    w.column.resize(optics_.constituents());
    column_to_lamp(share.lamp, x, w.column);
    add(w.column, w.point.column);
    w.p.resize(phases);
    tables_.phase(h, w.p);
    const std::size_t bands = optics_.bands();
    const std::span<double> radiance = w.radiance.first(bands);
    optics_.transmittances(s + radius, w.column, w.radiance);
    const double factor = (weights.empty() ? 1 : weights[share.lamp]) * relative * 2 /
                          ((1 + h * h) * share.distance * density);
    for (std::size_t b = 0; b < bands; ++b) {
        double beta = 0;
        for (std::size_t m = 0; m < phases; ++m) beta += w.point.scattering[m][b] * w.p[m];
        radiance[b] *= factor * beta * lamp.axis_intensity()[b] * state.throughput[b];
    }
    PathTerm term = state.term(share.lamp, radiance);
    if (term.scatterings + term.reflections == 0) term.distance = s;  // on the camera ray
    ++term.scatterings;
    terms.add(term);
}

double LampGathering::gather_from_surface(const WaterSegment& segment,
                                          const Spectrum& transmittance, const PathState& state,
                                          PathRandom& random, PathTerms& terms) const {
    thread_local Workspace w;
    double u = random.next();
    const std::size_t bands = optics_.bands();
    const std::vector<Lamp>& lamps = *optics_.scene().emitters;
    const SurfaceHit& hit = segment.hit;
    const SurfaceSample sample{segment.ray, hit, 0, 0};
    const SurfaceReflection reflection(*optics_.scene().surfaces, sample, static_cast<int>(bands));
    const std::span<double> radiance = w.radiance.first(bands);
    double seen = 0, transmitted = 0;
    for (const double value : transmittance.first(bands)) transmitted += value;
    if (!(transmitted > 0)) return 0;
    const auto add_term = [&](const PathTerm& term) {
        for (const double value : radiance) seen += value / transmitted;
        terms.add(term);
    };
    if (reflection.emits()) {
        for (std::size_t b = 0; b < bands; ++b)
            radiance[b] = state.throughput[b] * transmittance[b] * reflection.emission()[b];
        add_term(state.term(k_no_lamp, radiance));
    }
    w.shares.clear();
    w.cumulative.clear();
    double total = 0;
    for (std::size_t j = 0; j < lamps.size(); ++j) {
        const Vector3 to_lamp = lamps[j].position() - hit.position;
        const double towards = glm::dot(hit.normal, to_lamp);
        if (towards <= 0 || glm::dot(hit.geometric_normal, to_lamp) <= 0) continue;
        const double relative = lamps[j].relative_intensity(-to_lamp);
        if (!(relative > 0)) continue;
        const double radius = glm::length(to_lamp);
        const double geometry = relative * towards / (radius * radius * radius);
        const double weight =
            lamps.size() == 1 ? 1
                              : geometry * optics_.attenuated_sum(
                                               state.throughput, lamps[j].axis_intensity(), radius);
        if (!(weight > 0)) continue;
        total += weight;
        Share share;
        share.lamp = j;
        share.distance = radius;
        share.mass = geometry;
        w.shares.push_back(share);
        w.cumulative.push_back(total);
    }
    if (w.shares.empty()) return seen;
    const auto [chosen, probability] = choose(w.cumulative, u);
    const Share& share = w.shares[chosen];
    const Lamp& lamp = lamps[share.lamp];
    if (optics_.scene().surfaces->occluded(lamp.position(), hit.position)) return seen;
    w.column.resize(optics_.constituents());
    column_to_lamp(share.lamp, hit.position, w.column);
    reflection.brdf(lamp.position(), w.brdf);
    optics_.transmittances(share.distance, w.column, w.radiance);
    for (std::size_t b = 0; b < bands; ++b)
        radiance[b] *= share.mass / probability * lamp.axis_intensity()[b] * w.brdf[b] *
                       transmittance[b] * state.throughput[b];
    PathTerm term = state.term(share.lamp, radiance);
    ++term.reflections;
    add_term(term);
    return seen;
}

}  // namespace uw
