#include "tests/support/random/random_scene.h"

#include <fmt/format.h>

#include <sstream>

#include "tests/support/random/random_draw.h"

namespace uw::test {
namespace {

const std::string k_assets = UWVDB_SOURCE_DIR "/assets/";

/// The sections but the camera's. What is drawn is written by <<, as the order of arguments and of
/// operands of + is up to the compiler.
class SceneText {
  public:
    SceneText(RandomDraw& draw, const SceneKinds& kinds) : draw_(draw), kinds_(kinds) {
        out_.precision(17);
    }

    std::string sections() {
        water();
        volumes();
        geometry();
        lamps();
        render();
        return out_.str();
    }

  private:
    std::string per_band(double low, double high) {
        return draw_.per_band(kinds_.bands, low, high);
    }

    void phase() {
        switch (draw_.whole(0, 4)) {
            case 0:
                out_ << "{type: fournier-forand, n: " << draw_.uniform(1.001, 1.5)
                     << ", mu: " << draw_.uniform(3.05, 4.9) << "}";
                break;
            case 1:
                out_ << "{type: petzold}";
                break;
            case 2:
                out_ << "{type: water}";
                break;
            default:
                out_ << "{type: hg, g: "
                     << (draw_.chance(0.2) ? draw_.uniform(-0.99, 0.99) : draw_.uniform(0, 0.98))
                     << "}";
        }
    }

    void water() {
        out_ << "water:\n";
        if (kinds_.bands != 3) {
            out_ << "  bands: [";
            for (int band = 0; band < kinds_.bands; ++band)
                out_ << (band == 0 ? "" : ", ") << 400 + 50 * band;
            out_ << "]\n";
        }
        if (draw_.chance(0.5)) {
            out_ << "  absorption: " << per_band(1e-6, 1e3) << "\n";
            out_ << "  scattering: {b: " << per_band(1e-6, 1e3) << ", phase: ";
            phase();
            out_ << "}\n";
        } else {
            if (draw_.chance(0.5))
                out_ << "  preset: " << draw_.one_of({"jerlov-IB", "jerlov-II", "jerlov-5C"})
                     << "\n";
            else
                out_ << "  chlorophyll: " << draw_.log_uniform(1e-3, 30)
                     << "\n  cdom: " << draw_.log_uniform(1e-3, 5) << "\n";
            out_ << "  particles: {small: " << draw_.log_uniform(1e-6, 1e3)
                 << ", large: " << draw_.log_uniform(1e-6, 1e3)
                 << (draw_.chance(0.3) ? ", absorption: mineral" : "") << "}\n";
        }
        if (kinds_.has_forward_scatter)
            out_ << "  forward_scatter: {K: " << draw_.log_uniform(1e-3, 2)
                 << ", B: " << draw_.log_uniform(1e-4, 0.3)
                 << ", shape: " << draw_.one_of({"gaussian", "gaussian", "exponential"}) << "}\n";
        if (kinds_.has_surface)
            out_ << "  surface: {point: [0, " << kinds_.size * draw_.uniform(2, 20)
                 << ", 0], normal: [0, 1, 0]}\n";
        if (kinds_.has_snow) snow();
    }

    void snow() {
        const double least = draw_.log_uniform(1e-6, 0.05);
        out_ << "  snow: {number: " << draw_.log_uniform(1e-3, 1e8) << ", diameter: [" << least
             << ", " << least + draw_.uniform(1e-6, 0.1 - least)
             << "], exponent: " << draw_.uniform(0, 10) << ", reflectance: " << per_band(1e-3, 1)
             << ", drift: " << draw_.vector(kinds_.size)
             << ", mean: added, ground_truth: " << draw_.one_of({"ignored", "held"})
             << ", most: " << draw_.whole(1, 3000) << ", seed: " << draw_.whole(0, 1000) << "}\n";
    }

