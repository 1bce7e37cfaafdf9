#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

#include "core/scene/lamp_spectrum_desc.h"
#include "core/scene/source_location.h"

namespace uw {

/// Slabs of water parallel to the image plane: what the planes integrator sums over, and the first
/// of them is the layer `backscatter_first`.
struct PlanesDesc {
    int count = 64;  ///< of slabs, 1..65536
    /// Camera z [m]; chosen by what the image sees if left out (core/integrators/slabs.h).
    std::optional<double> near, far;
    SourceLocation where;
};

/// How bands become R G B.
struct ColourDesc {
    /// Automatic: three bands are R, G and B themselves, others what CIE 1931 makes of them.
    enum class Response { automatic, bands, cie, camera };
    Response response = Response::automatic;
    std::filesystem::path file;  ///< of a camera: CSV of wavelength_nm,r,g,b
    /// The light that is shown white, R = G = B; flat if it is left out.
    std::optional<LampSpectrumDesc> white;
    bool raw = false;  ///< nothing is shown white: the response as it is
    SourceLocation where = "render.response";
};

/// What is rendered and how.
struct RenderDesc {
    enum class Integrator { volume, planes, reference };
    Integrator integrator = Integrator::volume;
    PlanesDesc planes;
    /// What the image holds; all but radiance need the camera's lens.
    enum class Output { radiance, sensor_irradiance, paper };
    Output output = Output::radiance;
    SourceLocation output_where;
    ColourDesc colour;
    int samples = 4;     ///< rays per pixel, 1..4096
    double shutter = 0;  ///< exposure time [s], 0..60; 0: no motion blur
    /// A draft is for looking: within 3 % of the final image, at a fraction of its cost. Exact is
    /// for comparison: every pixel's water has a ray of its own (InScatterLattice).
    enum class Quality { draft, final, exact };
    Quality quality = Quality::final;
};

/// The qualities by the names that users write.
inline constexpr std::array<std::pair<std::string_view, RenderDesc::Quality>, 3> k_quality_names{
    {{"draft", RenderDesc::Quality::draft},
     {"final", RenderDesc::Quality::final},
     {"exact", RenderDesc::Quality::exact}}};

/// The integrators by the names that users write.
inline constexpr std::array<std::pair<std::string_view, RenderDesc::Integrator>, 3>
    k_integrator_names{{{"volume", RenderDesc::Integrator::volume},
                        {"planes", RenderDesc::Integrator::planes},
                        {"reference", RenderDesc::Integrator::reference}}};

}  // namespace uw
