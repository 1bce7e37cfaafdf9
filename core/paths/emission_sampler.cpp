#include "core/paths/emission_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/parallel.h"
#include "core/light/half_tangent_density.h"
#include "core/light/ray_panels.h"

namespace uw {

namespace {

struct EmissionCellOptions {
    /// About the number of cells of a volume's bounds. More follow its flames more closely, and
    /// take longer to cross.
    double cells = 32768;
    /// Places at which a cell's emission is looked up, along each axis: one per voxel, within these
    /// limits.
    int min_places = 2, max_places = 8;
    /// The emission that is assumed of a dark cell beside a lit one, relative to that: the places
    /// may have missed a flame's edge, and what shines where nothing is expected would be lost.
    float at_edge = 0.02F;
    /// EmissionSampler::mean has so many cells along each axis, and a mean so many directions.
    int means_along = 16, directions = 20;
    /// Places in the light from which its escape is judged.
    int escapes = 256;
};
constexpr EmissionCellOptions k_emission_cells;

// Calls visit(cell, begin, end) for the cells that a ray crosses up to `max_distance`, in order,
// while it returns true (Amanatides and Woo 1987).
template <class Visit>
void cross(const Ray& ray, const Bounds& bounds, const Vector3& edge,
           const std::array<int, 3>& count, double max_distance, const Visit& visit) {
    const Interval part = inside(ray, bounds);
    double s = std::max(part.begin, 0.0);
    const double end = std::min(part.end, max_distance);
    if (!(end > s)) return;
    std::array<int, 3> at{}, step{};
    Vector3 next(k_far), stride(k_far);
    const Vector3 place = (ray.at(s) - bounds.min) / edge;
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        at[i] = std::clamp(static_cast<int>(place[axis]), 0, count[i] - 1);
        const double direction = ray.direction[axis];
        if (direction == 0) continue;
        step[i] = direction > 0 ? 1 : -1;
        const double face = bounds.min[axis] + (at[i] + (direction > 0 ? 1 : 0)) * edge[axis];
        next[axis] = (face - ray.origin[axis]) / direction;
        stride[axis] = edge[axis] / std::abs(direction);
    }
    for (;;) {
        const int axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
        const auto i = static_cast<std::size_t>(axis);
        const double leave = std::min(next[axis], end);
        if (leave > s) {
            const std::size_t cell =
                (static_cast<std::size_t>(at[2]) * static_cast<std::size_t>(count[1]) +
                 static_cast<std::size_t>(at[1])) *
                    static_cast<std::size_t>(count[0]) +
                static_cast<std::size_t>(at[0]);
            if (!visit(cell, s, leave)) return;
            s = leave;
        }
        if (!(next[axis] < end)) return;
        at[i] += step[i];
        if (at[i] < 0 || at[i] >= count[i]) return;
        next[axis] += stride[axis];
    }
}

// `count` directions, evenly spread: a golden spiral.
Vector3 spiral_direction(int i, int count) {
    const double cosine = 1 - 2 * (i + 0.5) / count, sine = std::sqrt(1 - cosine * cosine);
    const double azimuth = 2 * std::numbers::pi * i / std::numbers::phi;
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

// Beyond this optical depth, light on a segment is not looked for by its cells' masses: e^-20.
constexpr double k_max_depth_of_emission = 20;

}  // namespace

EmissionSampler::EmissionSampler(const LitScene& scene) {
    if (!scene.emissions) return;
    for (const SceneEmission& emission : *scene.emissions) {
        const auto emitter = std::ranges::find(*scene.emitters, emission.lamp, &Lamp::index);
        if (emitter == scene.emitters->end() || !emitter->is_met_by_paths()) continue;
        Volume volume = make_volume(scene, emission);
        spheres_.resize(std::max(spheres_.size(), emission.lamp + 1));
        if (volume.lit.empty()) continue;
        spheres_[emission.lamp] = sphere_of(volume);
        spheres_[emission.lamp].escaping = escaping_fraction(volume);
        volumes_.push_back(std::move(volume));
    }
    if (!empty()) fill_means(scene);
}

Point3 EmissionSampler::Volume::at(std::size_t n, const Vector3& place) const {
    const auto across = static_cast<std::size_t>(count[0]);
    const auto down = static_cast<std::size_t>(count[1]);
    return bounds.min +
           edge * (Vector3(static_cast<double>(n % across), static_cast<double>(n / across % down),
                           static_cast<double>(n / across / down)) +
                   place);
}

std::size_t EmissionSampler::Volume::lit_at(double target) const {
    const auto found = std::ranges::upper_bound(cumulative, target) - cumulative.begin();
    return std::min(static_cast<std::size_t>(found), lit.size() - 1);
}

EmissionSampler::Volume EmissionSampler::make_volume(const LitScene& scene,
                                                     const SceneEmission& emission) {
    Volume volume;
    volume.lamp = emission.lamp;
    volume.light = emission.volume;
    volume.bounds = emission.volume->field->bounds();
    const Vector3 size = volume.bounds.empty() ? Vector3(0) : volume.bounds.max - volume.bounds.min;
    if (!(size.x > 0 && size.y > 0 && size.z > 0)) return volume;
    const double edge = std::max(emission.volume->field->finest_voxel(),
                                 std::cbrt(size.x * size.y * size.z / k_emission_cells.cells));
    std::size_t cells = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        volume.count[i] = std::max(1, static_cast<int>(std::ceil(size[axis] / edge - 1e-6)));
        volume.edge[axis] = size[axis] / volume.count[i];
        cells *= static_cast<std::size_t>(volume.count[i]);
    }
    volume.cells.resize(cells);
    fill_cells(scene, volume);
    add_faint_edge(volume);
    const double of_cell = volume.edge.x * volume.edge.y * volume.edge.z;
    for (std::size_t n = 0; n < cells; ++n) {
        if (!(volume.cells[n].emission > 0)) continue;
        volume.power += of_cell * static_cast<double>(volume.cells[n].emission);
        volume.lit.push_back(n);
        volume.cumulative.push_back(volume.power);
    }
    volume.uniform_attenuation = k_far;
    for (std::size_t b = 0; b < static_cast<std::size_t>(scene.medium->band_count()); ++b)
        volume.uniform_attenuation =
            std::min(volume.uniform_attenuation, scene.medium->uniform.attenuation(b));
    return volume;
}

