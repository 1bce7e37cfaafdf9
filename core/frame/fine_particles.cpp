#include "core/frame/fine_particles.h"

#include <algorithm>
#include <cmath>

namespace uw {

namespace {

// Of the greatest light that particles of a square take away, the share by which interpolation may
// miss it: what is found is a cloud beside the rays, not how its light varies.
constexpr double k_missed = 0.25;
// Less than that, of all light, is not looked for.
constexpr double k_least = 1e-4;
// Where there are particles everywhere, of which the least take more than this share of what the
// most do, they hide what is smaller than the first, wider probes.
constexpr double k_even = 0.5;

double lerp(double a, double b, double t) {
    return a + t * (b - a);
}

}  // namespace

FineParticles::FineParticles(const RaySource& rays, const LitScene& scene)
    : rays_(rays),
      field_(scene.field && !scene.field->bounds().empty() ? scene.field : nullptr),
      attenuation_(*scene.medium) {
    if (field_) column_.resize(static_cast<std::size_t>(field_->constituent_count()));
}

void FineParticles::begin(const PixelWindow& tile, int edge, double reach) {
    if (!field_) return;
    tile_ = tile;
    reach_ = reach;
    taken_.assign(edge / k_spacing + 1, edge / k_spacing + 1, -1);
}

// The share of light that the particles along a probe take away.
double FineParticles::taken(int i, int j) {
    double& known = taken_(i / k_spacing, j / k_spacing);
    if (known >= 0) return known;
    known = 0;
    const std::optional<Ray> ray = rays_.refracted_ray(tile_.x0 + i + 0.5, tile_.y0 + j + 0.5);
    if (!ray) return known;
    // As far as there are any.
    const Bounds bounds = field_->bounds();
    const double end = std::min(reach_, distance(ray->origin, bounds.center()) +
                                            0.5 * glm::length(bounds.max - bounds.min));
    field_->column(ray->origin, ray->at(end), column_);
    for (int b = 0; b < attenuation_.band_count; ++b)
        known -= std::expm1(-attenuation_.optical_depth(static_cast<std::size_t>(b), 0, column_)) /
                 attenuation_.band_count;
    return known;
}

bool FineParticles::has_any(int i, int j, int size, int spacing) {
    if (!field_) return false;
    // Tiles end with the image.
    const Square square{i, j, std::min(size, tile_.width() - i),
                        std::min(size, tile_.height() - j)};
    for (const int step : {2 * k_spacing, k_spacing}) {
        if (step >= spacing) continue;
        const auto [least, most] = range(square, step);
        if (most >= k_least && differs(square, step, spacing, k_missed * most)) return true;
        if (least > k_even * most) return false;
    }
    return false;
}

// Of what the probes `step` pixels apart say.
Interval FineParticles::range(const Square& square, int step) {
    Interval found{1, 0};
    for (int y = 0; y <= square.height; y += step) {
        for (int x = 0; x <= square.width; x += step) {
            const double here = taken(square.x + x, square.y + y);
            found = {std::min(found.begin, here), std::max(found.end, here)};
        }
    }
    return found;
}

bool FineParticles::differs(const Square& square, int step, int spacing, double allowed) {
    for (int y = 0; y < square.height; y += step) {
        for (int x = 0; x < square.width; x += step) {
            const int left = square.x + x - x % spacing, top = square.y + y - y % spacing;
            const double u = static_cast<double>(x % spacing) / spacing;
            const double v = static_cast<double>(y % spacing) / spacing;
            const double above = lerp(taken(left, top), taken(left + spacing, top), u);
            const double below =
                lerp(taken(left, top + spacing), taken(left + spacing, top + spacing), u);
            const double here = taken(square.x + x, square.y + y);
            if (std::abs(here - lerp(above, below, v)) > allowed) return true;
        }
    }
    return false;
}

}  // namespace uw
