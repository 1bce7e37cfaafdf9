#include "core/paths/surface_halo.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/base/parallel.h"
#include "core/paths/point_spread.h"

namespace uw {

namespace {

// The levels of the blur are fitted for so many angles of cells per octave, and interpolated.
constexpr double k_scales_of_octave = 4;
// Weights below this are left out, relative to the surface's own light.
constexpr float k_min_weight = 1e-5F;
// In small images pixels are divided into cells, up to about this number of cells.
constexpr int k_fine_cells = 130'000;
// Each channel is blurred in so many tasks, unless there are more channels, whose sums would take
// much memory.
constexpr std::size_t k_tasks_of_channel = 2, k_max_split_channels = 8;
// Cells show the same surface as a pixel if their relative distances differ by less.
constexpr double k_agreeing_distance = 0.1;

/// Water that changes with depth, reduced to what PointSpread can represent: the mean medium on the
/// camera rays to surfaces, and a factor for how much more or less of each surface's light is
/// scattered.
class WaterInView {
  public:
    WaterInView(const RaySource& rays, const LitScene& scene)
        : strata_(scene.field->strata()), medium_(*scene.medium) {
        if (!strata_) return;
        for (const Constituent& constituent : medium_.constituents)
            per_unit_.push_back(constituent.per_unit.total_scattering());
        uniform_ = medium_.uniform.total_scattering();
        constexpr int k_rays_per_axis = 16;
        std::vector<double> columns(per_unit_.size());
        double length = 0;
        for (int j = 0; j < k_rays_per_axis; ++j)
            for (int i = 0; i < k_rays_per_axis; ++i) {
                const auto ray = rays.refracted_ray((i + 0.5) * rays.width() / k_rays_per_axis,
                                                    (j + 0.5) * rays.height() / k_rays_per_axis);
                if (!ray) continue;
                const double end = scene.surfaces->hit_distance(*ray);
                if (!(end < k_far)) continue;
                strata_->add_column(ray->origin, ray->at(end), columns);
                length += end;
            }
        for (std::size_t k = 0; k < columns.size() && length > 0; ++k)
            for (std::size_t m = 0; m < medium_.uniform.scattering.size(); ++m)
                medium_.uniform.scattering[m] +=
                    columns[k] / length * medium_.constituents[k].per_unit.scattering[m];
        mean_ = medium_.uniform.total_scattering();
    }

    const Medium& medium() const { return medium_; }

    /// e^(b T) - 1, the scattered light of a surface at the end of a camera ray relative to its
    /// unscattered light, divided by the same of the mean medium.
    Spectrum factors(const Ray& ray, double distance) const {
        if (!strata_) return per_band(k_max_bands, [](std::size_t) { return 1.0; });
        std::vector<double> columns(per_unit_.size());
        strata_->add_column(ray.origin, ray.at(distance), columns);
        return per_band(k_max_bands, [&](std::size_t band) {
            double depth = uniform_[band] * distance;
            for (std::size_t k = 0; k < columns.size(); ++k)
                depth += per_unit_[k][band] * columns[k];
            constexpr double k_opaque = 50;  // optical depth beyond which nothing is visible
            const double mean = mean_[band] * distance;
            return mean > 0 ? std::expm1(std::min(depth, k_opaque)) /
                                  std::expm1(std::min(mean, k_opaque))
                            : 1;
        });
    }

  private:
    std::shared_ptr<const Strata> strata_;
    Medium medium_;
    Spectrum uniform_{}, mean_{};  // scattering [1/m]
    std::vector<Spectrum> per_unit_;
};

/// Returns angles to tabulate [rad], from the smallest of the cells' to the greatest, ascending.
std::vector<double> table_of(const Grid2D<float>& angles) {
    float min_angle = std::numeric_limits<float>::max(), max_angle = 0;
    for (const float angle : angles) {
        if (!(angle > 0)) continue;
        min_angle = std::min(min_angle, angle);
        max_angle = std::max(max_angle, angle);
    }
    if (max_angle == 0) min_angle = max_angle = 1;
    const double octaves = std::log2(max_angle / min_angle);
    const double last = std::min(std::floor(k_scales_of_octave * octaves) + 1, 255.0);
    std::vector<double> table;
    for (double scale = 0; scale <= last; ++scale)
        table.push_back(min_angle * std::exp2(scale / k_scales_of_octave));
    return table;
}

/// Weights of levels of the blur are tabulated by a cell's angle and its surface's distance. This
/// is where the cells lie in that table, for bilinear interpolation: the entry before each, and how
/// far it is beyond that.
struct PlacesInTable {
    std::vector<int> entry;
    std::vector<float> beyond_angle, beyond_distance;  // 0..1

