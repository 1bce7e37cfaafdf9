#include "core/paths/next_event_estimator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/geometry/surface_reflection.h"
#include "core/light/integrator.h"
#include "core/light/ray_panels.h"
#include "core/paths/scattering_tables.h"

namespace uw {

namespace {

// Over a smaller change the light counts as even.
constexpr double k_even_depth = 1e-6;

/// Where on a line the parallel light of a sun is scattered along it: distances drawn as its way
/// through uniform water attenuates it.
class ParallelStretch {
  public:
    ParallelStretch() = default;
    /// `lit`: what the sun illuminates of the line; may be infinite only if the light falls along
    /// it. `attenuation`: of the water [1/m].
    ParallelStretch(const LampPassage& passage, const Interval& lit, double attenuation)
        : lit_(lit), rate_(attenuation * (1 + passage.slope)) {}

    /// The length over which light as bright as at the beginning would be scattered as much [m].
    double effective_length() const;
    /// The distance up to which a `share` (0..1) of all lie.
    double draw(double share) const;
    /// The density of what is drawn at `s` [1/m].
    double density(double s) const;

  private:
    Interval lit_;
    double rate_ = 0;  // of e^(-rate s) [1/m]
};

double ParallelStretch::effective_length() const {
    const double depth = rate_ * lit_.length();
    return std::abs(depth) < k_even_depth ? lit_.length() : -std::expm1(-depth) / rate_;
}

double ParallelStretch::draw(double share) const {
    const double depth = rate_ * lit_.length();
    const double s = std::abs(depth) < k_even_depth
                         ? share * lit_.length()
                         : -std::log1p(share * std::expm1(-depth)) / rate_;
    return lit_.begin + std::clamp(s, 0.0, lit_.length());
}

double ParallelStretch::density(double s) const {
    const double depth = rate_ * lit_.length();
    if (std::abs(depth) < k_even_depth) return 1 / lit_.length();
    return std::exp(-rate_ * (s - lit_.begin)) / effective_length();
}

/// Where on a segment a lamp's light is scattered once.
struct ScatterPlace {
    std::size_t lamp = 0;
    double s = 0;             // along the segment
    double half_tangent = 0;  // of the scattering angle
    double radius = 0;        // from the light's origin
    double density = 0;       // Lamp::spread times that of choosing it, per metre
};

/// The lamps' parts in the light that the water of a segment scatters, for choosing one of them and
/// a place: around a lamp by the scattering angle, in a sun's light by its attenuation. Reused
/// storage.
class WaterShares {
  public:
    void find(const WaterOptics& optics, const ScatteringTables& tables,
              const WaterSegment& segment, const PathState& state);

    /// By three random numbers, 0..1, on the segment of this `length`; none where nothing is lit.
    /// Once after each `find`, with the same tables.
    std::optional<ScatterPlace> choose(const ScatteringTables& tables, double length,
                                       double of_lamp, double of_phase, double of_angle);

  private:
    // One lamp's part.
    struct Share {
        // An interval of h = tan(psi / 2).
        struct HalfTangents {
            double begin = 0, end = 0;
        };

        std::size_t lamp = 0;
        double foot = 0, distance = 0;      // LampPassage
        std::array<HalfTangents, 2> parts;  // outside the lamp's sphere and within its beam
        std::size_t part_count = 0;
        double mass = 0;               // of the weighted phase functions on them
        std::size_t first_masses = 0;  // of masses_
        // Members for a sun, whose mass is that of the weighted phase functions at its one angle:
        bool parallel = false;
        ParallelStretch stretch;
        LampPassage passage;
    };
    // HalfTangentDensity::mass_to at both ends of a part.
    struct Masses {
        double from = 0, to = 0;
    };

