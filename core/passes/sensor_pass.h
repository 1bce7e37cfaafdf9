#pragma once

#include <cstdint>
#include <optional>

#include "core/image/camera_sensor.h"
#include "core/passes/pass.h"

namespace uw {

/// Turns the light of the finished image into the digital numbers of its camera's sensor, if the
/// layer is requested. They are stored as 32-bit floats, which hold whole numbers of 16 bits
/// exactly, so that a film needs no second kind of channel.
class SensorPass final : public Pass {
  public:
    /// `frame`: the number of the image, on which the noise depends.
    SensorPass(const SensorDesc& desc, std::int64_t frame);

    void provide(LayerSupply& supply) const override;
    void prepare(const SceneDesc& scene, const LayerPlan& plan) override;
    void run(Rendering& rendering) override;

  private:
    std::size_t value_count_;
    std::int64_t frame_;
    std::optional<CameraSensor> sensor_;
};

}  // namespace uw
