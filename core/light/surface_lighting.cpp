#include "core/light/surface_lighting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/base/numerics.h"
#include "core/base/random.h"
#include "core/light/sky_emitter.h"

namespace uw {

namespace {

// Nodes farther than this many voxels from a sample are not used for it.
constexpr double k_near_voxels = 4;
// A surface may lie this many voxels in front of or behind the position interpolated between its
// nodes.
constexpr double k_step_voxels = 0.5;

int pixel(double position) {
    return static_cast<int>(std::floor(position));
}

}  // namespace

namespace {

// The steps of Roberts's R2 sequence, which fills the unit square most evenly (Roberts 2018, "The
// unreasonable effectiveness of quasirandom sequences"): powers of 1/1.3247..., the inverse of the
// root of x^3 = x + 1. The step of the third coordinate, the golden ratio, is independent of them.
constexpr UnitPoint k_even_steps{0.7548776662466927, 0.5698402909980532, 0.6180339887498949};

double fraction(double x) {
    return x - std::floor(x);
}

}  // namespace

// The positions of a pixel's samples are stratified, and so are the points derived from them; the
// pattern has another random shift (Cranley-Patterson rotation) for each pixel and each number.
Point3 shadow_origin(const Lamp& emitter, const SurfaceSample& sample, std::size_t number) {
    if (!emitter.is_part()) return emitter.origin(sample.hit.position);
    const auto pixel_bits = [](double position) {
        return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(position)));
    };
    PathRandom shift(PathRandom::seed_of(pixel_bits(sample.x), pixel_bits(sample.y)), 0);
    const auto steps = static_cast<double>(number);
    const double u = fraction(sample.x + shift.next() + steps * k_even_steps.u);
    const double v = fraction(sample.y + shift.next() + steps * k_even_steps.v);
    const double w = fraction(5 * sample.x + 3 * sample.y + shift.next() + steps * k_even_steps.w);
    return emitter.origin_on_patch(sample.hit.position, {u, v, w});
}

void brdf_for(const Lamp& emitter, const SurfaceReflection& reflection, const SurfaceSample& sample,
              Spectrum& values) {
    if (!reflection.is_glossy()) {
        reflection.brdf_towards(Vector3(0), values);
        return;
    }
    const Vector3 to_lamp = emitter.origin(sample.hit.position) - sample.hit.position;
    const double length = glm::length(to_lamp);
    reflection.brdf_towards(to_lamp / length, values, emitter.patch_angle(length));
}

void SurfaceColumns::begin(const LitScene& scene, const AttenuationTable& attenuation,
                           const ColumnMixing& mixing,
                           std::span<const SurfaceSample* const> samples) {
    scene_ = &scene;
    attenuation_ = &attenuation;
    mixing_ = mixing;
    samples_ = samples;
    constituents_ = attenuation.constituents.size();
    voxel_ = scene.field->finest_voxel();
    mixed_ = mixing.tolerance > 0 && constituents_ > 0 && samples.size() > 1;
    if (mixed_) place_nodes();
}

void SurfaceColumns::place_nodes() {
    x0_ = y0_ = std::numeric_limits<int>::max();
    x1_ = y1_ = std::numeric_limits<int>::min();
    positions_.clear();
    for (const SurfaceSample* sample : samples_) {
        x0_ = std::min(x0_, pixel(sample->x));
        y0_ = std::min(y0_, pixel(sample->y));
        x1_ = std::max(x1_, pixel(sample->x));
        y1_ = std::max(y1_, pixel(sample->y));
        positions_.push_back(sample->hit.position);
    }
    // The last pixels have nodes too, however close the preceding ones are.
    const int columns = (x1_ - x0_ + k_spacing - 1) / k_spacing + 1;
    const int rows = (y1_ - y0_ + k_spacing - 1) / k_spacing + 1;
    nodes_.assign(columns, rows);
    cells_.assign(columns, rows);
    node_columns_.resize(nodes_.size() * constituents_);
    for (std::size_t i = 0; i < samples_.size(); ++i) {
        const int x = pixel(samples_[i]->x) - x0_, y = pixel(samples_[i]->y) - y0_;
        const bool at_column = x % k_spacing == 0 || x == x1_ - x0_;
        const bool at_row = y % k_spacing == 0 || y == y1_ - y0_;
        if (at_column && at_row) {
            Node& node = nodes_((x + k_spacing - 1) / k_spacing, (y + k_spacing - 1) / k_spacing);
            if (node.sample == k_none) node.sample = i;
        } else if (x % k_spacing == k_spacing / 2 && y % k_spacing == k_spacing / 2) {
            Cell& cell = cells_(x / k_spacing, y / k_spacing);
            if (cell.middle == k_none) cell.middle = i;
        }
    }
}

