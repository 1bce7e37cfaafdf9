#include "render/exposed_image.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/frame/exposure_mean.h"
#include "core/integrators/integrator_table.h"

namespace uw {

namespace {

/// The rows of `window` that have a share of a part; all of them for forward scatter, whose light
/// comes from everywhere.
PixelWindow rows_of_part(const Exposure& exposure, int part, bool needs_all,
                         const PixelWindow& window) {
    if (needs_all) return window;
    PixelWindow rows = window;
    while (rows.y0 < rows.y1 && exposure.share(part, rows.y0) == 0) ++rows.y0;
    while (rows.y1 > rows.y0 && exposure.share(part, rows.y1 - 1) == 0) --rows.y1;
    return rows;
}

void find_truth(const AssembledScene& scene, const Camera& camera, const LightTransport& transport,
                const PointMatchers& matchers, const LayerPlan& plan, Film& film,
                const std::function<bool(int row)>& is_wanted) {
    const PixelRenderer pixels(camera, scene.lit(), transport, {}, {}, SensorModel(scene.desc), {},
                               matchers);
    const PixelWindow& window = film.window();
    parallel_for(static_cast<std::size_t>(window.height()), [&](std::size_t line) {
        thread_local PixelResult result;
        const int y = window.y0 + static_cast<int>(line);
        for (int x = window.x0; x < window.x1 && is_wanted(y); ++x) {
            pixels.find_truth(x, y, result);
            store_truth(result, plan, film.pixel(x, y));
        }
    });
}

/// Tells what the parts have reached as if they were one image.
class ReachedByParts {
  public:
    ReachedByParts(const ImageCallbacks& reached, int parts) : reached_(reached), parts_(parts) {}

    ImageCallbacks of_part() {
        return {[this](const PathAccuracy& part) { paths_ = part; },
                [this](double error) { multiple_ = std::max(multiple_, error); },
                [this](std::size_t count) { snow_ = std::max(snow_, count); }};
    }
    /// The errors of the parts' light paths are independent.
    void finish_part() {
        samples_ += paths_.samples;
        if (paths_.error) squares_ += *paths_.error * *paths_.error;
    }
    void finish(int samples_of_pixel) const {
        if (samples_ > 0 && reached_.paths) {
            PathAccuracy all{samples_of_pixel, {}};
            if (squares_ > 0) all.error = std::sqrt(squares_) / parts_;
            reached_.paths(all);
        }
        if (multiple_ > 0 && reached_.multiple) reached_.multiple(multiple_);
        if (snow_ > 0 && reached_.particles) reached_.particles(snow_);
    }

  private:
    const ImageCallbacks& reached_;
    int parts_;
    PathAccuracy paths_;
    int samples_ = 0;
    double squares_ = 0, multiple_ = 0;
    std::size_t snow_ = 0;  // particles of the part with the most
};

}  // namespace

void render_exposure(const Exposure& exposure, const AssembledScene& scene,
                     const LightTransport& transport, const LightOfPart& light_of_part,
                     const LayerPlan& plan, const BandColour& colour, Film& film,
                     const RenderProgress& progress, const ImageCallbacks& reached,
                     const PointMatchers& matchers) {
    const SceneDesc& desc = scene.desc;
    if (desc.water.snow && desc.water.snow->in_ground_truth)
        throw InputError(
            "water.snow.ground_truth: held is for images in which nothing but the snow moves while "
            "the shutter is open; give --set water.snow.ground_truth=ignored");
    const bool scatters_forward = desc.water.forward_scatter.K > 0;
    const LightTerms terms{scatters_forward,
                           scattering_of(desc.render) == RenderDesc::Scattering::multiple,
                           desc.water.snow.has_value()};
    const int parts = exposure.part_count();
    ReachedByParts reached_by_parts(reached, parts);
    ExposureMean mean(plan, terms, colour, film);
    const Camera truth_camera = camera_of_truth(desc);
    const bool truth_differs = exposure.is_rolling() && exposure.moves_surfaces();
    for (int k = 0; k < parts; ++k) {
        const auto tell = [&](const std::string& stage, double fraction) {
            const double done = stage == "render" ? fraction : stage == "forward scatter" ? 1 : 0;
            return progress("render", (k + done) / parts);
        };
        if (!tell("", 0)) throw Interrupted();
        const AssembledScene part = exposure.part(k);
        const DeepShadows light = light_of_part(part);
        const LightTransport part_transport = make_light_transport(part, light);
        const PixelWindow rows = rows_of_part(exposure, k, scatters_forward, film.window());
        if (rows.y0 < rows.y1) {
            Film image(film.width(), film.height(), rows, film.channel_names());
            render_scene(part, light, part_transport, plan, colour, image, tell,
                         {.samples = exposure.samples_of_part()}, reached_by_parts.of_part());
            reached_by_parts.finish_part();
            mean.add(image, [&](int row) { return exposure.share(k, row); });
        }
        if (truth_differs)
            find_truth(part, truth_camera, part_transport, matchers, plan, film,
                       [&](int row) { return exposure.has_middle(k, row); });
    }
    mean.finish();
    if (!truth_differs)
        find_truth(scene, truth_camera, transport, matchers, plan, film, [](int) { return true; });
    reached_by_parts.finish(samples_of(desc.render));
}

}  // namespace uw
