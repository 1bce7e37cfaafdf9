#include "core/light/volume_integrator.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "core/base/error.h"
#include "core/base/numerics.h"

namespace uw {

void ScatterNodes::clear() {
    s.clear();
    weight.clear();
    radius.clear();
    half_tangent.clear();
    distance.clear();
    position.clear();
}

void ScatterNodes::reserve(std::size_t count) {
    s.reserve(count);
    weight.reserve(count);
    radius.reserve(count);
    half_tangent.reserve(count);
    distance.reserve(count);
    position.reserve(count);
}

void ScatterNodes::look_up(const ConcentrationProfile& profile) {
    const auto constituents = static_cast<std::size_t>(profile.constituent_count);
    concentration.resize(size() * constituents);
    column.resize(size() * constituents);
    if (constituents == 0) return;
    std::size_t knot = 0;
    for (std::size_t i = 0; i < size(); ++i) {
        while (knot + 2 < profile.s.size() && profile.s[knot + 1] < s[i]) ++knot;
        const double length = profile.s[knot + 1] - profile.s[knot];
        const double t = (s[i] - profile.s[knot]) / length;
        for (std::size_t k = 0; k < constituents; ++k) {
            const std::size_t at = knot * constituents + k;
            const double begin = profile.concentration[at];
            const double slope = profile.concentration[at + constituents] - begin;
            concentration[k * size() + i] = begin + t * slope;
            column[k * size() + i] = lamp_column[i * constituents + k] + profile.column[at] +
                                     t * length * (begin + 0.5 * t * slope);
        }
    }
}

void ScatterNodes::evaluate_phases(const PhaseTable& table, std::size_t phases) {
    phase.resize(size() * phases);
    table.eval(half_tangent, phase);
}

void ScatterNodes::set_phases(std::span<const double> values) {
    phase.clear();
    for (const double value : values) phase.insert(phase.end(), size(), value);
}

ScatterSum::ScatterSum(const Medium& medium)
    : attenuation_(medium), uniform_(medium.uniform.scattering) {
    for (std::size_t k = 0; k < medium.constituents.size(); ++k) {
        const std::vector<Spectrum>& scattering = medium.constituents[k].per_unit.scattering;
        for (std::size_t m = 0; m < scattering.size(); ++m)
            if (scattering[m] != Spectrum{}) terms_.push_back({m, k, scattering[m]});
    }
}

UWVDB_VECTOR_CLONES void ScatterSum::add(const ScatterNodes& nodes, const Spectrum& intensity,
                                         std::span<Spectrum> radiance) const {
    std::vector<double> memory(2 * nodes.size());
    const std::span<double> tau = std::span(memory).first(nodes.size());
    const std::span<double> beta = std::span(memory).subspan(nodes.size());
    // Band by band, so that each loop runs over contiguous nodes without a branch.
    for (std::size_t b = 0; b < static_cast<std::size_t>(attenuation_.band_count); ++b) {
        std::ranges::fill(beta, 0.0);
        add_depth(nodes, b, tau);
        add_scattering(nodes, b, beta);
        for (std::size_t i = 0; i < nodes.size(); ++i)
            beta[i] *= nodes.weight[i] * exp_of_minus(tau[i]);
        for (std::size_t i = 0; i < nodes.size(); ++i)
            radiance[nodes.distance[i]][b] += intensity[b] * beta[i];
    }
}

UWVDB_VECTOR_CLONES void ScatterSum::add_depth(const ScatterNodes& nodes, std::size_t band,
                                               std::span<double> tau) const {
    const std::size_t count = nodes.size();
    const double c = attenuation_.uniform[band];
    for (std::size_t i = 0; i < count; ++i) tau[i] = c * (nodes.s[i] + nodes.radius[i]);
    for (std::size_t k = 0; k < attenuation_.constituents.size(); ++k) {
        const double per_unit = attenuation_.constituents[k][band];
        const double* column = nodes.column.data() + k * count;
        for (std::size_t i = 0; i < count; ++i) tau[i] += per_unit * column[i];
    }
}

UWVDB_VECTOR_CLONES void ScatterSum::add_scattering(const ScatterNodes& nodes, std::size_t band,
                                                    std::span<double> beta) const {
    const std::size_t count = nodes.size();
    for (std::size_t m = 0; m < uniform_.size(); ++m) {
        const double b = uniform_[m][band];
        const double* p = nodes.phase.data() + m * count;
        for (std::size_t i = 0; i < count; ++i) beta[i] += b * p[i];
    }
    for (const Term& term : terms_) {
        const double b = term.scattering[band];
        const double* p = nodes.phase.data() + term.m * count;
        const double* nu = nodes.concentration.data() + term.k * count;
        for (std::size_t i = 0; i < count; ++i) beta[i] += b * nu[i] * p[i];
    }
}

namespace {

// Greatest change in the optical depth of the whole light path across a Gauss panel: three nodes
// integrate e^-x over [0, 1.5] to 1e-5.
constexpr double k_panel_optical_depth = 1.5;
// The nodes of most rays, and the marks of one kind: they are allocated once, not as they grow.
constexpr std::size_t k_usual_nodes = 128, k_usual_marks = 32;
// Light whose path exceeds the least optical depth by this much adds less than 1e-6 of the total.
constexpr double k_negligible_optical_depth = 15;

// Parameters by quality. A step of the profile along a ray may be off by k_depth_tolerance; the
// integral over hundreds of steps, whose errors differ in sign, is off by far less. The
// transmittance error of surfaces due to interpolated columns is far below what the eye or a 12-bit
// camera can resolve.
constexpr double k_depth_tolerance = 1e-3;
constexpr double k_draft_depth_tolerance = 0.02;
constexpr VolumeIntegrator::Fineness k_fineness;
constexpr VolumeIntegrator::Fineness k_draft_fineness{.knots_per_panel = 6,
                                                      .interpolated_half_tangent = 0};
// A measured profile (IES) has kinks at its angles, which may lie anywhere on a panel.
constexpr VolumeIntegrator::Fineness k_exact_fineness{
    .min_relative_panel = 0.1, .pieces = 2, .interpolated_half_tangent = 1.5};
constexpr double k_column_tolerance = 5e-4;
constexpr double k_draft_column_tolerance = 0.01;

std::vector<double> cotangents_of_breakpoints(const Medium& medium) {
    std::vector<double> all;
    for (const auto& phase : medium.phase_functions) {
        const std::vector<double> own = phase->breakpoints();
        all.insert(all.end(), own.begin(), own.end());
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    for (double& psi : all) psi = 1 / std::tan(psi);
    return all;
}

// Number of Gauss nodes for a panel, from the relative change of R across it; only attenuation
// changes a sun's light. Where waves focus it panels are short, a few texels of a map that is
// linear in each.
int node_count(double length, double nearest_radius, bool parallel, bool focused) {
    if (parallel) return focused ? 2 : 3;
    if (length < 0.12 * nearest_radius) return 2;
    return length < 0.35 * nearest_radius ? 3 : 4;
}

// One segment between two breaks, and its properties.
struct Panel {
    Interval interval;
    int pieces = 1;            // equal parts, each with its own nodes
    bool evenly = false;       // the relative intensity is 1 throughout
    std::size_t distance = 0;  // index of the first requested distance beyond it
};

void add_nodes(const Ray& ray, const Lamp& lamp, const LampPassage& passage, const Panel& panel,
               ScatterNodes& nodes) {
    const double length = panel.interval.length() / panel.pieces;
    for (int piece = 0; piece < panel.pieces; ++piece) {
        const double begin = panel.interval.begin + piece * length;
        const double nearest = passage.radius(glm::clamp(passage.foot, begin, begin + length));
        for (const QuadratureNode& node :
             gauss_legendre(node_count(length, nearest, passage.parallel, lamp.is_focused()))) {
            const double s = begin + node.position * length;
            const double radius = passage.radius(s);
            const Point3 x = ray.at(s);
            const double relative =
                panel.evenly ? 1.0 : lamp.relative_intensity(x - lamp.origin(x));
            nodes.s.push_back(s);
            nodes.radius.push_back(radius);
            nodes.weight.push_back(node.weight * length * relative / lamp.spread(radius));
            nodes.half_tangent.push_back(passage.half_tangent(s, radius));
            nodes.distance.push_back(panel.distance);
            nodes.position.push_back(x);
        }
    }
}

// Adds a profile's knots: every `knots`-th one, and those where particles begin and end.
void add_knots(const ConcentrationProfile& profile, int knots, PanelBreaks& breaks) {
    const auto pace = static_cast<std::size_t>(knots);
    const double min_knots = knots - 0.1;
    bool was_empty = true;
    for (std::size_t i = 0; i + 1 < profile.s.size(); ++i) {
        const bool is_empty = profile.empty_between(i);
        if (is_empty != was_empty)
            breaks.add_edge(profile.s[i]);
        else if (!is_empty && i % pace == 0)
            breaks.add_mark(profile.s[i], min_knots * (profile.s[i + 1] - profile.s[i]));
        was_empty = is_empty;
    }
}

/// Whether parallel light gets brighter along the ray: towards the water's surface the light's path
/// gets shorter by more than the ray gets longer.
bool brightens(const LampPassage& passage) {
    return passage.slope < -1;
}

LightTransport make_volume(const IntegratorInputs& inputs) {
    using Quality = RenderDesc::Quality;
    const LitScene& scene = inputs.scene;
    const auto make = [&](double depth_tolerance, const VolumeIntegrator::Fineness& fineness,
                          double column_tolerance) {
        const auto integrator = [&](const VolumeIntegrator::Part& part) {
            return std::make_unique<VolumeIntegrator>(
                scene, inputs.deep_shadows, DepthTolerance(*scene.medium, depth_tolerance),
                fineness, part);
        };
        LightTransport transport{integrator({}), std::make_unique<DirectLighting>(
                                                     scene, inputs.deep_shadows, column_tolerance)};
        if (std::ranges::any_of(*scene.emitters, &Lamp::is_focused))
            for (const bool focused : {false, true})
                transport.parts.push_back(integrator({.focused = focused, .even = !focused}));
        return transport;
    };
    switch (inputs.quality) {
        case Quality::draft:
            return make(k_draft_depth_tolerance, k_draft_fineness, k_draft_column_tolerance);
        case Quality::final:
            return make(k_depth_tolerance, k_fineness, k_column_tolerance);
        case Quality::exact:
            return make(0, k_exact_fineness, 0);
    }
    throw InputError("unknown quality");
}

}  // namespace

constinit const IntegratorKind VolumeIntegrator::k_kind{.needs_deep_shadows = true,
                                                        .interpolates_between_pixels = true,
                                                        .multiple_scattering = true,
                                                        .make = make_volume};

struct VolumeIntegrator::Workspace {
    ConcentrationProfile profile;
    std::vector<Interval> lit;
    PanelBreaks breaks;
    std::vector<double> marks;
    std::vector<Spectrum> radiance;
    std::vector<Spectrum> evenness;  // of the current lamp, up to each distance from the one before
    ScatterNodes nodes;
    // These are of a part of the sky:
    std::vector<double> mean_phases;
    SkyScattering::Workspace sky;
};

VolumeIntegrator::VolumeIntegrator(const LitScene& scene,
                                   std::vector<std::shared_ptr<const DeepShadow>> deep_shadows,
                                   const DepthTolerance& tolerance, const Fineness& fineness,
                                   const Part& part)
    : scene_(scene),
      evenness_(scene),
      sky_(scene),
      tolerance_(tolerance),
      fineness_(fineness),
      deep_shadows_(std::move(deep_shadows)),
      phase_cotangents_(cotangents_of_breakpoints(*scene.medium)),
      phases_(*scene.medium),
      sum_(*scene.medium) {
    const AttenuationTable& c = sum_.attenuation();
    const auto bands = static_cast<std::size_t>(c.band_count);
    for (std::size_t j = 0; j < scene.emitters->size(); ++j) {
        const Lamp& emitter = (*scene.emitters)[j];
        if (emitter.is_met_by_paths()) continue;
        if (emitter.is_focused() ? part.focused : part.even) emitters_.push_back(j);
    }
    max_attenuation_ = c.uniform.greatest(bands);
    min_attenuation_ = c.uniform.least(bands);
    for (const Spectrum& constituent : c.constituents)
        max_per_unit_.push_back(constituent.greatest(bands));
}

void VolumeIntegrator::in_scatter(const Ray& ray, std::span<const double> distances,
                                  InScatter& result) const {
    in_scatter_from(ray, 0, distances, result);
}

void VolumeIntegrator::in_scatter_from(const Ray& ray, double begin,
                                       std::span<const double> distances, InScatter& result) const {
    Workspace w;
    w.nodes.reserve(k_usual_nodes);
    w.marks.reserve(k_usual_marks);
    const std::vector<Lamp>& emitters = *scene_.emitters;
    result.reset(distances.size(), scene_.lamp_count());
    scene_.field->profile_within(tolerance_, ray, distances.back(), w.profile);
    std::optional<std::size_t> lamp;  // of which evenness is known
    for (const std::size_t j : emitters_) {
        throw_if_stopped();
        find_nodes(ray, j, begin, distances, w);
        w.radiance.assign(distances.size(), Spectrum{});
        sum_.add(w.nodes, emitters[j].axis_intensity(), w.radiance);
        if (scene_.lamp_surfaces && lamp != emitters[j].index()) {
            lamp = emitters[j].index();
            evenness_.find(*lamp, ray, begin, distances, w.evenness);
        }
        Spectrum so_far;
        for (std::size_t i = 0; i < distances.size(); ++i) {
            if (scene_.lamp_surfaces) w.radiance[i] *= w.evenness[i];
            so_far += w.radiance[i];
            result.at(i, emitters[j].index()) += so_far;
        }
    }
}

void VolumeIntegrator::visit_nodes(const Ray& ray, std::span<const double> distances,
                                   const std::function<void(const Node&)>& visit) const {
    Workspace w;
    std::vector<Spectrum> radiance;
    std::vector<std::size_t> distance_of_node;
    std::vector<double> columns, concentration;
    const std::vector<Lamp>& emitters = *scene_.emitters;
    scene_.field->profile_within(tolerance_, ray, distances.back(), w.profile);
    const auto constituents = static_cast<std::size_t>(w.profile.constituent_count);
    columns.resize(constituents);
    concentration.resize(constituents);
    for (const std::size_t j : emitters_) {
        throw_if_stopped();
        find_nodes(ray, j, 0, distances, w);
        evenness_.find(emitters[j].index(), ray, 0, distances, w.evenness);
        // Summed node by node.
        distance_of_node = w.nodes.distance;
        std::iota(w.nodes.distance.begin(), w.nodes.distance.end(), std::size_t{0});
        radiance.assign(w.nodes.size(), Spectrum{});
        sum_.add(w.nodes, emitters[j].axis_intensity(), radiance);
        for (std::size_t i = 0; i < radiance.size(); ++i) {
            for (std::size_t k = 0; k < constituents; ++k) {
                columns[k] = w.nodes.column[k * radiance.size() + i];
                concentration[k] = w.nodes.concentration[k * radiance.size() + i];
            }
            radiance[i] *= w.evenness[distance_of_node[i]];
            visit({j, w.nodes.s[i], distance_of_node[i], radiance[i], columns, concentration});
        }
    }
}

void VolumeIntegrator::find_nodes(const Ray& ray, std::size_t emitter, double begin,
                                  std::span<const double> distances, Workspace& w) const {
    const Lamp& lamp = (*scene_.emitters)[emitter];
    LampPassage passage = lamp.passage(ray);
    const bool is_sky = sky_.contains(emitter);
    const double lengthening = is_sky ? sky_.find(emitter, ray.direction, w.mean_phases, w.sky) : 1;
    passage.begin_length *= lengthening;
    passage.slope *= lengthening;
    double max_distance = distances.back();
    if (min_attenuation_ > 0)
        max_distance = std::min(
            max_distance, passage.max_distance(k_negligible_optical_depth / min_attenuation_));
    deep_shadows_[emitter]->lit_intervals(ray, lamp.beam(ray, {begin, max_distance}), w.lit);
    w.nodes.clear();
    for (const Interval& interval : w.lit) {
        const std::vector<double>& breaks =
            find_breaks(ray, emitter, passage, interval, distances, w);
        add_panels(ray, emitter, passage, distances, breaks, w.profile, w.nodes);
    }
    w.nodes.lamp_column.resize(w.nodes.size() *
                               static_cast<std::size_t>(w.profile.constituent_count));
    deep_shadows_[emitter]->columns(w.nodes.position, w.nodes.lamp_column);
    refine_columns(emitter, w.nodes, w.profile.constituent_count);
    if (is_sky)
        for (double& column : w.nodes.lamp_column) column *= lengthening;
    w.nodes.look_up(w.profile);
    if (is_sky)
        w.nodes.set_phases(w.mean_phases);
    else
        w.nodes.evaluate_phases(phases_, scene_.medium->phase_functions.size());
}

// On a ray towards the lamp, all of its light has nearly the same path, so that interpolation
// errors do not average out along the ray.
void VolumeIntegrator::refine_columns(std::size_t lamp, ScatterNodes& nodes,
                                      int constituents) const {
    const auto count = static_cast<std::size_t>(constituents);
    const Lamp& source = (*scene_.emitters)[lamp];
    for (std::size_t i = 0; count > 0 && i < nodes.size(); ++i) {
        if (nodes.half_tangent[i] > fineness_.interpolated_half_tangent) continue;
        const std::span<double> column = std::span(nodes.lamp_column).subspan(i * count, count);
        if (std::ranges::all_of(column, [](double value) { return value == 0; })) continue;
        const Point3& x = nodes.position[i];
        scene_.field->column(source.origin(x), x, column);
    }
}

const std::vector<double>& VolumeIntegrator::find_breaks(const Ray& ray, std::size_t lamp,
                                                         const LampPassage& passage,
                                                         const Interval& interval,
                                                         std::span<const double> distances,
                                                         Workspace& w) const {
    w.breaks.reset(interval);
    for (const double distance : distances) w.breaks.add_edge(distance);
    w.marks.clear();
    (*scene_.emitters)[lamp].append_profile_breaks(ray, interval, w.marks);
    for (const double s : w.marks) w.breaks.add_edge(s);
    if (!passage.parallel && passage.distance < k_lamp_radius) {
        const double half =
            std::sqrt(k_lamp_radius * k_lamp_radius - passage.distance * passage.distance);
        w.breaks.add_edge(passage.foot - half);
        w.breaks.add_edge(passage.foot + half);
    }
    w.marks.clear();
    append_octaves(passage, interval, w.marks);
    for (const double s : w.marks)
        w.breaks.add_mark(s, fineness_.min_relative_panel * passage.radius(s));
    // Parallel light is divided by octaves of the distance from the interval's brighter end: the
    // light of the densest bands ends in the first, and that of ever fewer others in each of the
    // next.
    if (passage.parallel)
        for (double u = k_negligible_optical_depth / (max_attenuation_ * passage.rate());
             u < interval.length(); u *= 2)
            w.breaks.add_edge(brightens(passage) ? interval.end - u : interval.begin + u);
    for (const double cotangent :
         passage.parallel ? std::span<const double>{} : std::span(phase_cotangents_))
        w.breaks.add_edge(passage.foot - passage.distance * cotangent);
    if (w.profile.constituent_count > 0) {
        add_knots(w.profile, fineness_.knots_per_panel, w.breaks);
        w.marks.clear();
        deep_shadows_[lamp]->append_column_breaks(ray, interval, w.marks);
        const double spacing = fineness_.knots_per_panel * scene_.field->finest_voxel();
        for (const double s : w.marks) w.breaks.add_mark(s, spacing);
        if (const auto strata = scene_.field->strata()) {
            w.marks.clear();
            strata->append_breaks(ray, interval.end, w.marks);
            for (const double s : w.marks) w.breaks.add_edge(s);
        }
    }
    return w.breaks.kept();
}

void VolumeIntegrator::add_panels(const Ray& ray, std::size_t lamp, const LampPassage& passage,
                                  std::span<const double> distances, std::span<const double> breaks,
                                  const ConcentrationProfile& profile, ScatterNodes& nodes) const {
    const Lamp& source = (*scene_.emitters)[lamp];
    const std::size_t first = nodes.size();
    std::size_t next = 0;
    std::size_t knot = 0;
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        const Interval panel{breaks[i], breaks[i + 1]};
        const double middle = 0.5 * (panel.begin + panel.end);
        if (panel.length() <= 1e-12 * (1 + middle)) continue;
        if (source.contains(passage.radius(middle))) continue;
        // A panel lies between the edges of the lamp's cone: dark at the midpoint means dark
        // throughout, but for a soft edge, which lies somewhere within a panel. It is met once
        // there, as the point nearest to the axis is a break.
        const auto relative_at = [&](double s) {
            const Point3 x = ray.at(s);
            return source.relative_intensity(x - source.origin(x));
        };
        const double relative = relative_at(middle);
        if (relative == 0 &&
            !(source.is_soft() && (relative_at(panel.begin) > 0 || relative_at(panel.end) > 0)))
            continue;
        while (next + 1 < distances.size() && distances[next] < middle) ++next;
        while (knot + 2 < profile.s.size() && profile.s[knot + 1] < middle) ++knot;
        double attenuation = max_attenuation_;
        if (passage.parallel) {  // of bands whose light gets there from the brighter end
            const double u =
                brightens(passage) ? breaks.back() - panel.end : panel.begin - breaks.front();
            attenuation = std::min(attenuation, k_negligible_optical_depth / (passage.rate() * u));
        }
        for (std::size_t k = 0; k < max_per_unit_.size(); ++k)
            attenuation +=
                max_per_unit_[k] * profile.concentration[knot * max_per_unit_.size() + k];
        // The optical depth along the light's path, s + R.
        const double depth = passage.rate() * attenuation * panel.length();
        const int pieces =
            static_cast<int>(std::min(64.0, std::ceil(depth / k_panel_optical_depth)));
        add_nodes(ray, source, passage,
                  {panel, std::max(fineness_.pieces, pieces),
                   relative == 1 && source.has_even_core(), next},
                  nodes);
    }
    source.focus(ray, std::span(nodes.s).subspan(first), std::span(nodes.weight).subspan(first));
}

}  // namespace uw