    /// A cell without an angle may use any.
    PlacesInTable(const Grid2D<float>& angles, std::span<const double> table_of_angles,
                  const Grid2D<float>& cells, std::span<const double> distances) {
        const double last = static_cast<double>(table_of_angles.size() - 1);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const double ratio = std::max(angles[i] / table_of_angles.front(), 1.0);
            const double scale = std::min(k_scales_of_octave * std::log2(ratio), last - 1e-3);
            const auto after = std::ranges::upper_bound(distances, cells[i]);
            const auto d = std::clamp<std::ptrdiff_t>(after - distances.begin() - 1, 0,
                                                      std::ssize(distances) - 2);
            const double* at = &distances[static_cast<std::size_t>(d)];
            entry.push_back(static_cast<int>(scale) * static_cast<int>(distances.size()) +
                            static_cast<int>(d));
            beyond_angle.push_back(static_cast<float>(scale - std::floor(scale)));
            beyond_distance.push_back(
                static_cast<float>(std::clamp((cells[i] - at[0]) / (at[1] - at[0]), 0.0, 1.0)));
        }
    }
};

// Cells that are no farther than `begin` have no light in what is behind it. No two arrays overlap,
// which the compiler must know to look up several weights at a time.
UWVDB_VECTOR_CLONES void weigh_cells(const PlacesInTable& places, const float* __restrict weights,
                                     std::size_t distances, const float* source, const float* cells,
                                     float begin, std::size_t count, float* __restrict image) {
    const int* const entry = places.entry.data();
    const float* const t = places.beyond_distance.data();
    const float* const u = places.beyond_angle.data();
    const float* __restrict const next = weights + distances;
    for (std::size_t i = 0; i < count; ++i) {
        const int k = entry[i];
        const float lower = weights[k] + t[i] * (weights[k + 1] - weights[k]);
        const float upper = next[k] + t[i] * (next[k + 1] - next[k]);
        const float weighted = source[i] * (lower + u[i] * (upper - lower));
        image[i] = cells[i] > begin ? weighted : 0.0F;
    }
}

/// Blurs one channel, interval by interval.
class Spreading {
  public:
    Spreading(const Grid2D<float>& cells, const PlacesInTable& places, const PointSpread& spread,
              std::span<const BlurFit> fits)
        : cells_(cells), places_(places), spread_(spread), fits_(fits) {}

    /// The light of a channel whose scattering nearest to the camera is in `interval`, by cell.
    /// Valid until the next call.
    const Grid2D<float>& part(std::size_t interval, std::size_t band, double begin,
                              std::span<const float> source) {
        find_level_weights(interval, band);
        pyramid_.begin(cells_.width(), cells_.height());
        const std::size_t distances = spread_.distances().size();
        for (std::size_t level = 0; level < levels(); ++level) {
            if (max_weights_[level] < k_min_weight) continue;
            image_.resize(cells_.width(), cells_.height());
            weigh_cells(places_, &weights_[level * fits_.size() * distances], distances,
                        source.data(), cells_.values().data(), static_cast<float>(begin),
                        cells_.size(), image_.values().data());
            pyramid_.add(static_cast<int>(level), image_);
        }
        return pyramid_.sum();
    }

  private:
    std::size_t levels() const {
        return static_cast<std::size_t>(BlurPyramid::level_count(cells_.width(), cells_.height()));
    }

    void find_level_weights(std::size_t interval, std::size_t band) {
        const std::size_t scales = fits_.size(), distances = spread_.distances().size();
        weights_.resize(levels() * scales * distances);
        max_weights_.assign(levels(), 0.0F);
        std::vector<double> fitted(levels());
        for (std::size_t scale = 0; scale < scales; ++scale) {
            for (std::size_t d = 0; d < distances; ++d) {
                fits_[scale].fit(spread_.transfer(interval, band, d), fitted);
                for (std::size_t level = 0; level < levels(); ++level) {
                    const auto weight = static_cast<float>(fitted[level]);
                    weights_[(level * scales + scale) * distances + d] = weight;
                    max_weights_[level] = std::max(max_weights_[level], std::abs(weight));
                }
            }
        }
    }

    const Grid2D<float>& cells_;
    const PlacesInTable& places_;
    const PointSpread& spread_;
    std::span<const BlurFit> fits_;  // by angle
    BlurPyramid pyramid_;
    Grid2D<float> image_;
    std::vector<float> weights_;      // by level, angle and distance
    std::vector<float> max_weights_;  // by level
};

}  // namespace

