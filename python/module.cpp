#include <filesystem>

#include "core/base/version.h"
#include "media/water/species_cache.h"
#include "python/bindings.h"

// NOLINTNEXTLINE: the macro's code is pybind11's
PYBIND11_MODULE(_uwvdb, module) {
    module.doc() = "The compiled part of uwvdb; use the package.";
    module.attr("version") = uw::program_version();
    if (const std::filesystem::path cache = uw::user_cache_folder(); !cache.empty())
        uw::keep_species_in(cache / "uwvdb" / "species");
    uw::bind_errors(module);
    uw::bind_scene(module);
    uw::bind_image(module);
    uw::bind_renderer(module);
    uw::bind_camera(module);
    uw::bind_water(module);
    uw::bind_files(module);
    uw::bind_validate(module);
}
