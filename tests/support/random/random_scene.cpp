#include "tests/support/random/random_scene.h"

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>
#include <random>

namespace uw::test {
namespace {

const std::string k_assets = UWVDB_SOURCE_DIR "/assets/";

class SceneDraw {
  public:
    explicit SceneDraw(std::uint64_t seed) : bits_(seed) {}

    std::string scene() {
        draw_kinds();
        return "uwvdb: 1\n" + camera() + water() + volumes() + geometry() + lamps() + render();
    }

  private:
    // The library's distributions differ from one to another.
    double uniform(double low, double high) {
        return low + (high - low) * (static_cast<double>(bits_() >> 11U) * 0x1p-53);
    }
    double log_uniform(double low, double high) {
        return std::exp(uniform(std::log(low), std::log(high)));
    }
    bool chance(double share) { return uniform(0, 1) < share; }
    int whole(int low, int high) { return static_cast<int>(uniform(low, high + 1)); }
    std::string one_of(std::initializer_list<std::string> choices) {
        return choices.begin()[whole(0, static_cast<int>(choices.size()) - 1)];
    }
    std::string vector(double size) {
        return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", uniform(-size, size),
                           uniform(-size, size), uniform(-size, size));
    }
    /// A list of one number per band, or a single one.
    std::string per_band(double low, double high) {
        if (chance(0.3)) return fmt::format("{:.17g}", log_uniform(low, high));
        std::string list;
        for (int band = 0; band < bands_; ++band)
            list += fmt::format("{}{:.17g}", band == 0 ? "" : ", ",
                                chance(0.1) ? 0.0 : log_uniform(low, high));
        return "[" + list + "]";
    }

    /// What different sections have to agree on.
    void draw_kinds() {
        bands_ = chance(0.7) ? 3 : whole(1, 6);
        is_fisheye_ = chance(0.15);
        integrator_ = chance(0.12) && !is_fisheye_ ? "planes"
                      : chance(0.1)                ? "reference"
                                                   : "volume";
        has_volume_ = integrator_ != "planes" && chance(0.3);
        has_surface_ = chance(0.2);
        is_multiple_ = integrator_ == "volume" && chance(0.15);
        size_ = log_uniform(0.05, 300);  // of the scene [m]
    }

    std::string camera() {
        std::string text = "camera:\n  resolution: [16, 9]\n";
        text += is_fisheye_ ? fmt::format("  intrinsics: {{fov_x: {:.17g}}}\n", uniform(5, 300))
                : chance(0.7)
                    ? fmt::format("  intrinsics: {{fov_x: {:.17g}}}\n",
                                  chance(0.2) ? log_uniform(1e-3, 1) : uniform(1, 150))
                    : fmt::format("  intrinsics: {{fx: {:.17g}, fy: {:.17g}, cx: {:.17g}}}\n",
                                  log_uniform(2, 1e4), log_uniform(2, 1e4), uniform(-16, 32));
        if (is_fisheye_) text += "  distortion: {model: fisheye}\n";
        if (!is_fisheye_ && chance(0.3))
            text += fmt::format("  distortion: {{k: [{:.17g}, {:.17g}, 0], p: [{:.17g}, 0]}}\n",
                                uniform(-0.3, 0.3), uniform(-0.1, 0.1), uniform(-0.01, 0.01));
        if (!is_fisheye_ && chance(0.3))
            text += fmt::format(
                "  port: {{type: flat, distance: {:.17g}, thickness: {:.17g}, n_water: {:.17g}, "
                "normal: [{:.17g}, 0, 1], fresnel: {}}}\n",
                chance(0.2) ? 0 : log_uniform(1e-6, 1), chance(0.2) ? 0 : log_uniform(1e-6, 1),
                uniform(1, 1.5), chance(0.5) ? 0 : uniform(-0.3, 0.3), one_of({"true", "false"}));
        else if (chance(0.2))
            text += fmt::format("  port: {{type: dome, radius: {:.17g}, thickness: {:.17g}}}\n",
                                log_uniform(1e-3, 1), log_uniform(1e-5, 0.1));
        // Sometimes exactly on what is there.
        const std::string position = chance(0.15) ? "[0, 0, 0]" : vector(size_);
        const std::string target =
            fmt::format("[{:.17g}, {:.17g}, {:.17g}]", size_ * uniform(1.1, 2),
                        size_ * uniform(-1, 1), size_ * uniform(1.1, 2));
        return text + "  pose: {position: " + position + ", look_at: " + target + "}\n";
    }

