#include "core/passes/pass.h"

#include "core/base/error.h"

namespace uw {

PassNeeds Pass::needs(const LayerPlan& /*plan*/) const {
    return {};
}
void Pass::provide(LayerSupply& /*supply*/) const {}
void Pass::prepare(const SceneDesc& /*scene*/, const LayerPlan& /*plan*/) {}
void Pass::share(Rendering& /*middle*/) {}
void Pass::begin(Rendering& /*rendering*/) {}
void Pass::end(Rendering& /*rendering*/) {}

LayerSupply PassList::supply() const {
    LayerSupply supply;
    for (const auto& pass : passes_) pass->provide(supply);
    return supply;
}

PassNeeds PassList::needs(const LayerPlan& plan) const {
    PassNeeds all;
    for (const auto& pass : passes_) {
        const PassNeeds needs = pass->needs(plan);
        all.light |= needs.light;
        all.slabs |= needs.slabs;
        all.paths |= needs.paths;
        all.whole_image |= needs.whole_image;
    }
    return all;
}

void PassList::prepare(const SceneDesc& scene, const LayerPlan& plan) {
    for (const auto& pass : passes_) pass->prepare(scene, plan);
}

void PassList::share(Rendering& middle) {
    for (const auto& pass : passes_)
        if (pass->of() == Pass::Of::light) pass->share(middle);
}

void PassList::run(Pass::Of of, Rendering& rendering) {
    for (const auto& pass : passes_)
        if (pass->of() == of) pass->begin(rendering);
    for (const auto& pass : passes_) {
        if (pass->of() != of) continue;
        if (pass->stage()) rendering.progress(*pass->stage(), 0);
        throw_if_stopped();
        pass->run(rendering);
    }
    for (const auto& pass : passes_)
        if (pass->of() == of) pass->end(rendering);
}

}  // namespace uw
