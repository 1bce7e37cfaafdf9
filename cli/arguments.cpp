#include "cli/arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>

#include "cli/version.h"
#include "core/config_text.h"
#include "core/error.h"

namespace uw {

namespace {

constexpr const char* k_render_examples = R"(Examples:
  uwvdb render assets/scenes/plume.yaml
  uwvdb render plume.yaml -o out/plume.exr --size 960x540 --samples 1
  uwvdb render plume.yaml --set lamps.left.intensity='[80, 80, 80]' --layers direct,depth
  uwvdb render plume.yaml --integrator reference --crop 100,80,140,120 --stats stats.json
  uwvdb render houdini.yaml --set 'volumes[0].file=/data/my.vdb' --irradiance-vdb light.vdb

Writes OUT.exr (32-bit float, layers by name) and OUT.png beside it, a preview.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write,
130 interrupted. More: docs/command-line.md)";

template <std::size_t N>
std::array<int, N> parse_integers(const std::string& text, char separator, const char* option,
                                  const char* form) {
    std::array<int, N> values{};
    const char* at = text.data();
    const char* const end = at + text.size();
    for (std::size_t i = 0; i < N; ++i) {
        const auto [next, error] = std::from_chars(at, end, values[i]);
        const bool last = i + 1 == N;
        if (error != std::errc() || (last ? next != end : next == end || *next != separator))
            throw UsageError(
                fmt::format("{}: expected {}, found '{}'", option, form, printable(text)));
        at = next + 1;
    }
    return values;
}

// A check like CLI::Range that reads "expected 1 to 4096, found 'abc'".
CLI::Validator in_range(int low, int high) {
    return CLI::Validator(
        [low, high](const std::string& text) -> std::string {
            int value = 0;
            const char* const end = text.data() + text.size();
            const auto [next, error] = std::from_chars(text.data(), end, value);
            if (error == std::errc() && next == end && value >= low && value <= high) return {};
            return fmt::format("expected {} to {}, found '{}'", low, high, printable(text));
        },
        "");
}

void add_render_options(CLI::App& render, RenderArguments& a, std::string& size,
                        std::string& crop) {
    render.add_option("SCENE", a.scene, "scene file (docs/scene-file.md)")->required();
    render.add_option("-o,--output", a.output, "EXR to write; without it, the scene's name, here")
        ->type_name("OUT.exr");
    render.add_option("--set", a.overrides, "replace a value of the scene file; may be repeated")
        ->take_all()
        ->type_name("KEY.PATH=VALUE")
        ->type_size(1)
        ->allow_extra_args(false);
    render.add_option("--size", size, "render at this size, the intrinsics scaled with it")
        ->type_name("WxH");
    render.add_option("--crop", crop, "render these pixels only; x1 and y1 are excluded")
        ->type_name("x0,y0,x1,y1");
    render.add_option("--integrator", a.integrator, "volume or reference")->type_name("NAME");
    render
        .add_option("--layers", a.layers,
                    "all, or names separated by commas, among them default and lamps")
        ->type_name("NAMES");
    render.add_option("--samples", a.samples, "surface samples per pixel, 1 to 4096")
        ->check(in_range(1, 4096))
        ->type_name("N");
    render.add_option("--threads", a.threads, "threads to use; 0, the default: all there are")
        ->check(in_range(0, 1024))
        ->type_name("N");
    render.add_option("--stats", a.stats, "write times, rays, voxels and memory as JSON")
        ->type_name("FILE");
    render
        .add_option("--irradiance-vdb", a.irradiance_vdb,
                    "write each lamp's irradiance per band as grids of a VDB")
        ->type_name("FILE");
    render.add_flag("--quiet", a.quiet, "print nothing but warnings and errors");
    render.footer(k_render_examples);
}

std::vector<std::string> names_of_options(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

// One line about the first word that neither `app` nor its command could place.
std::string about_unexpected(const CLI::App& app) {
    const std::vector<CLI::App*> commands = app.get_subcommands();
    const std::vector<std::string> words = app.remaining(true);
    const auto option = std::ranges::find_if(
        words, [](const std::string& word) { return word.size() > 1 && word[0] == '-'; });
    if (option != words.end()) {
        const std::vector<std::string> names =
            names_of_options(commands.empty() ? app : *commands.front());
        const std::string word = option->substr(0, option->find('='));
        return fmt::format(
            "{}: unknown option; {}", printable(word),
            suggestion(word, std::vector<std::string_view>(names.begin(), names.end())));
    }
    const std::string word = words.empty() ? "" : words.front();
    if (!commands.empty())
        return fmt::format("'{}': not expected; give one SCENE, and options", printable(word));
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    return fmt::format("'{}': unknown command; {}", printable(word),
                       suggestion(word, std::vector<std::string_view>(names.begin(), names.end())));
}

// Refuses `-o ''`: most likely a variable of a script that was not set.
void refuse_empty_files(const CLI::App& command) {
    for (const CLI::Option* option : command.get_options()) {
        if (option->count() == 0 || option->get_type_size() == 0) continue;
        for (const std::string& text : option->results())
            if (text.empty())
                throw UsageError(
                    fmt::format("{}: has an empty value; give one, or leave it out",
                                option->get_positional() ? "SCENE" : option->get_name()));
    }
}

}  // namespace

Arguments parse_arguments(int argc, const char* const* argv) {
    Arguments arguments;
    std::string size, crop;
    bool version = false;
    CLI::App app("uwvdb: physically exact images of lamp-lit water, plumes and what is in them",
                 "uwvdb");
    app.add_flag("--version", version, "print the version and stop");
    app.footer(
        "Example:\n  uwvdb render assets/scenes/plume.yaml -o plume.exr\n\n"
        "`uwvdb render --help` tells more.");
    CLI::App* render = app.add_subcommand("render", "render a scene to a multi-layer EXR");
    add_render_options(*render, arguments.render, size, crop);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        arguments.message = render->parsed() ? render->help("uwvdb") : app.help();
        return arguments;
    } catch (const CLI::ExtrasError&) {
        throw UsageError(about_unexpected(app));
    } catch (const CLI::ParseError& error) {
        throw UsageError(fmt::format("{}; see 'uwvdb render --help'", error.what()));
    }
    if (version) {
        arguments.message = "uwvdb " + program_version() + "\n";
        return arguments;
    }
    if (!render->parsed()) throw UsageError("which command? 'uwvdb render SCENE', or --help");
    refuse_empty_files(*render);
    if (!size.empty())
        arguments.render.size = parse_integers<2>(size, 'x', "--size", "WxH such as 640x360");
    if (!crop.empty())
        arguments.render.crop = parse_integers<4>(crop, ',', "--crop", "x0,y0,x1,y1");
    return arguments;
}

}  // namespace uw