    void volumes() {
        if (!kinds_.has_volume) return;
        out_ << "volumes:\n  - file: " << k_assets
             << "grids/plume128_blosc_half_0030.vdb\n    grids: {density: ";
        if (draw_.chance(0.5)) {
            out_ << "{small: " << draw_.log_uniform(1e-6, 1e4)
                 << ", large: " << draw_.log_uniform(1e-6, 1e4) << "}";
        } else {
            out_ << "{absorption: " << per_band(1e-6, 1e4)
                 << ", scattering: " << per_band(1e-6, 1e4) << ", phase: ";
            phase();
            out_ << "}";
        }
        out_ << "}\n    transform: {scale: "
             << (draw_.chance(0.2) ? draw_.log_uniform(1e-5, 1e4)
                                   : kinds_.size * draw_.log_uniform(0.1, 1))
             << ", rotate: " << draw_.vector(180) << ", translate: " << draw_.vector(kinds_.size)
             << "}\n";
    }

    void geometry() {
        const int count = draw_.whole(0, 3);
        if (count > 0) out_ << "geometry:\n";
        for (int n = 0; n < count; ++n) {
            out_ << "  - {";
            switch (draw_.whole(0, 6)) {
                case 0:
                case 1:
                    out_ << reflectance() << "type: plane, point: [0, 0, "
                         << (draw_.chance(0.3) ? 0 : draw_.uniform(-kinds_.size, kinds_.size))
                         << "], normal: " << draw_.normal();
                    break;
                case 2:
                case 3:
                    out_ << reflectance() << "type: sphere, center: " << draw_.vector(kinds_.size)
                         << ", radius: "
                         << (draw_.chance(0.2) ? draw_.log_uniform(1e-5, 1e5)
                                               : kinds_.size * draw_.log_uniform(0.01, 1));
                    break;
                case 4:
                case 5:
                    box();
                    break;
                default:
                    mesh();
            }
            if (kinds_.moves && draw_.chance(0.3))
                out_ << ", trajectory: " << draw_.trajectory(kinds_.size, false);
            out_ << "}\n";
        }
    }
    std::string reflectance() {
        const double r = draw_.chance(0.1) ? 0 : draw_.chance(0.1) ? 1 : draw_.uniform(0, 1);
        return fmt::format("reflectance: {:.17g}, ", r);
    }
    void box() {
        out_ << reflectance() << "type: box";
        std::string min, max;
        for (int axis = 0; axis < 3; ++axis) {
            const double from = draw_.uniform(-kinds_.size, kinds_.size);
            const double to = from + kinds_.size * draw_.log_uniform(1e-3, 1);
            min += fmt::format("{}{:.17g}", axis == 0 ? "" : ", ", from);
            max += fmt::format("{}{:.17g}", axis == 0 ? "" : ", ", to);
        }
        out_ << ", min: [" << min << "], max: [" << max << "]";
    }
    void mesh() {
        // The wreck has textures with holes, bumps and emission.
        const std::string file =
            draw_.one_of({"cube_quads.ply", "housing.glb", "housing.glb", "wreck.glb"});
        if (draw_.chance(0.3)) out_ << reflectance();
        if (file != "cube_quads.ply" && draw_.chance(0.5)) out_ << "material: pbr, ";
        out_ << "file: " << k_assets << "meshes/" << file
             << ", transform: {scale: " << kinds_.size * draw_.log_uniform(0.01, 3)
             << ", rotate: " << draw_.vector(180) << ", translate: " << draw_.vector(kinds_.size)
             << "}";
    }

    void profile() {
        switch (draw_.whole(0, 3)) {
            case 0:
                out_ << "{type: isotropic}";
                break;
            case 1: {
                const double beam =
                    draw_.chance(0.2) ? draw_.log_uniform(0.01, 1) : draw_.uniform(1, 179);
                out_ << "{type: spot, beam: " << beam
                     << ", edge: " << (draw_.chance(0.3) ? 0 : draw_.uniform(0, 0.9 * beam))
                     << ", falloff: "
                     << (beam > 90 ? "smooth" : draw_.one_of({"smooth", "gltf", "blender-3.4"}))
                     << "}";
                break;
            }
            case 2:
                out_ << "{type: cosine, fwhm: " << draw_.uniform(1, 179) << "}";
                break;
            default:
                out_ << "{type: ies, file: " << k_assets << "ies/synthetic_spot_6000lm_20deg.ies}";
        }
    }

