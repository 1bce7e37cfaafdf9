#include "core/paths/lamp_gathering.h"

#include <cmath>

#include "core/paths/choice.h"
#include "core/paths/water_shares.h"
#include "core/surfaces/surface_reflection.h"

namespace uw {

struct LampGathering::Workspace {
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

LampGathering::LampGathering(const WaterOptics& optics, const ScatteringTables& tables,
                             std::vector<std::shared_ptr<const DeepShadow>> deep_shadows)
    : optics_(optics), tables_(tables), deep_shadows_(std::move(deep_shadows)) {}

void LampGathering::column_to_lamp(std::size_t lamp, const Point3& x,
                                   std::span<double> column) const {
    if (column.empty()) return;
    if (deep_shadows_.empty())
        optics_.scene().field->column((*optics_.scene().emitters)[lamp].origin(x), x, column);
    else
        deep_shadows_[lamp]->columns(std::span(&x, 1), column);
}

void LampGathering::gather_from_water(const WaterSegment& segment, std::span<const double> weights,
                                      const PathState& state, PathRandom& random,
                                      PathTerms& terms) const {
    thread_local Workspace w;
    const double of_lamp = random.next(), of_phase = random.next(), of_angle = random.next();
    const std::size_t phases = tables_.phase_count();
    if (phases == 0) return;
    w.of_water.find(optics_, tables_, segment, weights, state);
    const std::optional<ScatterPlace> place =
        w.of_water.choose(tables_, segment.length, of_lamp, of_phase, of_angle);
    if (!place) return;
    const double s = place->s;

    const Lamp& lamp = (*optics_.scene().emitters)[place->lamp];
    const Point3 x = segment.ray.at(s);
    const Point3 origin = lamp.origin(x);
    const double relative = lamp.relative_intensity(x - origin);
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
    const double factor = (weights.empty() ? 1 : weights[place->lamp]) * relative / place->density;
    for (std::size_t b = 0; b < bands; ++b) {
        double beta = 0;
        for (std::size_t m = 0; m < phases; ++m) beta += w.point.scattering[m][b] * w.p[m];
        radiance[b] *= factor * beta * lamp.axis_intensity()[b] * state.throughput[b];
    }
    PathTerm term = state.term(place->lamp, radiance);
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
    w.of_surface.clear();
    w.cumulative.clear();
    double total = 0;
    for (std::size_t j = 0; j < lamps.size(); ++j) {
        const Vector3 to_lamp = lamps[j].origin(hit.position) - hit.position;
        const double towards = glm::dot(hit.normal, to_lamp);
        if (towards <= 0 || glm::dot(hit.geometric_normal, to_lamp) <= 0) continue;
        const double relative = lamps[j].relative_intensity(-to_lamp);
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
    if (w.of_surface.empty()) return seen;
    const auto [chosen, probability] = choose(w.cumulative, u);
    const Workspace::SurfaceShare& share = w.of_surface[chosen];
    const Lamp& lamp = lamps[share.lamp];
    const Point3 origin = lamp.origin(hit.position);
    if (optics_.scene().surfaces->occluded(origin, hit.position)) return seen;
    w.column.resize(optics_.constituents());
    column_to_lamp(share.lamp, hit.position, w.column);
    reflection.brdf(origin, w.brdf);
    optics_.transmittances(share.radius, w.column, w.radiance);
    for (std::size_t b = 0; b < bands; ++b)
        radiance[b] *= share.geometry / probability * lamp.axis_intensity()[b] * w.brdf[b] *
                       transmittance[b] * state.throughput[b];
    PathTerm term = state.term(share.lamp, radiance);
    ++term.reflections;
    add_term(term);
    return seen;
}

}  // namespace uw
