#include "core/passes/forward_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace uw {

void LampPaths::add_mean(double weight, const Point3& x, WaterPath& path) const {
    std::vector<double> column(path.columns.size());
    const double each = weight / static_cast<double>(scene_.lamp_count());
    for (std::size_t j = 0; j < scene_.emitters->size(); ++j) {
        const Lamp& emitter = (*scene_.emitters)[j];
        if (!column.empty()) column_(j, x, column);
        path.add(each * emitter.fraction(), distance(emitter.origin(x), x), column);
    }
}

InScatterSlabs::InScatterSlabs(const LitScene& scene, const Integrator& integrator,
                               const LampPaths& paths, const Affine& world_from_camera,
                               std::vector<double> faces, bool shells, const SensorModel& sensor)
    : scene_(scene),
      integrator_(integrator),
      paths_(paths),
      camera_from_world_(world_from_camera.inverse()),
      faces_(std::move(faces)),
      shells_(shells),
      attenuation_(*scene.medium),
      sensor_(sensor) {}

void InScatterSlabs::join_pairs(double end, const Interval& kept) {
    std::vector<double> joined;
    bool dropped = false;  // whether the previous face was dropped
    for (std::size_t i = 0; i < faces_.size(); ++i) {
        const double face = faces_[i];
        dropped = !dropped && i > 0 && i + 1 < faces_.size() && faces_[i + 1] < end &&
                  face != kept.begin && face != kept.end;
        if (!dropped) joined.push_back(face);
    }
    faces_ = std::move(joined);
}

void InScatterSlabs::integrate(const Ray& ray, double end, std::size_t first, std::size_t last,
                               std::vector<SlabLight>& slabs) const {
    const std::size_t constituents = attenuation_.constituents.size();
    slabs.resize(last - first);
    for (SlabLight& slab : slabs) {
        slab.visible = false;
        slab.lamps.assign(scene_.lamp_count(), Spectrum{});
        slab.weight = Spectrum{};
        slab.to_lamps.reset(constituents);
        slab.to_camera.reset(constituents);
    }
    const RayDepth along = depth(ray);
    if (along.cosine() <= 0) return;
    const auto distance_of = [&](std::size_t face) {
        return std::max(0.0, along.distance(faces_[face]));
    };
    const double start = distance_of(first);
    std::vector<double> ends;
    ends.reserve(last - first);
    for (std::size_t i = first; i < last && distance_of(i) < end; ++i)
        ends.push_back(std::min(end, distance_of(i + 1)));
    // Slabs that lie entirely before the start of the ray in water are empty.
    const auto empty = static_cast<std::size_t>(
        std::find_if(ends.begin(), ends.end(), [&](double s) { return s > start; }) - ends.begin());
    if (empty == ends.size()) return;
    InScatter light;
    integrator_.in_scatter_from(ray, start, std::span(ends).subspan(empty), light);

    WaterPath path;
    path.reset(constituents);
    path.length = start;
    if (constituents > 0) scene_.field->column(ray.origin, ray.at(start), path.columns);
    double begin = start;
    for (std::size_t i = empty; i < ends.size(); ++i) {
        SlabLight& slab = slabs[i];
        slab.visible = true;
        for (std::size_t j = 0; j < slab.lamps.size(); ++j) {
            slab.lamps[j] = light.at(i - empty, j);
            if (i > empty) slab.lamps[j] -= light.at(i - empty - 1, j);
        }
        fill_slab(ray, begin, ends[i], distance_of(first + i + 1), path, slab);
        begin = ends[i];
    }
}

void InScatterSlabs::fill_slab(const Ray& ray, double begin, double end, double behind,
                               WaterPath& path, SlabLight& slab) const {
    WaterPath part, whole;
    const auto measure = [&](double to, WaterPath& piece) {
        piece.reset(attenuation_.constituents.size());
        piece.length = to - begin;
        if (!piece.columns.empty()) scene_.field->column(ray.at(begin), ray.at(to), piece.columns);
    };
    measure(end, part);
    measure(behind, whole);
    slab.weight = weight(path, whole);
    const Spectrum visible = weight(path, part);
    constexpr double k_min = std::numeric_limits<float>::min();
    for (Spectrum& lamp : slab.lamps)
        for (std::size_t b = 0; b < static_cast<std::size_t>(attenuation_.band_count); ++b)
            // Cumulative in-scattering never decreases, so negative differences are due to
            // rounding.
            lamp[b] = visible[b] > k_min ? std::max(0.0, lamp[b]) / visible[b] : 0.0;
    path.add(0.5, part.length, part.columns);  // to the middle of the visible part
    slab.to_camera.add(1, path.length, path.columns);
    paths_.add_mean(1, ray.at(path.length), slab.to_lamps);
    path.add(0.5, part.length, part.columns);
}

