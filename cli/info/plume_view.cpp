#include "cli/info/plume_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/vector_math.h"
#include "core/image/colour.h"
#include "core/light/integrator_table.h"
#include "core/light/medium.h"
#include "media/volumes/stratified_field.h"
#include "render/measures/picture_numbers.h"
#include "render/renderer.h"
#include "render/run/draft.h"
#include "render/scene_loading.h"

namespace uw {

namespace {

/// Per pixel, row by row; 0 where no ray enters the water.
std::vector<double> luminances(const Film& film) {
    std::vector<double> values;
    values.reserve(static_cast<std::size_t>(film.width()) *
                   static_cast<std::size_t>(film.height()));
    for (int y = 0; y < film.height(); ++y)
        for (int x = 0; x < film.width(); ++x) {
            const std::span<const float> pixel = film.pixel(x, y);
            const double light = luminance({pixel[k_red], pixel[k_green], pixel[k_blue]});
            values.push_back(pixel[k_alpha] > 0 && std::isfinite(light) ? std::max(light, 0.0) : 0);
        }
    return values;
}

/// Optical depth of the volumes along the rays of all pixels up to the first surface.
std::vector<double> volume_depths(const AssembledScene& scene) {
    const int width = scene.desc().camera.width, height = scene.desc().camera.height;
    std::vector<double> depths(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const ConcentrationField& grids = scene.field->grids();
    const Bounds bounds = grids.bounds();
    if (bounds.empty()) return depths;
    const Medium& medium = scene.water.medium;
    const AttenuationTable attenuation(medium);
    const auto band = static_cast<std::size_t>(medium.band_count() / 2);
    parallel_for(static_cast<std::size_t>(height), [&](std::size_t row) {
        std::vector<double> columns(static_cast<std::size_t>(medium.constituent_count()));
        for (int x = 0; x < width; ++x) {
            const auto ray = scene.camera->refracted_ray(x + 0.5, static_cast<double>(row) + 0.5);
            if (!ray) continue;
            const double end = std::min(scene.surfaces->hit_distance(*ray),
                                        distance(ray->origin, bounds.center()) + bounds.diagonal());
            grids.column(ray->origin, ray->at(end), columns);
            depths[row * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] =
                attenuation.optical_depth(band, 0, columns);
        }
    });
    return depths;
}

}  // namespace

DraftContrast compare_drafts(const AssembledScene& scene, const Film& with, const Film& without) {
    std::vector<double> light = luminances(with);
    const std::vector<double> before = luminances(without);
    const std::vector<double> depths = volume_depths(scene);
    double mean = 0;
    for (const double value : before) mean += value / static_cast<double>(before.size());
    std::vector<double> contrasts, brightness, depth;
    for (std::size_t n = 0; n < depths.size(); ++n) {
        if (!(depths[n] > 0)) continue;
        const double reference = std::max(before[n], mean);
        contrasts.push_back(reference > 0 ? std::abs(light[n] - before[n]) / reference : 0);
        brightness.push_back(light[n]);
        depth.push_back(depths[n]);
    }
    DraftContrast result;
    result.seen = static_cast<double>(contrasts.size()) / static_cast<double>(depths.size());
    if (contrasts.empty()) return result;
    result.contrast = percentile(contrasts, 0.99);
    result.median_contrast = percentile(contrasts, 0.5);
    const double bright = percentile(light, 0.99);
    if (bright > 0) result.brightness = percentile(brightness, 0.5) / bright;
    result.depth = percentile(depth, 0.9);
    return result;
}

ImageScene quick_draft_of(const ImageScene& scene, int width) {
    constexpr int k_max_height = 1024;
    const RenderDesc::Scattering scattering = scattering_of(scene.desc().render);
    const ImageScene quick = scene.with([&](SceneDesc& desc) {
        desc.render.integrator = RenderDesc::Integrator::volume;
        desc.render.scattering = scattering;
    });
    return draft_of(quick, width, k_max_height);
}

namespace {

constexpr double k_filled = 0.9;  // fraction of the picture that the box fills
constexpr const char* k_water = "jerlov-II";

/// The camera's axes in the world, unit.
struct View {
    Vector3 right, up, forward;
};

/// Towards the broader of the box's upright sides; steeper, the flatter the box.
View view_of(const Vector3& size) {
    const Vector3 level = size.x >= size.z ? Vector3(0, 0, -1) : Vector3(-1, 0, 0);
    const double flatness = 1 - std::min(1.0, size.y / std::max(size.x, size.z));
    const double elevation = (6 + 24 * flatness * flatness) * k_degree;
    View view;
    view.forward = std::cos(elevation) * level - std::sin(elevation) * Vector3(0, 1, 0);
    view.right = glm::normalize(glm::cross(view.forward, Vector3(0, 1, 0)));
    view.up = glm::cross(view.right, view.forward);
    return view;
}

double tangent_of_half_width() {
    return std::tan(0.5 * k_proposed_fov * k_degree);
}
double tangent_of_half_height() {
    return tangent_of_half_width() * k_proposed_height / k_proposed_width;
}

/// From where, along the view, all corners of the box lie within the filled part of the picture.
double distance_to(const Bounds& box, const View& view) {
    double away = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
        Point3 p;
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = (corner >> axis & 1U) != 0 ? box.max[axis] : box.min[axis];
        const Vector3 v = p - box.center();
        const double across = std::abs(glm::dot(v, view.right)) / tangent_of_half_width();
        const double upwards = std::abs(glm::dot(v, view.up)) / tangent_of_half_height();
        away = std::max(away, std::max(across, upwards) / k_filled - glm::dot(v, view.forward));
    }
    return away;
}

/// A lamp that lights a ball of this radius around `target`, a hundredth of a W/m^2 falling on it
/// per watt and steradian whatever its distance.
ProposedLamp aimed(const char* name, const Point3& position, const Point3& target, double radius) {
    const Vector3 way = target - position;
    const double away = glm::length(way);
    ProposedLamp lamp;
    lamp.name = name;
    lamp.position = position;
    lamp.direction = way / away;
    const double half = std::asin(std::min(1.0, radius / away)) / k_degree;
    lamp.beam = std::clamp(std::ceil(2.2 * half), 10.0, 120.0);
    lamp.intensity = 20 * away * away;
    return lamp;
}

std::string point_text(const Point3& p, double size) {
    return fmt::format("[{}, {}, {}]", length_text(p.x, size), length_text(p.y, size),
                       length_text(p.z, size));
}

}  // namespace

SceneProposal propose_scene(const Bounds& bounds) {
    const Vector3 size = bounds.max - bounds.min;
    const double radius = 0.5 * bounds.diagonal();
    const View view = view_of(size);
    const double away = distance_to(bounds, view);
    SceneProposal proposal;
    proposal.size = 2 * radius;
    proposal.target = bounds.center();
    proposal.eye = proposal.target - away * view.forward;
    proposal.floor = bounds.min.y - 0.05 * radius;
    proposal.water = k_water;
    // Out of the picture: beyond its edge at the depth at which the lamp stands.
    const auto place = [&](double right, double up, double behind) {
        const double depth = away + behind;
        return proposal.target + right * tangent_of_half_width() * depth * view.right +
               up * tangent_of_half_height() * depth * view.up + behind * view.forward;
    };
    proposal.lamps.push_back(
        aimed("key", place(-1.25, 1.9, -0.2 * radius), proposal.target, radius));
    proposal.lamps.push_back(aimed("back", place(1.15, 1.9, radius), proposal.target, radius));
    proposal.lamps.back().intensity *= 0.6;
    return proposal;
}

std::string length_text(double length, double size) {
    const double step = std::pow(10, std::floor(std::log10(std::max(size, 1e-300))) - 3);
    const double steps = std::round(length / step);
    if (steps == 0) return "0";
    const double digits = std::floor(std::log10(std::abs(steps)) + 1e-9) + 1;
    return fmt::format("{:.{}g}", steps * step, static_cast<int>(std::min(digits, 15.0)));
}

std::string proposal_yaml(const SceneProposal& p) {
    std::string yaml = "uwvdb: 2\n";
    yaml += fmt::format(
        "camera:\n  resolution: [{}, {}]\n  intrinsics: {{fov_x: {:g}}}\n"
        "  pose: {{position: {}, look_at: {}}}\n",
        k_proposed_width, k_proposed_height, k_proposed_fov, point_text(p.eye, p.size),
        point_text(p.target, p.size));
    yaml += fmt::format("water:\n  preset: {}\n", p.water);
    yaml += fmt::format(
        "geometry:\n  - {{type: plane, point: {}, normal: [0, 1, 0], reflectance: [0.12, 0.11, "
        "0.09]}}\n",
        point_text({p.target.x, p.floor, p.target.z}, p.size));
    yaml += "lamps:\n";
    for (const ProposedLamp& lamp : p.lamps)
        yaml += fmt::format(
            "  - name: {}\n    position: {}\n    direction: [{:.3f}, {:.3f}, {:.3f}]\n"
            "    profile: {{type: spot, beam: {:g}, edge: {:g}}}\n    intensity: {:.3g}\n"
            "    frame: world\n",
            lamp.name, point_text(lamp.position, p.size), lamp.direction.x, lamp.direction.y,
            lamp.direction.z, lamp.beam, std::round(0.25 * lamp.beam), lamp.intensity);
    return yaml;
}

namespace {

// The goals: a contrast well above clear visibility, as other water and lamps will give less, rays
// that pass through most of the volume, and a volume that is not a black shape.
constexpr double k_wanted_contrast = 0.6;
constexpr double k_max_depth = 2.5;
constexpr double k_min_brightness = 0.03;
constexpr int k_max_drafts = 8, k_max_pictures = 3;  // of one water and one kind of light
// Multiple scattering has the same nodes in a picture of half the size, in which the contrast is
// within some 1 % of that in the whole one.
constexpr int k_judged_width = k_picture_width / 2;
// Of a volume that fewer pixels see, such as a wire, the brightest hundredth is a handful of
// pixels, and half the size shows others.
constexpr double k_min_seen_at_half_size = 0.05;
constexpr std::array k_waters{"jerlov-II", "jerlov-IB"};

/// Counts the drafts for the progress display.
class DraftCount {
  public:
    explicit DraftCount(const InfoProgress& progress) : progress_(progress) {}

