#include <fmt/format.h>

#include <charconv>
#include <memory>

#include "cli/command_options.h"
#include "cli/frame_list.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/scene_desc.h"

namespace uw {

namespace {

constexpr const char* k_render_examples = R"(Examples:
  uwvdb render assets/scenes/plume.yaml
  uwvdb render plume.yaml -o out/plume.exr --size 960x540 --samples 1
  uwvdb render plume.yaml --quality draft --size 480x270
  uwvdb render plume.yaml --set lamps.left.intensity='[80, 80, 80]' --layers direct,depth
  uwvdb render plume.yaml --integrator reference --crop 100,80,140,120 --stats stats.json
  uwvdb render smoke.yaml --frames 1-48 -o out/smoke.####.exr --resume
  uwvdb render stereo.yaml -o 'out/{camera}.exr'
  uwvdb render houdini.yaml --set 'volumes[0].file=/data/my.vdb' --irradiance-vdb light.vdb

Writes OUT.exr (32-bit float, layers by name) and OUT.png beside it, a preview. With --frames, a
volume's file may hold the place of the frame's number: file: smoke_####.vdb. A scene of several
cameras becomes an image of each, OUT.NAME.exr, or where {camera} stands in the name.
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

struct Parsed {
    RenderArguments arguments;
    std::string size, crop, frames;
};

}  // namespace

Command add_render_command(CLI::App& app) {
    CLI::App& render = *app.add_subcommand("render", "render a scene to a multi-layer EXR");
    const auto p = std::make_shared<Parsed>();
    render.add_option("SCENE", p->arguments.scene, "scene file (docs/scene-file.md)")->required();
    render
        .add_option("-o,--output", p->arguments.output,
                    "EXR to write; without it, the scene's name, here")
        ->type_name("OUT.exr");
    render
        .add_option("--frames", p->frames,
                    "render these frames; file names hold %04d, ####, $F4 or {frame}")
        ->type_name("1-10,20-40:2");
    render.add_flag("--resume", p->arguments.resume,
                    "with --frames: leave out frames that are there already");
    add_set_option(render, p->arguments.overrides);
    render.add_option("--size", p->size, "render at this size, the intrinsics scaled with it")
        ->type_name("WxH");
    render.add_option("--crop", p->crop, "render these pixels only; x1 and y1 are excluded")
        ->type_name("x0,y0,x1,y1");
    render.add_option("--camera", p->arguments.camera, "of a rig's cameras render this one only")
        ->type_name("NAME");
    render
        .add_option("--integrator", p->arguments.integrator,
                    alternatives(words_of(k_integrator_names)))
        ->type_name("NAME");
    render
        .add_option("--layers", p->arguments.layers,
                    "all, or names separated by commas, among them default and lamps")
        ->type_name("NAMES");
    render.add_option("--samples", p->arguments.samples, "surface samples per pixel, 1 to 4096")
        ->check(in_range(1, 4096))
        ->type_name("N");
    render
        .add_option("--quality", p->arguments.quality,
                    "draft: within 3 %, one sample, for looking; final; or exact: "
                    "every pixel's water by itself")
        ->type_name("NAME");
    add_threads_option(render, p->arguments.threads);
    render
        .add_option("--stats", p->arguments.stats, "write times, rays, voxels and memory as JSON")
        ->type_name("FILE");
    render
        .add_option("--irradiance-vdb", p->arguments.irradiance_vdb,
                    "write each lamp's irradiance per band as grids of a VDB")
        ->type_name("FILE");
    render.add_flag("--quiet", p->arguments.quiet, "print nothing but warnings and errors");
    render.footer(k_render_examples);
    return {&render, [p]() -> Arguments {
                RenderArguments a = p->arguments;
                if (!p->size.empty())
                    a.size = parse_integers<2>(p->size, 'x', "--size", "WxH such as 640x360");
                if (!p->crop.empty())
                    a.crop = parse_integers<4>(p->crop, ',', "--crop", "x0,y0,x1,y1");
                if (!p->frames.empty()) a.frames = parse_frame_list(p->frames);
                if (a.resume && a.frames.empty())
                    throw UsageError("--resume: goes on with a sequence; give its --frames");
                return a;
            }};
}

}  // namespace uw
