// Renders a scene file at a small size and prints what the pixel at its centre sees.
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "core/colour/colour.h"
#include "core/image/film.h"
#include "core/image/layers.h"
#include "core/scene/yaml/scene_reader.h"
#include "render/scene_assembly.h"
#include "render/scene_rendering.h"

namespace {

void print_center(const std::string& file) {
    const uw::SceneDesc desc = uw::read_scene(file, {"camera.resolution=[32, 18]"});
    const uw::AssembledScene scene = uw::assemble_scene(desc, [](const std::string&) {});
    const uw::DeepShadows light =
        uw::splat_lamps(scene, uw::deep_shadow_options(desc.render.quality));
    const auto integrator = uw::make_integrator(scene, light);

    std::vector<std::string> lamp_names;
    for (const uw::LampDesc& lamp : scene.desc.lamps) lamp_names.push_back(lamp.name);
    const uw::LayerPlan layers("depth", desc.water.bands_nm, lamp_names);
    const uw::BandColour colour(desc.water.bands_nm);
    const int width = desc.camera.width, height = desc.camera.height;
    uw::Film image(width, height, {0, 0, width, height}, layers.channel_names());
    uw::render_scene(scene, light, *integrator, layers, colour, image,
                     [](const std::string&, double) { return true; });

    const auto pixel = image.pixel(width / 2, height / 2);
    const auto depth = static_cast<std::size_t>(layers.first_channel(uw::Layer::depth));
    std::printf("radiance %g %g %g W m^-2 sr^-1, depth %g m\n", pixel[uw::k_red],
                pixel[uw::k_green], pixel[uw::k_blue], pixel[depth]);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: depth_at_centre SCENE.yaml\n");
        return 2;
    }
    try {
        print_center(argv[1]);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "depth_at_centre: %s\n", error.what());
        return 1;
    }
}