Spectrum InScatterSlabs::weight(const WaterPath& path, const WaterPath& part) const {
    const double length =
        part.length * sensor_.mean_surface_factor(path.length, path.length + part.length);
    return per_band(static_cast<std::size_t>(attenuation_.band_count), [&](std::size_t band) {
        const double tau = attenuation_.optical_depth(band, path.length, path.columns);
        const double more = attenuation_.optical_depth(band, part.length, part.columns);
        // This assumes that e^-tau falls exponentially along the segment, which is exact in uniform
        // water.
        const double mean = more > 0 ? -std::expm1(-more) / more : 1.0;
        return length * std::exp(-tau) * mean;
    });
}

PathScatter::PathScatter(const ForwardScatterDesc& desc, const ScatterPlane& plane,
                         const Medium& medium, double spacing)
    : PathScatter(ForwardScatter(desc, plane, spacing), medium,
                  SplineLine::node_count(plane.width, spacing),
                  SplineLine::node_count(plane.height, spacing)) {}

PathScatter::PathScatter(ForwardScatter scatter, const Medium& medium, int width, int height)
    : scatter_(std::move(scatter)),
      attenuation_(medium),
      uniform_b_(medium.uniform.total_scattering()) {
    for (const Constituent& constituent : medium.constituents)
        constituent_b_.push_back(constituent.per_unit.total_scattering());
    if (constituent_b_.empty()) return;
    blur_length_.assign(width, height);
    optical_depth_.assign(width, height);
}

void PathScatter::add(std::size_t band, const ImagePlane& light, const PathImage& paths,
                      bool means) {
    const double c = attenuation_.uniform[band];
    if (constituent_b_.empty()) {
        scatter_.add({light.values(), paths.length().values(), {}, c}, means);
        return;
    }
    constexpr std::size_t k_block = 1 << 14;
    parallel_for((light.size() + k_block - 1) / k_block, [&](std::size_t block) {
        const std::size_t end = std::min(light.size(), (block + 1) * k_block);
        for (std::size_t i = block * k_block; i < end; ++i) {
            double blur = static_cast<double>(paths.length()[i]);
            double tau = c * blur;
            for (std::size_t k = 0; k < constituent_b_.size(); ++k) {
                const auto column = static_cast<double>(paths.column(k)[i]);
                blur += constituent_b_[k][band] / uniform_b_[band] * column;
                tau += attenuation_.constituents[k][band] * column;
            }
            blur_length_[i] = static_cast<float>(blur);
            optical_depth_[i] = static_cast<float>(tau);
        }
    });
    scatter_.add({light.values(), blur_length_.values(), optical_depth_.values(), c}, means);
}

void check_blur_length(const Medium& medium, const SourceLocation& where) {
    if (medium.constituents.empty()) return;
    const Spectrum b = medium.uniform.total_scattering();
    for (std::size_t band = 0; band < medium.wavelengths_nm.size(); ++band)
        if (!(b[band] > 0))
            throw InputError(
                fmt::format("{}: with volumes, the blur length is defined by the scattering of the "
                            "water itself, which is 0 at {:g} nm; give water.particles or "
                            "water.scattering, or K: 0",
                            where, medium.wavelengths_nm[band]));
}

void VisibleWater::set(std::size_t pixel, const PixelView& view, const RayDepth& depth) {
    const std::size_t count = view.distances.size();
    if (count == 0 || depth.cosine() <= 0) return;
    std::size_t behind = count;  // the first distance behind the widest gap
    double widest = 1;
    for (std::size_t i = 1; i < count; ++i) {
        const double ratio = view.distances[i] / view.distances[i - 1];
        if (ratio <= widest) continue;
        widest = ratio;
        behind = i;
    }
    const auto store = [&](std::size_t part, std::size_t begin, std::size_t end) {
        double fraction = 0, sum = 0;
        for (std::size_t i = begin; i < end; ++i) {
            fraction += view.weights[i];
            sum += view.weights[i] * depth.z(view.distances[i]);
        }
        if (!(fraction > 0)) return;
        fractions_[pixel][part] = static_cast<float>(fraction);
        depths_[part][pixel] = static_cast<float>(sum / fraction);
    };
    store(0, 0, behind);
    store(1, behind, count);
}

VisibleWater::Extent VisibleWater::extent() const {
    Extent extent;
    for (std::size_t i = 0; i < size(); ++i) {
        constexpr double k_whole = 1 - 1e-6;
        if (alpha(i) < k_whole) extent.nearest = -std::numeric_limits<double>::infinity();
        for_each(i, [&](double, double end) {
            extent.nearest = std::min(extent.nearest, end);
            extent.farthest = std::max(extent.farthest, end);
        });
    }
    return extent;
}

}  // namespace uw