    void next(const char* what) {
        // With and without the volume; small, finer, and in all light.
        constexpr double k_most =
            static_cast<double>(k_waters.size()) * (k_max_drafts + k_max_pictures + 5);
        progress_(std::min(1.0, count_++ / k_most), what);
    }

  private:
    const InfoProgress& progress_;
    int count_ = 0;
};

/// Drafts of one scene with its volume at different concentrations.
class Drafts {
  public:
    Drafts(const SceneProposal& proposal, const VolumeDesc& volume, int width,
           RenderDesc::Scattering scattering, DraftCount& count)
        : count_(count) {
        SceneDesc desc = load_scene_text(proposal_yaml(proposal), "proposal.yaml");
        desc.volumes = {volume};
        desc.render.scattering = scattering;
        renderer_.set_scene(quick_draft_of(std::move(desc), width));
        count_.next("the scene without the volume");
        for (const LoadedVolume& loaded : renderer_.assemble().volumes)
            grids_.insert(grids_.end(), loaded.grids.begin(), loaded.grids.end());
        set_grids({});
        renderer_.render();
        without_.emplace(renderer_.release_film());
    }

    DraftContrast at(double factor) {
        count_.next("how clearly the volume is seen");
        scale_grids(factor);
        const Film& with = renderer_.render();
        return compare_drafts(renderer_.assembled(), with, *without_);
    }