void SurfaceColumns::take(int path) {
    path_ = path;
    if (!mixed_) return;
    for (Node& node : nodes_) node.known = false;
    for (Cell& cell : cells_) cell.state = Cell::State::unknown;
    if (path == k_camera) return;
    field_columns_.resize(samples_.size() * constituents_);
    (*mixing_.deep_shadows)[static_cast<std::size_t>(path)]->columns(positions_, field_columns_);
}

Point3 SurfaceColumns::origin_of(const Point3& x) const {
    return (*scene_->emitters)[static_cast<std::size_t>(path_)].origin(x);
}

void SurfaceColumns::integrate(std::size_t sample, std::span<double> column) const {
    const auto& [ray, hit, x, y] = *samples_[sample];
    const Point3 end = path_ == k_camera ? ray.origin : origin_of(hit.position);
    scene_->field->column(end, hit.position, column);
}

const double* SurfaceColumns::node_column(std::size_t node) {
    double* const own = &node_columns_[node * constituents_];
    if (nodes_[node].known) return own;
    nodes_[node].known = true;
    const std::size_t sample = nodes_[node].sample;
    integrate(sample, std::span(own, constituents_));
    if (path_ != k_camera)
        for (std::size_t k = 0; k < constituents_; ++k)
            own[k] -= field_columns_[sample * constituents_ + k];
    return own;
}

std::size_t SurfaceColumns::cell_of(const SurfaceSample& sample) const {
    const int x = std::min((pixel(sample.x) - x0_) / k_spacing, std::max(0, cells_.width() - 2));
    const int y = std::min((pixel(sample.y) - y0_) / k_spacing, std::max(0, cells_.height() - 2));
    return cells_.index(x, y);
}

