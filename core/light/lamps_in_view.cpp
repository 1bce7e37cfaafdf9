#include "core/light/lamps_in_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/base/numerics.h"
#include "core/light/lamp_passage.h"
#include "core/light/point_emitter.h"
#include "core/light/ray_panels.h"

namespace uw {

namespace {

// A lamp may lie this far behind the surface to which it is fixed [m].
constexpr double k_contact = 1e-4;
// A flat surface viewed at less than this sine is a line: with a profile that does not fall like
// the cosine, its radiance would grow without bound there.
constexpr double k_edge_on = 1e-3;
// The light of a point is not corrected on rays farther from it than this many radii of its patch.
constexpr double k_corrected_radii = 3;

// The table covers psi = 1e-6, below which the integrals are negligible, to pi - 1e-4.
constexpr double k_min_octave = -21, k_max_octave = 14;
constexpr int k_knots_per_octave = 32;
constexpr auto k_knots =
    static_cast<std::size_t>(k_max_octave - k_min_octave) * k_knots_per_octave + 1;

double half_tangent_at(double knot) {
    return std::exp2(k_min_octave + knot / k_knots_per_octave);
}

}  // namespace

bool LampSurface::is_passed_by(const Ray& ray) const {
    const Vector3 across = glm::cross(lamp.position() - ray.origin, ray.direction);
    const double half = frame.extent.shape == LampExtentDesc::Shape::rectangle
                            ? 0.5 * std::hypot(frame.extent.width, frame.extent.height)
                            : frame.extent.radius;
    const double near = half + k_corrected_radii * emitters.patch_radius;
    return glm::dot(across, across) <= near * near;
}

PhaseIntegrals::PhaseIntegrals(const Medium& medium)
    : phases_(medium.phase_functions.size()), integrals_(k_knots * phases_) {
    for (std::size_t m = 0; m < phases_; ++m) {
        const PhaseFunction& phase = *medium.phase_functions[m];
        const auto angle = [](double knot) { return 2 * std::atan(half_tangent_at(knot)); };
        double sum = 0;
        for (std::size_t knot = 1; knot < k_knots; ++knot) {
            const auto at = static_cast<double>(knot);
            const double begin = angle(at - 1), end = angle(at);
            sum += (end - begin) / 6 *
                   (phase.eval(begin) + 4 * phase.eval(0.5 * (begin + end)) + phase.eval(end));
            integrals_[knot * phases_ + m] = sum;
        }
    }
}

void PhaseIntegrals::add(double half_tangent, double factor, std::span<double> sums) const {
    const double octave = std::log2(std::max(half_tangent, 0x1p-21));
    const double place = std::min((octave - k_min_octave) * k_knots_per_octave,
                                  static_cast<double>(k_knots) - 1.001);
    const auto knot = static_cast<std::size_t>(place);
    const double t = place - static_cast<double>(knot);
    const double* const begin = &integrals_[knot * phases_];
    for (std::size_t m = 0; m < phases_; ++m)
        sums[m] += factor * (begin[m] + t * (begin[m + phases_] - begin[m]));
}

LampEvenness::LampEvenness(const LitScene& scene) : scene_(scene) {
    if (scene.lamp_surfaces) integrals_.emplace(*scene.medium);
}

void LampEvenness::integrate(const LampPoints& points, const Ray& ray, const Interval& interval,
                             std::span<double> scattered) const {
    std::ranges::fill(scattered, 0.0);
    for (const Point3& position : points.positions) {
        LampPassage passage(ray, position);
        passage.distance = std::sqrt(passage.distance * passage.distance +
                                     squared_offset(position, points.patch_radius, ray));
        const double factor = 1 / (passage.distance * static_cast<double>(points.positions.size()));
        const auto add = [&](double s, double sign) {
            integrals_->add(passage.half_tangent(s, passage.radius(s)), sign * factor, scattered);
        };
        add(interval.end, 1);
        add(interval.begin, -1);
    }
}

Spectrum LampEvenness::one() const {
    return per_band(scene_.medium->wavelengths_nm.size(), [](std::size_t) { return 1.0; });
}

Spectrum LampEvenness::of(std::size_t lamp, const Ray& ray, const Interval& interval) const {
    if (!integrals_) return one();
    const auto surface = std::ranges::find_if(
        *scene_.lamp_surfaces, [&](const LampSurface& s) { return s.lamp.index() == lamp; });
    if (surface == scene_.lamp_surfaces->end() || !surface->is_passed_by(ray)) return one();
    std::vector<double> of_emitters(integrals_->phase_count()), of_many(integrals_->phase_count());
    integrate(surface->emitters, ray, interval, of_emitters);
    integrate(surface->many, ray, interval, of_many);
    const Medium& medium = *scene_.medium;
    std::vector<double> concentration(medium.constituents.size());
    const LampPassage passage(ray, surface->lamp.position());
    if (!concentration.empty())
        scene_.field->sample(ray.at(std::clamp(passage.foot, interval.begin, interval.end)),
                             concentration);
    return per_band(medium.wavelengths_nm.size(), [&](std::size_t band) {
        double truth = 0, found = 0;
        for (std::size_t m = 0; m < of_many.size(); ++m) {
            double b = medium.uniform.scattering[m][band];
            for (std::size_t k = 0; k < concentration.size(); ++k)
                b += concentration[k] * medium.constituents[k].per_unit.scattering[m][band];
            truth += b * of_many[m];
            found += b * of_emitters[m];
        }
        return truth > 0 && found > 0 ? truth / found : 1.0;
    });
}

void LampEvenness::find(std::size_t lamp, const Ray& ray, double begin,
                        std::span<const double> distances, std::vector<Spectrum>& result) const {
    result.clear();
    for (const double distance : distances) {
        result.push_back(of(lamp, ray, {begin, distance}));
        begin = distance;
    }
}

double LampSurface::crossing(const Ray& ray) const {
    constexpr double k_nowhere = std::numeric_limits<double>::infinity();
    if (!frame.is_flat()) {
        const LampPassage passage(ray, lamp.position());
        return passage.foot > 0 && passage.distance <= frame.extent.radius ? passage.foot
                                                                           : k_nowhere;
    }
    const Vector3 normal = glm::cross(frame.x, frame.y);
    const double towards = glm::dot(normal, ray.direction);
    if (towards == 0) return k_nowhere;
    const double s = glm::dot(normal, lamp.position() - ray.origin) / towards;
    if (!(s > 0)) return k_nowhere;
    const Vector3 from_center = ray.at(s) - lamp.position();
    const double across = glm::dot(from_center, frame.x), along = glm::dot(from_center, frame.y);
    const bool is_inside =
        frame.extent.shape == LampExtentDesc::Shape::disk
            ? across * across + along * along <= frame.extent.radius * frame.extent.radius
            : std::abs(across) <= 0.5 * frame.extent.width &&
                  std::abs(along) <= 0.5 * frame.extent.height;
    return is_inside ? s : k_nowhere;
}

double LampSurface::radiance_towards(const Ray& ray) const {
    const double cosine =
        frame.is_flat() ? std::abs(glm::dot(glm::cross(frame.x, frame.y), ray.direction)) : 1;
    if (cosine < k_edge_on) return 0;
    return lamp.relative_intensity(-ray.direction) / (frame.area() * cosine);
}

namespace {

/// The columns of a profile at distances along its ray, each near the one before.
class ColumnWalk {
  public:
    explicit ColumnWalk(const ConcentrationProfile& profile) : profile_(profile) {}

