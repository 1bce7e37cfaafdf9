#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/lamps/lamp.h"
#include "core/surfaces/surface_sample.h"

namespace uw {

/// Light of every emitter (LitScene::emitters) on surface points, and the transmittance of the
/// water from the emitters to the points and from there to the camera.
class SurfaceLight {
  public:
    /// Resets everything to dark. `emitters` must outlive this object.
    void reset(std::size_t samples, const std::vector<Lamp>& emitters, std::size_t bands) {
        emitters_ = &emitters;
        bands_ = bands;
        geometry_terms_.assign(samples * emitters.size(), 0.0);
        transmittances_.assign(samples * (1 + emitters.size()) * bands, 0.0);
        camera_weights_.clear();
    }

    const std::vector<Lamp>& emitters() const { return *emitters_; }
    std::size_t emitter_count() const { return emitters_->size(); }
    /// Whether the emitter shines on the sample.
    bool visible(std::size_t sample, std::size_t emitter) const {
        return geometry_term(sample, emitter) > 0;
    }
    /// Irradiance in the absence of water [W/m^2].
    double clean(std::size_t sample, std::size_t emitter, std::size_t band) const {
        return (*emitters_)[emitter].axis_intensity()[band] * geometry_term(sample, emitter);
    }
    /// Irradiance [W/m^2].
    double irradiance(std::size_t sample, std::size_t emitter, std::size_t band) const {
        return clean(sample, emitter, band) * from_emitter(sample, emitter)[band];
    }
    /// e^-tau per band from the sample to its ray's origin.
    std::span<const double> to_camera(std::size_t sample) const { return row(sample, 0); }

    /// By what the sample's own glow is weighted (PathWeight).
    double glow_weight(std::size_t sample) const {
        return camera_weights_.empty() ? 1 : camera_weights_[sample];
    }

    // For SurfaceLighting, which fills in the values:

    /// Irradiance without water for 1 W/sr on the emitter's axis [1/m^2]: relative intensity times
    /// cosine over squared distance; 0 where it is occluded or behind the surface.
    double& geometry_term(std::size_t sample, std::size_t emitter) {
        return geometry_terms_[sample * emitter_count() + emitter];
    }
    double geometry_term(std::size_t sample, std::size_t emitter) const {
        return geometry_terms_[sample * emitter_count() + emitter];
    }
    std::span<double> to_camera(std::size_t sample) { return row(sample, 0); }
    /// e^-tau per band from the emitter to the sample; undefined where it is not visible.
    std::span<double> from_emitter(std::size_t sample, std::size_t emitter) {
        return row(sample, 1 + emitter);
    }
    std::span<const double> from_emitter(std::size_t sample, std::size_t emitter) const {
        return row(sample, 1 + emitter);
    }
    /// Empty, or the weight of every sample's path to the camera.
    std::vector<double>& camera_weights() { return camera_weights_; }
    /// All transmittances, for processing in bulk.
    std::span<double> transmittances() { return transmittances_; }

  private:
    std::size_t place(std::size_t sample, std::size_t path) const {
        return (sample * (1 + emitter_count()) + path) * bands_;
    }
    std::span<double> row(std::size_t sample, std::size_t path) {
        return std::span(transmittances_).subspan(place(sample, path), bands_);
    }
    std::span<const double> row(std::size_t sample, std::size_t path) const {
        return std::span(transmittances_).subspan(place(sample, path), bands_);
    }

    const std::vector<Lamp>* emitters_ = nullptr;
    std::size_t bands_ = 0;
    std::vector<double> geometry_terms_;  // [sample][emitter]
    std::vector<double> camera_weights_;
    std::vector<double> transmittances_;  // [sample][to the camera, then from each emitter][band]
};

}  // namespace uw
