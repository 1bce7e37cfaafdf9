#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cli/validate/validation_methods.h"

namespace uw {

/// Wraps the light transport under test; tests make it wrong here.
using TransportWrapper = std::function<LightTransport(LightTransport honest)>;

struct ValidationOptions {
    double tolerance = 1e-3;              // largest relative difference allowed at a smooth pixel
    int longest_side = 48;                // of the image that is compared [pixels]
    int longest_side_of_all_light = 320;  // where all light is compared [pixels]
    int most_planes = 512;    // slabs of the finest sum, and more where shadow edges leave it rough
    TransportWrapper volume;  // of the volume integrator's; empty: it is tested as it is
    std::function<bool()> proceed = [] { return true; };  // false stops with Interrupted
    std::function<void(const std::string&)> say = [](const std::string&) {};
};

/// Which part of a picture is compared.
struct Component {
    const char* name;
    std::vector<Spectrum> MethodImage::*image;
};
inline constexpr Component k_direct{"direct", &MethodImage::direct};
inline constexpr Component k_backscatter{"backscatter", &MethodImage::backscatter};
inline constexpr Component k_forward{"forward", &MethodImage::forward};
inline constexpr Component k_blurred_backscatter{"blurred backscatter",
                                                 &MethodImage::blurred_backscatter};

/// How two methods differ in one component and band.
struct Check {
    std::string left, right;  // names of the methods, keys of SceneValidation::images
    Component component;
    std::size_t band = 0;
    bool everywhere = true;    // false: `largest` is over smooth pixels only
    std::size_t pixels = 0;    // how many these are
    double dark = 0;           // darker pixels count as this fraction of the mean
    double largest = 0;        // relative, over these pixels
    double rms = 0;            // over all pixels, of the image's mean
    double own = 0;            // what `right` may itself be off by; 0 if it has converged
    double tolerance = 0;      // of `largest`, with `own`
    double rms_tolerance = 0;  // of `rms`
    bool passed() const { return largest <= tolerance && rms <= rms_tolerance; }
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
    double seconds = 0;

    bool passed() const;
};

/// Compares every way of computing `scene`: sums over McGlamery's planes and their limit, adaptive
/// quadrature, the reference integrator and a VDB of constant value against the volume integrator,
/// all in uniform water (a scene with volumes is homogenised: its grids replaced by their mean),
/// and on the scene's own grids the volume against the reference integrator. With forward scatter
/// also its effect on each method's light: the finest sum over planes, the reference integrator, a
/// VDB that holds half of the water, and a sum over all pairs of pixels against the volume
/// integrator.
SceneValidation validate_scene(const ImageScene& scene, const std::string& name,
                               const ValidationOptions& options);

}  // namespace uw
