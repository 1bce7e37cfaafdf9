#include "cli/render/render_arguments.h"

#include <fmt/format.h>

#include "cli/image_choice.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/scene/scene_desc.h"

namespace uw {

const char* const k_render_examples = R"(Examples:
  uwvdb render assets/scenes/plume.yaml
  uwvdb render plume.yaml -o out/plume.exr --size 960x540 --samples 1
  uwvdb render plume.yaml --quality draft --size 480x270
  uwvdb render plume.yaml --layers all --precision half
  uwvdb render plume.yaml --set lamps.left.intensity='[80, 80, 80]' --layers direct,depth
  uwvdb render plume.yaml --integrator reference --crop 100,80,140,120 --stats stats.json
  uwvdb render smoke.yaml --frames 1-48 -o out/smoke.####.exr --resume
  uwvdb render smoke.yaml --frames 1-48 -o out/smoke.####.png --exposure first --contact-sheet s.png
  uwvdb render stereo.yaml -o 'out/{camera}.exr'
  uwvdb render varied.yaml --variations 100 -o 'out/{variation}.exr' --resume
  uwvdb render camera.yaml -o camera.sensor.png --set camera.sensor.exposure=0.01
  uwvdb render plume.yaml --integrator path --error 0.02 --size 320x180
  uwvdb render plume.yaml --numbers - --object seabed
  uwvdb render plume.yaml -o shot/plume.exr --deep 32
  uwvdb render houdini.yaml --set 'volumes[0].file=/data/my.vdb' --irradiance-vdb light.vdb

render.scattering: multiple, the default of scenes with uwvdb: 2, is all light, however often it
was scattered and reflected, fast by --integrator volume, unbiased by path; single is light that the
water scatters once or a surface reflects once.

Writes OUT.exr (the image and its depth; more with --layers) and OUT.png beside it, a preview; with
-o OUT.png the preview alone: 8 or 16 bits of what is to be seen, not the light itself. So do .jpg
.tif .dpx .tga .bmp and .webp; .hdr, and .tif with --precision float, hold the light's R G B.
A camera with a sensor (camera.sensor) also writes its own image, OUT.sensor.png or .jpg, or that
alone with -o OUT.sensor.png or -o OUT.jpg. Folders are made. With --frames, a volume's
file may contain a placeholder for the frame's number: file: smoke_####.vdb. A scene of several cameras
becomes an image of each, OUT.NAME.exr, or with NAME in place of {camera}. --variations makes
OUT.v0000.exr and so on, or 0000 in place of {variation}, and SCENE.variations.csv and .json beside
them, which list every value drawn.
Exit codes: 0 done, 1 internal fault, 2 wrong usage, 3 bad input, 4 cannot read or write,
130 interrupted. More: docs/command-line.md)";

namespace {

constexpr int k_max_variations = 1'000'000;

// The most layers of --orders, of either kind.
constexpr int k_max_orders = 64;

// The most samples of a deep pixel.
constexpr int k_max_deep = 256;

/// Restricts `option` to the words of `names`, a table of words and their meanings.
void accept_words(Option& option, const auto& names) {
    option.value = Option::Value::word;
    for (const auto& [word, meaning] : names) option.words.emplace_back(word);
}

constexpr std::array<std::pair<std::string_view, int>, 2> k_preview_bits{{{"8", 8}, {"16", 16}}};

int preview_bits_in(const std::string& text) {
    for (const auto& [word, bits] : k_preview_bits)
        if (text == word) return bits;
    throw UsageError(fmt::format("--preview-bits: expected 8 or 16, found '{}'", printable(text)));
}

PreviewExposure exposure_in(const std::string& text) {
    using Kind = PreviewExposure::Kind;
    if (text == "auto") return {};
    if (text == "first") return {.kind = Kind::first};
    double factor = 0;
    if (parse_number(text, factor) == NumberText::number && factor > 0)
        return {.kind = Kind::fixed, .factor = factor};
    throw UsageError(fmt::format("--exposure: expected a number above 0, auto or first; found '{}'",
                                 printable(text)));
}

template <class T, std::size_t N>
T value_of(const char* option, const std::string& word,
           const std::array<std::pair<std::string_view, T>, N>& names, T otherwise) {
    if (word.empty()) return otherwise;
    for (const auto& [known, value] : names)
        if (word == known) return value;
    throw UsageError(fmt::format("{}: unknown '{}'; use {}", option, printable(word),
                                 alternatives(words_of(names))));
}

}  // namespace

