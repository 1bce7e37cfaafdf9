#include "render/image_request.h"

#include <fmt/format.h>

#include "camera/image_size.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/integrators/integrator_table.h"

namespace uw {

namespace {

RenderDesc::Integrator integrator_named(const std::string& name) {
    for (const auto& [known, integrator] : k_integrator_names)
        if (name == known) return integrator;
    throw UsageError(fmt::format("--integrator: unknown '{}'; use {}", printable(name),
                                 alternatives(words_of(k_integrator_names))));
}

RenderDesc::Quality quality_named(const std::string& name) {
    for (const auto& [known, quality] : k_quality_names)
        if (name == known) return quality;
    throw UsageError(
        fmt::format("--quality: unknown '{}'; use draft, final or exact", printable(name)));
}

}  // namespace

void apply_request(const ImageRequest& request, SceneDesc& scene) {
    RenderDesc& render = scene.render;
    if (!request.quality.empty()) render.quality = quality_named(request.quality);
    if (!request.integrator.empty()) render.integrator = integrator_named(request.integrator);
    const IntegratorKind& kind = integrator_kind(render.integrator);
    if (render.quality == RenderDesc::Quality::draft) render.samples = kind.draft_samples;
    if (request.samples && request.error)
        throw UsageError("--samples and --error: each says how long to go on; give one of them");
    if (request.samples) render.samples = *request.samples;
    const int most = kind.traces_paths ? k_most_paths : k_most_samples;
    if (samples_of(render) > most)
        throw UsageError(fmt::format(
            "{}: expected 1 to {}, found {}; only integrator path takes more",
            request.samples ? "--samples" : "render.samples", most, samples_of(render)));
    if (request.size) resize_images(scene, (*request.size)[0], (*request.size)[1]);
}

}  // namespace uw
