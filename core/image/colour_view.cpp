#include "core/image/colour_view.h"

#include <fmt/format.h>

#include <cstdlib>
#include <mutex>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/troubleshooting.h"
#include "core/image/loaded_module.h"

namespace uw {

namespace {

/// The config that the environment names; empty: none.
std::string config_of_environment() {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): nothing here changes the environment
    const char* const name = std::getenv("OCIO");
    return name != nullptr ? name : "";
}

std::shared_ptr<ColourView> make_view(const ViewDesc& desc, const std::string& config,
                                      const std::string& where) {
    static const ModuleFunction module = load_function("uwvdb_colour_views", k_make_view);
    if (module.address == nullptr)
        throw InputError(
            fmt::format("{}: a view needs OpenColorIO ({}); {}; or take it out for sRGB{}", where,
                        module.fault, how_to_install("uwvdb-image-formats", "libopencolorio-dev"),
                        see_troubleshooting("Installing")));
    ViewRequest request{config, desc.display, desc.view, desc.look, desc.input, {}};
    std::error_code status;
    if (!std::filesystem::is_regular_file(config, status))
        throw IoError(
            fmt::format("{}: '{}': no such OpenColorIO config; check the name", where, config));
    // What the user's own environment names may lie anywhere.
    const bool is_of_scene = !desc.config.empty();
    request.check = [&](const std::filesystem::path& file) {
        if (is_of_scene) remember_input(file);
    };
    request.check(config);
    std::shared_ptr<ColourView> view;
    std::string fault;
    reinterpret_cast<MakeView*>(module.address)(request, view, fault);
    if (!fault.empty()) throw InputError(fmt::format("{}: '{}': {}", where, config, fault));
    return view;
}

}  // namespace

std::shared_ptr<const ColourView> colour_view(const std::optional<ViewDesc>& desc) {
    const std::string environment = config_of_environment();
    if (!desc && environment.empty()) return nullptr;
    const ViewDesc wanted = desc.value_or(ViewDesc{});
    const std::string config = wanted.config.empty() ? environment : wanted.config.string();
    if (config.empty())
        throw InputError(
            wanted.where +
            ": which config? Add config: FILE.ocio, or set the environment variable OCIO");
    static std::mutex busy;
    static std::pair<std::string, ViewDesc> last;
    static FileStamps stamps;
    static std::shared_ptr<const ColourView> view;
    static std::uint64_t made = 0;
    const std::lock_guard lock(busy);
    if (view && last == std::pair(config, wanted) && stamps.are_current()) return view;
    const std::shared_ptr<ColourView> made_now =
        make_view(wanted, config, desc ? wanted.where : "OCIO");
    made_now->number = ++made;
    view = made_now;
    stamps = FileStamps(view->files);
    last = {config, wanted};
    return view;
}

std::vector<std::filesystem::path> files_of(const ViewDesc& desc) {
    try {
        return colour_view(desc)->files;
    } catch (const InputError&) {
        return {desc.config};  // whoever needs the view will say what is wrong
    } catch (const IoError&) {
        return {desc.config};
    }
}

}  // namespace uw
