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

}  // namespace

/// Blurs one channel, interval by interval.
class SurfaceHalo::Spreading {
  public:
    Spreading(const SurfaceHalo& halo, const PointSpread& spread, std::span<const BlurFit> fits)
        : halo_(halo), spread_(spread), fits_(fits) {}

    /// The light of a channel whose scattering nearest to the camera is in `interval`, by cell.
    /// Valid until the next call.
    const Grid2D<float>& part(std::size_t interval, std::size_t band, double begin,
                              std::span<const float> source) {
        const Grid2D<Cell>& cells = halo_.cells_;
        find_level_weights(interval, band);
        pyramid_.begin(cells.width(), cells.height());
        const std::size_t distances = spread_.distances().size();
        for (std::size_t level = 0; level < levels(); ++level) {
            if (max_weights_[level] < k_min_weight) continue;
            image_.resize(cells.width(), cells.height());
            for (std::size_t i = 0; i < cells.size(); ++i) {
                const Cell& cell = cells[i];
                if (source[i] == 0 || cell.distance <= begin) {
                    image_[i] = 0;
                    continue;
                }
                const auto d = static_cast<std::size_t>(cell.place);
                const auto scale = static_cast<std::size_t>(cell.scale);
                const float t = cell.place - static_cast<float>(d);
                const float u = cell.scale - static_cast<float>(scale);
                const float* weight =
                    &weights_[(level * halo_.angles_.size() + scale) * distances + d];
                const float* next = weight + distances;
                const float lower = weight[0] + t * (weight[1] - weight[0]);
                const float upper = next[0] + t * (next[1] - next[0]);
                image_[i] = source[i] * (lower + u * (upper - lower));
            }
            pyramid_.add(static_cast<int>(level), image_);
        }
        return pyramid_.sum();
    }

  private:
    std::size_t levels() const {
        return static_cast<std::size_t>(
            BlurPyramid::level_count(halo_.cells_.width(), halo_.cells_.height()));
    }

    void find_level_weights(std::size_t interval, std::size_t band) {
        const std::size_t scales = halo_.angles_.size(), distances = spread_.distances().size();
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

    const SurfaceHalo& halo_;
    const PointSpread& spread_;
    std::span<const BlurFit> fits_;  // by scale
    BlurPyramid pyramid_;
    Grid2D<float> image_;
    std::vector<float> weights_;      // by level, scale and distance
    std::vector<float> max_weights_;  // by level
};

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
    trace(rays, scene, lighting,
          [&](const SurfaceSample& sample, const SurfaceLight& light, std::size_t index,
              std::span<double> values) {
              radiance(sample, light, index, values);
              const Spectrum factors = water.factors(sample.ray, sample.hit.distance);
              const auto bands = static_cast<std::size_t>(scene.medium->band_count());
              for (std::size_t c = 0; c < values.size(); ++c) values[c] *= factors[c % bands];
          });
    double farthest = 0;
    for (const Cell& cell : cells_)
        if (std::isfinite(cell.distance))
            farthest = std::max(farthest, static_cast<double>(cell.distance));
    if (farthest == 0) return;
    const PointSpread spread(water.medium(), intervals, farthest);
    intervals_ = spread.interval_count();
    node_light_.assign(nodes.size() * intervals_ * channels_, 0.0F);
    const std::span<const double> distances = spread.distances();
    for (Cell& cell : cells_) {
        const auto after = std::ranges::upper_bound(distances, cell.distance);
        const auto d =
            std::clamp<std::ptrdiff_t>(after - distances.begin() - 1, 0, std::ssize(distances) - 2);
        const double* at = &distances[static_cast<std::size_t>(d)];
        cell.place =
            static_cast<float>(d) + static_cast<float>(std::clamp(
                                        (cell.distance - at[0]) / (at[1] - at[0]), 0.0, 1 - 1e-4));
    }
    const int levels = BlurPyramid::level_count(cells_.width(), cells_.height());
    std::vector<BlurFit> fits;
    for (const double angle : angles_) fits.emplace_back(levels, angle);
    const auto bands = static_cast<std::size_t>(scene.medium->band_count());
    parallel_for(channels_, [&](std::size_t channel) {
        const auto source = std::span(source_).subspan(channel * cells_.size(), cells_.size());
        if (std::ranges::all_of(source, [](float value) { return value == 0; })) return;
        Spreading spreading(*this, spread, fits);
        std::vector<Corner> corners;
        for (std::size_t interval = 0; interval < intervals_; ++interval) {
            const double begin = intervals.begin(interval);
            const Grid2D<float>& part = spreading.part(interval, channel % bands, begin, source);
            for (std::size_t i = 0; i < cells_.size(); ++i)
                if (cells_[i].distance > begin) light_[i * channels_ + channel] += part[i];
            for (std::size_t node = 0; node < nodes.size(); ++node) {
                find_corners(nodes[node].x, nodes[node].y, corners);
                double sum = 0;
                for (const Corner& corner : corners) sum += corner.weight * part[corner.cell];
                node_light_[(node * intervals_ + interval) * channels_ + channel] =
                    static_cast<float>(sum);
            }
        }
    });
    source_ = {};
}