SurfaceHalo::SurfaceHalo(const RaySource& rays, const LitScene& scene,
                         const SurfaceLighting& lighting, const DistanceIntervals& intervals,
                         std::size_t channels, int cells, const Radiance& radiance,
                         std::span<const Position> nodes)
    : channels_(channels) {
    const double area = static_cast<double>(rays.width()) * rays.height();
    spacing_ = std::max(1.0, std::ceil(std::sqrt(area / cells)));
    cells_of_pixel_ =
        std::max(1, static_cast<int>(std::sqrt(std::min(cells, k_fine_cells) / area)));
    spacing_ /= cells_of_pixel_;
    cells_.assign(static_cast<int>(std::ceil(rays.width() / spacing_)),
                  static_cast<int>(std::ceil(rays.height() / spacing_)));
    source_.assign(channels_ * cells_.size(), 0.0F);
    light_.assign(channels_ * cells_.size(), 0.0F);
    const WaterInView water(rays, scene);
    if (scene.field->strata())
        mean_water_ = {water.medium().uniform.total_scattering(),
                       water.medium().uniform.attenuation()};
    const Grid2D<float> angles =
        trace(rays, scene, lighting,
              [&](const SurfaceSample& sample, const SurfaceLight& light, std::size_t index,
                  std::span<double> values) {
                  radiance(sample, light, index, values);
                  const Spectrum factors = water.factors(sample.ray, sample.hit.distance);
                  const auto bands = static_cast<std::size_t>(scene.medium->band_count());
                  for (std::size_t c = 0; c < values.size(); ++c) values[c] *= factors[c % bands];
              });
    double farthest = 0;
    for (const float distance : cells_)
        if (std::isfinite(distance)) farthest = std::max(farthest, static_cast<double>(distance));
    if (farthest == 0) return;
    const PointSpread spread(water.medium(), intervals, farthest);
    intervals_ = spread.interval_count();
    node_light_.assign(nodes.size() * intervals_ * channels_, 0.0F);
    const std::vector<double> scales = table_of(angles);
    const PlacesInTable places(angles, scales, cells_, spread.distances());
    const int levels = BlurPyramid::level_count(cells_.width(), cells_.height());
    std::vector<BlurFit> fits;
    for (const double angle : scales) fits.emplace_back(levels, angle);
    const auto bands = static_cast<std::size_t>(scene.medium->band_count());
    // A few tasks per channel, by every so many intervals, keep all threads busy.
    const std::size_t strides = channels_ <= k_max_split_channels ? k_tasks_of_channel : 1;
    std::vector<Grid2D<float>> sums(channels_ * strides);
    parallel_for(sums.size(), [&](std::size_t task) {
        const std::size_t channel = task / strides;
        const auto source = std::span(source_).subspan(channel * cells_.size(), cells_.size());
        if (std::ranges::all_of(source, [](float value) { return value == 0; })) return;
        sums[task].assign(cells_.width(), cells_.height());
        Spreading spreading(cells_, places, spread, fits);
        std::vector<Corner> corners;
        for (std::size_t interval = task % strides; interval < intervals_; interval += strides) {
            const double begin = intervals.begin(interval);
            const Grid2D<float>& part = spreading.part(interval, channel % bands, begin, source);
            for (std::size_t i = 0; i < cells_.size(); ++i)
                if (cells_[i] > begin) sums[task][i] += part[i];
            for (std::size_t node = 0; node < nodes.size(); ++node) {
                find_corners(nodes[node].x, nodes[node].y, corners);
                double sum = 0;
                for (const Corner& corner : corners) sum += corner.weight * part[corner.cell];
                node_light_[(node * intervals_ + interval) * channels_ + channel] =
                    static_cast<float>(sum);
            }
        }
    });
    for (std::size_t task = 0; task < sums.size(); ++task)
        for (std::size_t i = 0; i < sums[task].size(); ++i)
            light_[i * channels_ + task / strides] += sums[task][i];
    source_ = {};
}

