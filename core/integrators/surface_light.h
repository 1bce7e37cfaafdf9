#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/lamps/lamp.h"
#include "core/surfaces/surface_sample.h"

namespace uw {

/// Light of every lamp on surface points, and the transmittance of the water from the lamps to the
/// points and from there to the camera.
class SurfaceLight {
  public:
    /// Resets everything to dark. `lamps` must outlive this object.
    void reset(std::size_t samples, const std::vector<Lamp>& lamps, std::size_t bands) {
        lamps_ = &lamps;
        bands_ = bands;
        geometry_terms_.assign(samples * lamps.size(), 0.0);
        transmittances_.assign(samples * (1 + lamps.size()) * bands, 0.0);
    }

    std::size_t lamp_count() const { return lamps_->size(); }
    /// Whether the lamp shines on the sample.
    bool visible(std::size_t sample, std::size_t lamp) const {
        return geometry_term(sample, lamp) > 0;
    }
    /// Irradiance in the absence of water [W/m^2].
    double clean(std::size_t sample, std::size_t lamp, std::size_t band) const {
        return (*lamps_)[lamp].axis_intensity()[band] * geometry_term(sample, lamp);
    }
    /// Irradiance [W/m^2].
    double irradiance(std::size_t sample, std::size_t lamp, std::size_t band) const {
        return clean(sample, lamp, band) * from_lamp(sample, lamp)[band];
    }
    /// e^-tau per band from the sample to its ray's origin.
    std::span<const double> to_camera(std::size_t sample) const { return row(sample, 0); }

    // For SurfaceLighting, which fills in the values:

    /// Irradiance without water for 1 W/sr on the lamp's axis [1/m^2]: relative intensity times
    /// cosine over squared distance; 0 where the lamp is occluded or behind the surface.
    double& geometry_term(std::size_t sample, std::size_t lamp) {
        return geometry_terms_[sample * lamp_count() + lamp];
    }
    double geometry_term(std::size_t sample, std::size_t lamp) const {
        return geometry_terms_[sample * lamp_count() + lamp];
    }
    std::span<double> to_camera(std::size_t sample) { return row(sample, 0); }
    /// e^-tau per band from the lamp to the sample; undefined where the lamp is not visible.
    std::span<double> from_lamp(std::size_t sample, std::size_t lamp) {
        return row(sample, 1 + lamp);
    }
    std::span<const double> from_lamp(std::size_t sample, std::size_t lamp) const {
        return row(sample, 1 + lamp);
    }
    /// All transmittances, for processing in bulk.
    std::span<double> transmittances() { return transmittances_; }

  private:
    std::size_t place(std::size_t sample, std::size_t path) const {
        return (sample * (1 + lamp_count()) + path) * bands_;
    }
    std::span<double> row(std::size_t sample, std::size_t path) {
        return std::span(transmittances_).subspan(place(sample, path), bands_);
    }
    std::span<const double> row(std::size_t sample, std::size_t path) const {
        return std::span(transmittances_).subspan(place(sample, path), bands_);
    }

    const std::vector<Lamp>* lamps_ = nullptr;
    std::size_t bands_ = 0;
    std::vector<double> geometry_terms_;  // [sample][lamp]
    std::vector<double> transmittances_;  // [sample][to the camera, then from each lamp][band]
};

}  // namespace uw
