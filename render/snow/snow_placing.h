#pragma once

#include "core/image/film.h"
#include "core/integrators/sensor.h"
#include "core/snow/snow_image.h"
#include "core/snow/water_veil.h"
#include "render/snow/exposure_views.h"
#include "render/snow/snow_lighting.h"
#include "render/snow/snow_model.h"

namespace uw {

/// What placing the particles of an image needs; all references outlive it.
struct SnowPlacing {
    const SnowModel& model;
    const SnowDesc& desc;
    double time = 0;  // the middle of the exposure [s]
    const std::vector<ExposureView>& views;
    const Surfaces& surfaces;
    const SnowLighting& lighting;
    const WaterVeil& veil;
    const SensorModel& sensor;

    /// Every particle that touches a pixel of `window` and is not behind a surface, on all threads.
    /// `progress` receives the fraction done, from any thread, and may throw.
    SnowSplats splats(const PixelWindow& window,
                      const std::function<void(double fraction)>& progress) const;
};

}  // namespace uw
