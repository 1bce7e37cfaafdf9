#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/affine.h"
#include "core/base/vec.h"
#include "core/scene/camera_desc.h"

/// The scene file as inert data (docs/scene-file.md). Lengths in metres, angles in degrees,
/// wavelengths in nm, coefficients in 1/m, concentrations in ppm by volume. File names are already
/// resolved against the scene file's folder. Per-band lists hold exactly one value per band.
namespace uw {

using PerBand = std::vector<double>;

struct PhaseDesc {
    enum class Type { henyey_greenstein, fournier_forand, petzold, table, water };
    Type type = Type::henyey_greenstein;
    double g = 0;                  // henyey_greenstein
    double n = 1.10, mu = 3.5835;  // fournier_forand: relative index, Junge slope
    std::filesystem::path file;    // table: CSV of angle_deg,phase
    SourceLocation where;

    friend bool operator==(const PhaseDesc&, const PhaseDesc&) = default;
};

struct ScatteringDesc {
    PerBand b;
    PhaseDesc phase;

    friend bool operator==(const ScatteringDesc&, const ScatteringDesc&) = default;
};

/// Light that comes back blurred after scattering by small angles (physics section 6).
struct ForwardScatterDesc {
    enum class Shape { gaussian, exponential };
    double K = 0;  // strength; 0 turns it off
    double G = 0;  // attenuation of what is scattered forward [1/m], |G| <= c
    double B = 0;  // blur: the spectrum falls as e^{-B R f}, f in cycles/rad [rad/m]
    Shape shape = Shape::gaussian;
    SourceLocation where = "water.forward_scatter";

    friend bool operator==(const ForwardScatterDesc&, const ForwardScatterDesc&) = default;
};

struct WaterDesc {
    std::vector<double> bands_nm{620, 540, 450};
    std::string preset;                 // "", or "jerlov-II"
    double salinity = 35;               // PSU
    double temperature = 20;            // deg C
    std::optional<PerBand> absorption;  // a_0 of everything but particles
    double cdom = 0;                    // a_g(440 nm) [1/m]
    double chlorophyll = 0;             // mg/m^3
    std::optional<double> small_ppm, large_ppm;
    bool mineral_absorption = false;           // particles absorb as mineral sediment
    std::optional<ScatteringDesc> scattering;  // instead of particles and molecules
    ForwardScatterDesc forward_scatter;
    SourceLocation where;

    friend bool operator==(const WaterDesc&, const WaterDesc&) = default;
};

/// What one unit of a grid's value means.
struct GridMappingDesc {
    std::string grid;  // name in the file; name[i] where several share one
    double small_ppm = 0, large_ppm = 0;
    struct Optics {
        PerBand absorption, scattering;
        std::optional<PhaseDesc> phase;  // the water's if left out

        friend bool operator==(const Optics&, const Optics&) = default;
    };
    std::optional<Optics> optics;  // instead of ppm
    SourceLocation where;

    friend bool operator==(const GridMappingDesc&, const GridMappingDesc&) = default;
};

/// How the volume moves while the shutter is open.
struct MotionDesc {
    std::vector<std::string> grids;  // one of vectors, or three of numbers: x, y, z
    std::filesystem::path file;      // that has them
    bool is_sequence = false;        // as VolumeDesc's
    std::optional<double> scale;     // m/s per unit, file's axes; automatic if left out
    double shutter = 0;              // how long it is open, around the frame's moment [s]
    SourceLocation where;

    friend bool operator==(const MotionDesc&, const MotionDesc&) = default;
};

enum class Centering { automatic, cell, node };
enum class UpAxis { automatic, y, z };

struct VolumeDesc {
    std::filesystem::path file;
    bool is_sequence = false;  // `file` has a place for the frame's number (core/frame_pattern.h)
    std::vector<GridMappingDesc> grids;
    Centering centering = Centering::automatic;
    UpAxis up = UpAxis::automatic;
    Affine world_from_upright;  // `transform`, applied after `up` has been brought to y
    std::optional<MotionDesc> motion;
    SourceLocation where;

    friend bool operator==(const VolumeDesc&, const VolumeDesc&) = default;
};

/// What a glTF file's light intensities are (Blender's exporter offers these three).
enum class LightUnits {
    standard,  // candela, as the format has it: W/sr times 683
    compat,    // W/sr
    raw,       // W in all directions
};

/// What to take from a glTF file beside its meshes (core/gltf_import.h).
struct GltfImportDesc {
    bool camera = false;
    std::string camera_name;  // empty: the file's only one
    SourceLocation camera_where;
    bool all_lamps = false;
    std::vector<std::string> lamps;  // by name; empty with all_lamps
    SourceLocation lamps_where;
    LightUnits units = LightUnits::standard;

