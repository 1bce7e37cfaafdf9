#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "render/image_scene.h"

/// The coefficients of the formula by which computer vision describes pictures in water, for a
/// scene's water, lamps and camera (Akkaynak and Treibitz, "A revised underwater image formation
/// model", CVPR 2018):
///
///     I = J exp(-beta_D d) + B_inf (1 - exp(-beta_B d))
///
/// with the range d, a target's colour J without water, the wideband coefficients of direct light
/// and of backscatter, beta_D and beta_B, and the backscatter of water without end, B_inf.
namespace uw {

/// The targets that are rendered, and how the formula is judged.
struct TargetSeriesOptions {
    double nearest = 0.5, farthest = 10;  // from the camera's centre along its axis [m]
    int count = 12;                       // of ranges, in equal ratios, 2 or more
    double side = 0.5;  // of the square targets [m]; larger ones where a few pixels see more
    /// In all light: the standard error of each image to be reached, relative to its mean.
    double error = 0.02;
};

/// The light of targets in one band, or in one of the colours R, G and B, by range.
struct TargetSeries {
    std::string name;  // "620 nm", "R"
    std::vector<double>
        signal;  // white target less black target: light of the target [W m^-2 sr^-1]
    std::vector<double> backscatter;  // of the water before a black target [W m^-2 sr^-1]
    /// The white target as lit and seen without water; without lamps' fall-off it is constant.
    std::vector<double> clean;
    double background = 0;   // without a target
    double attenuation = 0;  // c, the mean from the camera to the nearest target [1/m]
};

/// What the camera sees on its axis.
struct TargetSeriesSet {
    std::vector<double> ranges;        // in the water, from the outer glass surface [m]
    std::vector<TargetSeries> series;  // the bands; then, unless there are three, R, G, B
    /// In all light: the standard error of an image, relative to its mean, the largest of all.
    std::optional<double> error;
};

/// Renders square targets across the camera's axis, white and black, at each range, and the water
/// without one: all light, by random paths, or with `render.scattering: single` the light scattered
/// once, by the scene's integrator. A few pixels around the principal
/// point see them. They replace the scene's geometry; sensor, marine snow and the paper's forward
/// scatter are left out. `progress` receives the fraction done. Throws as Renderer; InputError if
/// the principal point has no ray or a target would be before the water begins.
TargetSeriesSet measure_targets(const ImageScene& scene, const TargetSeriesOptions& options,
                                const std::function<void(double)>& progress = {});

struct FormulaOptions {
    double reflectance = 0.5;  // of the target whose misfit is stated
    /// J without water follows the lamps' light, which falls off with distance, as `clean` says;
    /// else it is the same at all ranges, and beta_D takes over the fall-off.
    bool divides_falloff = true;
};

/// The formula for one series.
struct FormulaFit {
    double beta_d = 0, beta_b = 0;  // [1/m]
    double background = 0;          // B_inf, that of the series
    /// J of white at each range: the clean target's times one factor. In daylight that is what has
    /// become of the light on its way down.
    std::vector<double> white;
    /// beta_D from each range to the next, one less than there are ranges, and beta_B up to each
    /// range: what the formula would need to be exact [1/m]; NaN where the light does not tell.
    std::vector<double> beta_d_here, beta_b_here;
    std::vector<double> misfit;  // of the grey target's I, relative

    double worst_misfit() const;
    /// The first range from which on |misfit| is above `tolerance` somewhere; none if nowhere.
    std::optional<std::size_t> breaks_at(double tolerance) const;
};

/// Finds the coefficients: beta_D and the factor of J by least squares of ln(signal / clean), where
/// each range counts as much as the target's light is of all that is seen there; beta_B by least
/// squares of the backscatter. B_inf is the background. None if the target is lit directly, and
/// seen, at fewer than two ranges.
std::optional<FormulaFit> fit_formula(const std::vector<double>& ranges, const TargetSeries& series,
                                      const FormulaOptions& options = {});

}  // namespace uw
