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

/// The range of a rig: a flat target in front of the camera, alone in the scene's water.
namespace uw {

/// A flat target perpendicular to the camera's axis, half bright and half dark, and how it is
/// measured.
struct TargetOptions {
    double bright = 1, dark = 0;  // reflectances, 0 <= dark < bright <= 1
    /// The fraction of the image's width and height, around its centre, in which the target is
    /// measured.
    double field = 0.5;
    int rays = 3;  // along each side of that part, 1..64, evenly spaced

    friend bool operator==(const TargetOptions&, const TargetOptions&) = default;
};

/// The light of one lamp on a target and in the water before it, mean over the rays. It is linear
/// in the lamp's brightness.
struct LampOnTarget {
    Spectrum signal;       // radiance at the camera from a target of reflectance 1 [W m^-2 sr^-1]
    Spectrum backscatter;  // radiance at the camera from the water before it [W m^-2 sr^-1]
    Spectrum irradiance;   // on the target [W m^-2]
};

/// The appearance of a target at one distance. Light of surfaces and backscatter are means over
/// bands and rays.
struct TargetNumbers {
    double distance = 0;  // from the camera's centre along its axis [m]
    /// The Michelson contrast (bright - dark) / (bright + dark) of the target's two halves at the
    /// camera: with S the signal of a target of reflectance 1, B the backscatter, R and r the two
    /// reflectances,
    ///
    ///     (R - r) S / ((R + r) S + 2 B),      for black and white  S / (S + 2 B).
    ///
    /// 0 in the dark.
    double contrast = 0;
    double signal = 0, backscatter = 0;  // S of the bright part, and B [W m^-2 sr^-1]
    double signal_to_backscatter = 0;    // of the bright part; infinite without backscatter
    double irradiance = 0;               // [W m^-2]
};

/// Computes the numbers of the light of all `lamps` together. `bands`: the number of the scene's
/// bands.
TargetNumbers target_numbers(std::span<const LampOnTarget> lamps, double distance,
                             std::size_t bands, const TargetOptions& options);

/// Renders targets, lamp by lamp and with few rays, and caches the light of each: if a lamp of the
/// scene has moved, only that lamp is rendered again, and if a lamp is brighter, none is.
///
/// The target replaces the scene's geometry; water, volumes, camera and port are the scene's.
/// Direct light illuminates it, and backscatter is single scattering. Its halves are taken to be so
/// large that forward scatter does not blur them into each other.
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

    /// Returns the light of each lamp of the scene. Throws as Renderer; what was rendered before
    /// Interrupted is kept.
    std::vector<LampOnTarget> lamps_on_target(const ImageScene& scene, double distance);
    /// Returns the light of a lamp that need not belong to the scene: its brightness and position
    /// are those of `lamp`.
    LampOnTarget lamp_on_target(const ImageScene& scene, const LampDesc& lamp, double distance);

    /// Computes the numbers of the scene's target at each distance.
    std::vector<TargetNumbers> curve(const ImageScene& scene, std::span<const double> distances);

    /// The number of targets rendered so far; the light of all others came from the cache.
    std::uint64_t rendered() const { return rendered_; }

  private:
    void enter(const SceneDesc& scene);
    LampOnTarget render(const LampDesc& lamp, double distance);

    TargetOptions options_;
    /// The scene without target for which lamps are cached; none at first.
    std::optional<SceneDesc> surrounding_;
    /// The light of lamps of intensity 1, by lamp and distance.
    std::unordered_map<std::string, LampOnTarget> kept_;
    Renderer renderer_;
    std::uint64_t rendered_ = 0;
};

/// Returns `count` distances from `nearest` to `farthest` in equal ratios [m].
std::vector<double> target_distances(double nearest = 0.5, double farthest = 10, int count = 20);

}  // namespace uw
