#include "cli/render/apply_arguments.h"

#include <fmt/format.h>

#include <string>

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

void apply_arguments(const RenderArguments& a, SceneDesc& desc) {
    RenderDesc& render = desc.render;
    if (!a.quality.empty()) render.quality = quality_named(a.quality);
    if (!a.integrator.empty()) render.integrator = integrator_named(a.integrator);
    const IntegratorKind& kind = integrator_kind(render.integrator);
    if (render.quality == RenderDesc::Quality::draft) render.samples = kind.draft_samples;
    if (a.samples && a.error)
        throw UsageError("--samples and --error: each says how long to go on; give one of them");
    if (a.samples) render.samples = *a.samples;
    const int most = kind.traces_paths ? k_most_paths : k_most_samples;
    if (samples_of(render) > most)
        throw UsageError(
            fmt::format("{}: expected 1 to {}, found {}; only integrator path takes more",
                        a.samples ? "--samples" : "render.samples", most, samples_of(render)));
    if (!a.size) return;
    resize_images(desc, (*a.size)[0], (*a.size)[1]);
}

}  // namespace uw
