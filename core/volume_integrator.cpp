#include "core/volume_integrator.h"

#include <algorithm>
#include <cmath>

#include "core/quadrature.h"
#include "core/surface_lighting.h"

namespace uw {

namespace {

// A Gauss panel may change the optical depth of the whole light path by this much: with three
// nodes e^-x over [0, 1.5] is then exact to 1e-5.
constexpr double k_panel_optical_depth = 1.5;
// What lies this many optical depths behind the nearest light path adds less than 1e-6 of it.
constexpr double k_negligible_optical_depth = 15;

struct Workspace {
    ConcentrationProfile profile;
    std::vector<Interval> lit;
    std::vector<double> breaks;
    std::vector<Spectrum> radiance;
    ScatterNodes nodes;
};

Workspace& workspace() {
    thread_local Workspace w;
    return w;
}

std::vector<double> merged_breakpoints(const Medium& medium) {
    std::vector<double> all;
    for (const auto& phase : medium.phase_functions) {
        const std::vector<double> own = phase->breakpoints();
        all.insert(all.end(), own.begin(), own.end());
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

// How many Gauss nodes a panel needs: by how much R changes across it, relative to itself.
int node_count(double length, double nearest_radius) {
    if (length < 0.12 * nearest_radius) return 2;
    return length < 0.35 * nearest_radius ? 3 : 4;
}

// Puts Gauss nodes on [begin, end], between two breaks, in `pieces` equal parts.
void add_panel(const Ray& ray, const Lamp& lamp, const LampPassage& passage, const Interval& panel,
               int pieces, std::size_t end_index, ScatterNodes& nodes) {
    const double length = panel.length() / pieces;
    for (int piece = 0; piece < pieces; ++piece) {
        const double begin = panel.begin + piece * length;
        const double nearest = passage.radius(glm::clamp(passage.foot, begin, begin + length));
        for (const QuadratureNode& node : gauss_legendre(node_count(length, nearest))) {
            const double s = begin + node.position * length;
            const double radius = passage.radius(s);
            const Point3 x = ray.at(s);
            const double relative = lamp.relative_intensity(x - lamp.position());
            nodes.s.push_back(s);
            nodes.radius.push_back(radius);
            nodes.weight.push_back(node.weight * length * relative / (radius * radius));
            nodes.psi.push_back(passage.scattering_angle(s));
            nodes.end.push_back(end_index);
            nodes.position.push_back(x);
        }
    }
}

// Appends the knots of a profile at the pace of its voxels: every second one, and where
// particles begin and end.
void append_knots(const ConcentrationProfile& profile, const Interval& interval,
                  std::vector<double>& s) {
    bool was_empty = true;
    for (std::size_t i = 0; i + 1 < profile.s.size(); ++i) {
        const bool is_empty = profile.empty_between(i);
        const bool wanted = is_empty != was_empty || (!is_empty && i % 2 == 0);
        if (wanted && profile.s[i] > interval.begin && profile.s[i] < interval.end)
            s.push_back(profile.s[i]);
        was_empty = is_empty;
    }
}

double largest_value(const Spectrum& spectrum, int band_count) {
    return *std::max_element(spectrum.begin(), spectrum.begin() + band_count);
}

}  // namespace

VolumeIntegrator::VolumeIntegrator(const LitScene& scene,
                                   std::vector<std::shared_ptr<const LightField>> light_fields)
    : scene_(scene),
      light_fields_(std::move(light_fields)),
      phase_breakpoints_(merged_breakpoints(*scene.medium)),
      sum_(*scene.medium) {
    const AttenuationTable& c = sum_.attenuation();
    largest_attenuation_ = largest_value(c.uniform, c.band_count);
    smallest_attenuation_ = *std::min_element(c.uniform.begin(), c.uniform.begin() + c.band_count);
    for (const Spectrum& constituent : c.constituents)
        largest_per_unit_.push_back(largest_value(constituent, c.band_count));
}

void VolumeIntegrator::in_scatter(const Ray& ray, std::span<const double> ends,
                                  InScatter& result) const {
    in_scatter_from(ray, 0, ends, result);
}

void VolumeIntegrator::in_scatter_from(const Ray& ray, double begin, std::span<const double> ends,
                                       InScatter& result) const {
    Workspace& w = workspace();
    const std::vector<Lamp>& lamps = *scene_.lamps;
    result.reset(ends.size(), lamps.size());
    scene_.field->profile(ray, ends.back(), w.profile);
    for (std::size_t j = 0; j < lamps.size(); ++j) {
        const LampPassage passage(ray, lamps[j].position());
        double reach = ends.back();
        if (smallest_attenuation_ > 0)
            reach = std::min(
                reach, passage.radius(0) + k_negligible_optical_depth / smallest_attenuation_);
        light_fields_[j]->lit_intervals(ray, reach, w.lit);
        w.nodes.clear();
        for (Interval interval : w.lit) {
            interval.begin = std::max(interval.begin, begin);
            if (interval.length() <= 0) continue;
            append_breaks(ray, j, passage, interval, ends, w.profile, w.breaks);
            add_panels(ray, j, passage, ends, w.breaks, w.profile, w.nodes);
        }
        w.nodes.lamp_column.resize(w.nodes.size() *
                                   static_cast<std::size_t>(w.profile.constituent_count));
        light_fields_[j]->columns(w.nodes.position, w.nodes.lamp_column);
        w.nodes.look_up(w.profile);
        w.nodes.evaluate_phases(*scene_.medium);
        w.radiance.assign(ends.size(), Spectrum{});
        sum_.add(w.nodes, lamps[j].axis_intensity(), w.radiance);
        Spectrum so_far{};
        for (std::size_t end = 0; end < ends.size(); ++end) {
            for (std::size_t band = 0; band < k_max_bands; ++band)
                so_far[band] += w.radiance[end][band];
            result.at(end, j) = so_far;
        }
    }
}

void VolumeIntegrator::append_breaks(const Ray& ray, std::size_t lamp, const LampPassage& passage,
                                     const Interval& interval, std::span<const double> ends,
                                     const ConcentrationProfile& profile,
                                     std::vector<double>& breaks) const {
    breaks.assign({interval.begin, interval.end});
    breaks.insert(breaks.end(), ends.begin(), ends.end());
    (*scene_.lamps)[lamp].append_profile_breaks(ray, breaks);
    append_passage_breaks(passage, interval, phase_breakpoints_, breaks);
    if (passage.distance < k_lamp_radius) {
        const double half =
            std::sqrt(k_lamp_radius * k_lamp_radius - passage.distance * passage.distance);
        breaks.push_back(passage.foot - half);
        breaks.push_back(passage.foot + half);
    }
    if (profile.constituent_count > 0) {
        append_knots(profile, interval, breaks);
        light_fields_[lamp]->append_column_breaks(ray, interval, breaks);
    }
    std::erase_if(breaks, [&](double s) { return s < interval.begin || s > interval.end; });
    std::sort(breaks.begin(), breaks.end());
}

void VolumeIntegrator::add_panels(const Ray& ray, std::size_t lamp, const LampPassage& passage,
                                  std::span<const double> ends, std::span<const double> breaks,
                                  const ConcentrationProfile& profile, ScatterNodes& nodes) const {
    const Lamp& source = (*scene_.lamps)[lamp];
    std::size_t end_index = 0;
    std::size_t knot = 0;
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        const Interval panel{breaks[i], breaks[i + 1]};
        const double middle = 0.5 * (panel.begin + panel.end);
        if (panel.length() <= 1e-12 * (1 + middle)) continue;
        if (passage.radius(middle) < k_lamp_radius) continue;
        // A panel lies between the edges of the lamp's cone: dark in the middle is dark all over.
        if (source.relative_intensity(ray.at(middle) - source.position()) == 0) continue;
        while (end_index + 1 < ends.size() && ends[end_index] < middle) ++end_index;
        while (knot + 2 < profile.s.size() && profile.s[knot + 1] < middle) ++knot;
        double attenuation = largest_attenuation_;
        for (std::size_t k = 0; k < largest_per_unit_.size(); ++k)
            attenuation +=
                largest_per_unit_[k] * profile.concentration[knot * largest_per_unit_.size() + k];
        // Light path s + R: it changes by at most twice the panel's length.
        const double depth = 2 * attenuation * panel.length();
        const int pieces =
            static_cast<int>(std::min(64.0, std::ceil(depth / k_panel_optical_depth)));
        add_panel(ray, source, passage, panel, std::max(1, pieces), end_index, nodes);
    }
}

void VolumeIntegrator::surface_light(const Ray& ray, const SurfaceHit& hit,
                                     SurfaceLight& light) const {
    light_surface(
        scene_, sum_.attenuation(), ray, hit,
        [&](std::size_t lamp, std::span<double> column) {
            light_fields_[lamp]->columns(std::span<const Point3>(&hit.position, 1), column);
        },
        light);
}

}  // namespace uw
