#include "core/passes/in_scatter_lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/light/integrator.h"

namespace uw {

namespace {

// Rays of any spacing meet wider beams, except for the first centimetres of these.
constexpr double k_max_angle = 80 * std::numbers::pi / 180;
// The angles from the axis at which intensities are sampled: the first one [rad], and the factor to
// the next.
constexpr double k_min_angle = 1e-6, k_angle_factor = 1.1;
constexpr int k_azimuths = 8;
// At this many times the angle of half the intensity, a power of the cosine has fallen to 0.02 %.
constexpr double k_outer_factor = 3.5;
// Distance by which rays may lie outside the planes through a rectangle's corners, as refraction
// bends these [pixels].
constexpr double k_bulge = 1;

// Returns the greatest angle from the lamp's axis at which the intensity is at least half of its
// maximum.
double core_angle(const Lamp& emitter, const Vector3& axis) {
    const Vector3 other = std::abs(axis.x) < 0.5 ? Vector3(1, 0, 0) : Vector3(0, 1, 0);
    const Vector3 u = glm::normalize(glm::cross(axis, other)), v = glm::cross(axis, u);
    const auto brightest = [&](double angle) {
        double most = 0;
        for (int k = 0; k < k_azimuths; ++k) {
            const double azimuth = 2 * std::numbers::pi * k / k_azimuths;
            const Vector3 offset = std::cos(azimuth) * u + std::sin(azimuth) * v;
            most = std::max(most, emitter.relative_intensity(std::cos(angle) * axis +
                                                             std::sin(angle) * offset));
        }
        return most;
    };
    std::vector<std::pair<double, double>> intensities;  // by angle
    double most = 0;
    for (double angle = k_min_angle; angle < std::numbers::pi; angle *= k_angle_factor) {
        intensities.emplace_back(angle, brightest(angle));
        most = std::max(most, intensities.back().second);
    }
    double core = k_min_angle;
    for (const auto& [angle, intensity] : intensities)
        if (intensity >= 0.5 * most) core = angle;
    return core;
}

// Clips `part` to where slope * t <= limit.
void clip(double slope, double limit, Interval& part) {
    if (slope > 0)
        part.end = std::min(part.end, limit / slope);
    else if (slope < 0)
        part.begin = std::max(part.begin, limit / slope);
    else if (limit < 0)
        part.end = part.begin - 1;
}

}  // namespace

FineBeams::FineBeams(const RaySource& rays, const std::vector<Lamp>& emitters) : rays_(rays) {
    std::optional<Beam> beam;
    for (std::size_t i = 0; i < emitters.size(); ++i) {
        const Lamp& emitter = emitters[i];
        if (emitter.sunlight()) continue;
        // The points of a lamp differ in position alone, and so do their mirror images.
        if (i == 0 || emitters[i - 1].index() != emitter.index() ||
            emitters[i - 1].is_mirrored() != emitter.is_mirrored())
            beam = beam_of(emitter);
        if (!beam) continue;
        beam->apex = emitter.position();
        beams_.push_back(*beam);
    }
}

std::optional<FineBeams::Beam> FineBeams::beam_of(const Lamp& emitter) {
    const DirectionCone cone = emitter.cone();
    const FineStructure fine = emitter.fine_structure();
    if (fine.is_everywhere || fine.normal) {
        const double angle = std::acos(cone.cosine), slope = std::tan(std::min(angle, k_max_angle));
        return Beam{{}, glm::normalize(cone.axis), slope, slope, angle > k_max_angle, fine};
    }
    const double core = core_angle(emitter, cone.axis);
    if (core >= k_max_angle) return std::nullopt;
    double outer = k_outer_factor * core;
    if (!cone.has_all()) outer = std::min(outer, std::max(core, std::acos(cone.cosine)));
    return Beam{{},
                glm::normalize(cone.axis),
                std::tan(core),
                std::tan(std::min(outer, k_max_angle)),
                false,
                {}};
}

std::optional<FineBeams::Bundle> FineBeams::bundle(const ImageRectangle& area) const {
    struct Position {
        double x, y;
    };
    const Position middle{0.5 * (area.x0 + area.x1), 0.5 * (area.y0 + area.y1)};
    const std::array<Position, 5> positions{
        {{area.x0, area.y0}, {area.x1, area.y0}, {area.x1, area.y1}, {area.x0, area.y1}, middle}};
    std::array<Ray, 5> rays;
    Bundle found;
    for (std::size_t k = 0; k < positions.size(); ++k) {
        const auto [x, y] = positions[k];
        // The neighbouring position, one pixel towards the middle.
        const double dx = x > middle.x ? -1 : 1, dy = y > middle.y ? -1 : 1;
        const std::optional<Ray> ray = rays_.refracted_ray(x, y);
        const std::optional<Ray> neighbour = rays_.refracted_ray(x + dx, y + dy);
        if (!ray || !neighbour) return std::nullopt;
        rays[k] = *ray;
        found.pixel = std::max(found.pixel,
                               glm::length(neighbour->direction - ray->direction) / std::sqrt(2.0));
    }
    found.origin = rays.back().origin;
    found.direction = rays.back().direction;
    for (std::size_t k = 0; k < found.outwards.size(); ++k) {
        const Ray &a = rays[k], &b = rays[(k + 1) % found.outwards.size()];
        Vector3 outwards = glm::normalize(glm::cross(a.direction, b.direction));
        if (glm::dot(outwards, found.direction) > 0) outwards = -outwards;
        found.outwards[k] = outwards;
        found.corners[k] = a.direction;
        // Behind a port, rays have no common origin.
        found.offsets[k] = std::max(glm::dot(outwards, from_origin(a.origin)),
                                    glm::dot(outwards, from_origin(b.origin)));
    }
    return found;
}

void FineBeams::begin(const ImageRectangle& area, double width, double max_distance) {
    near_.clear();
    max_distance_ = max_distance;
    if (beams_.empty()) return;
    const std::optional<Bundle> all = bundle(area);
    for (const Beam& beam : beams_)
        if (!all || is_fine_in(*all, beam, width)) near_.push_back(&beam);
}

bool FineBeams::has_any(const ImageRectangle& area, double width) const {
    if (near_.empty()) return false;
    const std::optional<Bundle> part = bundle(area);
    return !part || std::ranges::any_of(
                        near_, [&](const Beam* beam) { return is_fine_in(*part, *beam, width); });
}

// Within a rectangle's own size of the plane the light changes by factors from ray to ray.
bool FineBeams::may_lie_in_sheet(const Bundle& bundle, const Vector3& normal) {
    double least = 1, most = -1;
    for (const Vector3& direction : bundle.corners) {
        const double off = glm::dot(direction, normal);
        least = std::min(least, off);
        most = std::max(most, off);
    }
    const double size = most - least + 2 * k_bulge * bundle.pixel;
    return least - size < 0 && most + size > 0;
}

// At t metres from its lamp, the beam is bounded by a ball around the point there, so each
// condition is linear in t.
bool FineBeams::is_fine_in(const Bundle& bundle, const Beam& beam, double width) const {
    if (beam.fine.normal && !may_lie_in_sheet(bundle, *beam.fine.normal)) return false;
    if (beam.is_wide) return true;
    const Vector3 to_apex = beam.apex - bundle.origin;
    // The point at t is at the distance z + t * dz from the camera, along the ray in the middle.
    const double z = glm::dot(bundle.direction, to_apex);
    const double dz = glm::dot(bundle.direction, beam.axis);
    Interval part{0, k_far};
    clip(-dz - beam.outer_slope, z, part);
    clip(dz - beam.outer_slope, max_distance_ - z, part);
    const double margin = k_bulge * bundle.pixel;
    for (std::size_t k = 0; k < bundle.outwards.size(); ++k) {
        const Vector3& outwards = bundle.outwards[k];
        clip(glm::dot(outwards, beam.axis) - beam.outer_slope - margin * dz,
             bundle.offsets[k] - glm::dot(outwards, from_origin(beam.apex)) + margin * z, part);
    }
    if (!(part.begin < part.end)) return false;
    if (beam.fine.is_everywhere || beam.fine.normal) return true;
    const auto is_fine_at = [&](double t) {
        return 2 * beam.core_slope * t <
               width * bundle.pixel * glm::length(to_apex + t * beam.axis);
    };
    return is_fine_at(part.begin) || is_fine_at(part.end);
}

namespace {

// Tolerance of interpolation, relative to the maximum attenuation by particles in a square: the
// probes are to find clouds that the rays miss, not to resolve how their light varies.
constexpr double k_tolerance = 0.25;
// Particles that attenuate less than this fraction of the light are ignored.
constexpr double k_min_attenuated = 1e-4;
// If the least attenuation of a square exceeds this fraction of its greatest, it is an even haze,
// which hides what is finer than the first, wider probes.
constexpr double k_haze = 0.5;

double lerp(double a, double b, double t) {
    return a + t * (b - a);
}

}  // namespace

FineParticles::FineParticles(const RaySource& rays, const LitScene& scene)
    : rays_(rays),
      field_(scene.field && !scene.field->grids().bounds().empty() ? &scene.field->grids()
                                                                   : nullptr),
      attenuation_(*scene.medium) {
    if (field_) column_.resize(static_cast<std::size_t>(field_->constituent_count()));
}

void FineParticles::begin(const PixelWindow& tile, int edge, double max_distance) {
    if (!field_) return;
    tile_ = tile;
    max_distance_ = max_distance;
    attenuated_.assign(edge / k_spacing + 1, edge / k_spacing + 1, -1);
}

// Returns the fraction of light that the particles along a probe attenuate.
double FineParticles::attenuated(int i, int j) {
    double& known = attenuated_(i / k_spacing, j / k_spacing);
    if (known >= 0) return known;
    known = 0;
    const std::optional<Ray> ray = rays_.refracted_ray(tile_.x0 + i + 0.5, tile_.y0 + j + 0.5);
    if (!ray) return known;
    // Integrate to the end of the particles' bounds.
    const Bounds bounds = field_->bounds();
    const double end = std::min(max_distance_, distance(ray->origin, bounds.center()) +
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
        if (most >= k_min_attenuated && differs(square, step, spacing, k_tolerance * most))
            return true;
        if (least > k_haze * most) return false;
    }
    return false;
}

// Returns the range of the values of probes `step` pixels apart.
Interval FineParticles::range(const Square& square, int step) {
    Interval found{1, 0};
    for (int y = 0; y <= square.height; y += step) {
        for (int x = 0; x <= square.width; x += step) {
            const double here = attenuated(square.x + x, square.y + y);
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
            const double above = lerp(attenuated(left, top), attenuated(left + spacing, top), u);
            const double below =
                lerp(attenuated(left, top + spacing), attenuated(left + spacing, top + spacing), u);
            const double here = attenuated(square.x + x, square.y + y);
            if (std::abs(here - lerp(above, below, v)) > allowed) return true;
        }
    }
    return false;
}

namespace {

// Returns the maximum relative width of a depth (greatest over least distance, minus 1) at which a
// parabola follows the in-scattered light to a tenth of the tolerance.
double max_relative_width(double tolerance) {
    return 0.12 * std::cbrt(tolerance / 1e-3);
}

// Errors of a radiance below this fraction of the tile's mean are relative to that level instead.
constexpr double k_dark = 0.02;

}  // namespace

/// The position within a cell at which to interpolate, and the distances with their weights.
struct InScatterLattice::Place {
    double u, v;  // 0..1 across and down the cell
    std::span<const double> distances, weights;
};

InScatterLattice::InScatterLattice(const RaySource& rays, const LitScene& scene,
                                   const RayInScatter& in_scatter, double tolerance)
    : rays_(rays),
      in_scatter_(in_scatter),
      tolerance_(tolerance),
      max_relative_width_(max_relative_width(tolerance)),
      value_count_(in_scatter.value_count()),
      beams_(rays, *scene.emitters),
      particles_(rays, scene),
      floor_(in_scatter.band_count()),
      interpolated_(value_count_),
      integrated_(value_count_) {}

void InScatterLattice::evaluate(const PixelWindow& tile, const Grid2D<PixelView>& views,
                                std::span<const double> other_light) {
    tile_ = tile;
    views_ = &views;
    other_light_.assign(other_light.begin(), other_light.end());
    pixel_values_.assign(views.size() * value_count_, 0.0);
    collect_distances();
    nodes_.assign(k_side, k_side);
    node_values_.clear();
    set_floor();
    const double max_distance =
        distances_.empty() ? 0 : *std::max_element(distances_.begin(), distances_.end());
    beams_.begin(cell(0, 0, k_coarsest), k_coarsest / 2, max_distance);
    particles_.begin(tile, k_tile, max_distance);
    for (int j = 0; j < tile.height(); j += k_coarsest)
        for (int i = 0; i < tile.width(); i += k_coarsest) fill_cell(i, j, k_coarsest);
}

void InScatterLattice::find_least(std::span<double> least) const {
    const std::size_t bands = floor_.size();
    std::ranges::fill(least, pixel_values_.empty() ? 0 : std::numeric_limits<double>::infinity());
    for (std::size_t first = 0; first < pixel_values_.size(); first += value_count_)
        for (std::size_t b = 0; b < bands; ++b) {
            double light = 0;
            for (std::size_t k = b; k < in_scatter_.group_count() * bands; k += bands)
                light += pixel_values_[first + k];
            least[b] = std::min(least[b], light);
        }
}

void InScatterLattice::collect_distances() {
    distances_.clear();
    first_distances_.clear();
    for (const PixelView& view : *views_) {
        first_distances_.push_back(distances_.size());
        distances_.insert(distances_.end(), view.distances.begin(), view.distances.end());
    }
    first_distances_.push_back(distances_.size());
}

const InScatterLattice::Node& InScatterLattice::node(int i, int j) {
    Node& node = nodes_(i / k_finest, j / k_finest);
    if (node.state == Node::State::unknown) {
        find_depths(i, j, node);
        const bool ready = node.radius > 0 && integrate_node(i, j, node);
        node.state = ready ? Node::State::ready : Node::State::unusable;
    }
    return node;
}

/// Finds the depths at which the water ends in the pixels around a node, within the largest radius
/// in which there are no more than k_depths.
void InScatterLattice::find_depths(int i, int j, Node& node) const {
    int radius = k_coarsest;
    while (i % radius != 0 || j % radius != 0) radius /= 2;
    for (; radius >= k_finest; radius /= 2) {
        node.depth_count = 0;
        bool few = true;
        // The radius of a node beyond the image's edge may contain none of its pixels.
        const int x0 = std::clamp(i - radius, 0, tile_.width());
        const int x1 = std::min(i + radius, tile_.width() - 1);
        const int y0 = std::max(0, j - radius), y1 = std::min(j + radius, tile_.height() - 1);
        for (int y = y0; y <= y1 && few; ++y) {
            const std::size_t* first = &first_distances_[views_->index(0, y)];
            for (std::size_t at = first[x0]; at < first[x1 + 1] && few; ++at)
                few = include(distances_[at], node);
        }
        if (!few) continue;
        if (node.depth_count > 0) node.radius = radius;
        return;
    }
}

/// Includes `distance` in one of the node's depths; false if it already has too many.
bool InScatterLattice::include(double distance, Node& node) const {
    for (std::size_t d = 0; d < node.depth_count; ++d) {
        Depth& depth = node.depths[d];
        if (distance >= depth.least && distance <= depth.greatest) return true;
        const double least = std::min(depth.least, distance);
        const double greatest = std::max(depth.greatest, distance);
        if (greatest > (1 + max_relative_width_) * least) continue;
        depth = {least, greatest};
        return true;
    }
    if (node.depth_count == k_depths) return false;
    node.depths[node.depth_count++] = {distance, distance};
    return true;
}

bool InScatterLattice::integrate_node(int i, int j, Node& node) {
    const auto ray = rays_.refracted_ray(tile_.x0 + i + 0.5, tile_.y0 + j + 0.5);
    if (!ray) return false;
    std::array<double, k_depths * k_stops> distances{};
    std::size_t count = 0;
    for (std::size_t d = 0; d < node.depth_count; ++d) {
        const Depth& depth = node.depths[d];
        distances[count++] = depth.least;
        if (depth.alike()) continue;
        distances[count++] = depth.middle();
        distances[count++] = depth.greatest;
    }
    node.values = node_values_.size();
    node_values_.resize(node.values + count * value_count_);
    in_scatter_.integrate(*ray, std::span(distances).first(count),
                          std::span(node_values_).subspan(node.values));
    return true;
}

void InScatterLattice::set_floor() {
    std::fill(floor_.begin(), floor_.end(), 0.0);
    std::size_t count = 0;
    for (int j = 0; j < tile_.height(); j += k_coarsest) {
        for (int i = 0; i < tile_.width(); i += k_coarsest) {
            const Node& at = node(i, j);
            if (at.state != Node::State::ready) continue;
            ++count;
            for (std::size_t k = 0; k < in_scatter_.group_count() * floor_.size(); ++k)
                floor_[k % floor_.size()] += node_values_[at.values + k];
        }
    }
    for (double& value : floor_)
        if (count > 0) value *= k_dark / static_cast<double>(count);
}

bool InScatterLattice::corners(int i, int j, int spacing, Corners& found) {
    for (std::size_t c = 0; c < found.size(); ++c) {
        const int right = c % 2 != 0 ? spacing : 0, below = c / 2 != 0 ? spacing : 0;
        const Node& corner = node(i + right, j + below);
        if (corner.state != Node::State::ready || corner.radius < spacing) return false;
        found[c] = &corner;
    }
    return true;
}

bool InScatterLattice::confirmed(int i, int j, int spacing) {
    // Pointers to nodes stay valid, as all of them are allocated from the start.
    Corners from{};
    if (!corners(i, j, spacing, from)) return false;
    const int half = spacing / 2;
    // Finer cells tolerate more: they contain few pixels, and a feature that the five nodes of a
    // large cell miss is found by those of smaller ones.
    const double allowed = tolerance_ * std::sqrt(static_cast<double>(k_coarsest) / spacing);
    for (int v = 0; v <= 2; ++v) {
        for (int u = 0; u <= 2; ++u) {
            if (u != 1 && v != 1) continue;
            const Node& middle = node(i + u * half, j + v * half);
            if (middle.state != Node::State::ready || middle.radius < half) return false;
            // Compare up to every surface around the node, not only up to the one that the node
            // itself sees.
            constexpr std::array<double, 1> k_whole{1.0};
            for (std::size_t d = 0; d < middle.depth_count; ++d) {
                for (const double& distance : {middle.depths[d].least, middle.depths[d].greatest}) {
                    const Place place{0.5 * u, 0.5 * v, std::span(&distance, 1), k_whole};
                    if (!agree(from, place, middle, allowed)) return false;
                }
            }
        }
    }
    return !has_fine(i, j, spacing);
}

ImageRectangle InScatterLattice::cell(int i, int j, int spacing) const {
    const int x = tile_.x0 + i, y = tile_.y0 + j;
    return {static_cast<double>(x), static_cast<double>(y),
            static_cast<double>(std::min(x + spacing + 1, tile_.x1)),
            static_cast<double>(std::min(y + spacing + 1, tile_.y1))};
}

bool InScatterLattice::has_fine(int i, int j, int spacing) {
    const int half = spacing / 2;
    if (beams_.has_any(cell(i, j, spacing), half)) return true;
    return half > FineParticles::k_spacing && particles_.has_any(i, j, spacing, half);
}

bool InScatterLattice::agree(const Corners& from, const Place& place, const Node& node,
                             double allowed) {
    std::fill(interpolated_.begin(), interpolated_.end(), 0.0);
    std::fill(integrated_.begin(), integrated_.end(), 0.0);
    for (std::size_t c = 0; c < from.size(); ++c) {
        const double across = c % 2 != 0 ? place.u : 1 - place.u;
        const double down = c / 2 != 0 ? place.v : 1 - place.v;
        if (across * down > 0 &&
            !add_node(*from[c], across * down, place.distances, place.weights, interpolated_))
            return false;
    }
    if (!add_node(node, 1, place.distances, place.weights, integrated_)) return false;
    const std::size_t bands = floor_.size();
    for (std::size_t b = 0; b < bands; ++b) {
        double difference = 0, light = 0;
        for (std::size_t k = b; k < in_scatter_.group_count() * bands; k += bands) {
            difference += interpolated_[k] - integrated_[k];
            light += integrated_[k];
        }
        const double reference = std::max(light + other_light_[b], floor_[b]);
        if (!(std::abs(difference) <= allowed * reference)) return false;
    }
    return true;
}

void InScatterLattice::fill_cell(int i, int j, int spacing) {
    if (i >= tile_.width() || j >= tile_.height()) return;
    const int half = spacing / 2;
    const bool interpolate = confirmed(i, j, spacing);
    if (!interpolate && half >= k_finest * 2) {
        for (const int v : {0, half})
            for (const int u : {0, half}) fill_cell(i + u, j + v, half);
        return;
    }
    for (int y = j; y < std::min(j + spacing, tile_.height()); ++y)
        for (int x = i; x < std::min(i + spacing, tile_.width()); ++x)
            fill_pixel(x, y, interpolate ? half : 0);
}

/// Interpolates a pixel from the lattice of this `spacing`, or integrates it if `spacing` is 0.
void InScatterLattice::fill_pixel(int x, int y, int spacing) {
    const PixelView& view = (*views_)(x, y);
    if (view.distances.empty()) return;
    const std::span values =
        std::span(pixel_values_).subspan(views_->index(x, y) * value_count_, value_count_);
    Corners from{};
    if (spacing == 0 || !corners(x - x % spacing, y - y % spacing, spacing, from)) {
        in_scatter_.integrate(view, values);
        return;
    }
    const double u = static_cast<double>(x % spacing) / spacing;
    const double v = static_cast<double>(y % spacing) / spacing;
    for (std::size_t c = 0; c < from.size(); ++c) {
        const double weight = (c % 2 != 0 ? u : 1 - u) * (c / 2 != 0 ? v : 1 - v);
        // The depths of the corners cover those of all pixels within their radius.
        if (weight > 0) add_node(*from[c], weight, view.distances, view.weights, values);
    }
    // A parabola through light that begins only behind the nearest distance may be negative.
    for (double& value : values) value = std::max(value, 0.0);
}

/// Adds `weight` times the weighted mean over the distances of the node's parabolas.
bool InScatterLattice::add_node(const Node& node, double weight, std::span<const double> distances,
                                std::span<const double> weights, std::span<double> values) const {
    for (std::size_t i = 0; i < distances.size(); ++i) {
        const double* at_stops = &node_values_[node.values];
        std::size_t d = 0;
        for (; d < node.depth_count; ++d) {
            const Depth& depth = node.depths[d];
            if (distances[i] >= depth.least && distances[i] <= depth.greatest) break;
            at_stops += depth.stops() * value_count_;
        }
        if (d == node.depth_count) return false;
        const Depth& depth = node.depths[d];
        const double whole = weight * weights[i];
        if (depth.alike()) {
            for (std::size_t k = 0; k < value_count_; ++k) values[k] += whole * at_stops[k];
            continue;
        }
        // t runs from -1 at the nearest distance to 1 at the farthest.
        const double t = 2 * (distances[i] - depth.middle()) / (depth.greatest - depth.least);
        const double of_least = whole * 0.5 * t * (t - 1), of_middle = whole * (1 - t * t);
        const double of_greatest = whole * 0.5 * t * (t + 1);
        for (std::size_t k = 0; k < value_count_; ++k)
            values[k] += of_least * at_stops[k] + of_middle * at_stops[value_count_ + k] +
                         of_greatest * at_stops[2 * value_count_ + k];
    }
    return true;
}

}  // namespace uw
