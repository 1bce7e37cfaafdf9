#include "tests/support/random/random_draw.h"

#include <fmt/format.h>

#include <algorithm>

namespace uw::test {

std::string RandomDraw::vector(double size) {
    const double x = uniform(-size, size), y = uniform(-size, size);
    return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", x, y, uniform(-size, size));
}

std::string RandomDraw::normal() {
    const double x = uniform(-1, 1), y = uniform(-1, 1);
    return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", x, y, log_uniform(1e-3, 1e3));
}

std::string RandomDraw::per_band(int bands, double low, double high) {
    if (chance(0.3)) return fmt::format("{:.17g}", log_uniform(low, high));
    std::string list;
    for (int band = 0; band < bands; ++band)
        list += fmt::format("{}{:.17g}", band == 0 ? "" : ", ",
                            chance(0.1) ? 0.0 : log_uniform(low, high));
    return "[" + list + "]";
}

std::string RandomDraw::trajectory(double size, bool looks) {
    std::string poses;
    const double speed = size * log_uniform(1e-4, 1);
    double time = -1;
    for (int n = whole(2, 3); n > 0; --n, time += uniform(1, 2)) {
        const std::string position = vector(speed);
        poses += fmt::format("{}{{time: {:.17g}, position: {}", poses.empty() ? "" : ", ", time,
                             position);
        if (looks) poses += fmt::format(", look_at: [{:.17g}, 0, {:.17g}]", 1.5 * size, 2 * size);
        poses += "}";
    }
    const std::string interpolation = one_of({"smooth", "linear"});
    return "{keyframes: [" + poses + "], interpolation: " + interpolation + "}";
}

SceneKinds::SceneKinds(RandomDraw& draw) {
    bands = draw.chance(0.7) ? 3 : draw.whole(1, 6);
    size = draw.log_uniform(0.05, 300);
    is_fisheye = draw.chance(0.15);
    integrator = draw.chance(0.12) && !is_fisheye ? "planes"
                 : draw.chance(0.08)              ? "reference"
                 : draw.chance(0.1)               ? "path"
                                                  : "volume";
    has_volume = integrator != "planes" && draw.chance(0.3);
    has_surface = draw.chance(0.2);
    // In a dense plume, light is scattered hundreds of times everywhere: minutes.
    is_multiple =
        integrator == "path" || (integrator == "volume" && !has_volume && draw.chance(0.12));
    has_forward_scatter = !is_multiple && integrator != "reference" && draw.chance(0.12);
    has_snow = integrator != "path" && draw.chance(0.12);
    has_lens = draw.chance(0.25);
    has_sensor = has_lens && bands == 3 && draw.chance(0.5);
    is_in_focus = !has_lens || is_fisheye || draw.chance(0.5);
    moves = draw.chance(0.12);
    // A part of an image with forward scatter takes all of it, by the reference integrator, too;
    // where light is scattered hundreds of times, each pixel takes seconds.
    width = is_multiple           ? draw.whole(3, 4)
            : has_forward_scatter ? draw.whole(4, 6)
                                  : draw.whole(6, 14);
    height = is_multiple           ? draw.whole(2, 3)
             : has_forward_scatter ? draw.whole(3, 4)
                                   : draw.whole(4, 9);
}

namespace {

std::string intrinsics(RandomDraw& draw, const SceneKinds& kinds) {
    if (kinds.is_fisheye)
        return fmt::format("  intrinsics: {{fov_x: {:.17g}}}\n  distortion: {{model: fisheye}}\n",
                           draw.uniform(5, 300));
    std::string text;
    if (draw.chance(0.7)) {
        const double narrow = draw.log_uniform(1e-3, 1), wide = draw.uniform(1, 150);
        text = fmt::format("  intrinsics: {{fov_x: {:.17g}}}\n", draw.chance(0.2) ? narrow : wide);
    } else {
        const double fx = draw.log_uniform(2, 1e4), fy = draw.log_uniform(2, 1e4);
        text = fmt::format("  intrinsics: {{fx: {:.17g}, fy: {:.17g}, cx: {:.17g}}}\n", fx, fy,
                           draw.uniform(-1, 2) * kinds.width);
    }
    if (!draw.chance(0.3)) return text;
    const double k1 = draw.uniform(-0.3, 0.3), k2 = draw.uniform(-0.1, 0.1);
    return text + fmt::format("  distortion: {{k: [{:.17g}, {:.17g}, 0], p: [{:.17g}, 0]}}\n", k1,
                              k2, draw.uniform(-0.01, 0.01));
}

std::string port(RandomDraw& draw, const SceneKinds& kinds) {
    if (!kinds.is_fisheye && draw.chance(0.3)) {
        const double distance = draw.chance(0.2) ? 0 : draw.log_uniform(1e-6, 1);
        const double thickness = draw.chance(0.2) ? 0 : draw.log_uniform(1e-6, 1);
        const double n_water = draw.uniform(1, 1.5);
        const double slant = draw.chance(0.5) ? 0 : draw.uniform(-0.3, 0.3);
        return fmt::format(
            "  port: {{type: flat, distance: {:.17g}, thickness: {:.17g}, n_water: {:.17g}, "
            "normal: [{:.17g}, 0, 1], fresnel: {}}}\n",
            distance, thickness, n_water, slant, draw.one_of({"true", "false"}));
    }
    if (!draw.chance(0.2)) return "";
    const double radius = draw.log_uniform(1e-3, 1);
    return fmt::format("  port: {{type: dome, radius: {:.17g}, thickness: {:.17g}}}\n", radius,
                       draw.log_uniform(1e-5, 0.1));
}

std::string lens(RandomDraw& draw, const SceneKinds& kinds) {
    if (!kinds.has_lens) return "";
    const double f_number = draw.log_uniform(0.5, 50);
    const double focal_length = draw.log_uniform(1e-3, 0.2);
    std::string text =
        fmt::format("  lens: {{f_number: {:.17g}, focal_length: {:.17g}, transmission: {:.17g}",
                    f_number, focal_length, draw.uniform(0, 1));
    if (!kinds.is_in_focus)
        text += fmt::format(", focus_distance: {:.17g}",
                            std::max(1.5 * focal_length, kinds.size * draw.log_uniform(0.01, 2)));
    return text + "}\n";
}

std::string sensor(RandomDraw& draw, const SceneKinds& kinds) {
    if (!kinds.has_sensor) return "";
    const double exposure = draw.log_uniform(1e-6, 10);
    const double pitch = draw.log_uniform(1e-6, 1e-4);
    const std::string mosaic = draw.one_of({"mono", "rggb", "bggr", "grbg", "gbrg", "three"});
    const double efficiency = draw.uniform(0, 1);
    const double full_well = draw.log_uniform(1, 1e6);
    const double dark_current = draw.chance(0.5) ? 0 : draw.log_uniform(1e-3, 1e6);
    const double read_noise = draw.chance(0.3) ? 0 : draw.log_uniform(1e-2, 1e4);
    const double prnu = draw.chance(0.5) ? 0 : draw.log_uniform(1e-4, 1);
    const int bits = draw.whole(8, 16);
    return fmt::format(
        "  sensor: {{exposure: {:.17g}, pixel_pitch: {:.17g}, mosaic: {}, quantum_efficiency: "
        "{:.17g}, full_well: {:.17g}, dark_current: {:.17g}, read_noise: {:.17g}, prnu: {:.17g}, "
        "bit_depth: {}, seed: {}}}\n",
        exposure, pitch, mosaic, efficiency, full_well, dark_current, read_noise, prnu, bits,
        draw.whole(0, 1000));
}

std::string pose(RandomDraw& draw, const SceneKinds& kinds) {
    if (kinds.moves && draw.chance(0.7)) {
        std::string text = "  trajectory: " + draw.trajectory(kinds.size, true) + "\n";
        if (draw.chance(0.3))
            text += fmt::format("  line_time: {:.17g}\n", draw.log_uniform(1e-6, 0.01));
        return text;
    }
    // Sometimes exactly on what is there.
    const std::string position = draw.chance(0.15) ? "[0, 0, 0]" : draw.vector(kinds.size);
    const double x = kinds.size * draw.uniform(1.1, 2), y = kinds.size * draw.uniform(-1, 1);
    return fmt::format("  pose: {{position: {}, look_at: [{:.17g}, {:.17g}, {:.17g}]}}\n", position,
                       x, y, kinds.size * draw.uniform(1.1, 2));
}

}  // namespace

std::string random_camera(RandomDraw& draw, const SceneKinds& kinds) {
    std::string text = fmt::format("camera:\n  resolution: [{}, {}]\n", kinds.width, kinds.height);
    text += intrinsics(draw, kinds);
    text += port(draw, kinds);
    text += lens(draw, kinds);
    text += sensor(draw, kinds);
    return text + pose(draw, kinds);
}

}  // namespace uw::test
