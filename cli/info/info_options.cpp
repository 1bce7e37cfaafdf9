#include "cli/info/info_options.h"

namespace uw {

const char* const k_info_examples = R"(Examples:
  uwvdb info smoke.vdb
  uwvdb info cache/fluid_data_####.vdb --frame 30
  uwvdb info smoke.vdb --scene --picture smoke.png > scene.yaml
  uwvdb info plume.yaml --set 'volumes[0].grids.density.large=50'
  uwvdb info plume.yaml --json
  uwvdb info dive.yaml --svg path.svg

For a VDB or NanoVDB file: every grid in metres, what is wrong with it, which to map and how, and a
`volumes:` block to paste into a scene, or a whole scene that shows it. For a scene: water, camera,
lamps, how opaque each grid is, how much of it is in view and in a lamp's reach, how clearly it is
seen, and what will be black or opaque. Of both, small drafts are rendered to judge by.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write.)";

Options info_options(InfoArguments& a) {
    Options options;
    options.path("FILE|SCENE", "", a.subject, "a .vdb or .nvdb file, a sequence, or a scene file")
        .required = true;
    options.set(a.overrides);
    options.integer("--frame", "N", a.frame, 0, 999'999'999,
                    "which frame of a sequence, or of a scene that moves; default: the first that "
                    "holds something");
    options.flag("--scene", a.scene,
                 "of a volume: print a whole scene that shows it, ready to render, and nothing "
                 "else");
    options.path("--picture", "OUT.png", a.picture, "of a volume: write a thumbnail of that scene");
    options.path("--svg", "OUT.svg", a.svg,
                 "of a scene that moves: draw the camera's path over it, from above and by height");
    options.flag("--json", a.json, "print everything as JSON");
    options.confine();
    return options;
}

}  // namespace uw
