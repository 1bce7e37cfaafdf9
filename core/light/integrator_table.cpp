#include "core/light/integrator_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/base/error.h"
#include "core/light/planes_integrator.h"
#include "core/light/reference_integrator.h"
#include "core/light/volume_integrator.h"

namespace uw {

namespace {

// Paths are a reference, so that the estimators beside them interpolate nothing either.
LightTransport make_path(const IntegratorInputs& inputs) {
    return {std::make_unique<ReferenceIntegrator>(inputs.scene),
            std::make_unique<DirectLighting>(inputs.scene)};
}

// Renders all light without bias by random paths from the camera (`render.integrator: path`). The
// caller of `make` adds the path tracer (LightTransport::paths): this layer does not know it.
constinit const IntegratorKind k_path_kind{.traces_paths = true,
                                           .multiple_scattering = true,
                                           .samples = 16,
                                           .draft_samples = 4,
                                           .make = make_path};

struct Entry {
    RenderDesc::Integrator integrator;
    const IntegratorKind& kind;
};

// The same size as the list of names: omitting an integrator is a compile-time error.
constexpr std::array<Entry, k_integrator_names.size()> k_integrators{
    {{RenderDesc::Integrator::volume, VolumeIntegrator::k_kind},
     {RenderDesc::Integrator::planes, PlanesIntegrator::k_kind},
     {RenderDesc::Integrator::reference, ReferenceIntegrator::k_kind},
     {RenderDesc::Integrator::path, k_path_kind}}};

static_assert(std::ranges::all_of(k_integrator_names, [](const auto& named) {
    return std::ranges::any_of(
        k_integrators, [&](const Entry& entry) { return entry.integrator == named.second; });
}));

void check_scattering(const SceneDesc& scene) {
    using Scattering = RenderDesc::Scattering;
    const RenderDesc& render = scene.render;
    const IntegratorKind& kind = integrator_kind(render.integrator);
    const Scattering scattering = scattering_of(render);
    if (kind.traces_paths && scattering == Scattering::single)
        throw InputError(fmt::format(
            "{}: the integrator path always renders all light; write multiple, or leave it out; "
            "for single scattering use integrator volume",
            render.scattering_where));
    if (scattering == Scattering::single) return;
    if (!kind.multiple_scattering)
        throw InputError(
            fmt::format("{}: this integrator renders light scattered once only; use integrator "
                        "volume or path for multiple scattering",
                        render.scattering_where));
    if (scene.water.forward_scatter.K > 0)
        throw InputError(fmt::format(
            "{}: its blur stands for light that multiple scattering renders, which would count "
            "twice; set K: 0, or use integrator volume with render.scattering: single",
            scene.water.forward_scatter.where));
    if (render.output == RenderDesc::Output::paper)
        throw InputError(fmt::format(
            "{}: the paper's formula has a factor for the distance at which light was scattered "
            "once, and none for light scattered more often; write sensor_irradiance, or use "
            "integrator volume with render.scattering: single",
            render.output_where));
}

}  // namespace

const IntegratorKind& integrator_kind(RenderDesc::Integrator integrator) {
    return std::ranges::find(k_integrators, integrator, &Entry::integrator)->kind;
}

RenderDesc::Scattering scattering_of(const RenderDesc& render) {
    if (render.scattering) return *render.scattering;
    const IntegratorKind& kind = integrator_kind(render.integrator);
    if (kind.traces_paths) return RenderDesc::Scattering::multiple;
    return kind.multiple_scattering ? render.default_scattering : RenderDesc::Scattering::single;
}

int samples_of(const RenderDesc& render) {
    return render.samples.value_or(integrator_kind(render.integrator).samples);
}

void check_integrator(const SceneDesc& scene) {
    if (scene.water.snow && integrator_kind(scene.render.integrator).traces_paths)
        throw InputError(fmt::format(
            "{}: the integrator path has no particles, only their mean; use integrator volume, "
            "with render.scattering: multiple for all light, or take the snow out",
            scene.water.snow->where));
    check_scattering(scene);
    integrator_kind(scene.render.integrator).check(scene);
}

}  // namespace uw
