#include "core/light/lamp.h"

#include <utility>

#include "core/light/directional_emitter.h"
#include "core/light/focused_emitter.h"
#include "core/light/glass_shaded_emitter.h"
#include "core/light/mirrored_emitter.h"
#include "core/light/point_emitter.h"

namespace uw {

Lamp::Lamp(std::string name, std::shared_ptr<const Emitter> emitter, const Spectrum& axis_intensity,
           std::size_t index, double fraction)
    : name_(std::move(name)),
      emitter_(std::move(emitter)),
      axis_intensity_(axis_intensity),
      index_(index),
      fraction_(fraction) {}

Lamp::Lamp(std::string name, const Point3& position, LampProfile profile,
           const Spectrum& axis_intensity)
    : Lamp(std::move(name), std::make_shared<PointEmitter>(position, std::move(profile)),
           axis_intensity) {}

Lamp::Lamp(std::string name, const Sunlight& sunlight, const Spectrum& irradiance)
    : Lamp(std::move(name), std::make_shared<DirectionalEmitter>(sunlight), irradiance) {}

Lamp Lamp::with_index(std::size_t index) const {
    Lamp lamp = *this;
    lamp.index_ = index;
    return lamp;
}

Lamp Lamp::brightened(double factor) const {
    Lamp lamp = *this;
    lamp.axis_intensity_ *= factor;
    return lamp;
}

Lamp Lamp::mirrored(const WaterSurface& surface) const {
    Lamp image = *this;
    image.emitter_ = std::make_shared<MirroredEmitter>(emitter_, surface);
    return image;
}

Lamp Lamp::met_by_paths() const {
    Lamp lamp = *this;
    lamp.is_met_by_paths_ = true;
    return lamp;
}

Lamp Lamp::behind_glass(std::shared_ptr<const GlassOptics> glass) const {
    Lamp lamp = *this;
    lamp.emitter_ = std::make_shared<GlassShadedEmitter>(emitter_, std::move(glass), 0);
    return lamp;
}

std::vector<Lamp> Lamp::behind_coloured_glass(const std::shared_ptr<const GlassOptics>& glass,
                                              std::size_t bands) const {
    std::vector<Lamp> lamps(bands, *this);
    for (std::size_t b = 0; b < bands; ++b) {
        lamps[b].emitter_ = std::make_shared<GlassShadedEmitter>(emitter_, glass, b);
        lamps[b].axis_intensity_ = {};
        lamps[b].axis_intensity_[b] = axis_intensity_[b];
        lamps[b].fraction_ /= static_cast<double>(bands);
    }
    return lamps;
}

Lamp Lamp::focused(std::shared_ptr<const SunFocus> focus) const {
    const Sunlight& calm = *sunlight();
    Lamp sun = *this;
    sun.emitter_ = std::make_shared<FocusedEmitter>(calm.surface, std::move(focus));
    const Vector3& up = calm.surface.normal;
    return sun.brightened(sun.sunlight()->slope(up) / calm.slope(up));
}

bool operator==(const Lamp& a, const Lamp& b) {
    return a.name_ == b.name_ && a.axis_intensity_ == b.axis_intensity_ && a.index_ == b.index_ &&
           a.fraction_ == b.fraction_ && a.is_met_by_paths_ == b.is_met_by_paths_ &&
           *a.emitter_ == *b.emitter_;
}

}  // namespace uw
