#include "core/image/colour_view.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <mutex>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/text.h"
#include "core/base/troubleshooting.h"
#include "core/image/loaded_module.h"
#include "core/scene/yaml_document.h"

namespace uw {

namespace {

/// What OpenColorIO would take gigabytes or hours for, such as nested aliases, is refused before it
/// reads the config. An archive, which is no text, is left to it.
void check_config_text(const std::string& config) {
    YamlLimits limits;
    limits.subject = "OpenColorIO config";
    limits.has_tags = true;
    std::string text(limits.bytes + 1, '\0');
    std::ifstream in = open_own_file(config);
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(in.gcount()));
    if (!text.starts_with("PK")) parse_yaml(text, config, limits);
}

/// Look-up tables in XML can refer to further files, which would be opened unchecked. The tables of
/// any other format are not even read here.
void refuse_references(const std::filesystem::path& file, const std::string& subject) {
    constexpr std::string_view k_before_xml("\xef\xbb\xbf\xfe\xff\0 \t\r\n", 10);
    std::ifstream in = open_own_file(file);
    std::istreambuf_iterator<char> at(in), end;
    while (at != end && k_before_xml.find(*at) != std::string_view::npos) ++at;
    if (at == end || *at != '<') return;
    std::string text;
    for (; at != end; ++at)  // in UTF-16 every other byte is 0
        if (*at != '\0')
            text += *at >= 'A' && *at <= 'Z' ? static_cast<char>(*at + ('a' - 'A')) : *at;
    for (const std::string_view word : {"<reference", "<!doctype"})
        if (text.find(word) != std::string::npos)
            throw InputError(fmt::format(
                "{}: has a {}>, by which it can bring in other files; write what it refers to into "
                "the file itself",
                subject, word == "<reference" ? "<Reference" : "<!DOCTYPE"));
}

std::shared_ptr<ColourView> make_view(const ViewDesc& desc, const std::string& config,
                                      const std::string& where) {
    static const ModuleFunction module = load_function("uwvdb_colour_views", k_make_view);
    if (module.address == nullptr)
        throw InputError(fmt::format(
            "{}: a view needs OpenColorIO ({}); {}; or take it out for sRGB{}", where, module.fault,
            how_to_install("uwvdb-image-formats"), see_troubleshooting("Installing")));
    ViewRequest request{config, desc.display, desc.view, desc.look, desc.input, {}};
    const NamedBy named_by = desc.config.empty() ? NamedBy::user : NamedBy::scene;
    admit_input(config, fmt::format("{}: '{}'", where, printable(config, 300)),
                "OpenColorIO config", named_by);
    check_config_text(config);
    request.check = [&](const std::filesystem::path& file) {
        const std::string subject = fmt::format("{}: '{}'", where, printable(file.string(), 300));
        admit_input(file, subject, "look-up table", named_by);
        refuse_references(file, subject);
    };
    std::shared_ptr<ColourView> view;
    std::string fault;
    reinterpret_cast<MakeView*>(module.address)(request, view, fault);
    if (!fault.empty()) throw InputError(fmt::format("{}: '{}': {}", where, config, fault));
    return view;
}

}  // namespace

std::shared_ptr<const ColourView> colour_view(const std::optional<ViewDesc>& desc) {
    const std::string environment = config_of_environment().string();
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

std::filesystem::path config_of_environment() {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): nothing here changes the environment
    const char* const name = std::getenv("OCIO");
    return name != nullptr ? name : "";
}

std::vector<std::filesystem::path> files_named_by_view(const ViewDesc& desc) {
    try {
        const std::vector<std::filesystem::path>& files = colour_view(desc)->files;
        return {files.begin() + 1, files.end()};
    } catch (const InputError&) {
        return {};  // whoever needs the view will say what is wrong
    } catch (const IoError&) {
        return {};
    }
}

}  // namespace uw