    void lamps() {
        out_ << "lamps:\n";
        for (int n = draw_.whole(1, 3); n > 0; --n) {
            if (kinds_.has_surface && draw_.chance(0.5))
                sun();
            else
                lamp();
        }
    }
    void sun() {
        out_ << "  - {type: sun, direction: [" << draw_.uniform(-2, 2) << ", -1, "
             << draw_.uniform(-2, 2) << "], irradiance: " << per_band(1e-3, 1e3)
             << ", angle: " << (draw_.chance(0.5) ? 0 : 5) << ", samples: 4}\n";
    }
    void lamp() {
        const bool has_extent = draw_.chance(0.1);
        out_ << "  - {";
        if (has_extent && draw_.chance(0.5))
            out_ << draw_.one_of({"type: disk", "type: sphere"})
                 << ", samples: 4, radius: " << kinds_.size * draw_.log_uniform(1e-3, 0.3) << ", ";
        else if (has_extent)
            out_ << "type: rectangle, samples: 4, width: "
                 << kinds_.size * draw_.log_uniform(1e-3, 0.3)
                 << ", height: " << kinds_.size * draw_.log_uniform(1e-3, 0.3) << ", ";
        out_ << "position: " << (draw_.chance(0.1) ? "[0, 0, 0]" : draw_.vector(kinds_.size))
             << ", direction: " << draw_.normal() << ", profile: ";
        if (has_extent)
            out_ << "{type: isotropic}";
        else
            profile();
        if (draw_.chance(0.1))
            out_ << ", spectrum: "
                 << draw_.one_of({"{type: led, name: LED-B3}", "{type: d65}", "{type: flat}",
                                  "{type: blackbody, temperature: 3200}"})
                 << draw_.one_of({", intensity: ", ", power: ", ", lumens: "})
                 << draw_.log_uniform(1e-6, 1e6);
        else
            out_ << (draw_.chance(0.7) ? ", intensity: " : ", power: ") << per_band(1e-6, 1e6);
        if (kinds_.moves && draw_.chance(0.3))
            out_ << ", trajectory: " << draw_.trajectory(kinds_.size, false);
        else
            out_ << ", frame: " << draw_.one_of({"camera", "world"});
        out_ << "}\n";
    }

    void render() {
        out_ << "render:\n  integrator: " << kinds_.integrator
             << "\n  samples: " << draw_.whole(1, kinds_.moves ? 4 : 2) << "\n";
        if (kinds_.is_multiple) out_ << "  scattering: multiple\n";
        if (kinds_.moves) out_ << "  shutter: " << draw_.log_uniform(1e-5, 2) << "\n";
        if (kinds_.has_lens && !kinds_.has_sensor)
            out_ << "  output: "
                 << (kinds_.is_multiple ? draw_.one_of({"radiance", "sensor_irradiance"})
                                        : draw_.one_of({"radiance", "sensor_irradiance", "paper"}))
                 << "\n";
        if (kinds_.integrator == "planes" || draw_.chance(0.1))
            out_ << "  planes: {count: " << draw_.whole(1, 64)
                 << ", near: " << kinds_.size * draw_.log_uniform(1e-3, 0.1)
                 << ", far: " << kinds_.size * draw_.log_uniform(0.2, 3) << "}\n";
    }

    RandomDraw& draw_;
    const SceneKinds& kinds_;
    std::ostringstream out_;
};

}  // namespace

std::string random_scene(std::uint64_t seed) {
    RandomDraw draw(seed);
    const SceneKinds kinds(draw);
    const std::string camera = random_camera(draw, kinds);
    return "uwvdb: 1\n" + camera + SceneText(draw, kinds).sections();
}

}  // namespace uw::test
