#include "core/light/mirrored_emitter.h"

#include <cmath>
#include <utility>

namespace uw {

MirroredEmitter::MirroredEmitter(std::shared_ptr<const Emitter> original,
                                 const WaterSurface& surface)
    : Emitter(original->patch()),
      original_(std::move(original)),
      surface_(surface),
      position_(surface.mirrored(original_->origin({}))) {}

double MirroredEmitter::relative_intensity(const Vector3& v) const {
    const double down = -glm::dot(v, surface_.up());
    if (!(down > 0)) return 0;
    return surface_.reflectance_from_water(down / glm::length(v)) *
           original_->relative_intensity(surface_.mirrored(v));
}

DirectionCone MirroredEmitter::cone() const {
    DirectionCone cone = original_->cone();
    cone.axis = surface_.mirrored(cone.axis);
    return cone;
}

FineStructure MirroredEmitter::fine_structure() const {
    FineStructure fine = original_->fine_structure();
    if (fine.normal) fine.normal = surface_.mirrored(*fine.normal);
    return fine;
}

void MirroredEmitter::append_profile_breaks(const Ray& ray, const Interval& interval,
                                            std::vector<double>& s) const {
    original_->append_profile_breaks(surface_.mirrored(ray), interval, s);
    // The reflectance rises like a square root of the angle up to total reflection, hence the ever
    // shorter steps towards the critical angle.
    const double critical = surface_.critical_cosine(), square = critical * critical;
    for (const double step : {0.0, 1.0 / 256, 1.0 / 64, 1.0 / 16, 1.0 / 4})
        append_cone_crossings(ray, position_, -surface_.up(),
                              std::sqrt(square + step * (1 - square)), s);
}

bool MirroredEmitter::equals(const Emitter& other) const {
    const auto& image = static_cast<const MirroredEmitter&>(other);
    return *original_ == *image.original_ && surface_ == image.surface_;
}

}  // namespace uw