void EmissionSampler::fill_cells(const LitScene& scene, Volume& volume) {
    const ConcentrationField& field = *volume.light->field;
    const Medium& medium = *scene.medium;
    const auto bands = static_cast<std::size_t>(medium.band_count());
    const std::size_t constituents = medium.constituents.size();
    const double voxel = field.finest_voxel();
    const double edge = std::max({volume.edge.x, volume.edge.y, volume.edge.z});
    const int places = std::clamp(voxel > 0 ? static_cast<int>(std::ceil(edge / voxel)) : 0,
                                  k_emission_cells.min_places, k_emission_cells.max_places);
    parallel_for(volume.cells.size(), [&](std::size_t n) {
        double emission = 0;
        for (int k = 0; k < places; ++k)
            for (int j = 0; j < places; ++j)
                for (int i = 0; i < places; ++i) {
                    double value = 0;
                    field.sample(volume.at(n, Vector3(i + 0.5, j + 0.5, k + 0.5) * (1.0 / places)),
                                 std::span(&value, 1));
                    if (!(value > 0)) continue;
                    const Spectrum emitted = volume.light->emission.of(value);
                    for (const double band : emitted.first(bands)) emission += band;
                }
        std::vector<double> concentration(constituents, 0.0);
        if (constituents > 0) scene.field->sample(volume.at(n, Vector3(0.5)), concentration);
        double attenuation = 0;
        for (std::size_t b = 0; b < bands; ++b) {
            attenuation += medium.uniform.attenuation(b);
            for (std::size_t k = 0; k < constituents; ++k)
                attenuation += concentration[k] * medium.constituents[k].per_unit.attenuation(b);
        }
        const double all_bands = static_cast<double>(bands);
        volume.cells[n] = {static_cast<float>(emission / (all_bands * places * places * places)),
                           static_cast<float>(attenuation / all_bands)};
    });
}