bool SurfaceColumns::mix(std::size_t sample, std::size_t cell, std::span<double> column) {
    const auto across = static_cast<std::size_t>(nodes_.width());
    if (nodes_.width() < 2 || nodes_.height() < 2) return false;
    const std::array corners{cell, cell + 1, cell + across, cell + across + 1};
    const SurfaceSample& here = *samples_[sample];
    for (const std::size_t corner : corners) {
        const std::size_t node = nodes_[corner].sample;
        if (node == k_none) return false;
        const Vector3 apart = samples_[node]->hit.position - here.hit.position;
        const double near = k_near_voxels * voxel_;
        if (glm::dot(apart, apart) > near * near) return false;
    }
    const auto at = [&](std::size_t corner) -> const SurfaceSample& {
        return *samples_[nodes_[corner].sample];
    };
    const double u = (here.x - at(corners[0]).x) / (at(corners[1]).x - at(corners[0]).x);
    const double v = (here.y - at(corners[0]).y) / (at(corners[2]).y - at(corners[0]).y);
    const std::array weights{(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v};
    std::fill(column.begin(), column.end(), 0.0);
    double nearer = here.hit.distance;
    for (std::size_t c = 0; c < corners.size(); ++c) {
        const double* const own = node_column(corners[c]);
        for (std::size_t k = 0; k < constituents_; ++k) column[k] += weights[c] * own[k];
        nearer -= weights[c] * at(corners[c]).hit.distance;
    }
    if (path_ != k_camera) {
        for (std::size_t k = 0; k < constituents_; ++k)
            column[k] += field_columns_[sample * constituents_ + k];
        return true;
    }
    if (std::abs(nearer) > k_step_voxels * voxel_) return false;
    exact_.resize(constituents_);
    scene_->field->sample(here.hit.position, exact_);
    for (std::size_t k = 0; k < constituents_; ++k) column[k] += nearer * exact_[k];
    return true;
}

bool SurfaceColumns::confirmed(std::size_t cell) {
    Cell& asked = cells_[cell];
    if (asked.state != Cell::State::unknown) return asked.state == Cell::State::confirmed;
    asked.state = Cell::State::refused;
    mixture_.resize(constituents_);
    if (asked.middle == k_none || !mix(asked.middle, cell, mixture_)) return false;
    exact_.resize(constituents_);
    integrate(asked.middle, exact_);
    const double length = path_ == k_camera
                              ? samples_[asked.middle]->hit.distance
                              : distance(origin_of(samples_[asked.middle]->hit.position),
                                         samples_[asked.middle]->hit.position);
    for (std::size_t band = 0; band < static_cast<std::size_t>(attenuation_->band_count); ++band) {
        const double depth = attenuation_->optical_depth(band, length, exact_);
        const double difference = attenuation_->optical_depth(band, length, mixture_) - depth;
        if (std::abs(difference) * exp_of_minus(depth) > mixing_.tolerance) return false;
    }
    asked.state = Cell::State::confirmed;
    return true;
}

void SurfaceColumns::column(std::size_t sample, std::span<double> column) {
    if (mixed_) {
        const std::size_t cell = cell_of(*samples_[sample]);
        if (confirmed(cell) && mix(sample, cell, column)) return;
    }
    integrate(sample, column);
}

namespace {

// Shadow rays are traced in batches, as a tile of thousands of samples per pixel has a million of
// them to each lamp.
constexpr std::size_t k_rays_at_once = 1024;

/// The samples that one emitter may illuminate: they face it and lie within its beam.
struct Facing {
    std::vector<std::size_t> samples;
    std::vector<Point3> positions;
    std::vector<double> radii, geometry_terms;
    std::vector<char> hidden;

    /// Finds them among all samples, or among those marked in `wanted` unless it is empty.
    void find(const Lamp& lamp, std::span<const SurfaceSample* const> all,
              std::span<const char> wanted = {}) {
        samples.clear();
        positions.clear();
        radii.clear();
        geometry_terms.clear();
        const auto* const sky = dynamic_cast<const SkyEmitter*>(&lamp.emitter());
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (!wanted.empty() && wanted[i] == 0) continue;
            const SurfaceHit& hit = all[i]->hit;
            const Vector3 to_lamp = lamp.origin(hit.position) - hit.position;
            // The geometric normal decides what a lamp can illuminate; the shading normal only
            // affects shading.
            const auto towards_light = [&](const Vector3& normal) {
                return sky ? sky->mean_cosine(normal) : glm::dot(normal, to_lamp);
            };
            const double towards = towards_light(hit.normal);
            if (towards <= 0 || towards_light(hit.geometric_normal) <= 0) continue;
            const double relative = lamp.relative_intensity(-to_lamp) * lamp.focus(hit.position);
            if (relative <= 0) continue;
            const double radius = glm::length(to_lamp);
            samples.push_back(i);
            positions.push_back(hit.position);
            radii.push_back(radius);
            geometry_terms.push_back(sky ? towards
                                         : relative * towards / (lamp.spread(radius) * radius));
        }
        hidden.resize(samples.size());
    }

    /// Traces the rays with this number (shadow_origin). `all`: as for find().
    void trace_shadows(const Lamp& emitter, std::span<const SurfaceSample* const> all,
                       std::size_t number, const Surfaces& surfaces) {
        std::vector<Point3> origins;
        for (std::size_t n = 0; n < positions.size(); n += k_rays_at_once) {
            throw_if_stopped();
            const std::size_t count = std::min(k_rays_at_once, positions.size() - n);
            origins.clear();
            for (std::size_t k = n; k < n + count; ++k)
                origins.push_back(shadow_origin(emitter, *all[samples[k]], number));
            surfaces.occluded_many(origins, std::span(positions).subspan(n, count),
                                   std::span(hidden).subspan(n, count));
        }
    }
};

/// Implements find_half_shades, one lamp at a time.
class HalfShades {
  public:
    HalfShades(const LitScene& scene, std::span<const SurfaceSample* const> samples,
               std::span<double> visibilities)
        : scene_(scene), samples_(samples), visibilities_(visibilities) {}

    /// Finds the visibility of the emitters from `first` up to `last`, which form one lamp.
    void find(std::size_t first, std::size_t last) {
        std::vector<char> lit(samples_.size(), 0), dark(samples_.size(), 0);
        trace(first, last, 0, {}, [&](std::size_t sample, double& visibility, bool is_hidden) {
            (is_hidden ? dark : lit)[sample] = 1;
            visibility = is_hidden ? 0 : 1;
        });
        // All samples of a pixel are treated alike: if the first ray of a sample decided whether
        // that sample gets more, the mean would be biased.
        for (std::size_t begin = 0, end = 0; begin < samples_.size(); begin = end) {
            const auto is_of_pixel = [&](std::size_t i) {
                return pixel(samples_[i]->x) == pixel(samples_[begin]->x) &&
                       pixel(samples_[i]->y) == pixel(samples_[begin]->y);
            };
            bool any_lit = false, any_dark = false;
            for (end = begin; end < samples_.size() && is_of_pixel(end); ++end) {
                any_lit = any_lit || lit[end] != 0;
                any_dark = any_dark || dark[end] != 0;
            }
            std::fill(lit.begin() + static_cast<std::ptrdiff_t>(begin),
                      lit.begin() + static_cast<std::ptrdiff_t>(end), any_lit && any_dark ? 1 : 0);
        }
        if (std::ranges::count(lit, 1) == 0) return;
        for (int round = 1; round < k_half_shade_rays; ++round)
            trace(first, last, round, lit, [&](std::size_t, double& visibility, bool is_hidden) {
                visibility += ((is_hidden ? 0 : 1) - visibility) / (round + 1);
            });
    }

  private:
    template <class Take>
    void trace(std::size_t first, std::size_t last, int round, std::span<const char> wanted,
               const Take& take) {
        Facing facing;
        const std::vector<Lamp>& emitters = *scene_.emitters;
        for (std::size_t j = first; j < last; ++j) {
            facing.find(emitters[j], samples_, wanted);
            // Numbers are counted within the lamp, so that its light does not depend on other
            // lamps.
            facing.trace_shadows(emitters[j], samples_,
                                 j - first + static_cast<std::size_t>(round) * (last - first),
                                 *scene_.surfaces);
            for (std::size_t n = 0; n < facing.samples.size(); ++n) {
                const std::size_t i = facing.samples[n];
                take(i, visibilities_[i * emitters.size() + j], facing.hidden[n] != 0);
            }
        }
    }

    const LitScene& scene_;
    std::span<const SurfaceSample* const> samples_;
    std::span<double> visibilities_;
};

}  // namespace

