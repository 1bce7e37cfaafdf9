#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/spectrum.h"
#include "core/image/pixel_image.h"
#include "render/image_scene.h"

namespace uw {

struct ValidationOptions {
    double tolerance = 1e-3;  // largest relative difference allowed at a smooth pixel
    std::function<void(const std::string&)> say = [](const std::string&) {};
};

/// The result of a method for every pixel of a scene, row by row, one sample at each pixel's centre
/// [W m^-2 sr^-1]. Components that the method does not compute are empty.
struct MethodImage {
    std::vector<Spectrum> direct, backscatter;  // before forward scatter
    std::vector<Spectrum> forward;              // what forward scatter adds to `direct`
    std::vector<Spectrum> blurred_backscatter;  // with forward scatter
};

/// The component of a picture that is compared.
struct Component {
    const char* name;
    std::vector<Spectrum> MethodImage::*image;
};
inline constexpr Component k_direct{"direct", &MethodImage::direct};
inline constexpr Component k_backscatter{"backscatter", &MethodImage::backscatter};
inline constexpr Component k_forward{"forward", &MethodImage::forward};
inline constexpr Component k_blurred_backscatter{"blurred backscatter",
                                                 &MethodImage::blurred_backscatter};

/// The difference of two methods in one component and band.
struct Check {
    std::string left, right;  // names of the methods, keys of SceneValidation::images
    Component component;
    std::size_t band = 0;
    bool everywhere = true;    // false: `largest` is over smooth pixels only
    std::size_t pixels = 0;    // how many these are
    double dark = 0;           // darker pixels count as this fraction of the mean
    double largest = 0;        // relative, over these pixels
    double rms = 0;            // over all pixels, of the image's mean
    double own = 0;            // the error of `right` itself; 0 if it has converged
    double tolerance = 0;      // of `largest`, with `own`
    double rms_tolerance = 0;  // of `rms`
    /// Whether any pixel was compared; otherwise the absence of differences means little.
    bool is_compared() const { return pixels > 0; }
    /// Whether all differences are within their tolerances.
    bool passed() const { return largest <= tolerance && rms <= rms_tolerance; }
};

/// One sum over slabs, compared with the limit of many.
struct PlanesStep {
    int count = 0;
    double error = 0;  // largest relative difference to the limit over smooth pixels and bands
    double order = 0;  // log2 of how much smaller it is than with half the slabs; 0 for the first
};

/// The results for one scene.
struct SceneValidation {
    std::string name;
    int width = 0, height = 0;
    std::vector<double> bands_nm;
    std::vector<char> smooth;  // pixels without a shadow or beam edge in their ray
    std::map<std::string, MethodImage> images;
    std::vector<Check> checks;
    std::vector<PlanesStep> planes;
    std::vector<std::string> notes;  // what all methods leave out, a line each
    double seconds = 0;

    bool passed() const;
};

/// Compares every way of computing `scene`: sums over McGlamery's planes and their limit, adaptive
/// quadrature, the reference integrator and a VDB of constant value against the volume integrator,
/// all in uniform water (a scene with volumes is homogenised: its grids replaced by their mean),
/// and on the scene's own grids the volume against the reference integrator. With forward scatter
/// also its effect on each method's light: the finest sum over planes, the reference integrator, a
/// VDB that contains half of the water, and a sum over all pairs of pixels against the volume
/// integrator. Throws InputError, and Interrupted.
SceneValidation validate_scene(const ImageScene& scene, const std::string& name,
                               const ValidationOptions& options);

/// The differences of single pixels, over a number of them.
struct PixelSpread {
    std::size_t pixels = 0;
    double rms = 0;              // of the image's mean
    double rms_in_errors = 0;    // each in units of its stated standard error
    double worst_in_errors = 0;  // the largest of these
};

/// The difference of two estimates of some light, at least one of which has a standard error.
/// Relative to the mean of all light in the band.
struct LightCheck {
    /// A deviation beyond so many standard errors is a fault; and so is noise of single pixels of
    /// so many times the stated error.
    static constexpr double k_max_errors = 4, k_max_noise = 2;

    std::string left, right;
    std::string light;     // which: "multiple.volume, 540 nm"
    double deviation = 0;  // of the left's mean from the right's
    double error = 0;      // standard error of that
    double max_error = 0;  // beyond which the comparison says nothing, and fails
    std::optional<PixelSpread> spread{};

    double deviation_in_errors() const;
    bool passed() const;
};

/// The mean radiance of an image, per band, by the path of the light [W m^-2 sr^-1].
struct LightParts {
    static constexpr std::array<const char*, 4> k_names{"direct", "backscatter", "multiple.volume",
                                                        "multiple.surface"};
    std::array<double, 4> means{};

    double all() const;
    /// The fraction of all light that is in part k_names[part]; 0 without any light.
    double fraction(std::size_t part) const;
    /// All light over that of single scattering; 0 without that.
    double ratio() const;
};

/// The results of what is compared in units of standard errors.
struct LightValidation {
    std::string name;
    std::vector<std::string> notes;  // a line each
    std::vector<LightCheck> checks;
    std::vector<double> bands_nm;
    std::vector<LightParts> parts;  // per band; may be empty
    std::vector<std::pair<std::string, Preview>> pictures;
    double seconds = 0;

    bool passed() const;
};

/// Compares light paths with tables of the light that a point lamp's water sends back
/// (tests/data/multiple), order by order. Throws Interrupted.
LightValidation validate_by_table(const ValidationOptions& options);

/// Compares the fast form of multiple scattering, an image of integrator volume, with unbiased
/// light paths (integrator path) at pixels drawn at random all over the image: the parts
/// multiple.volume and multiple.surface, and their sum, in units of both standard errors. The image
/// is that of `scene` with at most 320 pixels a side. Throws InputError, and Interrupted.
LightValidation validate_all_light(const ImageScene& scene, const std::string& name,
                                   const ValidationOptions& options);

}  // namespace uw
