#include "render/derivatives/texel_gradient.h"

#include "core/base/spectrum.h"

namespace uw {

int TexelGradient::add_vertex(int before, const PathVertex& vertex) {
    if (before == k_no_vertex) finish();
    if (count_ == vertices_.size()) vertices_.emplace_back();
    Vertex& added = vertices_[count_];
    added.before = before;
    added.is_reflection = vertex.kind == PathVertex::Kind::reflected;
    if (added.is_reflection) added.hit = *vertex.hit;
    added.sensitivity.assign(bands_, 0.0);
    return static_cast<int>(count_++);
}

void TexelGradient::add(const PathContribution& contribution, std::span<const double> sensitivity) {
    Vertex& from = vertices_[static_cast<std::size_t>(contribution.vertex)];
    for (std::size_t b = 0; b < bands_; ++b) from.sensitivity[b] += sensitivity[b];
    if (contribution.hit != nullptr && contribution.emitter != k_no_emitter)
        add_reflection(*contribution.hit, sensitivity);
}

void TexelGradient::finish() {
    // A vertex passes its sensitivity on to all vertices before it.
    for (std::size_t i = count_; i-- > 0;) {
        const Vertex& vertex = vertices_[i];
        if (vertex.is_reflection) add_reflection(vertex.hit, vertex.sensitivity);
        if (vertex.before == k_no_vertex) continue;
        Vertex& from = vertices_[static_cast<std::size_t>(vertex.before)];
        for (std::size_t b = 0; b < bands_; ++b) from.sensitivity[b] += vertex.sensitivity[b];
    }
    count_ = 0;
}

void TexelGradient::add_reflection(const SurfaceHit& hit, std::span<const double> sensitivity) {
    Spectrum by_reflectance{};
    for (std::size_t b = 0; b < bands_; ++b)
        if (hit.reflectance[b] > 0) by_reflectance[b] = sensitivity[b] / hit.reflectance[b];
    surfaces_.add_to_texture(hit, by_reflectance, gradient_);
}

}  // namespace uw
