#include "render/derivatives/path_scores.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/geometry/surface_reflection.h"
#include "core/paths/guiding_distribution.h"

namespace uw {

namespace {

// Surfaces that a change does not move are hit again at the same distance, up to single precision.
constexpr double k_same_place = 1e-4;

}  // namespace

ChangedScenes::Side::Side(const LitScene& of)
    : scene(of),
      attenuation(*of.medium),
      phases(*of.medium),
      textures(of.surfaces != nullptr ? textures_of(*of.surfaces) : nullptr) {}

ChangedScenes::ChangedScenes(const LitScene& scene, std::span<const SceneChange> changes)
    : bands_(static_cast<std::size_t>(scene.medium->band_count())),
      constituents_(scene.medium->constituents.size()) {
    sides_.emplace_back(scene);
    const auto add = [&](const LitScene& side) {
        if (static_cast<std::size_t>(side.medium->band_count()) != bands_ ||
            side.medium->constituents.size() != constituents_)
            throw UsageError("what the water is made of, or its bands, changes with the number");
        if (side.emitters->size() != scene.emitters->size())
            throw UsageError("the number of lamps, or of the points that they consist of, changes");
        compare(sides_.emplace_back(side));
    };
    for (const SceneChange& change : changes) {
        add(change.less);
        add(change.more);
        steps_.push_back(change.step);
    }
    for (std::size_t j = 0; j < scene.emitters->size(); ++j)
        if ((*scene.emitters)[j].index() == first_emitters_.size()) first_emitters_.push_back(j);
}

void ChangedScenes::compare(Side& side) const {
    const LitScene& scene = base().scene;
    const auto has_same_scattering = [](const OpticalCoefficients& a,
                                        const OpticalCoefficients& b) {
        return a.scattering == b.scattering;
    };
    const Medium& medium = *side.scene.medium;
    side.has_same_attenuation = side.attenuation == base().attenuation;
    side.has_same_scattering =
        side.phases == base().phases &&
        has_same_scattering(medium.uniform, scene.medium->uniform) &&
        std::ranges::equal(medium.constituents, scene.medium->constituents, has_same_scattering,
                           &Constituent::per_unit, &Constituent::per_unit);
    side.has_same_field = side.scene.field == scene.field;
    side.has_same_surfaces = side.scene.surfaces == scene.surfaces;
    for (std::size_t j = 0; j < scene.emitters->size(); ++j)
        side.has_same_emitter.push_back((*side.scene.emitters)[j] == (*scene.emitters)[j] ? 1 : 0);
}

bool ChangedScenes::keeps_transmittance(std::size_t change) const {
    const auto keeps = [](const Side& side) {
        return side.has_same_attenuation && side.has_same_field;
    };
    return keeps(less(change)) && keeps(more(change));
}

bool ChangedScenes::keeps(const Side& side, PathVertex::Kind kind) {
    if (kind == PathVertex::Kind::scattered) return side.has_same_scattering && side.has_same_field;
    return kind != PathVertex::Kind::reflected || side.has_same_surfaces;
}

bool ChangedScenes::keeps_emitter(std::size_t change, std::size_t emitter) const {
    return less(change).has_same_emitter[emitter] != 0 &&
           more(change).has_same_emitter[emitter] != 0;
}

PathScores::Vertex& PathScores::new_vertex() {
    if (count_ == vertices_.size()) vertices_.emplace_back();
    return vertices_[count_++];
}

int PathScores::add_vertex(int before, const PathVertex& vertex) {
    which_ = {};
    const auto number = static_cast<int>(count_);
    new_vertex();
    Vertex& added = vertices_[static_cast<std::size_t>(number)];
    added.scores.assign(scenes_.changes() * scenes_.bands(), 0.0);
    const Vertex* const from =
        before == k_no_vertex ? nullptr : &vertices_[static_cast<std::size_t>(before)];
    place(added, vertex.kind, vertex.position, vertex.hit, from);
    if (from == nullptr) return number;
    std::ranges::copy(from->scores, added.scores.begin());
    add_scattering(*from, added.in, added.scores);
    add_transmittance(from->position, added.position, added.scores);
    return number;
}

void PathScores::find(const PathContribution& contribution, const EveryFew& which,
                      std::span<double> scores) {
    which_ = which;
    const Vertex& from = vertices_[static_cast<std::size_t>(contribution.vertex)];
    const bool is_event = contribution.hit != nullptr || contribution.emitter != k_no_emitter;
    PathVertex::Kind kind = PathVertex::Kind::camera;
    if (is_event)
        kind =
            contribution.hit != nullptr ? PathVertex::Kind::reflected : PathVertex::Kind::scattered;
    place(last_, kind, contribution.place, contribution.hit, &from, contribution.concentration);
    std::ranges::copy(from.scores, scores.begin());
    add_scattering(from, last_.in, scores);
    if (contribution.columns.empty()) add_transmittance(from.position, last_.position, scores);
    if (contribution.emitter != k_no_emitter)
        add_lamp(contribution, scores);
    else if (contribution.hit != nullptr)
        add_emission(last_, scores);
    else
        add_visible_lamp(contribution.lamp, scores);
}

void PathScores::place(Vertex& vertex, PathVertex::Kind kind, const Point3& position,
                       const SurfaceHit* hit, const Vertex* before,
                       std::span<const double> concentration) const {
    vertex.kind = kind;
    vertex.position = position;
    if (before != nullptr) {
        const Vector3 offset = position - before->position;
        const double length = glm::length(offset);
        vertex.in = length > 0 ? offset / length : before->in;
    }
    vertex.hits.clear();
    vertex.concentration.clear();
    const std::vector<Side>& sides = scenes_.sides_;
    if (kind == PathVertex::Kind::reflected) {
        vertex.hits.push_back(*hit);
        for (std::size_t i = 1; i < sides.size(); ++i) {
            if (sides[i].has_same_surfaces) continue;
            SurfaceHit& found = vertex.hits.emplace_back(*hit);
            SurfaceHit other;
            const double length = distance(before->position, position);
            if (sides[i].scene.surfaces->closest_hit({before->position, vertex.in},
                                                     (1 + k_same_place) * length, other) &&
                other.distance > (1 - k_same_place) * length) {
                if (sides[i].textures != nullptr)
                    sides[i].textures->filter_textures(hit->spread, other);
                found = other;
            }
        }
    }
    if (kind == PathVertex::Kind::scattered && scenes_.constituents_ > 0) {
        const std::size_t count = scenes_.constituents_;
        for (std::size_t i = 0; i < sides.size(); ++i) {
            if (i > 0 && sides[i].has_same_field) continue;
            vertex.concentration.resize(vertex.concentration.size() + count);
            sides[i].scene.field->sample(position, std::span(vertex.concentration).last(count));
        }
        // Fields of the sides differ by the difference of their values at the point.
        if (!concentration.empty())
            for (std::size_t k = 0; k < count; ++k) {
                const double more = concentration[k] - vertex.concentration[k];
                for (std::size_t i = k; i < vertex.concentration.size(); i += count)
                    vertex.concentration[i] += more;
            }
    }
}

namespace {

// The index of a side's own value; sides that share the base's value have none.
template <class Sides, class Side, class Shares>
std::size_t place_among(const Sides& sides, const Side& side, const Shares& shares) {
    if (shares(side)) return 0;
    std::size_t place = 1;
    for (const Side* other = &sides[1]; other != &side; ++other)
        if (!shares(*other)) ++place;
    return place;
}

}  // namespace

std::span<const double> PathScores::concentrations(const Side& side, const Vertex& vertex) const {
    const std::size_t count = scenes_.constituents_;
    const std::size_t place =
        place_among(scenes_.sides_, side, [](const Side& each) { return each.has_same_field; });
    return std::span(vertex.concentration).subspan(place * count, count);
}

const SurfaceHit& PathScores::hit(const Side& side, const Vertex& vertex) const {
    return vertex.hits[place_among(scenes_.sides_, side,
                                   [](const Side& each) { return each.has_same_surfaces; })];
}

void PathScores::find_column(const Side& side, const Point3& from, const Point3& to,
                             std::vector<double>& column) const {
    column.assign(scenes_.constituents_, 0.0);
    if (!column.empty()) side.scene.field->column(from, to, column);
}

void PathScores::add_transmittance(const Point3& from, const Point3& to, std::span<double> scores) {
    const std::size_t bands = scenes_.bands();
    const double length = distance(from, to);
    bool has_column = false;
    for (std::size_t i = which_.first; i < scenes_.changes(); i += which_.step) {
        if (scenes_.keeps_transmittance(i)) continue;
        if (!std::exchange(has_column, true)) find_column(scenes_.base(), from, to, base_column_);
        const auto depths = [&](const Side& side, double sign) {
            if (!side.has_same_field) find_column(side, from, to, column_);
            const std::vector<double>& columns = side.has_same_field ? base_column_ : column_;
            const double factor = -sign / scenes_.steps_[i];
            for (std::size_t b = 0; b < bands; ++b)
                scores[i * bands + b] +=
                    factor * side.attenuation.optical_depth(b, length, columns);
        };
        depths(scenes_.more(i), 1);
        depths(scenes_.less(i), -1);
    }
}

template <class Keeps, class Find>
void PathScores::add_relative(const Keeps& keeps, const Find& find, std::span<double> scores) {
    const std::size_t bands = scenes_.bands();
    Spectrum value, less, more;
    bool has_value = false;
    for (std::size_t i = which_.first; i < scenes_.changes(); i += which_.step) {
        if (keeps(i)) continue;
        if (!std::exchange(has_value, true)) find(scenes_.base(), value);
        find(scenes_.less(i), less);
        find(scenes_.more(i), more);
        for (std::size_t b = 0; b < bands; ++b)
            if (value[b] > 0)
                scores[i * bands + b] += (more[b] - less[b]) / (scenes_.steps_[i] * value[b]);
    }
}

void PathScores::add_scattering(const Vertex& vertex, const Vector3& out,
                                std::span<double> scores) {
    if (vertex.kind != PathVertex::Kind::scattered && vertex.kind != PathVertex::Kind::reflected)
        return;
    add_relative([&](std::size_t change) { return scenes_.keeps(change, vertex.kind); },
                 [&](const Side& side, Spectrum& values) { eval(side, vertex, out, values); },
                 scores);
}

void PathScores::eval(const Side& side, const Vertex& vertex, const Vector3& out,
                      Spectrum& values) {
    const std::size_t bands = scenes_.bands();
    if (vertex.kind == PathVertex::Kind::reflected) {
        const SurfaceHit& on = hit(side, vertex);
        const SurfaceSample sample{{vertex.position - on.distance * vertex.in, vertex.in}, on};
        SurfaceReflection(*side.scene.surfaces, sample, static_cast<int>(bands))
            .brdf_towards(out, values);
        const double cosine = std::max(0.0, glm::dot(on.normal, out));
        for (double& value : values.first(bands)) value *= cosine;
        return;
    }
    const Medium& medium = *side.scene.medium;
    p_.resize(medium.phase_functions.size());
    const double h = half_tangent_between(vertex.in, out);
    side.phases.eval(std::span(&h, 1), p_);
    const std::span<const double> concentration = concentrations(side, vertex);
    for (std::size_t b = 0; b < bands; ++b) {
        double beta = 0;
        for (std::size_t m = 0; m < p_.size(); ++m) {
            double scattering = medium.uniform.scattering[m][b];
            for (std::size_t k = 0; k < concentration.size(); ++k)
                scattering += concentration[k] * medium.constituents[k].per_unit.scattering[m][b];
            beta += scattering * p_[m];
        }
        values[b] = beta;
    }
}

void PathScores::eval_lamp(const Side& side, std::size_t emitter, const LampTerm* base,
                           LampTerm& term) {
    const Lamp& lamp = (*side.scene.emitters)[emitter];
    if (base != nullptr && side.has_same_emitter[emitter] != 0) {
        term.to_lamp = base->to_lamp;
        term.distance = base->distance;
        term.light = base->light;
    } else {
        const Vector3 to_lamp = lamp.origin(last_.position) - last_.position;
        const double length = glm::length(to_lamp);
        const double squared_offset = last_.kind == PathVertex::Kind::scattered
                                          ? lamp.squared_offset({last_.position, last_.in})
                                          : 0;
        term.to_lamp = to_lamp / length;
        term.distance = std::sqrt(length * length + squared_offset);
        term.light = lamp.relative_intensity(-to_lamp) * lamp.focus(last_.position) /
                     lamp.spread(term.distance);
    }
    term.intensity = lamp.axis_intensity();
    if (base != nullptr && ChangedScenes::keeps(side, last_.kind) && term.to_lamp == base->to_lamp)
        term.scattered = base->scattered;
    else
        eval(side, last_, term.to_lamp, term.scattered);
}

void PathScores::add_lamp(const PathContribution& contribution, std::span<double> scores) {
    const std::size_t bands = scenes_.bands();
    bool has_value = false;
    for (std::size_t i = which_.first; i < scenes_.changes(); i += which_.step) {
        const bool keeps_light =
            scenes_.keeps(i, last_.kind) && scenes_.keeps_emitter(i, contribution.emitter);
        if (keeps_light && scenes_.keeps_transmittance(i)) continue;
        if (!std::exchange(has_value, true))
            eval_lamp(scenes_.base(), contribution.emitter, nullptr, lamp_);
        if (keeps_light) {
            add_depth(contribution, i, lamp_.distance, lamp_.distance, scores);
            continue;
        }
        eval_lamp(scenes_.less(i), contribution.emitter, &lamp_, lamp_less_);
        eval_lamp(scenes_.more(i), contribution.emitter, &lamp_, lamp_more_);
        for (std::size_t b = 0; b < bands; ++b) {
            const double value = lamp_.value(b);
            if (value > 0)
                scores[i * bands + b] +=
                    (lamp_more_.value(b) - lamp_less_.value(b)) / (scenes_.steps_[i] * value);
        }
        add_depth(contribution, i, lamp_less_.distance, lamp_more_.distance, scores);
    }
}

void PathScores::add_depth(const PathContribution& contribution, std::size_t change,
                           double radius_less, double radius_more, std::span<double> scores) {
    const std::size_t bands = scenes_.bands();
    const Side& less = scenes_.less(change);
    const Side& more = scenes_.more(change);
    const Lamp& lamp_less = (*less.scene.emitters)[contribution.emitter];
    const Lamp& lamp_more = (*more.scene.emitters)[contribution.emitter];
    const bool is_field_same = less.has_same_field && more.has_same_field;
    const Point3 origin_less = lamp_less.origin(contribution.place);
    const Point3 origin_more = lamp_more.origin(contribution.place);
    const bool is_same = is_field_same && origin_less == origin_more;
    double path_length = 0;  // of the segment before, if the contribution's columns include it
    if (!contribution.columns.empty()) {
        const Point3& from = vertices_[static_cast<std::size_t>(contribution.vertex)].position;
        path_length = distance(from, contribution.place);
    }
    if (is_same && !contribution.columns.empty()) {
        less_.assign(contribution.columns.begin(), contribution.columns.end());
        more_ = less_;
    } else {
        find_column(less, origin_less, contribution.place, less_);
        if (is_same)
            more_ = less_;
        else
            find_column(more, origin_more, contribution.place, more_);
        if (!contribution.columns.empty()) {
            if (!is_field_same) {
                const Point3& from =
                    vertices_[static_cast<std::size_t>(contribution.vertex)].position;
                find_column(less, from, contribution.place, column_);
                add(less_, column_);
                find_column(more, from, contribution.place, column_);
                add(more_, column_);
            }
            // Centres the columns on those that the contribution was computed with.
            for (std::size_t k = 0; k < less_.size(); ++k) {
                const double missing = contribution.columns[k] - 0.5 * (less_[k] + more_[k]);
                less_[k] += missing;
                more_[k] += missing;
            }
        }
    }
    for (std::size_t b = 0; b < bands; ++b)
        scores[change * bands + b] -=
            (more.attenuation.optical_depth(b, path_length + radius_more, more_) -
             less.attenuation.optical_depth(b, path_length + radius_less, less_)) /
            scenes_.steps_[change];
}

Spectrum PathScores::emission(const Side& side, const Vertex& vertex) const {
    const SurfaceHit& on = hit(side, vertex);
    if (!on.has_material) return {};
    return side.scene.surfaces->material(on).emission;
}

void PathScores::add_emission(const Vertex& vertex, std::span<double> scores) {
    add_relative([&](std::size_t change) { return scenes_.keeps(change, vertex.kind); },
                 [&](const Side& side, Spectrum& values) { values = emission(side, vertex); },
                 scores);
}

// The appearance of a lamp depends on its power alone.
void PathScores::add_visible_lamp(std::size_t lamp, std::span<double> scores) {
    const std::size_t emitter = scenes_.first_emitters_[lamp];
    add_relative([&](std::size_t change) { return scenes_.keeps_emitter(change, emitter); },
                 [&](const Side& side, Spectrum& values) {
                     values = (*side.scene.emitters)[emitter].axis_intensity();
                 },
                 scores);
}

}  // namespace uw
