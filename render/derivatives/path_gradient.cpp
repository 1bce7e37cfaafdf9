#include "render/derivatives/path_gradient.h"

#include <algorithm>

#include "core/paths/guiding_distribution.h"

namespace uw {

namespace {

Vector3 direction_between(const Point3& from, const Point3& to, const Vector3& otherwise) {
    const Vector3 offset = to - from;
    const double length = glm::length(offset);
    return length > 0 ? offset / length : otherwise;
}

}  // namespace

int PathGradient::add_vertex(int before, const PathVertex& vertex) {
    if (before == k_no_vertex) finish();
    if (count_ == vertices_.size()) vertices_.emplace_back();
    Vertex& added = vertices_[count_];
    added.kind = vertex.kind;
    added.before = before;
    added.position = vertex.position;
    added.sensitivity.assign(bands_, 0.0);
    if (before != k_no_vertex) {
        const Vertex& from = vertices_[static_cast<std::size_t>(before)];
        added.in = direction_between(from.position, vertex.position, from.in);
    }
    return static_cast<int>(count_++);
}

void PathGradient::add(const PathContribution& contribution, std::span<const double> sensitivity) {
    Vertex& from = vertices_[static_cast<std::size_t>(contribution.vertex)];
    const Vector3 in = direction_between(from.position, contribution.place, from.in);
    for (std::size_t b = 0; b < bands_; ++b) from.sensitivity[b] += sensitivity[b];
    add_transmittance(from, contribution.place, in, sensitivity);
    if (contribution.emitter == k_no_emitter) return;
    const Point3 origin =
        (*tables_.scene.emitters)[contribution.emitter].origin(contribution.place);
    find_column_weights(sensitivity);
    gradient_.add_column(origin, contribution.place, weights_);
    if (contribution.hit == nullptr)
        add_scattering(contribution.place, in, direction_between(contribution.place, origin, in),
                       sensitivity);
}

void PathGradient::finish() {
    // Predecessors have smaller numbers. A vertex passes its sensitivity on to all vertices before
    // it.
    for (std::size_t i = count_; i-- > 1;) {
        const Vertex& vertex = vertices_[i];
        Vertex& from = vertices_[static_cast<std::size_t>(vertex.before)];
        for (std::size_t b = 0; b < bands_; ++b) from.sensitivity[b] += vertex.sensitivity[b];
        add_transmittance(from, vertex.position, vertex.in, vertex.sensitivity);
    }
    // Columns along the camera ray overlap: each interval between two of their ends is added once.
    const auto columns = std::span(camera_columns_).first(camera_column_count_);
    std::ranges::sort(columns, {}, &ColumnWeights::distance);
    for (std::size_t i = columns.size(); i-- > 0;) {
        if (i + 1 < columns.size())
            for (std::size_t k = 0; k < constituents_; ++k)
                columns[i].weights[k] += columns[i + 1].weights[k];
        const double begin = i > 0 ? columns[i - 1].distance : 0;
        const Vertex& camera = vertices_.front();
        gradient_.add_column(camera.position + begin * camera.in,
                             camera.position + columns[i].distance * camera.in, columns[i].weights);
    }
    count_ = camera_column_count_ = 0;
}

void PathGradient::add_transmittance(const Vertex& from, const Point3& to, const Vector3& direction,
                                     std::span<const double> sensitivity) {
    find_column_weights(sensitivity);
    if (from.kind == PathVertex::Kind::camera) {
        vertices_.front().in = direction;
        if (camera_column_count_ == camera_columns_.size()) camera_columns_.emplace_back();
        ColumnWeights& column = camera_columns_[camera_column_count_++];
        column.distance = distance(from.position, to);
        column.weights = weights_;
        return;
    }
    gradient_.add_column(from.position, to, weights_);
    if (from.kind == PathVertex::Kind::scattered)
        add_scattering(from.position, from.in, direction, sensitivity);
}

void PathGradient::find_column_weights(std::span<const double> sensitivity) {
    weights_.assign(constituents_, 0.0);
    for (std::size_t k = 0; k < constituents_; ++k)
        for (std::size_t b = 0; b < bands_; ++b)
            weights_[k] -= sensitivity[b] * tables_.attenuation.constituents[k][b];
}

void PathGradient::add_scattering(const Point3& x, const Vector3& in, const Vector3& out,
                                  std::span<const double> sensitivity) {
    const Medium& medium = *tables_.scene.medium;
    const double h = half_tangent_between(in, out);
    p_.resize(medium.phase_functions.size());
    tables_.phases.eval(std::span(&h, 1), p_);
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
            weights_[k] += sensitivity[b] * per_unit_[k] / beta;
    }
    gradient_.add_sample(x, weights_);
}

}  // namespace uw
