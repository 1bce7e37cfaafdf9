#include "render/light_left_out.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "core/base/parallel.h"
#include "core/light/integrator_table.h"
#include "core/passes/path_pass.h"
#include "core/paths/path_tracer.h"
#include "core/paths/scattering_tables.h"
#include "render/scene_assembly.h"
#include "render/scene_rendering.h"

namespace uw {

namespace {

// For so few paths, guiding distributions need not be finer.
constexpr LampRadianceTable::Fineness k_guides{.orders = 8, .is_coarse = true};

// A path vertex takes about the work of six camera rays of single scattering, so that this is a
// tenth of the work of the image.
constexpr double k_vertices_per_ray = 1.0 / 64;
constexpr double k_min_vertices = 2000, k_max_vertices = 20'000;
constexpr std::size_t k_max_places = 1152;
constexpr std::size_t k_places_at_once = 4;  // traced before the work done is checked again
constexpr double k_vertices_of_place = 2;    // work of a place, apart from its paths

/// Returns a point of a low-discrepancy sequence in the unit square (Roberts 2018, "The
/// unreasonable effectiveness of quasirandom sequences").
std::pair<double, double> even_place(std::size_t number) {
    double whole = 0;
    const auto n = static_cast<double>(number);
    return {std::modf(0.5 + 0.7548776662466927 * n, &whole),
            std::modf(0.5 + 0.5698402909980532 * n, &whole)};
}

double max_work(const PixelRenderer& pixels) {
    const RaySource& rays = pixels.rays();
    return std::clamp(k_vertices_per_ray * rays.width() * rays.height() * pixels.samples(),
                      k_min_vertices, k_max_vertices);
}

/// The light at a place of the image: emitted, or scattered or reflected only once, and all other.
struct Light {
    double single = 0, multiple = 0;
};

/// Sums over places of light, and of its squares and products.
class Sums {
  public:
    void add(const Light& light) {
        ++count_;
        const double all = light.single + light.multiple;
        all_ += all, multiple_ += light.multiple;
        of_all_ += all * all, of_multiple_ += light.multiple * light.multiple,
            of_both_ += all * light.multiple;
    }

    /// Returns the ratio of two means and its standard error (Cochran 1977, eq. 2.46).
    std::optional<LightLeftOut> ratio() const {
        if (!(all_ > 0)) return std::nullopt;
        const double ratio = multiple_ / all_;
        const double squares =
            std::max(0.0, of_multiple_ - 2 * ratio * of_both_ + ratio * ratio * of_all_);
        return LightLeftOut{ratio, std::sqrt(count_ / std::max(1.0, count_ - 1) * squares) / all_};
    }

  private:
    double count_ = 0, all_ = 0, multiple_ = 0, of_all_ = 0, of_multiple_ = 0, of_both_ = 0;
};

}  // namespace

std::optional<LightLeftOut> estimate_light_left_out(const AssembledScene& scene) {
    if (scattering_of(scene.desc().render) == RenderDesc::Scattering::multiple) return std::nullopt;
    LightTransport transport = make_path_transport(
        scene, std::make_shared<const ScatteringTables>(scene.water.medium, k_guides));
    const PixelRenderer pixels = pixel_renderer(scene, transport);
    const PathPixels paths(pixels, 0);
    const RaySource& rays = pixels.rays();
    const double max_work_of_image = max_work(pixels);
    Sums sums;
    double work = 0;
    // The work of a path is the same in every run, and so is the number of places.
    for (std::size_t first = 0; first < k_max_places && work < max_work_of_image;
         first += k_places_at_once) {
        std::array<PathTrial, k_places_at_once> trials;
        parallel_for(trials.size(), [&](std::size_t i) {
            const auto [x, y] = even_place(first + i);
            trials[i] = paths.run_trial(x * rays.width(), y * rays.height(), first + i, 1);
        });
        for (const PathTrial& trial : trials) {
            Light light{trial.single, 0};
            work += k_vertices_of_place;
            for (const PathTrial::OfKind& kind : trial.kinds) {
                light.multiple += kind.mean;
                work += kind.work;
            }
            sums.add(light);
        }
    }
    return sums.ratio();
}

std::string settings_of_all_light(const SceneDesc& scene) {
    std::string how = "render.scattering: multiple";
    if (!integrator_kind(scene.render.integrator).multiple_scattering)
        how += " and render.integrator: volume";
    if (scene.water.forward_scatter.K > 0) how += " and water.forward_scatter.K: 0";
    return how;
}

std::optional<std::string> left_out_note(const AssembledScene& scene,
                                         const std::optional<LightLeftOut>& left_out) {
    if (!left_out || !left_out->matters()) return std::nullopt;
    const SceneDesc& desc = scene.desc();
    // The paper's image has no other light.
    if (desc.render.output == RenderDesc::Output::paper) return std::nullopt;
    return fmt::format(
        "single scattering leaves out about {:.0f} % of this image's light, which is scattered or "
        "reflected more than once; {} renders it",
        100 * left_out->fraction, settings_of_all_light(desc));
}

}  // namespace uw
