#include "cli/sweep/sweep_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "camera/image_size.h"
#include "cli/camera_choice.h"
#include "core/base/error.h"
#include "core/integrators/integrator_table.h"
#include "render/scene_loading.h"

namespace uw {

namespace {

constexpr double k_rendering = 0.9;  // of the time that a picture takes
constexpr int k_usual_width = 480;   // of pictures without --size [pixels]

/// Which value of each axis.
struct Place {
    std::size_t first, second;
};

Place place_of(const SweepArguments& a, std::size_t index) {
    const std::size_t count = a.axes.front().values.size();
    return {index % count, index / count};
}

std::vector<double> values_at(const SweepArguments& a, const Place& at) {
    std::vector<double> values{a.axes[0].values[at.first]};
    if (a.axes.size() > 1) values.push_back(a.axes[1].values[at.second]);
    for (const SweepAxis& companion : a.companions) values.push_back(companion.values[at.first]);
    return values;
}

void shrink(const SweepArguments& a, SceneDesc& scene) {
    const CameraDesc& camera = scene.camera;
    if (a.size)
        resize_image(scene.camera, (*a.size)[0], (*a.size)[1]);
    else if (camera.width > k_usual_width)
        resize_image(scene.camera, k_usual_width,
                     std::max(1, static_cast<int>(std::lround(static_cast<double>(camera.height) *
                                                              k_usual_width / camera.width))));
}

ResolvedScene scene_at(const SweepArguments& a, const Place& at) {
    std::vector<std::string> overrides = a.overrides;
    overrides.push_back(a.axes[0].override_at(at.first));
    if (a.axes.size() > 1) overrides.push_back(a.axes[1].override_at(at.second));
    for (const SweepAxis& companion : a.companions)
        overrides.push_back(companion.override_at(at.first));
    const SceneDesc all = load_scene(a.scene, overrides);
    SceneDesc scene = scene_of_image(all, {a.frame, chosen_camera(a.camera, all.cameras)});
    shrink(a, scene);
    scene.render.quality = a.quality;
    if (a.quality == RenderDesc::Quality::draft)
        scene.render.samples = integrator_kind(scene.render.integrator).draft_samples;
    return scene;
}

class Run {
  public:
    Run(const SweepArguments& arguments, const SweepProgress& progress)
        : a_(arguments),
          progress_(progress),
          renderer_([this](const std::string& stage, double fraction) {
              return tell(stage == "render" ? k_rendering * fraction : 0);
          }) {
        for (const SweepAxis& axis : a_.axes) sweep_.keys.push_back(axis.key);
        for (const SweepAxis& axis : a_.companions) sweep_.keys.push_back(axis.key);
    }

    Sweep take() {
        try {
            for (; done_ < a_.count(); ++done_) measure(place_of(a_, done_));
            tell(0);  // all is done
            sweep_.is_complete = true;
        } catch (const Interrupted&) {
            // What has been measured is the result.
        }
        return std::move(sweep_);
    }

  private:
    bool tell(double share_of_picture) const {
        return progress_((static_cast<double>(done_) + share_of_picture) /
                         static_cast<double>(a_.count()));
    }

    void measure(const Place& at) {
        const ResolvedScene scene = scene_at(a_, at);
        sweep_.width = scene.desc().camera.width;
        sweep_.height = scene.desc().camera.height;
        const RenderOptions options{.layers = layers_to_measure(scene.desc()) +
                                              (a_.parts.object.empty() ? "" : ",id")};
        renderer_.set_scene(scene);
        const Film& film = renderer_.render(options);
        for (const std::string& warning : renderer_.report().warnings) warn(warning);
        const LayerPlan plan = layer_plan(scene.desc(), options.layers);
        const std::vector<PicturePart> parts = picture_parts(
            a_.parts, scene.desc(), renderer_.assembled().surfaces->names(), film, plan);
        SweepPoint point{values_at(a_, at), part_numbers({film, plan}, parts), {}};
        if (a_.target)
            point.target = target_numbers(
                probe_.lamps_on_target(scene, *a_.target, [this] { return tell(k_rendering); }),
                *a_.target, scene.desc().water.bands_nm.size(), probe_.options());
        sweep_.points.push_back(std::move(point));
    }

    void warn(const std::string& warning) {
        if (std::ranges::find(sweep_.warnings, warning) == sweep_.warnings.end())
            sweep_.warnings.push_back(warning);
    }

    const SweepArguments& a_;
    const SweepProgress& progress_;
    Sweep sweep_;
    std::size_t done_ = 0;
    Renderer renderer_;
    TargetProbe probe_;
};

}  // namespace

Sweep run_pictures(const SweepArguments& a, const SweepProgress& progress) {
    for (std::size_t index = 0; index < a.count(); ++index) {
        const ResolvedScene scene = scene_at(a, place_of(a, index));
        const CameraDesc& camera = scene.desc().camera;
        check_parts(a.parts, scene.desc(), {0, 0, camera.width, camera.height});
    }
    return Run(a, progress).take();
}

}  // namespace uw
