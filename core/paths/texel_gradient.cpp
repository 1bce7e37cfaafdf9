#include "core/paths/texel_gradient.h"

#include "core/base/spectrum.h"

namespace uw {

int TexelGradient::add_vertex(int before, const PathVertex& vertex) {
    if (before == k_no_vertex) finish();
    if (count_ == corners_.size()) corners_.emplace_back();
    Corner& corner = corners_[count_];
    corner.before = before;
    corner.is_reflection = vertex.kind == PathVertex::Kind::reflected;
    if (corner.is_reflection) corner.hit = *vertex.hit;
    corner.worth.assign(bands_, 0.0);
    return static_cast<int>(count_++);
}

void TexelGradient::add(const PathContribution& term, std::span<const double> worth) {
    Corner& from = corners_[static_cast<std::size_t>(term.vertex)];
    for (std::size_t b = 0; b < bands_; ++b) from.worth[b] += worth[b];
    if (term.hit != nullptr && term.emitter != k_no_emitter) add_reflection(*term.hit, worth);
}

void TexelGradient::finish() {
    // What is worth of a turn is so of all before it.
    for (std::size_t i = count_; i-- > 0;) {
        const Corner& corner = corners_[i];
        if (corner.is_reflection) add_reflection(corner.hit, corner.worth);
        if (corner.before == k_no_vertex) continue;
        Corner& from = corners_[static_cast<std::size_t>(corner.before)];
        for (std::size_t b = 0; b < bands_; ++b) from.worth[b] += corner.worth[b];
    }
    count_ = 0;
}

void TexelGradient::add_reflection(const SurfaceHit& hit, std::span<const double> worth) {
    Spectrum by_reflectance{};
    for (std::size_t b = 0; b < bands_; ++b)
        if (hit.reflectance[b] > 0) by_reflectance[b] = worth[b] / hit.reflectance[b];
    surfaces_.add_to_texture(hit, by_reflectance, gradient_);
}

}  // namespace uw
