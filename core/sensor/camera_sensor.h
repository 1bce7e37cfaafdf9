#pragma once

#include <cstdint>

#include "core/base/ray_source.h"
#include "core/image/film.h"
#include "core/image/layers.h"
#include "core/scene/scene_desc.h"
#include "core/sensor/photoelectrons.h"
#include "core/sensor/sensor_readout.h"

namespace uw {

/// The sensor of a scene's camera: turns the light of an image into digital numbers.
class CameraSensor {
  public:
    /// Of frame `frame`. Throws as Photoelectrons. Precondition: the camera has a sensor.
    CameraSensor(const SceneDesc& scene, std::int64_t frame);

    /// Fills the layer `sensor` of all pixels from the light of every band: `plan` has that layer
    /// and, unless there are three bands, `total`. On all permitted threads; neither their number
    /// nor the window changes a pixel. `rays` are those of the camera.
    void expose(const RaySource& rays, const LayerPlan& plan, Film& film) const;

  private:
    SensorMosaic mosaic_;
    Photoelectrons photoelectrons_;
    SensorReadout readout_;
};

}  // namespace uw