void find_half_shades(const LitScene& scene, std::span<const SurfaceSample* const> samples,
                      std::span<double> visibilities) {
    const std::vector<Lamp>& emitters = *scene.emitters;
    HalfShades half_shades(scene, samples, visibilities);
    for (std::size_t first = 0, last = 0; first < emitters.size(); first = last) {
        while (last < emitters.size() && emitters[last].index() == emitters[first].index()) ++last;
        if (emitters[first].is_part()) half_shades.find(first, last);
    }
}

DirectLighting::DirectLighting(const LitScene& scene,
                               std::vector<std::shared_ptr<const DeepShadow>> deep_shadows,
                               double column_tolerance)
    : scene_(scene),
      attenuation_(*scene.medium),
      deep_shadows_(std::move(deep_shadows)),
      column_tolerance_(column_tolerance) {}

void DirectLighting::evaluate(std::span<const SurfaceSample* const> samples,
                              SurfaceLight& light) const {
    const auto bands = static_cast<std::size_t>(attenuation_.band_count);
    std::vector<double> column(attenuation_.constituents.size());
    Facing facing;
    SurfaceColumns columns;
    light.reset(samples.size(), *scene_.emitters, bands);
    // Compute optical depths first; all are converted to transmittances at once.
    const auto set_depths = [&](std::size_t sample, double length, std::span<double> depths) {
        throw_if_stopped();
        columns.column(sample, column);
        for (std::size_t b = 0; b < bands; ++b)
            depths[b] = attenuation_.optical_depth(b, length, column);
    };
    columns.begin(scene_, attenuation_, {&deep_shadows_, column_tolerance_}, samples);
    columns.take_camera();
    for (std::size_t i = 0; i < samples.size(); ++i)
        set_depths(i, samples[i]->hit.distance, light.to_camera(i));
    find_half_shades(scene_, samples, light.visibilities());
    for (std::size_t j = 0; j < scene_.emitters->size(); ++j) {
        const Lamp& lamp = (*scene_.emitters)[j];
        facing.find(lamp, samples);
        if (!lamp.is_part()) facing.trace_shadows(lamp, samples, 0, *scene_.surfaces);
        columns.take_emitter(j);
        for (std::size_t n = 0; n < facing.samples.size(); ++n) {
            const std::size_t i = facing.samples[n];
            double& visibility = light.visibility(i, j);
            if (!lamp.is_part()) visibility = facing.hidden[n] != 0 ? 0 : 1;
            if (visibility == 0) continue;
            light.geometry_term(i, j) = visibility * facing.geometry_terms[n];
            set_depths(i, facing.radii[n], light.from_emitter(i, j));
        }
    }
    exp_of_minus(light.transmittances());
}

}  // namespace uw
