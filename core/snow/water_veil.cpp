#include "core/snow/water_veil.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/parallel.h"

namespace uw {

namespace {

// Pixels between nodes, over the whole image: a particle outside a crop may reach into it.
constexpr int k_spacing = 32;
constexpr int k_distances = 24;
constexpr double k_nearest = 0.02, k_last = 200;  // m

double mean_of(const Spectrum& light) {
    return std::accumulate(light.begin(), light.end(), 0.0);
}

}  // namespace

WaterVeil::WaterVeil(const RaySource& rays, const Integrator& integrator,
                     const std::function<double(double distance)>& depth) {
    for (int i = 0; i < k_distances; ++i)
        distances_.push_back(k_nearest * std::pow(k_last / k_nearest, i / (k_distances - 1.0)));
    const int columns = rays.width() / k_spacing + 2;
    const int rows = rays.height() / k_spacing + 2;
    nodes_.assign(columns, rows, std::vector<Light>(distances_.size()));
    parallel_for(nodes_.size(), [&](std::size_t node) {
        const int i = static_cast<int>(node) % columns;
        const int j = static_cast<int>(node) / columns;
        const auto ray = rays.refracted_ray(std::min(i * k_spacing, rays.width()),
                                            std::min(j * k_spacing, rays.height()));
        if (!ray) return;
        thread_local InScatter light;
        integrator.in_scatter(*ray, distances_, light);
        Light sum;
        double before = 0, from = 0;
        for (std::size_t d = 0; d < distances_.size(); ++d) {
            double all = 0;
            for (std::size_t lamp = 0; lamp < light.lamp_count(); ++lamp)
                all += mean_of(light.at(d, lamp));
            sum.all = all;
            sum.transmitted +=
                std::max(0.0, all - before) * std::exp(-depth(0.5 * (from + distances_[d])));
            nodes_[node][d] = sum;
            before = all;
            from = distances_[d];
        }
    });
}

WaterVeil::Light WaterVeil::light_up_to(double x, double y, double distance) const {
    const double u = std::clamp(x / k_spacing, 0.0, nodes_.width() - 1.001);
    const double v = std::clamp(y / k_spacing, 0.0, nodes_.height() - 1.001);
    const int i = static_cast<int>(u), j = static_cast<int>(v);
    const auto next = std::ranges::upper_bound(distances_, distance);
    const auto at = static_cast<std::size_t>(next - distances_.begin());
    // Linear between two distances, and from 0 at the first.
    const double begin = at == 0 ? 0 : distances_[at - 1];
    const double share =
        at == distances_.size() ? 0 : (distance - begin) / (distances_[at] - begin);
    Light sum;
    for (const int dy : {0, 1})
        for (const int dx : {0, 1}) {
            const double weight = (dx == 0 ? i + 1 - u : u - i) * (dy == 0 ? j + 1 - v : v - j);
            const std::vector<Light>& node = nodes_(i + dx, j + dy);
            const Light before = at == 0 ? Light{} : node[at - 1];
            const Light after = at == node.size() ? before : node[at];
            sum.all += weight * ((1 - share) * before.all + share * after.all);
            sum.transmitted +=
                weight * ((1 - share) * before.transmitted + share * after.transmitted);
        }
    return sum;
}

double WaterVeil::share_beyond(double x, double y, double distance, double end) const {
    const double all = light_up_to(x, y, end).all;
    if (!(all > 0)) return 0;
    return std::clamp(1 - light_up_to(x, y, distance).all / all, 0.0, 1.0);
}

double WaterVeil::mean_transmittance(double x, double y, double end) const {
    const Light light = light_up_to(x, y, end);
    return light.all > 0 && light.transmitted > 0 ? light.transmitted / light.all : 1;
}

}  // namespace uw
