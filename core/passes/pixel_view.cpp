#include "core/passes/pixel_view.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace uw {

RayInScatter::RayInScatter(const Integrator& integrator, const Affine& world_from_camera,
                           const Slabs& slabs, int lamps, int bands, const InScatterParts& parts)
    : integrator_(integrator),
      camera_from_world_(world_from_camera.inverse()),
      slabs_(slabs),
      lamps_(static_cast<std::size_t>(lamps)),
      bands_(static_cast<std::size_t>(bands)),
      groups_(parts.lamps ? lamps_ : 1),
      parts_(parts) {}

Interval RayInScatter::first_slab_along(const Ray& ray) const {
    const RayDepth depth(camera_from_world_, ray);
    if (depth.cosine() <= 0) return {};
    return {std::max(0.0, depth.distance(slabs_.boundary(0))),
            std::max(0.0, depth.distance(slabs_.boundary(1)))};
}

void RayInScatter::integrate(const Ray& ray, std::span<const double> distances,
                             std::span<double> values) const {
    InScatter light;
    const Interval slab = parts_.first_slab ? first_slab_along(ray) : Interval{};
    std::vector<double> stops(distances.begin(), distances.end());
    const double last = *std::max_element(distances.begin(), distances.end());
    for (const double face : {slab.begin, slab.end})
        if (face > 0 && face < last) stops.push_back(face);
    std::sort(stops.begin(), stops.end());
    stops.erase(std::unique(stops.begin(), stops.end()), stops.end());
    integrator_.in_scatter(ray, stops, light);

    const auto light_up_to = [&](double distance, std::size_t lamp) {
        const auto stop = static_cast<std::size_t>(
            std::lower_bound(stops.begin(), stops.end(), distance) - stops.begin());
        return std::as_const(light).at(stop, lamp).first(bands_);
    };
    std::fill(values.begin(), values.end(), 0.0);
    for (std::size_t i = 0; i < distances.size(); ++i) {
        const std::span own = values.subspan(i * value_count(), value_count());
        for (std::size_t j = 0; j < lamps_; ++j)
            add(own.subspan((parts_.lamps ? j : 0) * bands_, bands_), light_up_to(distances[i], j));
        const double end = std::min(slab.end, distances[i]);
        if (!(slab.begin < end)) continue;
        const std::span first = own.subspan(groups_ * bands_, bands_);
        for (std::size_t j = 0; j < lamps_; ++j) {
            add(first, light_up_to(end, j));
            if (slab.begin > 0) subtract(first, light_up_to(slab.begin, j));
        }
    }
}

void RayInScatter::integrate(const PixelView& view, std::span<double> values) const {
    std::fill(values.begin(), values.end(), 0.0);
    if (view.distances.empty()) return;
    std::vector<double> lists(view.distances.size() * value_count());
    integrate(*view.ray, view.distances, lists);
    for (std::size_t i = 0; i < view.distances.size(); ++i)
        add_scaled(values, view.weights[i],
                   std::span(lists).subspan(i * value_count(), value_count()));
}

}  // namespace uw