    std::string phase() {
        switch (whole(0, 4)) {
            case 0:
                return fmt::format("{{type: fournier-forand, n: {:.17g}, mu: {:.17g}}}",
                                   uniform(1.001, 1.5), uniform(3.05, 4.9));
            case 1:
                return "{type: petzold}";
            case 2:
                return "{type: water}";
            default:
                return fmt::format("{{type: hg, g: {:.17g}}}",
                                   chance(0.2) ? uniform(-0.99, 0.99) : uniform(0, 0.98));
        }
    }

    std::string water() {
        std::string text = "water:\n";
        if (bands_ != 3) {
            text += "  bands: [";
            for (int band = 0; band < bands_; ++band)
                text += fmt::format("{}{}", band == 0 ? "" : ", ", 400 + 50 * band);
            text += "]\n";
        }
        if (chance(0.5)) {
            text += "  absorption: " + per_band(1e-6, 1e3) + "\n";
            text += "  scattering: {b: " + per_band(1e-6, 1e3) + ", phase: " + phase() + "}\n";
        } else {
            text += chance(0.5)
                        ? "  preset: " + one_of({"jerlov-IB", "jerlov-II", "jerlov-5C"}) + "\n"
                        : fmt::format("  chlorophyll: {:.17g}\n  cdom: {:.17g}\n",
                                      log_uniform(1e-3, 30), log_uniform(1e-3, 5));
            text += fmt::format("  particles: {{small: {:.17g}, large: {:.17g}{}}}\n",
                                log_uniform(1e-6, 1e3), log_uniform(1e-6, 1e3),
                                chance(0.3) ? ", absorption: mineral" : "");
        }
        if (!is_multiple_ && integrator_ != "reference" && chance(0.15))
            text += fmt::format("  forward_scatter: {{K: {:.17g}, B: {:.17g}, shape: {}}}\n",
                                log_uniform(1e-3, 2), log_uniform(1e-4, 0.3),
                                one_of({"gaussian", "exponential"}));
        if (has_surface_)
            text += fmt::format("  surface: {{point: [0, {:.17g}, 0], normal: [0, 1, 0]}}\n",
                                size_ * uniform(2, 20));
        return text;
    }

    std::string volumes() {
        if (!has_volume_) return "";
        const std::string mapping =
            chance(0.5) ? fmt::format("{{small: {:.17g}, large: {:.17g}}}", log_uniform(1e-6, 1e4),
                                      log_uniform(1e-6, 1e4))
                        : "{absorption: " + per_band(1e-6, 1e4) +
                              ", scattering: " + per_band(1e-6, 1e4) + ", phase: " + phase() + "}";
        const double scale = chance(0.2) ? log_uniform(1e-5, 1e4) : size_ * log_uniform(0.1, 1);
        return "volumes:\n  - file: " + k_assets +
               "grids/plume128_blosc_half_0030.vdb\n    grids: {density: " + mapping +
               fmt::format("}}\n    transform: {{scale: {:.17g}, rotate: {}, translate: {}}}\n",
                           scale, vector(180), vector(size_));
    }