void SurfaceHalo::trace(const RaySource& rays, const LitScene& scene,
                        const SurfaceLighting& lighting, const Radiance& radiance) {
    Grid2D<float> angles(cells_.width(), cells_.height());
    parallel_for(static_cast<std::size_t>(cells_.height()), [&](std::size_t row) {
        std::vector<Ray> water_rays;
        std::vector<int> columns;
        const int j = static_cast<int>(row);
        const double y = (j + 0.5) * spacing_;
        for (int i = 0; i < cells_.width(); ++i) {
            cells_(i, j).distance = std::numeric_limits<float>::infinity();
            const double x = (i + 0.5) * spacing_;
            const auto ray = rays.refracted_ray(x, y);
            if (!ray) continue;
            water_rays.push_back(*ray);
            columns.push_back(i);
            const auto right = rays.refracted_ray(x + spacing_, y);
            const auto below = rays.refracted_ray(x, y + spacing_);
            if (right && below)
                angles(i, j) = static_cast<float>(std::sqrt(glm::length(glm::cross(
                    right->direction - ray->direction, below->direction - ray->direction))));
        }
        std::vector<SurfaceHit> hits(water_rays.size());
        std::vector<char> found(water_rays.size());
        scene.surfaces->closest_hits(water_rays, k_far, hits, found);
        std::vector<SurfaceSample> samples;
        for (std::size_t k = 0; k < water_rays.size(); ++k) {
            if (!found[k]) continue;
            cells_(columns[k], j).distance = static_cast<float>(hits[k].distance);
            samples.push_back({water_rays[k], hits[k], (columns[k] + 0.5) * spacing_, y});
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
            const std::size_t cell = cells_.index(columns[k], j);
            for (std::size_t c = 0; c < channels_; ++c)
                source_[c * cells_.size() + cell] = static_cast<float>(values[c]);
        }
    });
    // Tabulates angles from the smallest to the greatest; a cell without one may use any.
    float min_angle = std::numeric_limits<float>::max(), max_angle = 0;
    for (const float angle : angles) {
        if (!(angle > 0)) continue;
        min_angle = std::min(min_angle, angle);
        max_angle = std::max(max_angle, angle);
    }
    if (max_angle == 0) min_angle = max_angle = 1;
    const auto place_of = [&](double angle) {
        return k_scales_of_octave * std::log2(std::max(angle / min_angle, 1.0));
    };
    const double last = std::min(std::floor(place_of(max_angle)) + 1, 255.0);
    for (double scale = 0; scale <= last; ++scale)
        angles_.push_back(min_angle * std::exp2(scale / k_scales_of_octave));
    for (std::size_t i = 0; i < cells_.size(); ++i)
        cells_[i].scale = static_cast<float>(std::min(place_of(angles[i]), last - 1e-3));
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
        const double other = cells_[corner.cell].distance;
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