    void find(double s, std::vector<double>& column) {
        const auto count = static_cast<std::size_t>(profile_.constituent_count);
        column.resize(count);
        if (count == 0) return;
        while (knot_ > 0 && profile_.s[knot_] > s) --knot_;
        while (knot_ + 2 < profile_.s.size() && profile_.s[knot_ + 1] < s) ++knot_;
        const double length = profile_.s[knot_ + 1] - profile_.s[knot_];
        const double t = std::clamp((s - profile_.s[knot_]) / length, 0.0, 1.0);
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t at = knot_ * count + k;
            const double begin = profile_.concentration[at];
            const double slope = profile_.concentration[at + count] - begin;
            column[k] = profile_.column[at] + t * length * (begin + 0.5 * t * slope);
        }
    }

  private:
    const ConcentrationProfile& profile_;
    std::size_t knot_ = 0;
};

}  // namespace

// Between the knots of the grid, which are a quarter of a voxel apart unless it is constant, the
// grid's value is linear and the columns are smooth: two Gauss nodes per 0.5 of optical depth
// suffice.
void LampsInView::append_volume(const SceneEmission& emissive, const Ray& ray, double max_distance,
                                std::vector<SeenLamp>& visible) const {
    const ConcentrationField& field = *emissive.volume->field;
    const double end = std::min(max_distance, inside(ray, field.bounds()).end);
    if (!(end > 0)) return;
    ConcentrationProfile light, water;
    std::vector<double> column;
    field.profile(ray, end, light);
    SeenLamp lamp{emissive.lamp, 0, {}, {}, true};
    double weight = 0;
    std::optional<ColumnWalk> columns;
    // The least and the greatest optical depth of the bands.
    const auto depths = [&](double s, const std::vector<double>& at) {
        Interval found{k_far, 0};
        for (std::size_t b = 0; b < static_cast<std::size_t>(attenuation_.band_count); ++b) {
            const double depth = attenuation_.optical_depth(b, s, at);
            found = {std::min(found.begin, depth), std::max(found.end, depth)};
        }
        return found;
    };
    constexpr double k_piece = 0.5,
                     k_deep = 20;  // optical depths; beyond the latter e^-tau is negligible
    constexpr int k_max_pieces = 64;
    for (std::size_t knot = 0; knot + 1 < light.s.size(); ++knot) {
        if (light.empty_between(knot)) continue;
        if (!columns) {
            scene_.field->profile(ray, end, water);
            columns.emplace(water);
        }
        const double begin = light.s[knot], length = light.s[knot + 1] - begin;
        const double first = light.concentration[knot], last = light.concentration[knot + 1];
        columns->find(begin, column);
        const Interval before = depths(begin, column);
        columns->find(begin + length, column);
        const Interval behind = depths(begin + length, column);
        const int pieces =
            before.begin > k_deep
                ? 1
                : std::clamp(static_cast<int>((behind.end - before.end) / k_piece) + 1, 1,
                             k_max_pieces);
        for (int piece = 0; piece < pieces; ++piece)
            for (const QuadratureNode& node : gauss_legendre(2)) {
                const double t = (piece + node.position) / pieces, s = begin + t * length;
                const Spectrum emitted = node.weight * length / pieces *
                                         emissive.volume->emission.of(first + t * (last - first));
                columns->find(s, column);
                lamp.radiance += emitted;
                lamp.arriving += attenuation_.transmittance(s, column) * emitted;
                double sum = 0;
                for (const double band : emitted) sum += band;
                lamp.distance += sum * s;
                weight += sum;
            }
    }
    if (weight == 0) return;
    lamp.distance /= weight;
    visible.push_back(lamp);
}

void LampsInView::append(const Ray& ray, double max_distance,
                         std::vector<SeenLamp>& visible) const {
    if (scene_.emissions)
        for (const SceneEmission& emissive : *scene_.emissions)
            append_volume(emissive, ray, max_distance, visible);
    if (!scene_.lamp_surfaces) return;
    for (const LampSurface& surface : *scene_.lamp_surfaces) {
        const double distance = surface.crossing(ray);
        if (!(distance < max_distance + k_contact && distance < k_far)) continue;
        const double radiance = surface.radiance_towards(ray);
        if (radiance == 0) continue;
        std::vector<double> column(scene_.medium->constituents.size());
        if (!column.empty()) scene_.field->column(ray.origin, ray.at(distance), column);
        SeenLamp& lamp = visible.emplace_back();
        lamp.lamp = surface.lamp.index();
        lamp.distance = distance;
        lamp.radiance = radiance * surface.lamp.axis_intensity();
        lamp.arriving = (attenuation_.transmittance(distance, column) * lamp.radiance);
    }
}

}  // namespace uw
