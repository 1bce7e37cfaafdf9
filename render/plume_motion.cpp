#include "render/plume_motion.h"

#include <utility>

#include "media/volumes/grid_field.h"

namespace uw {

PlumeMotion::PlumeMotion(const AssembledScene& scene, Camera next, double seconds)
    : next_(std::move(next)), seconds_(seconds) {
    const Medium& medium = scene.water.medium;
    const auto bands = static_cast<std::size_t>(medium.band_count());
    for (const Constituent& constituent : medium.constituents) {
        double sum = 0;
        for (std::size_t b = 0; b < bands; ++b) sum += constituent.per_unit.attenuation(b);
        per_unit_.push_back(sum / medium.band_count());
    }
    const std::vector<VolumeDesc>& volumes = scene.desc().volumes;
    for (std::size_t v = 0; v < volumes.size(); ++v)
        if (volumes[v].motion && !volumes[v].grids.empty())
            volumes_.push_back({&scene.volumes.at(v), VolumeVelocity(volumes[v])});
}

double PlumeMotion::attenuation_at(const LoadedVolume& volume, const Point3& point) const {
    double sum = 0;
    for (const GridVolume& grid : volume.grids) {
        const double value = grid.value(point);
        for (const GridLoad& load : grid.loads())
            sum += value * load.per_unit * per_unit_[static_cast<std::size_t>(load.constituent)];
    }
    return sum;
}

std::optional<PointMatch> PlumeMotion::match(const Point3& point) const {
    Vector3 drift(0.0);
    double weights = 0;
    for (const Moving& moving : volumes_) {
        const double weight = attenuation_at(*moving.volume, point);
        if (!(weight > 0)) continue;
        drift += weight * moving.velocity.at(point);
        weights += weight;
    }
    if (!(weights > 0)) return std::nullopt;
    const std::optional<Sighting> sighting = next_.sight(point + seconds_ / weights * drift);
    if (!sighting) return std::nullopt;
    return PointMatch{sighting->image.x, sighting->image.y, false};
}

}  // namespace uw