ExrOptions RenderArguments::exr() const {
    const ExrOptions usual;
    if (is_aces) return ExrOptions::aces();
    return {value_of("--precision", precision, k_precision_names, usual.precision),
            value_of("--compression", compression, k_compression_names, usual.compression)};
}

Options render_options(RenderArguments& a) {
    Options options;
    options.input("SCENE", "", a.scene, "scene file (docs/scene-file.md)").required = true;
    options.output(
        "-o,--output", "OUT.exr", a.output,
        "EXR to write, or a PNG, TIFF, ... or the camera's image alone; default: the scene's name, "
        "in this folder");
    options.parsed(
        "--frames", "1-10,20-40:2|all",
        [&a](const std::string& text) {
            a.all_frames = text == "all";
            if (!a.all_frames) a.frames = parse_frame_list(text);
        },
        "render these frames, or all in which everything that moves has a pose; file names "
        "contain %04d, ####, $F4 or {frame}");
    options.integer("--variations", "N", a.variation_count, 1, k_max_variations,
                    "render N scenes whose values are drawn as the scene's section variations "
                    "says, and write a manifest of the values");
    options.parsed(
        "--variation", "0-9,17",
        [&a](const std::string& text) {
            a.variations = parse_frame_list(text, "--variation", "variations");
        },
        "render these variations only, counted from 0; the same images as among all of them");
    options.flag("--resume", a.resume,
                 "with --frames or --variations: skip images that already exist");
    options.set(a.overrides);
    options.size(a.size, "render at this size, the intrinsics scaled with it");
    options.window("--crop", a.crop, "render these pixels only; x1 and y1 are excluded");
    options.text("--camera", "NAME", a.camera, "render only this camera of a rig");
    accept_words(options.text("--integrator", "NAME", a.integrator,
                              alternatives(words_of(k_integrator_names))),
                 k_integrator_names);
    options.text("--layers", "NAMES", a.layers,
                 "names separated by commas, all, or default: the image and its depth");
    accept_words(options.text("--precision", "NAME", a.precision,
                              "store light in the EXR as half, float, or auto: half where that is "
                              "enough"),
                 k_precision_names);
    accept_words(
        options.text("--compression", "NAME", a.compression,
                     "compress the EXR without loss: zip, zips (each line by itself) or none"),
        k_compression_names);
    options.flag("--aces", a.is_aces,
                 "write the EXR as an ACES image container: R, G and B alone, in ACES2065-1, half "
                 "floats");
    options.parsed(
        "--exposure", "N|auto|first",
        [&a](const std::string& text) { a.exposure = exposure_in(text); },
        "expose the preview by a factor; auto: each image's own; first: the first image's for all");
    accept_words(
        options.parsed(
            "--preview-bits", "N",
            [&a](const std::string& text) { a.preview_bits = preview_bits_in(text); },
            "bits per channel of the preview, or of what is written in its place: 8 or 16"),
        k_preview_bits);
    options.output("--contact-sheet", "OUT.png", a.contact_sheet,
                   "write small pictures of all images, side by side");
    options.integer("--samples", "N", a.samples, 1, k_max_paths,
                    fmt::format("surface samples per pixel, 1 to {}; with --integrator path light "
                                "paths, up to {}",
                                k_max_samples, k_max_paths));
    options.number("--error", "R", a.error, 0, 1,
                   "with --integrator path, instead of --samples: until the standard error is "
                   "below this fraction of the image's mean");
    options.integer("--orders", "N", a.orders, 1, k_max_orders,
                    "with --integrator path: write layers of the light scattered, and reflected, "
                    "0 to N times");
    options.integer("--deep", "N", a.deep, 4, k_max_deep,
                    "write OUT.deep.exr, too: radiance and alpha by distance, about N samples per "
                    "pixel at most, to composite objects into the water");
    accept_words(options.text("--quality", "NAME", a.quality,
                              "draft: within 3 %, one sample, for previews; final; or exact: water "
                              "integrated for every pixel"),
                 k_quality_names);
    options.threads(a.threads);
    options.confine();
    options.output("--stats", "FILE", a.stats, "write times, rays, voxels and memory as JSON");
    options.output(
        "--numbers", "FILE.csv", a.numbers,
        "measure signal, backscatter, contrast and evenness, lamp by lamp; -: print them");
    add_part_options(options, a.parts);
    options.output("--irradiance-vdb", "FILE", a.irradiance_vdb,
                   "write each lamp's irradiance per band as grids of a VDB");
    options.messages(a.quiet, a.progress);
    return options;
}

}  // namespace uw