// Returns the angle of each cell, 0 where it is unknown.
Grid2D<float> SurfaceHalo::trace(const RaySource& rays, const LitScene& scene,
                                 const SurfaceLighting& lighting, const Radiance& radiance) {
    constexpr int k_rows_of_task = 16;
    const int width = cells_.width(), height = cells_.height();
    Grid2D<float> angles(width, height);
    const auto find_rays = [&](int row, std::vector<std::optional<Ray>>& of_row) {
        of_row.resize(static_cast<std::size_t>(width) + 1);  // one more: the angle of the last
        for (int i = 0; i <= width; ++i)
            of_row[static_cast<std::size_t>(i)] =
                rays.refracted_ray((i + 0.5) * spacing_, (row + 0.5) * spacing_);
    };
    const auto trace_row = [&](int row, const std::vector<std::optional<Ray>>& of_row,
                               const std::vector<std::optional<Ray>>& below) {
        std::vector<Ray> water_rays;
        std::vector<int> columns;
        for (int i = 0; i < width; ++i) {
            const auto at = static_cast<std::size_t>(i);
            cells_(i, row) = std::numeric_limits<float>::infinity();
            const std::optional<Ray>&ray = of_row[at], &right = of_row[at + 1];
            if (!ray) continue;
            water_rays.push_back(*ray);
            columns.push_back(i);
            if (right && below[at])
                angles(i, row) = static_cast<float>(std::sqrt(glm::length(glm::cross(
                    right->direction - ray->direction, below[at]->direction - ray->direction))));
        }
        std::vector<SurfaceHit> hits(water_rays.size());
        std::vector<char> found(water_rays.size());
        scene.surfaces->closest_hits(water_rays, k_far, hits, found);
        std::vector<SurfaceSample> samples;
        for (std::size_t k = 0; k < water_rays.size(); ++k) {
            if (!found[k]) continue;
            cells_(columns[k], row) = static_cast<float>(hits[k].distance);
            samples.push_back(
                {water_rays[k], hits[k], (columns[k] + 0.5) * spacing_, (row + 0.5) * spacing_});
        }
        std::vector<const SurfaceSample*> pointers;
        for (const SurfaceSample& sample : samples) pointers.push_back(&sample);
        SurfaceLight light;
        lighting.evaluate(pointers, light);
        std::vector<double> values(channels_);
        for (std::size_t k = 0, sample = 0; k < water_rays.size(); ++k) {
            if (!found[k]) continue;
            std::ranges::fill(values, 0.0);
            radiance(samples[sample], light, sample, values);
            ++sample;
            const std::size_t cell = cells_.index(columns[k], row);
            for (std::size_t c = 0; c < channels_; ++c)
                source_[c * cells_.size() + cell] = static_cast<float>(values[c]);
        }
    };
    const int tasks = (height + k_rows_of_task - 1) / k_rows_of_task;
    parallel_for(static_cast<std::size_t>(tasks), [&](std::size_t task) {
        std::vector<std::optional<Ray>> of_row, below;
        const int first = static_cast<int>(task) * k_rows_of_task;
        find_rays(first, of_row);
        for (int row = first; row < std::min(height, first + k_rows_of_task); ++row) {
            find_rays(row + 1, below);
            trace_row(row, of_row, below);
            std::swap(of_row, below);
        }
    });
    return angles;
}

void SurfaceHalo::find_corners(double x, double y, std::vector<Corner>& corners) const {
    const double u = std::clamp(x / spacing_ - 0.5, 0.0, cells_.width() - 1.0);
    const double v = std::clamp(y / spacing_ - 0.5, 0.0, cells_.height() - 1.0);
    const int i = static_cast<int>(u), j = static_cast<int>(v);
    const int right = std::min(i + 1, cells_.width() - 1);
    const int below = std::min(j + 1, cells_.height() - 1);
    corners = {Corner{cells_.index(i, j), (1 - u + i) * (1 - v + j)},
               Corner{cells_.index(right, j), (u - i) * (1 - v + j)},
               Corner{cells_.index(i, below), (1 - u + i) * (v - j)},
               Corner{cells_.index(right, below), (u - i) * (v - j)}};
}

void SurfaceHalo::find_cells_of_pixel(double x, double y, std::vector<Corner>& cells) const {
    if (cells_of_pixel_ == 1) return find_corners(x, y, cells);
    const auto first = [&](double at, int count) {
        return std::clamp(static_cast<int>(std::lround((at - 0.5) / spacing_)), 0,
                          count - cells_of_pixel_);
    };
    const int i = first(x, cells_.width()), j = first(y, cells_.height());
    const double weight = 1.0 / (cells_of_pixel_ * cells_of_pixel_);
    cells.clear();
    for (int below = 0; below < cells_of_pixel_; ++below)
        for (int right = 0; right < cells_of_pixel_; ++right)
            cells.push_back({cells_.index(i + right, j + below), weight});
}

void SurfaceHalo::add(double x, double y, double distance, double weight,
                      std::span<double> radiance) const {
    if (intervals_ == 0) return;
    std::vector<Corner> cells;
    find_cells_of_pixel(x, y, cells);
    // Only cells that show the same surface are used, if there are any.
    const auto agrees = [&](const Corner& corner) {
        const double other = cells_[corner.cell];
        return distance < k_far ? std::abs(other - distance) <= k_agreeing_distance * distance
                                : !std::isfinite(other);
    };
    double same = 0;
    for (const Corner& cell : cells)
        if (agrees(cell)) same += cell.weight;
    for (const Corner& cell : cells) {
        if (same > 0 && !agrees(cell)) continue;
        const double cell_weight = weight * cell.weight / (same > 0 ? same : 1);
        const float* light = &light_[cell.cell * channels_];
        for (std::size_t c = 0; c < channels_; ++c) radiance[c] += cell_weight * light[c];
    }
}

}  // namespace uw
