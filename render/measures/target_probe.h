#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/base/spectrum.h"
#include "core/scene/scene_desc.h"
#include "render/renderer.h"

/// How far a rig sees: a flat target ahead of the camera, alone in the scene's water.
namespace uw {

/// A flat target, half of it bright and half dark, perpendicular to the camera's axis, and how
/// closely it is looked at.
struct TargetOptions {
    double bright = 1, dark = 0;  // reflectances, 0 <= dark < bright <= 1
    /// The part of the image, about its centre, in which it is measured, by width and height.
    double field = 0.5;
    int rays = 3;  // per side of that part, 1..64; evenly spaced

    friend bool operator==(const TargetOptions&, const TargetOptions&) = default;
};

/// The light of one lamp on a target and on the way to it, mean over the rays: linear in the lamp's
/// brightness.
struct LampOnTarget {
    Spectrum signal;       // radiance at the camera from a target of reflectance 1 [W m^-2 sr^-1]
    Spectrum backscatter;  // radiance at the camera from the water before it [W m^-2 sr^-1]
    Spectrum irradiance;   // on the target [W m^-2]
};

/// What a target at one distance looks like. Light of the surfaces and the backscatter are means
/// over bands and rays.
struct TargetNumbers {
    double distance = 0;  // from the camera's centre along its axis [m]
    /// (bright - dark) / (bright + dark) of the target's two parts as the camera sees them: with S
    /// the signal of a target of reflectance 1, B the backscatter, R and r the two reflectances,
    ///
    ///     (R - r) S / ((R + r) S + 2 B),      for black and white  S / (S + 2 B).
    ///
    /// 0 in the dark.
    double contrast = 0;
    double signal = 0, backscatter = 0;  // S of the bright part, and B [W m^-2 sr^-1]
    double signal_to_backscatter = 0;    // of the bright part; infinite without backscatter
    double irradiance = 0;               // [W m^-2]
};

/// The numbers of the light of all `lamps` together. `bands`: how many the scene has.
TargetNumbers target_numbers(std::span<const LampOnTarget> lamps, double distance,
                             std::size_t bands, const TargetOptions& options);

/// Renders targets, lamp by lamp and with few rays, and keeps the light of each: a scene in which
/// one lamp has moved needs that one only, and one in which a lamp got brighter none.
///
/// The target replaces the scene's geometry; water, volumes, camera and port are the scene's. It is
/// lit by light that was not scattered, and seen through light scattered once: its parts are taken
/// to be so large that forward scatter does not blur them into each other.
class TargetProbe {
  public:
    /// Throws UsageError for options out of range.
    explicit TargetProbe(const TargetOptions& options = {});
    TargetProbe(const TargetProbe&) = delete;
    TargetProbe& operator=(const TargetProbe&) = delete;
    TargetProbe(TargetProbe&&) = delete;
    TargetProbe& operator=(TargetProbe&&) = delete;
    ~TargetProbe() = default;

    const TargetOptions& options() const { return options_; }

    /// One per lamp of the scene. Throws as Renderer; what was rendered until Interrupted is kept.
    std::vector<LampOnTarget> lamps_on_target(const ImageScene& scene, double distance);
    /// The light of a lamp that may not be the scene's: its brightness and place are those of
    /// `lamp`.
    LampOnTarget lamp_on_target(const ImageScene& scene, const LampDesc& lamp, double distance);

    /// The numbers of the scene's target at each distance.
    std::vector<TargetNumbers> curve(const ImageScene& scene, std::span<const double> distances);

    /// Targets rendered so far: what the others were remembered from.
    std::uint64_t rendered() const { return rendered_; }

  private:
    void enter(const SceneDesc& scene);
    LampOnTarget render(const LampDesc& lamp, double distance);

    TargetOptions options_;
    /// The scene around targets, as the probe sees it, for which lamps are kept; none at first.
    std::optional<SceneDesc> surrounding_;
    /// The light of lamps of intensity 1, by lamp and distance.
    std::unordered_map<std::string, LampOnTarget> kept_;
    Renderer renderer_;
    std::uint64_t rendered_ = 0;
};

/// Distances from `nearest` to `farthest` in equal ratios, `count` of them [m].
std::vector<double> target_distances(double nearest = 0.5, double farthest = 10, int count = 20);

}  // namespace uw
