#include "core/passes/sensor_pass.h"

namespace uw {

SensorPass::SensorPass(const SensorDesc& desc, std::int64_t frame)
    : Pass(std::nullopt, Of::image), value_count_(value_count(desc.mosaic)), frame_(frame) {}

void SensorPass::provide(LayerSupply& supply) const {
    supply.layers |= {Layer::sensor};
    supply.sensor_values = value_count_;
}

void SensorPass::prepare(const SceneDesc& scene, const LayerPlan& plan) {
    if (plan.has(Layer::sensor)) sensor_.emplace(scene, frame_);
}

void SensorPass::run(Rendering& rendering) {
    if (sensor_) sensor_->expose(rendering.pixels.rays(), rendering.plan, rendering.film);
}

}  // namespace uw