    std::optional<LightLeftOut> light_left_out(double factor) {
        scale_grids(factor);
        return renderer_.light_left_out();
    }

  private:
    void scale_grids(double factor) {
        std::vector<GridVolume> grids;
        for (const GridVolume& grid : grids_) grids.push_back(grid.scaled(factor));
        set_grids(std::move(grids));
    }

    void set_grids(std::vector<GridVolume> grids) {
        AssembledScene scene = renderer_.assembled();
        scene.field = make_field(std::move(grids), scene.water.medium.constituent_count(),
                                 scene.water.strata);
        renderer_.set_scene(std::move(scene));
    }

    DraftCount& count_;
    Renderer renderer_;
    std::vector<GridVolume> grids_;
    std::optional<Film> without_;
};

/// Neither opaque nor black.
bool is_fit(const DraftContrast& draft) {
    return draft.depth <= k_max_depth && draft.brightness >= k_min_brightness;
}

bool is_good(const DraftContrast& draft) {
    return is_fit(draft) && draft.contrast >= k_wanted_contrast;
}

bool will_do(const DraftContrast& draft) {
    return is_fit(draft) && draft.contrast >= k_plain_to_see;
}

/// Whether `a` is to be preferred: first a draft that is acceptable and clearly visible, then the
/// one with more contrast, up to the goal, then the less opaque one.
bool is_better(const DraftContrast& a, const DraftContrast& b) {
    if (will_do(a) != will_do(b)) return will_do(a);
    const auto clear = [](const DraftContrast& d) {
        return std::min(d.contrast, k_wanted_contrast);
    };
    return clear(a) > clear(b) * 1.02 || (clear(a) >= clear(b) && a.depth < b.depth);
}

/// Raises or lowers the concentrations, `factor` times the volume's, until the draft is good, or no
/// longer becomes better.
void improve(Drafts& drafts, int most, double& best_factor, DraftContrast& best) {
    double factor = best_factor;
    const bool raise = best.contrast < k_wanted_contrast && best.depth < k_max_depth;
    for (int n = 1; n < most && !is_good(best); ++n) {
        // If most of the volume is far thinner than its densest part, this takes one step.
        const double step = std::clamp(1 / std::max(best.depth, 1e-12), 2.0, 1e9);
        factor *= raise ? step : 0.5;
        const DraftContrast draft = drafts.at(factor);
        if (!is_better(draft, best)) break;
        best = draft;
        best_factor = factor;
    }
}

PlumeView view_in(const char* water, const VolumeDesc& volume, const Bounds& bounds,
                  DraftCount& count) {
    using Scattering = RenderDesc::Scattering;
    PlumeView view;
    view.proposal = propose_scene(bounds);
    view.proposal.water = water;
    std::optional<Drafts> drafts(std::in_place, view.proposal, volume, k_draft_width,
                                 Scattering::single, count);
    view.draft = drafts->at(1);
    if (view.draft.seen < k_min_seen) {
        drafts.emplace(view.proposal, volume, k_fine_draft_width, Scattering::single, count);
        view.draft = drafts->at(1);
    }
    improve(*drafts, k_max_drafts, view.factor, view.draft);
    count.next("the light that single scattering leaves out");
    view.left_out = drafts->light_left_out(view.factor);
    // The scene is judged by its picture, which depends on the light.
    const bool is_narrow = view.draft.seen < k_min_seen_at_half_size;
    drafts.emplace(view.proposal, volume,
                   view.needs_all_light() && !is_narrow ? k_judged_width : k_picture_width,
                   view.needs_all_light() ? Scattering::multiple : Scattering::single, count);
    view.draft = drafts->at(view.factor);
    if (view.needs_all_light()) improve(*drafts, k_max_pictures, view.factor, view.draft);
    return view;
}

}  // namespace

PlumeView view_plume(const VolumeDesc& volume, const Bounds& bounds, const InfoProgress& progress) {
    DraftCount count(progress);
    PlumeView best;
    for (const char* water : k_waters) {
        PlumeView view = view_in(water, volume, bounds, count);
        if (best.proposal.lamps.empty() || is_better(view.draft, best.draft))
            best = std::move(view);
        // Rendering all light takes seconds: clear visibility suffices.
        if (is_good(best.draft) || (best.needs_all_light() && will_do(best.draft))) break;
    }
    return best;
}

}  // namespace uw
