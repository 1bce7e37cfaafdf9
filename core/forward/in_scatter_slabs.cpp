#include "core/forward/in_scatter_slabs.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace uw {

void LampPaths::add_mean(double share, const Point3& x, WaterPath& path) const {
    thread_local std::vector<double> column;
    column.assign(path.columns.size(), 0.0);
    const double each = share / static_cast<double>(scene_.lamps->size());
    for (std::size_t j = 0; j < scene_.lamps->size(); ++j) {
        if (!column.empty()) column_(j, x, column);
        path.add(each, distance((*scene_.lamps)[j].position(), x), column);
    }
}

/// Stretches of one ray between neighbouring faces, parts of layers and ends.
struct InScatterSlabs::Cells {
    double begin = 0;                // of the first [m]
    std::vector<double> ends;        // of each
    std::vector<double> visible;     // share of the pixel that sees it
    std::vector<std::size_t> layer;  // counted from the first asked for
    InScatter light;                 // from `begin` to each end
};

InScatterSlabs::InScatterSlabs(const LitScene& scene, const Integrator& integrator,
                               const LampPaths& paths, const Affine& world_from_camera,
                               std::vector<double> faces, bool shells, int cells,
                               const SensorModel& sensor)
    : scene_(scene),
      integrator_(integrator),
      paths_(paths),
      camera_from_world_(world_from_camera.inverse()),
      faces_(std::move(faces)),
      shells_(shells),
      cells_(cells),
      attenuation_(*scene.medium),
      sensor_(sensor) {}

void InScatterSlabs::gather(const Ray& ray, std::span<const double> ends,
                            std::span<const double> shares, std::size_t first, std::size_t last,
                            std::vector<SlabLight>& layers) const {
    thread_local Cells cells;
    layers.resize(last - first);
    for (SlabLight& layer : layers) {
        layer.lamps.assign(scene_.lamps->size(), Spectrum{});
        layer.weight = Spectrum{};
        layer.to_lamps.reset(attenuation_.constituents.size());
        layer.to_camera.reset(attenuation_.constituents.size());
    }
    place_cells(ray, ends, shares, first, last, cells);
    if (cells.ends.empty()) return;
    integrator_.in_scatter_from(ray, cells.begin, cells.ends, cells.light);
    fill_layers(ray, cells, layers);
}

void InScatterSlabs::place_cells(const Ray& ray, std::span<const double> ends,
                                 std::span<const double> shares, std::size_t first,
                                 std::size_t last, Cells& cells) const {
    cells.ends.clear();
    cells.visible.clear();
    cells.layer.clear();
    const RayDepth depth = shells_ ? RayDepth::from_origin() : RayDepth(camera_from_world_, ray);
    if (depth.cosine() <= 0) return;
    const auto face = [&](std::size_t i) { return std::max(0.0, depth.distance(faces_[i])); };
    cells.begin = face(first);
    double begin = cells.begin;
    // Samples whose ray misses the water leave the shares short of 1.
    double visible = std::accumulate(shares.begin(), shares.end(), 0.0);
    std::size_t end = 0;
    const auto pass_ends = [&](double s) {
        for (; end < ends.size() && ends[end] <= s; ++end) visible -= shares[end];
    };
    pass_ends(begin);
    for (std::size_t i = first; i < last && end < ends.size(); ++i) {
        const double near = face(i), far = face(i + 1);
        for (int part = 1; part <= cells_ && end < ends.size(); ++part) {
            const double behind = part == cells_ ? far : near + (far - near) * part / cells_;
            while (end < ends.size() && begin < behind) {
                const double until = std::min(behind, ends[end]);
                cells.ends.push_back(until);
                cells.visible.push_back(visible);
                cells.layer.push_back(i - first);
                begin = until;
                pass_ends(until);
            }
        }
    }
}

void InScatterSlabs::fill_layers(const Ray& ray, const Cells& cells,
                                 std::vector<SlabLight>& layers) const {
    const std::size_t constituents = attenuation_.constituents.size();
    thread_local WaterPath path, part, lit, seen;
    path.reset(constituents);
    part.reset(constituents);
    path.length = cells.begin;
    if (constituents > 0) scene_.field->column(ray.origin, ray.at(cells.begin), path.columns);
    for (std::size_t i = 0; i < cells.ends.size();) {
        SlabLight& layer = layers[cells.layer[i]];
        lit.reset(constituents);
        seen.reset(constituents);
        double light = 0, length = 0;
        for (const std::size_t of = cells.layer[i]; i < cells.ends.size() && cells.layer[i] == of;
             ++i) {
            const double begin = path.length;
            part.length = cells.ends[i] - begin;
            if (constituents > 0)
                scene_.field->column(ray.at(begin), ray.at(cells.ends[i]), part.columns);
            add_weight(path, part, cells.visible[i], layer.weight);
            const double gained = add_light(cells, i, layer.lamps);
            const double stretch = cells.visible[i] * part.length;
            light += gained;
            length += stretch;
            path.add(0.5, part.length, part.columns);  // to the middle of the cell
            lit.add(gained, path.length, path.columns);
            seen.add(stretch, path.length, path.columns);
            path.add(0.5, part.length, part.columns);
            path.length = cells.ends[i];
        }
        // Where the layer is dark its middle is as good a place as any for what others spread.
        if (light > 0)
            layer.to_camera.add(1 / light, lit.length, lit.columns);
        else if (length > 0)
            layer.to_camera.add(1 / length, seen.length, seen.columns);
        if (light > 0) paths_.add_mean(1, ray.at(layer.to_camera.length), layer.to_lamps);
    }
}

void InScatterSlabs::add_weight(const WaterPath& path, const WaterPath& part, double share,
                                Spectrum& weight) const {
    const double end = path.length + part.length;
    const double stretch = share * part.length * sensor_.mean_surface_factor(path.length, end);
    for (int band = 0; band < attenuation_.band_count; ++band) {
        const double tau = attenuation_.optical_depth(band, path.length, path.columns);
        const double more = attenuation_.optical_depth(band, part.length, part.columns);
        // As if e^-tau fell exponentially across the cell: exact where the water is uniform.
        const double mean = more > 0 ? -std::expm1(-more) / more : 1.0;
        weight[static_cast<std::size_t>(band)] += stretch * std::exp(-tau) * mean;
    }
}

double InScatterSlabs::add_light(const Cells& cells, std::size_t i, std::vector<Spectrum>& lamps) {
    double sum = 0;
    for (std::size_t j = 0; j < lamps.size(); ++j) {
        for (std::size_t b = 0; b < k_max_bands; ++b) {
            const double before = i == 0 ? 0.0 : cells.light.at(i - 1, j)[b];
            // A difference may be rounded to below zero; light does not fall there.
            const double more = cells.visible[i] * std::max(0.0, cells.light.at(i, j)[b] - before);
            lamps[j][b] += more;
            sum += more;
        }
    }
    return sum;
}

}  // namespace uw
