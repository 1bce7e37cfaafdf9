#include "cli/arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>

#include "cli/band_list.h"
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

void add_set_option(CLI::App& command, std::vector<std::string>& overrides) {
    command.add_option("--set", overrides, "key.path=value: replace a value of the scene file")
        ->take_all()
        ->type_size(1)
        ->allow_extra_args(false);
}

void add_render_options(CLI::App& render, RenderArguments& a, std::string& size,
                        std::string& crop) {
    render.add_option("SCENE", a.scene, "scene file (docs/scene-file.md)")->required();
    render.add_option("-o,--output", a.output, "EXR to write; the preview goes beside it as PNG");
    add_set_option(render, a.overrides);
    render.add_option("--size", size, "WxH: render at this size, intrinsics scaled with it");
    render.add_option("--crop", crop, "x0,y0,x1,y1: render these pixels only (x1, y1 excluded)");
    render.add_option("--integrator", a.integrator, "volume | reference");
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

constexpr const char* k_water_examples = R"(Examples:
  uwvdb water                                    pure sea water
  uwvdb water jerlov-II --bands 400:700:10 --csv out/jerlov-II
  uwvdb water --set water.particles='{small: 1, large: 1}' --band 540 --svg vsf.svg
  uwvdb water plume.yaml --set water.preset=jerlov-3C --json

Prints a, b, c and what follows from them per band [1/m], then the volume scattering function by
component. --set water.* needs no scene. docs/water.md explains the tables and names their sources.
Presets: jerlov-IB, jerlov-II, jerlov-III, jerlov-1C, jerlov-3C, jerlov-5C.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write.)";

void add_water_options(CLI::App& water, WaterArguments& a, std::optional<std::string>& bands) {
    water.add_option("PRESET|SCENE", a.subject,
                     "jerlov-II, or a scene file; pure sea water if left out");
    add_set_option(water, a.overrides);
    water.add_option("--bands", bands, "nm: 620,540,450 or first:last:step; replaces the water's");
    water.add_option("--band", a.band_nm, "nm: the scattering function at this band only");
    water
        .add_option("--csv", a.csv,
                    "write PREFIX-coefficients.csv and PREFIX-vsf.csv, with finer angles")
        ->type_name("PREFIX");
    water.add_option("--svg", a.svg,
                     "plot coefficients over wavelength, and scattering over angle");
    water.add_flag("--json", a.json, "print everything as JSON instead of tables");
    water.footer(k_water_examples);
}

}  // namespace

Arguments parse_arguments(int argc, const char* const* argv) {
    RenderArguments render;
    WaterArguments water;
    std::string size, crop;
    std::optional<std::string> bands;
    bool version = false;
    CLI::App app("uwvdb: physically exact images of lamp-lit water, plumes and what is in them",
                 "uwvdb");
    app.add_flag("--version", version, "print the version and stop");
    app.footer(
        "Example:\n  uwvdb render assets/scenes/plume.yaml -o plume.exr\n\n"
        "`uwvdb render --help` and `uwvdb water --help` tell more.");
    CLI::App* const render_app =
        app.add_subcommand("render", "render a scene to a multi-layer EXR");
    add_render_options(*render_app, render, size, crop);
    CLI::App* const water_app =
        app.add_subcommand("water", "tables and plots of a water's optical properties");
    add_water_options(*water_app, water, bands);
    app.require_subcommand(0, 1);
    const auto chosen = [&]() -> CLI::App* {
        const std::vector<CLI::App*> parsed = app.get_subcommands();
        return parsed.empty() ? nullptr : parsed.front();
    };
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        CLI::App* const command = chosen();
        return MessageArguments{command ? command->help("uwvdb") : app.help()};
    } catch (const CLI::ParseError& error) {
        const CLI::App* const command = chosen();
        throw UsageError(fmt::format("{}; see 'uwvdb {}--help'", error.what(),
                                     command ? command->get_name() + " " : ""));
    }
    if (version) return MessageArguments{"uwvdb " + program_version() + "\n"};
    if (chosen() == water_app) {
        if (bands) water.bands_nm = parse_bands(*bands);
        return water;
    }
    if (chosen() != render_app)
        throw UsageError("which command? 'uwvdb render SCENE', 'uwvdb water', or --help");
    if (!size.empty()) render.size = parse_integers<2>(size, 'x', "--size", "WxH such as 640x360");
    if (!crop.empty()) render.crop = parse_integers<4>(crop, ',', "--crop", "x0,y0,x1,y1");
    return render;
}

}  // namespace uw
