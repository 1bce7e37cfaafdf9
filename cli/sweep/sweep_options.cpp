#include "cli/sweep/sweep_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/render_desc.h"

namespace uw {

const char* const k_sweep_examples = R"(Examples:
  uwvdb sweep plume.yaml --set 'lamps.left.position[0]=-1.2:-0.2:0.2'
  uwvdb sweep plume.yaml --set 'lamps.left.position[0]=-1.5:-0.1:0.1' --target 3 -o out/distance.csv
  uwvdb sweep stereo.yaml --camera left --set 'lamps.port.position[0]=-1.2:-0.2:0.2' \
      --with 'lamps.starboard.position[0]=1.2:0.2:0.2'
  uwvdb sweep plume.yaml --set 'lamps.left.position[0]=-1.2:-0.2:0.2' \
      --set water.particles.large=0.1:1:0.3 --object seabed

Renders the scene as a draft for each value from FIRST to LAST in steps of STEP, of a second --set
for each pair, and measures it: signal, backscatter, contrast, evenness (docs/edit-numbers.md). Other
values of --set are the same for all. Writes OUT.csv, a row for each picture and part of it, and
OUT.svg, plots of contrast and signal to backscatter. Ctrl-C keeps what has been measured.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write,
130 interrupted.)";

std::size_t SweepArguments::count() const {
    std::size_t product = 1;
    for (const SweepAxis& axis : axes) product *= axis.values.size();
    return product;
}

Options sweep_options(SweepArguments& a) {
    Options options;
    options.path("SCENE", "", a.scene, "scene file (docs/scene-file.md)").required = true;
    options.path("-o,--output", "OUT.csv", a.output,
                 "the table; the plot gets its name with .svg; default: the scene's, with -sweep");
    Option& set = options.parsed(
        "--set", "KEY.PATH=FIRST:LAST:STEP",
        [&a](const std::string& text) {
            if (const auto axis = sweep_axis(text))
                a.axes.push_back(*axis);
            else
                a.overrides.push_back(text);
        },
        "vary a value of the scene file; once or twice; or KEY.PATH=VALUE: replace it");
    set.required = true;
    set.repeatable = true;
    options
        .parsed(
            "--with", "KEY.PATH=FIRST:LAST:STEP",
            [&a](const std::string& text) {
                const auto axis = sweep_axis(text);
                if (!axis)
                    throw UsageError(fmt::format("--with {}: expected KEY.PATH=FIRST:LAST:STEP",
                                                 printable(text, 200)));
                a.companions.push_back(*axis);
            },
            "vary this value along with the first; may be repeated")
        .repeatable = true;
    options.number("--target", "D", a.target, 0, 1000,
                   "measure a black and white target at D metres, too");
    add_part_options(options, a.parts);
    options.text("--camera", "NAME", a.camera, "which camera of a rig");
    options.integer("--frame", "N", a.frame, 0, 999'999'999, "which frame of sequences");
    options.size(a.size, "of the pictures; default: the scene's, or less: 480 pixels wide");
    Option& quality = options.parsed(
        "--quality", "NAME",
        [&a](const std::string& word) {
            const auto* const known = std::ranges::find(
                k_quality_names, word, &std::pair<std::string_view, RenderDesc::Quality>::first);
            if (known == k_quality_names.end())
                throw UsageError(fmt::format("--quality: unknown '{}'; use {}", printable(word),
                                             alternatives(words_of(k_quality_names))));
            a.quality = known->second;
        },
        "of the pictures: draft, the default, final or exact");
    quality.value = Option::Value::word;
    for (const auto& [word, meaning] : k_quality_names) quality.words.emplace_back(word);
    options.threads(a.threads);
    options.confine();
    options.flag("--quiet", a.quiet, "print nothing but warnings and errors");
    return options;
}

void check_axes(const SweepArguments& a) {
    if (a.axes.empty() || a.axes.size() > 2)
        throw UsageError(
            fmt::format("--set: {} values with a range; vary one or two, such as "
                        "lamps.left.position[0]=-1.2:-0.2:0.2",
                        a.axes.size()));
    for (const SweepAxis& companion : a.companions)
        if (companion.values.size() != a.axes.front().values.size())
            throw UsageError(
                fmt::format("--with {}: has {} values, but {} has {}; give it a step "
                            "of as many",
                            printable(companion.key, 200), companion.values.size(),
                            printable(a.axes.front().key, 200), a.axes.front().values.size()));
    constexpr std::size_t k_most_pictures = 10000;
    if (a.count() > k_most_pictures)
        throw UsageError(fmt::format("--set: {} pictures, more than {}; give larger steps",
                                     a.count(), k_most_pictures));
}

}  // namespace uw