void EmissionSampler::add_faint_edge(Volume& volume) {
    const std::vector<Cell> cells = volume.cells;
    const auto [nx, ny, nz] = volume.count;
    const auto at = [nx = nx, ny = ny](int i, int j, int k) {
        return static_cast<std::size_t>((k * ny + j) * nx + i);
    };
    for (int k = 0; k < nz; ++k)
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i) {
                float around = 0;
                for (int z = std::max(0, k - 1); z <= std::min(nz - 1, k + 1); ++z)
                    for (int y = std::max(0, j - 1); y <= std::min(ny - 1, j + 1); ++y)
                        for (int x = std::max(0, i - 1); x <= std::min(nx - 1, i + 1); ++x)
                            around = std::max(around, cells[at(x, y, z)].emission);
                float& emission = volume.cells[at(i, j, k)].emission;
                emission = std::max(emission, k_emission_cells.at_edge * around);
            }
}

EmissionSampler::Sphere EmissionSampler::sphere_of(const Volume& volume) {
    double sum = 0, square = 0;
    Vector3 mean(0);
    for (const std::size_t n : volume.lit) {
        const auto weight = static_cast<double>(volume.cells[n].emission);
        const Vector3 place = volume.at(n, Vector3(0.5)) - volume.bounds.min;
        sum += weight;
        mean += weight * place;
        square += weight * glm::dot(place, place);
    }
    mean /= sum;
    return {volume.bounds.min + mean, std::max(0.0, square / sum - glm::dot(mean, mean))};
}

double EmissionSampler::escaping_fraction(const Volume& volume) {
    double sum = 0;
    for (int i = 0; i < k_emission_cells.escapes; ++i) {
        const double target = (i + 0.5) / k_emission_cells.escapes * volume.power;
        const Point3 x = volume.at(volume.lit[volume.lit_at(target)], Vector3(0.5));
        double depth = 0;
        // Every direction is as good as any other: neighbours in the list take very different ones.
        const int scattered = i * 89 % k_emission_cells.escapes;
        cross({x, spiral_direction(scattered, k_emission_cells.escapes)}, volume.bounds,
              volume.edge, volume.count, k_far, [&](std::size_t cell, double begin, double end) {
                  depth += static_cast<double>(volume.cells[cell].attenuation) * (end - begin);
                  return depth < k_max_depth_of_emission;
              });
        sum += std::exp(-depth);
    }
    return sum / k_emission_cells.escapes;
}

void EmissionSampler::fill_means(const LitScene& scene) {
    means_bounds_ = scene.field->grids().bounds();
    if (means_bounds_.empty()) return;
    const auto along = static_cast<std::size_t>(k_emission_cells.means_along);
    const Vector3 edge = (means_bounds_.max - means_bounds_.min) / static_cast<double>(along);
    means_.resize(along * along * along);
    parallel_for(means_.size(), [&](std::size_t n) {
        const Point3 x =
            means_bounds_.min + edge * Vector3(static_cast<double>(n % along) + 0.5,
                                               static_cast<double>(n / along % along) + 0.5,
                                               static_cast<double>(n / along / along) + 0.5);
        double sum = 0;
        for (int i = 0; i < k_emission_cells.directions; ++i)
            sum += towards({x, spiral_direction(i, k_emission_cells.directions)}).radiance;
        means_[n] = static_cast<float>(sum / k_emission_cells.directions);
    });
}

double EmissionSampler::mean(const Point3& x) const {
    if (means_.empty()) return 0;
    const int along = k_emission_cells.means_along;
    const Vector3 place = (x - means_bounds_.min) / (means_bounds_.max - means_bounds_.min) *
                          static_cast<double>(along);
    std::size_t n = 0;
    for (int axis = 2; axis >= 0; --axis) {
        if (!(place[axis] >= 0 && place[axis] < along)) return 0;
        n = n * static_cast<std::size_t>(along) + static_cast<std::size_t>(place[axis]);
    }
    return static_cast<double>(means_[n]);
}

// The irradiance at x of the volume's light as a sphere in clear water, about.
double EmissionSampler::weight(const Volume& volume, const Point3& x) const {
    const Sphere& sphere = spheres_[volume.lamp];
    const Vector3 way = sphere.centre - x;
    return volume.power / (glm::dot(way, way) + sphere.square + 1e-12);
}

