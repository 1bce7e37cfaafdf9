#pragma once

#include <optional>
#include <vector>

#include "core/base/ray.h"
#include "core/scene/scene_desc.h"

/// What a scene's lamps can give at most, from its description alone and by closed forms, whatever
/// the water, the shapes and the way the light is computed. Of scenes in which nothing moves.
namespace uw::test {

/// The greatest irradiance of anything at `at` [W/m^2], per band: I/R^2 of each lamp in the
/// direction in which it is brightest, at the nearest that its surface and `error` [m], by which
/// `at` may be off, allow; infinite where that is 0, or how bright it is at most is not known.
std::vector<double> max_irradiance(const SceneDesc& scene, const Point3& at, double error);

/// The greatest radiance of lamps that are seen themselves, per band: I/A of the area that they
/// show; infinite where that is not known.
std::vector<double> max_radiance_of_lamps(const SceneDesc& scene);

/// The greatest radiance that uniform water scatters once towards the origin of `ray`, without end,
/// per band; none for scenes of which this is not known. Of a lamp at h metres from the ray it is
/// b p I times the integral of ds/R^2, which is (pi/2 + atan(f/h))/h for a foot at f, with the peak
/// p of Henyey and Greenstein's phase function; of a sun b p E / c.
std::optional<std::vector<double>> max_in_scatter(const SceneDesc& scene, const Ray& ray);

}  // namespace uw::test
