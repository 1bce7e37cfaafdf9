#include "core/paths/path_gradient.h"

#include <algorithm>

#include "core/paths/guiding_distribution.h"

namespace uw {

namespace {

Vector3 direction_between(const Point3& from, const Point3& to, const Vector3& otherwise) {
    const Vector3 way = to - from;
    const double length = glm::length(way);
    return length > 0 ? way / length : otherwise;
}

}  // namespace

int PathGradient::add_vertex(int before, const PathVertex& vertex) {
    if (before == k_no_vertex) finish();
    if (count_ == corners_.size()) corners_.emplace_back();
    Corner& corner = corners_[count_];
    corner.kind = vertex.kind;
    corner.before = before;
    corner.position = vertex.position;
    corner.worth.assign(bands_, 0.0);
    if (before != k_no_vertex) {
        const Corner& from = corners_[static_cast<std::size_t>(before)];
        corner.in = direction_between(from.position, vertex.position, from.in);
    }
    return static_cast<int>(count_++);
}

void PathGradient::add(const PathContribution& term, std::span<const double> worth) {
    Corner& from = corners_[static_cast<std::size_t>(term.vertex)];
    const Vector3 in = direction_between(from.position, term.place, from.in);
    for (std::size_t b = 0; b < bands_; ++b) from.worth[b] += worth[b];
    add_way(from, term.place, in, worth);
    if (term.emitter == k_no_emitter) return;
    const Point3 origin = (*tables_.scene.emitters)[term.emitter].origin(term.place);
    find_column_weights(worth);
    gradient_.add_column(origin, term.place, weights_);
    if (term.hit == nullptr)
        add_scattering(term.place, in, direction_between(term.place, origin, in), worth);
}

void PathGradient::finish() {
    // Those that came later lie farther away. What is worth of a turn is so of all before it.
    for (std::size_t i = count_; i-- > 1;) {
        const Corner& corner = corners_[i];
        Corner& from = corners_[static_cast<std::size_t>(corner.before)];
        for (std::size_t b = 0; b < bands_; ++b) from.worth[b] += corner.worth[b];
        add_way(from, corner.position, corner.in, corner.worth);
    }
    // Along the camera's ray, each stretch once.
    const auto reaches = std::span(reaches_).first(reach_count_);
    std::ranges::sort(reaches, {}, &Reach::distance);
    for (std::size_t i = reaches.size(); i-- > 0;) {
        if (i + 1 < reaches.size())
            for (std::size_t k = 0; k < constituents_; ++k)
                reaches[i].weights[k] += reaches[i + 1].weights[k];
        const double begin = i > 0 ? reaches[i - 1].distance : 0;
        const Corner& camera = corners_.front();
        gradient_.add_column(camera.position + begin * camera.in,
                             camera.position + reaches[i].distance * camera.in, reaches[i].weights);
    }
    count_ = reach_count_ = 0;
}

void PathGradient::add_way(const Corner& from, const Point3& to, const Vector3& direction,
                           std::span<const double> worth) {
    find_column_weights(worth);
    if (from.kind == PathVertex::Kind::camera) {
        corners_.front().in = direction;
        if (reach_count_ == reaches_.size()) reaches_.emplace_back();
        Reach& reach = reaches_[reach_count_++];
        reach.distance = distance(from.position, to);
        reach.weights = weights_;
        return;
    }
    gradient_.add_column(from.position, to, weights_);
    if (from.kind == PathVertex::Kind::scattered)
        add_scattering(from.position, from.in, direction, worth);
}

void PathGradient::find_column_weights(std::span<const double> worth) {
    weights_.assign(constituents_, 0.0);
    for (std::size_t k = 0; k < constituents_; ++k)
        for (std::size_t b = 0; b < bands_; ++b)
            weights_[k] -= worth[b] * tables_.attenuation.constituents[k][b];
}

void PathGradient::add_scattering(const Point3& x, const Vector3& in, const Vector3& out,
                                  std::span<const double> worth) {
    const Medium& medium = *tables_.scene.medium;
    const double h = half_tangent_between(in, out);
    p_.resize(medium.phase_functions.size());
    tables_.phases.evaluate(std::span(&h, 1), p_);
    concentration_.resize(constituents_);
    per_unit_.resize(constituents_);
    tables_.scene.field->sample(x, concentration_);
    weights_.assign(constituents_, 0.0);
    for (std::size_t b = 0; b < bands_; ++b) {
        double beta = 0;
        for (std::size_t m = 0; m < p_.size(); ++m) beta += medium.uniform.scattering[m][b] * p_[m];
        for (std::size_t k = 0; k < constituents_; ++k) {
            per_unit_[k] = 0;
            for (std::size_t m = 0; m < p_.size(); ++m)
                per_unit_[k] += medium.constituents[k].per_unit.scattering[m][b] * p_[m];
            beta += concentration_[k] * per_unit_[k];
        }
        if (!(beta > 0)) continue;
        for (std::size_t k = 0; k < constituents_; ++k)
            weights_[k] += worth[b] * per_unit_[k] / beta;
    }
    gradient_.add_sample(x, weights_);
}

}  // namespace uw
