#include "core/image/loaded_module.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <system_error>

namespace uw {

namespace {

constexpr int k_max_above = 5;  // folders: a build has its programs and modules at most this deep

/// The nearest folder above `program` that has `name` in it, or an empty path.
std::filesystem::path folder_with(const std::filesystem::path& name,
                                  const std::filesystem::path& program) {
    std::error_code ignored;
    std::filesystem::path above = program;
    for (int i = 0; i < k_max_above && above.has_relative_path(); ++i) {
        above = above.parent_path();
        if (std::filesystem::exists(above / name, ignored)) return above;
    }
    return {};
}

bool is_below(const std::filesystem::path& path, const std::filesystem::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
           folder.end();
}

}  // namespace

std::filesystem::path own_file() {
    Dl_info self{};
    link_map* loaded = nullptr;
    if (dladdr1(reinterpret_cast<const void*>(&own_file), &self, reinterpret_cast<void**>(&loaded),
                RTLD_DL_LINKMAP) == 0)
        return {};
    std::error_code ignored;
    // Only libraries have a file name here: what dladdr has for a program is the word that it was
    // called by, which leads nowhere if it was found along PATH.
    const bool is_library = loaded->l_name[0] != '\0';
    return std::filesystem::canonical(is_library ? loaded->l_name : "/proc/self/exe", ignored);
}

ModuleFunction load_function(const char* name, const char* symbol) {
    const std::filesystem::path program = own_file();
    if (program.empty()) return {nullptr, "this program does not know its own place"};
    const std::filesystem::path file =
        std::filesystem::path(UWVDB_MODULE_FOLDER) / (std::string(name) + ".so");
    const std::filesystem::path above = folder_with(file, program);
    if (above.empty()) return {nullptr, fmt::format("the module {} is not installed", name)};
    void* const module = dlopen((above / file).c_str(), RTLD_NOW | RTLD_LOCAL);
    void* const address = module != nullptr ? dlsym(module, symbol) : nullptr;
    if (address == nullptr) return {nullptr, dlerror()};
    return {address, ""};
}

std::string how_to_install(std::string_view package, const std::filesystem::path& program) {
    if (is_below(program, "/usr") && !is_below(program, "/usr/local"))
        return fmt::format("install the package {}", package);
    if (!folder_with("CMakeCache.txt", program).empty())
        return "run scripts/demo, which installs what is missing and builds the rest of the "
               "program";
    return "run scripts/demo in the repository that this program was built from, and install it "
           "again";
}

}  // namespace uw
