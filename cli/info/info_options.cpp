#include <memory>

#include "cli/command_options.h"

namespace uw {

namespace {

constexpr const char* k_info_examples = R"(Examples:
  uwvdb info smoke.vdb
  uwvdb info cache/fluid_data_####.vdb --frame 30
  uwvdb info plume.yaml --set 'volumes[0].grids.density.large=50'
  uwvdb info plume.yaml --json

Of a VDB or NanoVDB file: every grid in metres, what is wrong with it, which to map and how, and a
`volumes:` block to paste into a scene. Of a scene: water, camera, lamps, how opaque each grid is, how
much of it is in view and in a lamp's reach, and what will be black or opaque. Renders nothing.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write.)";

}  // namespace

Command add_info_command(CLI::App& app) {
    CLI::App& info =
        *app.add_subcommand("info", "what a VDB file or a scene holds, and what to mend");
    const auto a = std::make_shared<InfoArguments>();
    info.add_option("FILE|SCENE", a->subject, "a .vdb or .nvdb file, a sequence, or a scene file")
        ->required();
    add_set_option(info, a->overrides);
    info.add_option("--frame", a->frame,
                    "which frame of a sequence; the first there is if left out")
        ->check(in_range(0, 999'999'999))
        ->type_name("N");
    info.add_flag("--json", a->json, "print everything as JSON");
    info.footer(k_info_examples);
    return {&info, [a]() -> Arguments { return *a; }};
}

}  // namespace uw
