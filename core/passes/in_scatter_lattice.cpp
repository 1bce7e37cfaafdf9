#include "core/passes/in_scatter_lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/light/integrator.h"

namespace uw {

namespace {

// Wider ones are seen by any rays, but for their first centimetres.
constexpr double k_widest = 80 * std::numbers::pi / 180;
// The least angle from the axis that is told from it [rad], and the factor to the next one.
constexpr double k_narrowest = 1e-6, k_next_angle = 1.1;
constexpr int k_azimuths = 8;
// Beyond this many times the angle of half the intensity, a cosine has 0.02 % of it.
constexpr double k_outer = 3.5;
// By how much rays may bulge out of the planes through a rectangle's corners [pixels].
constexpr double k_bulge = 1;

// The greatest angle from the lamp's axis at which the intensity is half of the greatest one.
double core_angle(const Lamp& emitter, const Vector3& axis) {
    const Vector3 other = std::abs(axis.x) < 0.5 ? Vector3(1, 0, 0) : Vector3(0, 1, 0);
    const Vector3 u = glm::normalize(glm::cross(axis, other)), v = glm::cross(axis, u);
    const auto brightest = [&](double angle) {
        double most = 0;
        for (int k = 0; k < k_azimuths; ++k) {
            const double azimuth = 2 * std::numbers::pi * k / k_azimuths;
            const Vector3 aside = std::cos(azimuth) * u + std::sin(azimuth) * v;
            most = std::max(
                most, emitter.relative_intensity(std::cos(angle) * axis + std::sin(angle) * aside));
        }
        return most;
    };
    std::vector<std::pair<double, double>> intensities;  // by angle
    double most = 0;
    for (double angle = k_narrowest; angle < std::numbers::pi; angle *= k_next_angle) {
        intensities.emplace_back(angle, brightest(angle));
        most = std::max(most, intensities.back().second);
    }
    double core = k_narrowest;
    for (const auto& [angle, intensity] : intensities)
        if (intensity >= 0.5 * most) core = angle;
    return core;
}

// Reduces `part` to where slope * t <= most.
void clip(double slope, double most, Interval& part) {
    if (slope > 0)
        part.end = std::min(part.end, most / slope);
    else if (slope < 0)
        part.begin = std::max(part.begin, most / slope);
    else if (most < 0)
        part.end = part.begin - 1;
}

}  // namespace

FineBeams::FineBeams(const RaySource& rays, const std::vector<Lamp>& emitters) : rays_(rays) {
    std::optional<Beam> beam;
    for (std::size_t i = 0; i < emitters.size(); ++i) {
        const Lamp& emitter = emitters[i];
        if (emitter.sunlight()) continue;
        // The points of a lamp differ by their places alone, and so do their mirror images.
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
    const double core = core_angle(emitter, cone.axis);
    if (core >= k_widest) return std::nullopt;
    double outer = k_outer * core;
    if (!cone.has_all()) outer = std::min(outer, std::max(core, std::acos(cone.cosine)));
    return Beam{{}, glm::normalize(cone.axis), std::tan(core), std::tan(std::min(outer, k_widest))};
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
        // A pixel further, within the rectangle.
        const double dx = x > middle.x ? -1 : 1, dy = y > middle.y ? -1 : 1;
        const std::optional<Ray> ray = rays_.refracted_ray(x, y);
        const std::optional<Ray> beside = rays_.refracted_ray(x + dx, y + dy);
        if (!ray || !beside) return std::nullopt;
        rays[k] = *ray;
        found.pixel =
            std::max(found.pixel, glm::length(beside->direction - ray->direction) / std::sqrt(2.0));
    }
    found.origin = rays.back().origin;
    found.direction = rays.back().direction;
    for (std::size_t k = 0; k < found.outwards.size(); ++k) {
        const Ray &a = rays[k], &b = rays[(k + 1) % found.outwards.size()];
        Vector3 outwards = glm::normalize(glm::cross(a.direction, b.direction));
        if (glm::dot(outwards, found.direction) > 0) outwards = -outwards;
        found.outwards[k] = outwards;
        // Behind a port, rays do not come from one point.
        found.offsets[k] = std::max(glm::dot(outwards, from_origin(a.origin)),
                                    glm::dot(outwards, from_origin(b.origin)));
    }
    return found;
}

void FineBeams::begin(const ImageRectangle& area, double width, double reach) {
    near_.clear();
    reach_ = reach;
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

// The beam at t metres from its lamp is a ball around the point there: each condition is linear.
bool FineBeams::is_fine_in(const Bundle& bundle, const Beam& beam, double width) const {
    const Vector3 to_apex = beam.apex - bundle.origin;
    // The distance of the point at t from the camera, along the ray in the middle: z + t * dz.
    const double z = glm::dot(bundle.direction, to_apex);
    const double dz = glm::dot(bundle.direction, beam.axis);
    Interval part{0, k_far};
    clip(-dz - beam.outer_slope, z, part);
    clip(dz - beam.outer_slope, reach_ - z, part);
    const double margin = k_bulge * bundle.pixel;
    for (std::size_t k = 0; k < bundle.outwards.size(); ++k) {
        const Vector3& outwards = bundle.outwards[k];
        clip(glm::dot(outwards, beam.axis) - beam.outer_slope - margin * dz,
             bundle.offsets[k] - glm::dot(outwards, from_origin(beam.apex)) + margin * z, part);
    }
    if (!(part.begin < part.end)) return false;
    const auto is_fine_at = [&](double t) {
        return 2 * beam.core_slope * t <
               width * bundle.pixel * glm::length(to_apex + t * beam.axis);
    };
    return is_fine_at(part.begin) || is_fine_at(part.end);
}

namespace {

// Interpolation may miss this share of the greatest light that particles of a square take away:
// what is found is a cloud beside the rays, not how its light varies.
constexpr double k_missed = 0.25;
// Less than that, of all light, is not looked for.
constexpr double k_least = 1e-4;
// Where there are particles everywhere, of which the least take more than this share of what the
// most do, they hide what is smaller than the first, wider probes.
constexpr double k_even = 0.5;

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

void FineParticles::begin(const PixelWindow& tile, int edge, double reach) {
    if (!field_) return;
    tile_ = tile;
    reach_ = reach;
    taken_.assign(edge / k_spacing + 1, edge / k_spacing + 1, -1);
}

// The share of light that the particles along a probe take away.
double FineParticles::taken(int i, int j) {
    double& known = taken_(i / k_spacing, j / k_spacing);
    if (known >= 0) return known;
    known = 0;
    const std::optional<Ray> ray = rays_.refracted_ray(tile_.x0 + i + 0.5, tile_.y0 + j + 0.5);
    if (!ray) return known;
    // As far as there are any.
    const Bounds bounds = field_->bounds();
    const double end = std::min(reach_, distance(ray->origin, bounds.center()) +
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
        if (most >= k_least && differs(square, step, spacing, k_missed * most)) return true;
        if (least > k_even * most) return false;
    }
    return false;
}

// The range of what the probes `step` pixels apart say.
Interval FineParticles::range(const Square& square, int step) {
    Interval found{1, 0};
    for (int y = 0; y <= square.height; y += step) {
        for (int x = 0; x <= square.width; x += step) {
            const double here = taken(square.x + x, square.y + y);
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
            const double above = lerp(taken(left, top), taken(left + spacing, top), u);
            const double below =
                lerp(taken(left, top + spacing), taken(left + spacing, top + spacing), u);
            const double here = taken(square.x + x, square.y + y);
            if (std::abs(here - lerp(above, below, v)) > allowed) return true;
        }
    }
    return false;
}

namespace {

// Greatest relative width of a depth (greatest over least distance, minus 1) for which a parabola
// follows the in-scatter to a tenth of the tolerance.
double distance_reach(double tolerance) {
    return 0.12 * std::cbrt(tolerance / 1e-3);
}

// Errors in radiance below this fraction of the tile's mean are measured relative to that level.
constexpr double k_dark = 0.02;

}  // namespace

/// The position within a cell at which to interpolate, and the distances.
struct InScatterLattice::Place {
    double u, v;  // 0..1 across and down the cell
    std::span<const double> distances, weights;
};

InScatterLattice::InScatterLattice(const RaySource& rays, const LitScene& scene,
                                   const RayInScatter& in_scatter, double tolerance)
    : rays_(rays),
      in_scatter_(in_scatter),
      tolerance_(tolerance),
      distance_reach_(distance_reach(tolerance)),
      value_count_(in_scatter.value_count()),
      beams_(rays, *scene.emitters),
      particles_(rays, scene),
      floor_(in_scatter.band_count()),
      interpolated_(value_count_),
      integrated_(value_count_) {}

void InScatterLattice::evaluate(const PixelWindow& tile, const Grid2D<PixelView>& views,
                                std::span<const double> beside) {
    tile_ = tile;
    views_ = &views;
    beside_.assign(beside.begin(), beside.end());
    pixel_values_.assign(views.size() * value_count_, 0.0);
    collect_distances();
    nodes_.assign(k_side, k_side);
    node_values_.clear();
    set_floor();
    const double reach =
        distances_.empty() ? 0 : *std::max_element(distances_.begin(), distances_.end());
    beams_.begin(cell(0, 0, k_coarsest), k_coarsest / 2, reach);
    particles_.begin(tile, k_tile, reach);
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
        const bool ready = node.reach > 0 && integrate_node(i, j, node);
        node.state = ready ? Node::State::ready : Node::State::unusable;
    }
    return node;
}

/// The depths at which the water ends in the pixels around a node, within the radius where there
/// are few of them.
void InScatterLattice::find_depths(int i, int j, Node& node) const {
    int reach = k_coarsest;
    while (i % reach != 0 || j % reach != 0) reach /= 2;
    for (; reach >= k_finest; reach /= 2) {
        node.depth_count = 0;
        bool few = true;
        // A node beyond the image's edge may reach none of its pixels.
        const int x0 = std::clamp(i - reach, 0, tile_.width());
        const int x1 = std::min(i + reach, tile_.width() - 1);
        const int y0 = std::max(0, j - reach), y1 = std::min(j + reach, tile_.height() - 1);
        for (int y = y0; y <= y1 && few; ++y) {
            const std::size_t* first = &first_distances_[views_->index(0, y)];
            for (std::size_t at = first[x0]; at < first[x1 + 1] && few; ++at)
                few = include(distances_[at], node);
        }
        if (!few) continue;
        if (node.depth_count > 0) node.reach = reach;
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
        if (greatest > (1 + distance_reach_) * least) continue;
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
        if (corner.state != Node::State::ready || corner.reach < spacing) return false;
        found[c] = &corner;
    }
    return true;
}

bool InScatterLattice::confirmed(int i, int j, int spacing) {
    // Pointers stay valid: all nodes are allocated from the start.
    Corners from{};
    if (!corners(i, j, spacing, from)) return false;
    const int half = spacing / 2;
    // Few pixels lie in small cells, and features that five nodes miss in a large one are found
    // by those of smaller ones.
    const double allowed = tolerance_ * std::sqrt(static_cast<double>(k_coarsest) / spacing);
    for (int v = 0; v <= 2; ++v) {
        for (int u = 0; u <= 2; ++u) {
            if (u != 1 && v != 1) continue;
            const Node& middle = node(i + u * half, j + v * half);
            if (middle.state != Node::State::ready || middle.reach < half) return false;
            // Up to every surface seen around the node, not only the one it sees itself.
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
        const double reference = std::max(light + beside_[b], floor_[b]);
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

/// `spacing`: that of the lattice from which the pixel is interpolated; 0: none.
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
        // Corners know the depths of all pixels within their reach.
        if (weight > 0) add_node(*from[c], weight, view.distances, view.weights, values);
    }
    // Parabolas through the light of a lamp that shines behind the surface alone go below zero.
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
        // -1..1 from the nearest to the farthest.
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