    Share parallel_share(const WaterOptics& optics, const ScatteringTables& tables,
                         const WaterSegment& segment, std::size_t lamp, const LampPassage& passage,
                         const Interval& lit);
    static ScatterPlace place_in_parallel(const Share& share, double u);
    std::optional<ScatterPlace> place_around(const ScatteringTables& tables, const Share& share,
                                             double length, double of_phase, double of_angle);

    std::vector<double> phase_weights_;  // of the phase functions on this segment
    std::vector<Share> shares_;
    std::vector<Masses> masses_;  // by share, part and phase function
    std::vector<double> cumulative_, phase_;
};

// The share of what a field may scatter, typically, in the choice of a phase function.
constexpr double k_field_share = 0.25;

void WaterShares::find(const WaterOptics& optics, const ScatteringTables& tables,
                       const WaterSegment& segment, const PathState& state) {
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
        const Interval lit = lamps[j].beam(segment.ray, {0, segment.length});
        if (!(lit.length() > 0)) continue;
        LampPassage passage(segment.ray, lamps[j]);
        if (passage.parallel) {
            Share share = parallel_share(optics, tables, segment, j, passage, lit);
            const double weight = share.mass * share.stretch.effective_length() *
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
        const double weight =
            lamps.size() == 1
                ? 1
                : share.mass / share.distance * arriving(j, lit.begin + passage.radius(lit.begin));
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
    // The clearest band that scatters at all decides; if none does, only the field counts.
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

struct GatheringWorkspace {
    // One lamp's light on a surface.
    struct SurfaceShare {
        std::size_t lamp = 0;
        double radius = 0, geometry = 0;
    };

    WaterShares of_water;
    std::vector<SurfaceShare> of_surface;
    std::vector<double> cumulative;
    std::vector<double> column, p;
    WaterPoint point;
    Spectrum radiance, brdf;
};

}  // namespace

NextEventEstimator::NextEventEstimator(const WaterOptics& optics, const ScatteringTables& tables,
                                       std::vector<std::shared_ptr<const DeepShadow>> deep_shadows,
                                       std::vector<std::size_t> emitters)
    : optics_(optics),
      tables_(tables),
      evenness_(optics.scene()),
      deep_shadows_(std::move(deep_shadows)),
      emitters_(std::move(emitters)) {}

void NextEventEstimator::column_to_lamp(std::size_t lamp, const Point3& x,
                                        std::span<double> column) const {
    if (column.empty()) return;
    if (deep_shadows_.empty())
        optics_.scene().field->column((*optics_.scene().emitters)[lamp].origin(x), x, column);
    else
        deep_shadows_[lamp]->columns(std::span(&x, 1), column);
}

void NextEventEstimator::estimate_in_scatter(const WaterSegment& segment, const PathState& state,
                                             PathRandom& random, ContributionSink& sink) const {
    thread_local GatheringWorkspace w;
    const double of_lamp = random.next(), of_phase = random.next(), of_angle = random.next();
    const std::size_t phases = tables_.phase_count();
    if (phases == 0) return;
    w.of_water.find(optics_, tables_, segment, state);
    const std::optional<ScatterPlace> place =
        w.of_water.choose(tables_, segment.length, of_lamp, of_phase, of_angle);
    if (!place) return;
    const double s = place->s;

    const Lamp& lamp = (*optics_.scene().emitters)[place->lamp];
    const Point3 x = segment.ray.at(s);
    const Point3 origin = lamp.origin(x);
    const double relative = lamp.relative_intensity(x - origin) * lamp.focus(x);
    if (!(relative > 0) || optics_.scene().surfaces->occluded(origin, x)) return;
    optics_.look_up(segment, s, w.point);
    optics_.find_scattering(w.point);
    w.column.resize(optics_.constituents());
    column_to_lamp(place->lamp, x, w.column);
    add(w.column, w.point.column);
    w.p.resize(phases);
    tables_.phase(place->half_tangent, w.p);
    const std::size_t bands = optics_.bands();
    const std::span<double> radiance = w.radiance.first(bands);
    optics_.transmittances(s + place->radius, w.column, w.radiance);
    const Spectrum even = evenness_.of(lamp.index(), segment.ray, {0, segment.length});
    const double factor = relative / place->density;
    for (std::size_t b = 0; b < bands; ++b) {
        double beta = 0;
        for (std::size_t m = 0; m < phases; ++m) beta += w.point.scattering[m][b] * w.p[m];
        radiance[b] *= factor * even[b] * beta * lamp.axis_intensity()[b] * state.throughput[b];
    }
    PathContribution contribution = state.contribution(lamp.index(), radiance);
    if (contribution.scatterings + contribution.reflections == 0)
        contribution.distance = s;  // on the camera ray
    ++contribution.scatterings;
    contribution.place = x;
    contribution.emitter = emitters_[place->lamp];
    sink.add(contribution);
}

void NextEventEstimator::estimate_direct_light(const WaterSegment& segment,
                                               const Spectrum& transmittance,
                                               const PathState& state, PathRandom& random,
                                               ContributionSink& sink) const {
    thread_local GatheringWorkspace w;
    double u = random.next();
    const std::size_t bands = optics_.bands();
    const std::vector<Lamp>& lamps = *optics_.scene().emitters;
    const SurfaceHit& hit = segment.hit;
    const SurfaceSample sample{segment.ray, hit, 0, 0};
    const SurfaceReflection reflection(*optics_.scene().surfaces, sample, static_cast<int>(bands));
    const std::span<double> radiance = w.radiance.first(bands);
    if (reflection.emits()) {
        for (std::size_t b = 0; b < bands; ++b)
            radiance[b] = state.throughput[b] * transmittance[b] * reflection.emission()[b];
        PathContribution contribution = state.contribution(k_no_lamp, radiance);
        contribution.place = hit.position;
        contribution.hit = &hit;
        sink.add(contribution);
    }
    w.of_surface.clear();
    w.cumulative.clear();
    double total = 0;
    for (std::size_t j = 0; j < lamps.size(); ++j) {
        const Vector3 to_lamp = lamps[j].origin(hit.position) - hit.position;
        const double towards = glm::dot(hit.normal, to_lamp);
        if (towards <= 0 || glm::dot(hit.geometric_normal, to_lamp) <= 0) continue;
        const double relative =
            lamps[j].relative_intensity(-to_lamp) * lamps[j].focus(hit.position);
        if (!(relative > 0)) continue;
        const double radius = glm::length(to_lamp);
        const double geometry = relative * towards / (lamps[j].spread(radius) * radius);
        const double weight =
            lamps.size() == 1 ? 1
                              : geometry * optics_.attenuated_sum(
                                               state.throughput, lamps[j].axis_intensity(), radius);
        if (!(weight > 0)) continue;
        total += weight;
        w.of_surface.push_back({j, radius, geometry});
        w.cumulative.push_back(total);
    }
    if (w.of_surface.empty()) return;
    const auto [chosen, probability] = choose(w.cumulative, u);
    const GatheringWorkspace::SurfaceShare& share = w.of_surface[chosen];
    const Lamp& lamp = lamps[share.lamp];
    const Point3 origin = lamp.origin(hit.position);
    if (optics_.scene().surfaces->occluded(origin, hit.position)) return;
    w.column.resize(optics_.constituents());
    column_to_lamp(share.lamp, hit.position, w.column);
    reflection.brdf(origin, w.brdf);
    optics_.transmittances(share.radius, w.column, w.radiance);
    for (std::size_t b = 0; b < bands; ++b)
        radiance[b] *= share.geometry / probability * lamp.axis_intensity()[b] * w.brdf[b] *
                       transmittance[b] * state.throughput[b];
    PathContribution contribution = state.contribution(lamp.index(), radiance);
    ++contribution.reflections;
    contribution.place = hit.position;
    contribution.hit = &hit;
    contribution.emitter = emitters_[share.lamp];
    sink.add(contribution);
}

}  // namespace uw