    bool any_lamps() const { return all_lamps || !lamps.empty(); }
    friend bool operator==(const GltfImportDesc&, const GltfImportDesc&) = default;
};

struct GeometryDesc {
    enum class Type { file, plane, box, sphere };
    Type type = Type::file;
    std::filesystem::path file;
    bool is_sequence = false;  // as VolumeDesc's
    Affine world_from_object;
    Point3 point;                        // plane
    Vector3 normal{0, 0, 1};             // plane, unit
    Point3 min, max;                     // box
    Point3 center;                       // sphere
    double radius = 0;                   // sphere
    std::optional<PerBand> reflectance;  // replaces the file's colours; without either, 0.5
    GltfImportDesc import;
    bool is_pbr = false;  // a glTF file's metallic-roughness materials; else all is diffuse
    SourceLocation where;

    friend bool operator==(const GeometryDesc&, const GeometryDesc&) = default;
};

struct LampProfileDesc {
    enum class Type { isotropic, spot, cosine, ies };
    Type type = Type::isotropic;
    double beam = 0;  // spot: full angle at half intensity
    double edge = 0;  // spot: angle over which the intensity falls from full to none
    double fwhm = 0;  // cosine: full angle at half intensity
    /// How a spot falls: smoothstep in the angle, or as glTF's spots do, by the square of what is
    /// left of the cosine's way (KHR_lights_punctual).
    enum class Falloff { smooth, gltf };
    Falloff falloff = Falloff::smooth;
    std::filesystem::path file{};      // ies
    double rotate = 0;                 // ies: about the lamp's direction
    double tilt = 0;                   // ies: then from it towards the luminaire's azimuth 0
    SourceLocation where = "profile";  // ies
};

/// The light of a lamp over wavelength, up to a factor.
struct LampSpectrumDesc {
    enum class Type { flat, d65, blackbody, led, file };
    Type type = Type::flat;
    double temperature = 0;      // blackbody [K]
    std::string name;            // led: of the CIE's illuminants, LED-B3
    std::filesystem::path file;  // CSV of wavelength_nm and
    std::string column;          // this column; empty: the only other one
    SourceLocation where;
};

struct LampDesc {
    std::string name;
    Point3 position;
    Vector3 direction{0, 0, 1};  // unit
    LampProfileDesc profile;
    // Exactly one is set; none for a profile of type ies: the file's candelas.
    std::optional<PerBand> intensity;  // W/sr on the axis; with a spectrum one value for all of it
    std::optional<PerBand> power;      // W; likewise
    std::optional<double> lumens;      // luminous flux; with a spectrum
    std::optional<LampSpectrumDesc> spectrum;
    bool fixed_to_camera = true;
    Affine world_from_mount;  // where it is not fixed to the camera: of its axes, rigid
    SourceLocation where;
};

/// Slabs of water parallel to the image plane, in camera z [m]: what the planes integrator sums
/// over, and the first of them is the layer `backscatter_first`.
struct PlanesDesc {
    int count = 64;
    std::optional<double> near, far;  // chosen by what the image sees if left out (core/slabs.h)
    SourceLocation where;
};

/// How bands become R G B.
struct ColourDesc {
    /// Automatic: three bands are R, G and B themselves, others what CIE 1931 makes of them.
    enum class Response { automatic, bands, cie, camera };
    Response response = Response::automatic;
    std::filesystem::path file;  // camera: CSV of wavelength_nm,r,g,b
    /// The light that is shown white, R = G = B; flat if it is left out. `raw`: no such light.
    std::optional<LampSpectrumDesc> white;
    bool raw = false;
    SourceLocation where = "render.response";
};

struct RenderDesc {
    enum class Integrator { volume, planes, reference };
    Integrator integrator = Integrator::volume;
    PlanesDesc planes;
    enum class Output { radiance, sensor_irradiance, paper };
    Output output = Output::radiance;  // all but radiance need camera.lens
    SourceLocation output_where;
    ColourDesc colour;
    int samples = 4;
    double shutter = 0;  // exposure time [s]; 0: no motion blur
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

/// One camera of a rig.
struct RigCameraDesc {
    std::string name;
    CameraDesc camera;
};

struct SceneDesc {
    std::filesystem::path file;
    CameraDesc camera;                   // of a rig the one that is rendered: at first its first
    std::string camera_name;             // empty: the scene has one camera, no rig
    std::vector<RigCameraDesc> cameras;  // of a rig; else none
    WaterDesc water;
    std::vector<VolumeDesc> volumes;
    std::vector<GeometryDesc> geometry;
    std::vector<LampDesc> lamps;
    RenderDesc render;
    std::string hash;                   // of the text as read with overrides, for image headers
    std::vector<std::string> warnings;  // one line each
};

}  // namespace uw
