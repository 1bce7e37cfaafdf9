#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/affine.h"
#include "core/vec.h"

/// The scene file as inert data (docs/scene-file.md). Lengths in metres, angles in degrees,
/// wavelengths in nm, coefficients in 1/m, concentrations in ppm by volume. File names are already
/// resolved against the scene file's folder. Per-band lists hold exactly one value per band.
namespace uw {

/// Where an entry stands in the scene file, for messages: "plume.yaml:14:7: volumes[0].file".
using SourceLocation = std::string;

using PerBand = std::vector<double>;

struct IntrinsicsDesc {  // pixels; the image's corner is (0, 0)
    double fx = 0, fy = 0, cx = 0, cy = 0;
};

struct DistortionDesc {  // Brown-Conrady, rational when k4..k6 are not 0
    std::array<double, 6> k{};
    std::array<double, 2> p{};
};

struct FlatPortDesc {         // camera frame
    Vector3 normal{0, 0, 1};  // unit, z > 0
    double distance = 0;      // camera centre to inner glass surface, along the normal
    double thickness = 0;
    double n_air = 1.0, n_glass = 1.49, n_water = 1.334;
    bool fresnel = false;          // reflection losses at both surfaces
    bool radiance_in_air = false;  // the camera's radiance is that in air, not in water
};

struct LensDesc {
    double f_number = 0, focal_length = 0, transmission = 1;
};

struct CameraDesc {
    int width = 0, height = 0;
    IntrinsicsDesc intrinsics;
    DistortionDesc distortion;
    std::optional<FlatPortDesc> port;
    std::optional<LensDesc> lens;
    Affine world_from_camera;  // rigid; x right, y down, z forward
};

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
    SourceLocation where;

    friend bool operator==(const GeometryDesc&, const GeometryDesc&) = default;
};

struct LampProfileDesc {
    enum class Type { isotropic, spot, cosine };
    Type type = Type::isotropic;
    double beam = 0;  // spot: full angle at half intensity
    double edge = 0;  // spot: angle over which the intensity falls from full to none
    double fwhm = 0;  // cosine: full angle at half intensity
};

struct LampDesc {
    std::string name;
    Point3 position;
    Vector3 direction{0, 0, 1};  // unit
    LampProfileDesc profile;
    std::optional<PerBand> intensity;  // W/sr on the axis; exactly one of the two is set
    std::optional<PerBand> power;      // W
    bool fixed_to_camera = true;
    SourceLocation where;
};

/// Slabs of water parallel to the image plane, in camera z [m]: what the planes integrator sums
/// over, and the first of them is the layer `backscatter_first`.
struct PlanesDesc {
    int count = 64;
    std::optional<double> near, far;  // chosen by what the image sees if left out (core/slabs.h)
    SourceLocation where;
};

struct RenderDesc {
    enum class Integrator { volume, planes, reference };
    Integrator integrator = Integrator::volume;
    PlanesDesc planes;
    enum class Output { radiance, sensor_irradiance, paper };
    Output output = Output::radiance;  // all but radiance need camera.lens
    SourceLocation output_where;
    int samples = 4;
    double shutter = 0;  // exposure time [s]; 0: no motion blur
    /// A draft is for looking: within 3 % of the final image, at a fraction of its cost. Exact is
    /// for comparison: every pixel's water has a ray of its own (WaterLattice).
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

struct SceneDesc {
    std::filesystem::path file;
    CameraDesc camera;
    WaterDesc water;
    std::vector<VolumeDesc> volumes;
    std::vector<GeometryDesc> geometry;
    std::vector<LampDesc> lamps;
    RenderDesc render;
    std::string hash;                   // of the text as read with overrides, for image headers
    std::vector<std::string> warnings;  // one line each
};

}  // namespace uw
