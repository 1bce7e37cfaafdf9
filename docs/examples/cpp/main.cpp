// Renders a scene file at a small size and prints what the pixel at its centre sees.
#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <exception>

#include "core/image/film.h"
#include "render/renderer.h"
#include "render/scene_loading.h"

namespace {

void print_center(const char* file) {
    uw::Renderer renderer;
    renderer.set_scene(uw::load_scene(file, {"camera.resolution=[32, 18]"}));
    const uw::Film& image = renderer.render({.layers = "depth"});

    const auto pixel = image.pixel(image.width() / 2, image.height() / 2);
    const auto& names = image.channel_names();
    const auto depth = std::ranges::find(names, "depth.Z") - names.begin();
    std::printf("radiance %g %g %g W m^-2 sr^-1, depth %g m\n", pixel[uw::k_red],
                pixel[uw::k_green], pixel[uw::k_blue], pixel[static_cast<std::size_t>(depth)]);
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
