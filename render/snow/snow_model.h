#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "core/optics/medium.h"
#include "core/scene/snow_desc.h"
#include "core/snow/beyond_snow.h"
#include "core/snow/snow_field.h"

namespace uw {

/// The snow of a scene as one of its cameras sees it (docs/snow.md).
struct SnowModel {
    SnowField field;
    /// How far the particles of each class are drawn, along rays in water [m]; those beyond are as
    /// many as their mean.
    std::vector<double> ranges{};
    double expected_count = 0;  // of particles drawn, in the view
    Medium water;               // without the light that snow scatters
    Medium alone;               // that light alone
    std::optional<std::string> warning{};

    /// The optical depth of the particles drawn, as a mean over many, up to a distance [m]: the
    /// water's coefficients hold it, and so do the particles.
    double drawn_depth(double distance) const;
    /// For what lies beyond the ranges.
    std::vector<BeyondSnow::Part> parts() const;
};

/// `medium` holds the snow's mean. Throws as without_snow.
std::shared_ptr<const SnowModel> make_snow_model(const SnowDesc& desc, const Camera& camera,
                                                 const Medium& medium);

}  // namespace uw
