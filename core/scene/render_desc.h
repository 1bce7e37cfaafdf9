#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/scene/config_value.h"
#include "core/scene/lamp_desc.h"
#include "core/scene/scene_context.h"

namespace uw {

/// Slabs of water parallel to the image plane: the planes integrator sums over them, and the first
/// is the layer `backscatter_first`.
struct PlanesDesc {
    int count = 64;  ///< of slabs, 1..65536
    /// Camera z [m]; if omitted, derived from what the image sees (core/light/slabs.h).
    std::optional<double> near, far;
    SourceLocation where;
};

/// How bands become R G B.
struct ColourDesc {
    /// Automatic: three bands are used directly as R, G and B, any other number is converted by CIE
    /// 1931.
    enum class Response { automatic, bands, cie, camera };
    Response response = Response::automatic;
    std::filesystem::path file;  ///< of a camera: CSV of wavelength_nm,r,g,b
    /// The light displayed as white, R = G = B; flat if omitted.
    std::optional<LampSpectrumDesc> white;
    bool raw = false;  ///< no white balance: the response as it is
    SourceLocation where = "render.response";
};

/// The view of an OpenColorIO config through which pictures of the image are made. Empty words mean
/// the config's own choice.
struct ViewDesc {
    std::filesystem::path config;  ///< empty: that of the environment variable OCIO
    std::string display, view;
    std::string look;   ///< instead of the view's own looks
    std::string input;  ///< the config's name for linear sRGB; empty: found by itself
    SourceLocation where = "render.view";

    friend bool operator==(const ViewDesc&, const ViewDesc&) = default;
};

/// What is rendered and how.
struct RenderDesc {
    enum class Integrator { volume, planes, reference, path };
    Integrator integrator = Integrator::volume;
    /// Single: light that the water scatters once and light that surfaces reflect once. Multiple:
    /// all light.
    enum class Scattering { single, multiple };
    std::optional<Scattering> scattering;  ///< if omitted, see scattering_of
    /// That of the scene's version, for integrators that render both.
    Scattering default_scattering = Scattering::single;
    SourceLocation scattering_where = "render.scattering";
    PlanesDesc planes;
    /// The quantity that the image contains; all but radiance require the camera's lens.
    enum class Output { radiance, sensor_irradiance, paper };
    Output output = Output::radiance;
    SourceLocation output_where;
    ColourDesc colour;
    std::optional<ViewDesc> view;  ///< none: sRGB, or what the environment says
    /// Rays per pixel, 1..k_max_samples or, of light paths, k_max_paths; if omitted, as many as
    /// the integrator needs (samples_of).
    std::optional<int> samples;
    double shutter = 0;  ///< exposure time [s], 0..60, around the frame's; 0: no motion blur
    double fps = 25;     ///< frames per second: frame n is at n/fps, > 0
    /// The times of frames: by `fps`, or frame n is at the time of pose n of the camera's or the
    /// rig's trajectory.
    enum class Times { fps, trajectory };
    Times times = Times::fps;
    SourceLocation times_where = "render.times";
    /// Draft is for previews: within 3 % of the final image, at a fraction of its cost. Exact is
    /// for comparison: in-scatter is integrated along every pixel's own ray (InScatterLattice).
    enum class Quality { draft, final, exact };
    Quality quality = Quality::final;
};

/// The most rays per pixel, and the most light paths.
inline constexpr int k_max_samples = 4096, k_max_paths = 65536;

/// The qualities by their names in scene files.
inline constexpr std::array<std::pair<std::string_view, RenderDesc::Quality>, 3> k_quality_names{
    {{"draft", RenderDesc::Quality::draft},
     {"final", RenderDesc::Quality::final},
     {"exact", RenderDesc::Quality::exact}}};

/// The integrators by their names in scene files.
inline constexpr std::array<std::pair<std::string_view, RenderDesc::Integrator>, 4>
    k_integrator_names{{{"volume", RenderDesc::Integrator::volume},
                        {"planes", RenderDesc::Integrator::planes},
                        {"reference", RenderDesc::Integrator::reference},
                        {"path", RenderDesc::Integrator::path}}};

/// What light is rendered, by its names in scene files.
inline constexpr std::array<std::pair<std::string_view, RenderDesc::Scattering>, 2>
    k_scattering_names{{{"single", RenderDesc::Scattering::single},
                        {"multiple", RenderDesc::Scattering::multiple}}};

/// `render`.
RenderDesc read_render(const ConfigValue& value, const SceneContext& context);

}  // namespace uw
