#include "cli/arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>

#include "cli/version.h"
#include "core/error.h"

namespace uw {

namespace {

constexpr const char* k_render_examples = R"(Examples:
  uwvdb render assets/scenes/plume.yaml
  uwvdb render plume.yaml -o out/plume.exr --size 960x540 --samples 1
  uwvdb render plume.yaml --set lamps.left.intensity='[80, 80, 80]' --layers direct,backscatter,depth
  uwvdb render plume.yaml --integrator reference --crop 100,80,140,120 --stats stats.json
  uwvdb render houdini.yaml --set volumes[0].file=my.vdb --irradiance-vdb light.vdb

Writes OUT.exr (32-bit float, one part, layers by name) and OUT.png, a preview.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write,
130 interrupted.)";

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
            throw UsageError(fmt::format("{}: expected {}, found '{}'", option, form, text));
        at = next + 1;
    }
    return values;
}

void add_render_options(CLI::App& render, RenderArguments& a, std::string& size,
                        std::string& crop) {
    render.add_option("SCENE", a.scene, "scene file (docs/scene-file.md)")->required();
    render.add_option("-o,--output", a.output, "EXR to write; the preview goes beside it as PNG");
    render.add_option("--set", a.overrides, "key.path=value: replace a value of the scene file")
        ->take_all()
        ->type_size(1)
        ->allow_extra_args(false);
    render.add_option("--size", size, "WxH: render at this size, intrinsics scaled with it");
    render.add_option("--crop", crop, "x0,y0,x1,y1: render these pixels only (x1, y1 excluded)");
    render.add_option("--integrator", a.integrator, "volume | planes | reference");
    render.add_option("--layers", a.layers, "all, or names separated by commas");
    render.add_option("--samples", a.samples, "surface samples per pixel")
        ->check(CLI::Range(1, 4096));
    render.add_option("--threads", a.threads, "threads to use; 0: all")->check(CLI::Range(0, 1024));
    render.add_option("--stats", a.stats, "write times, rays, voxels and memory as JSON");
    render.add_option("--irradiance-vdb", a.irradiance_vdb,
                      "write each lamp's irradiance per band as a VDB");
    render.add_flag("--quiet", a.quiet, "print errors only");
    render.footer(k_render_examples);
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
        arguments.message = render->parsed() ? render->help("uwvdb render") : app.help();
        return arguments;
    } catch (const CLI::ParseError& error) {
        throw UsageError(fmt::format("{}; see 'uwvdb render --help'", error.what()));
    }
    if (version) {
        arguments.message = "uwvdb " + program_version() + "\n";
        return arguments;
    }
    if (!render->parsed()) throw UsageError("which command? 'uwvdb render SCENE', or --help");
    if (!size.empty())
        arguments.render.size = parse_integers<2>(size, 'x', "--size", "WxH such as 640x360");
    if (!crop.empty())
        arguments.render.crop = parse_integers<4>(crop, ',', "--crop", "x0,y0,x1,y1");
    return arguments;
}

}  // namespace uw
