#include "core/image/loaded_module.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include <filesystem>
#include <system_error>

namespace uw {

ModuleFunction load_function(const char* name, const char* symbol) {
    Dl_info self{};
    link_map* loaded = nullptr;
    if (dladdr1(reinterpret_cast<const void*>(&load_function), &self,
                reinterpret_cast<void**>(&loaded), RTLD_DL_LINKMAP) == 0)
        return {nullptr, "this program does not know its own place"};
    std::error_code ignored;
    // Only libraries have a file name here: what dladdr has for a program is the word that it was
    // called by, which leads nowhere if it was found along PATH.
    const bool is_library = loaded->l_name[0] != '\0';
    std::filesystem::path above =
        std::filesystem::canonical(is_library ? loaded->l_name : "/proc/self/exe", ignored);
    constexpr int k_max_above = 5;
    for (int i = 0; i < k_max_above && above.has_relative_path(); ++i) {
        above = above.parent_path();
        const std::filesystem::path file =
            above / UWVDB_MODULE_FOLDER / (std::string(name) + ".so");
        if (!std::filesystem::exists(file, ignored)) continue;
        void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
        void* const address = module != nullptr ? dlsym(module, symbol) : nullptr;
        if (address == nullptr) return {nullptr, dlerror()};
        return {address, ""};
    }
    return {nullptr, fmt::format("the module {} is not installed", name)};
}

std::string how_to_install(std::string_view package, std::string_view development) {
    return fmt::format(
        "install the package {}, or, of a program built from source, {}, and run cmake and the "
        "build again",
        package, development);
}

}  // namespace uw
