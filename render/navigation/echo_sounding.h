#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "core/geometry/surfaces.h"
#include "core/scene/navigation_sensor_desc.h"
#include "render/renderer.h"

namespace uw {

/// The surfaces of a scene that return sound: its geometry, at any time.
class EchoSurfaces {
  public:
    /// `whole`: as it was read. Throws InputError at `where` for a scene whose meshes have a file
    /// for each frame, which are nowhere between frames.
    EchoSurfaces(const SceneDesc& whole, const SourceLocation& where);

    /// Those at a time [s]; the reference is valid until the next call. Throws as Renderer.
    const Surfaces& at(double time);

  private:
    Renderer renderer_;
    std::optional<ImageScene> first_;
    bool moves_ = false;
};

/// The echo along a ray of sound.
struct Echo {
    double distance = 0;   // to the nearest surface [m]; infinite if there is none
    bool returns = false;  // within what can be measured
};

/// `ray` is in the world.
Echo echo_along(const Ray& ray, const Surfaces& surfaces, const EchoRangeDesc& reach);

/// The directions of a DVL's beams in its axes.
std::array<Vector3, 4> beam_directions(const DvlDesc& dvl);

/// The directions of a DVL's beams are exact; an altimeter's beam is this many rings of rays, of
/// which the widest is its edge.
inline constexpr int k_altimeter_rings = 4;
std::vector<Vector3> altimeter_directions(const AltimeterDesc& altimeter);

/// The velocity that beams have measured, by least squares; none for fewer than three beams.
std::optional<Vector3> velocity_of_beams(const std::array<Vector3, 4>& directions,
                                         const std::array<std::optional<double>, 4>& along);

}  // namespace uw