    std::string geometry() {
        std::string text;
        for (int n = whole(0, 3); n > 0; --n) {
            text += "  - {reflectance: " + reflectance();
            switch (whole(0, 2)) {
                case 0:
                    text += fmt::format(", type: plane, point: [0, 0, {:.17g}], normal: {}}}\n",
                                        chance(0.3) ? 0 : uniform(-size_, size_), normal());
                    break;
                case 1:
                    text += fmt::format(
                        ", type: sphere, center: {}, radius: {:.17g}}}\n", vector(size_),
                        chance(0.2) ? log_uniform(1e-5, 1e5) : size_ * log_uniform(0.01, 1));
                    break;
                default: {
                    std::string min, max;
                    for (int axis = 0; axis < 3; ++axis) {
                        const double from = uniform(-size_, size_);
                        const double to = from + size_ * log_uniform(1e-3, 1);
                        min += fmt::format("{}{:.17g}", axis == 0 ? "" : ", ", from);
                        max += fmt::format("{}{:.17g}", axis == 0 ? "" : ", ", to);
                    }
                    text += ", type: box, min: [" + min + "], max: [" + max + "]}\n";
                }
            }
        }
        return text.empty() ? "" : "geometry:\n" + text;
    }
    std::string normal() {
        return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", uniform(-1, 1), uniform(-1, 1),
                           log_uniform(1e-3, 1e3));
    }
    std::string reflectance() {
        const double r = chance(0.1) ? 0 : chance(0.1) ? 1 : uniform(0, 1);
        return fmt::format("{:.17g}", r);
    }

    std::string profile() {
        switch (whole(0, 3)) {
            case 0:
                return "{type: isotropic}";
            case 1: {
                const double beam = chance(0.2) ? log_uniform(0.01, 1) : uniform(1, 179);
                return fmt::format("{{type: spot, beam: {:.17g}, edge: {:.17g}}}", beam,
                                   chance(0.3) ? 0 : uniform(0, 0.9 * beam));
            }
            case 2:
                return fmt::format("{{type: cosine, fwhm: {:.17g}}}", uniform(1, 179));
            default:
                return "{type: ies, file: " + k_assets + "ies/synthetic_spot_6000lm_20deg.ies}";
        }
    }

    std::string lamps() {
        std::string text = "lamps:\n";
        for (int n = whole(1, 3); n > 0; --n) {
            if (has_surface_ && chance(0.5)) {
                text += fmt::format(
                    "  - {{type: sun, direction: [{:.17g}, -1, {:.17g}], irradiance: {}, angle: "
                    "{}, samples: 4}}\n",
                    uniform(-2, 2), uniform(-2, 2), per_band(1e-3, 1e3), chance(0.5) ? 0 : 5);
                continue;
            }
            std::string extent;
            if (chance(0.1)) extent = "type: disk, samples: 4, radius: ";
            if (!extent.empty()) extent += fmt::format("{:.17g}, ", size_ * log_uniform(1e-3, 0.3));
            text += "  - {" + extent + "position: " + (chance(0.1) ? "[0, 0, 0]" : vector(size_)) +
                    ", direction: " + normal() +
                    ", profile: " + (extent.empty() ? profile() : "{type: isotropic}") +
                    (chance(0.7) ? ", intensity: " : ", power: ") + per_band(1e-6, 1e6) +
                    ", frame: " + one_of({"camera", "world"}) + "}\n";
        }
        return text;
    }

    std::string render() {
        std::string text =
            fmt::format("render:\n  integrator: {}\n  samples: {}\n", integrator_, whole(1, 2));
        if (is_multiple_) text += "  scattering: multiple\n";
        if (integrator_ == "planes" || chance(0.1))
            text +=
                fmt::format("  planes: {{count: {}, near: {:.17g}, far: {:.17g}}}\n", whole(1, 64),
                            size_ * log_uniform(1e-3, 0.1), size_ * log_uniform(0.2, 3));
        return text;
    }

    std::mt19937_64 bits_;
    int bands_ = 3;
    bool is_fisheye_ = false, has_volume_ = false, has_surface_ = false, is_multiple_ = false;
    std::string integrator_;
    double size_ = 1;
};

}  // namespace

std::string random_scene(std::uint64_t seed) {
    return SceneDraw(seed).scene();
}

}  // namespace uw::test