Vector3 EmissionSampler::sample(const Point3& x, double u, double v, double w) const {
    const Volume* volume = &volumes_.front();
    if (volumes_.size() > 1) {
        double all = 0;
        for (const Volume& each : volumes_) all += weight(each, x);
        double target = u * all;
        for (const Volume& each : volumes_) {
            const double of_each = weight(each, x);
            volume = &each;
            if (target < of_each) {
                u = target / of_each;
                break;
            }
            target -= of_each;
        }
        u = std::clamp(u, 0.0, 1.0);
    }
    const double target = u * volume->power;
    const std::size_t chosen = volume->lit_at(target);
    const double before = chosen == 0 ? 0 : volume->cumulative[chosen - 1];
    const double inside = (target - before) / (volume->cumulative[chosen] - before);
    const Point3 y = volume->at(volume->lit[chosen], Vector3(std::clamp(inside, 0.0, 1.0), v, w));
    const Vector3 way = y - x;
    const double length = glm::length(way);
    return length > 0 ? way / length : Vector3(0, 0, 1);
}

EmissionSampler::Towards EmissionSampler::towards(const Ray& ray) const {
    Towards found;
    double all = 0;
    for (const Volume& volume : volumes_) {
        const double of_volume = volumes_.size() > 1 ? weight(volume, ray.origin) : 1;
        all += of_volume;
        double transmittance = 1, before = 0, radiance = 0, moment = 0;
        cross(ray, volume.bounds, volume.edge, volume.count, k_far,
              [&](std::size_t n, double begin, double end) {
                  const Cell& cell = volume.cells[n];
                  if (before == 0) transmittance = std::exp(-volume.uniform_attenuation * begin);
                  before = end;
                  const double length = end - begin;
                  // e^-x is approximated by 1 / (1 + x).
                  const double passed = 1 / (1 + static_cast<double>(cell.attenuation) * length);
                  if (cell.emission > 0) {
                      const auto emission = static_cast<double>(cell.emission);
                      radiance += emission * transmittance * length * passed;
                      moment += emission * length * (begin * begin + begin * end + end * end) / 3;
                  }
                  transmittance *= passed;
                  return true;
              });
        found.radiance += radiance;
        found.pdf += of_volume * moment / volume.power;
    }
    if (all > 0) found.pdf /= all;
    return found;
}

void EmissionSampler::estimate(const WaterOptics& optics, const WaterSegment& segment,
                               const PathState& state, PathRandom& random, ContributionSink& sink,
                               Scratch& w) const {
    const std::size_t bands = optics.bands();
    for (const Volume& volume : volumes_) {
        const double u = random.next();
        w.pieces.clear();
        double all = 0, depth = 0;
        cross(segment.ray, volume.bounds, volume.edge, volume.count, segment.length,
              [&](std::size_t n, double begin, double end) {
                  const Cell& cell = volume.cells[n];
                  const double length = end - begin;
                  const double of_cell = static_cast<double>(cell.attenuation) * length;
                  if (cell.emission > 0) {
                      const double mass = static_cast<double>(cell.emission) * length *
                                          std::exp(-depth) / (1 + of_cell);
                      w.pieces.push_back({begin, length, mass});
                      all += mass;
                  }
                  depth += of_cell;
                  return depth < k_max_depth_of_emission;
              });
        if (!(all > 0)) continue;
        double target = u * all;
        std::size_t i = 0;
        while (i + 1 < w.pieces.size() && target >= w.pieces[i].mass) target -= w.pieces[i++].mass;
        const Scratch::Piece& piece = w.pieces[i];
        const double s = piece.begin + std::clamp(target / piece.mass, 0.0, 1.0) * piece.length;
        double value = 0;
        volume.light->field->sample(segment.ray.at(s), std::span(&value, 1));
        if (!(value > 0)) continue;
        Spectrum radiance = volume.light->emission.of(value), transmittance;
        optics.look_up(segment, s, w.point);
        optics.transmittances(s, w.point.column, transmittance);
        const double pdf = piece.mass / (all * piece.length);
        for (std::size_t b = 0; b < bands; ++b)
            radiance[b] *= state.throughput[b] * transmittance[b] / pdf;
        PathContribution contribution = state.contribution(volume.lamp, radiance.first(bands));
        contribution.is_met = true;
        contribution.place = segment.ray.at(s);
        sink.add(contribution);
    }
}

}  // namespace uw
