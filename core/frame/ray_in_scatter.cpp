#include "core/frame/ray_in_scatter.h"

#include <algorithm>
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

void RayInScatter::gather(const Ray& ray, std::span<const double> distances,
                          std::span<double> rows) const {
    thread_local std::vector<double> stops;
    thread_local InScatter light;
    const Interval slab = parts_.first_slab ? first_slab_along(ray) : Interval{};
    stops.assign(distances.begin(), distances.end());
    const double last = *std::max_element(distances.begin(), distances.end());
    for (const double face : {slab.begin, slab.end})
        if (face > 0 && face < last) stops.push_back(face);
    std::sort(stops.begin(), stops.end());
    stops.erase(std::unique(stops.begin(), stops.end()), stops.end());
    integrator_.in_scatter(ray, stops, light);

    const auto stop_at = [&](double distance) {
        return static_cast<std::size_t>(std::lower_bound(stops.begin(), stops.end(), distance) -
                                        stops.begin());
    };
    std::fill(rows.begin(), rows.end(), 0.0);
    for (std::size_t i = 0; i < distances.size(); ++i) {
        double* row = &rows[i * row_size()];
        const std::size_t stop = stop_at(distances[i]);
        for (std::size_t j = 0; j < lamps_; ++j) {
            double* group = row + (parts_.lamps ? j : 0) * bands_;
            const Spectrum& in = light.at(stop, j);
            for (std::size_t b = 0; b < bands_; ++b) group[b] += in[b];
        }
        const double end = std::min(slab.end, distances[i]);
        if (!(slab.begin < end)) continue;
        double* first = row + groups_ * bands_;
        for (std::size_t j = 0; j < lamps_; ++j) {
            const Spectrum& behind = light.at(stop_at(end), j);
            for (std::size_t b = 0; b < bands_; ++b) first[b] += behind[b];
            if (slab.begin <= 0) continue;
            const Spectrum& before = light.at(stop_at(slab.begin), j);
            for (std::size_t b = 0; b < bands_; ++b) first[b] -= before[b];
        }
    }
}

void RayInScatter::gather(const PixelView& view, std::span<double> row) const {
    std::fill(row.begin(), row.end(), 0.0);
    if (view.ends.empty()) return;
    thread_local std::vector<double> rows;
    rows.resize(view.ends.size() * row_size());
    gather(*view.ray, view.ends, rows);
    for (std::size_t end = 0; end < view.ends.size(); ++end)
        for (std::size_t k = 0; k < row.size(); ++k)
            row[k] += view.shares[end] * rows[end * row.size() + k];
}

}  // namespace uw
