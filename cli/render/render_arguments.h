#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/render/picture_numbers.h"
#include "core/image/exr_file.h"
#include "core/image/preview_exposure.h"
#include "render/scene_loading.h"
#include "render/scene_rendering.h"

namespace uw {

/// `uwvdb render` as typed.
struct RenderArguments {
    std::filesystem::path scene;
    std::filesystem::path output;        // empty: the scene's name with .exr, in the working folder
    std::vector<int> frames;             // --frames; empty: no sequence, or
    bool all_frames = false;             // all that the scene has
    std::optional<int> variation_count;  // --variations: of the set; none: not a whole set
    std::vector<int> variations;         // --variation: of these only; empty: all of the set
    bool resume = false;                 // --resume
    std::vector<std::string> overrides;  // --set key.path=value
    std::optional<std::array<int, 2>> size;  // --size WxH
    std::optional<std::array<int, 4>> crop;  // --crop x0,y0,x1,y1
    std::string camera;                      // --camera: this one of a rig only; empty: all
    std::string integrator;                  // empty: the scene's
    std::string layers;                      // empty: the default set
    std::string precision, compression;      // of the EXR; empty: as ExrOptions
    bool is_aces = false;                    // --aces
    PreviewExposure exposure;                // --exposure
    std::optional<int> preview_bits;         // --preview-bits; none: as is usual in its format
    std::filesystem::path contact_sheet;     // --contact-sheet: a PNG; empty: none
    std::optional<int> samples;
    std::optional<double> error;  // --error: instead of a number of samples
    std::optional<int> orders;    // --orders: layers by order of scattering
    std::optional<int> deep;      // --deep: the maximum of samples per pixel
    std::string quality;          // draft or final; empty: final
    int threads = 0;              // 0: all
    std::filesystem::path stats;
    std::filesystem::path numbers;  // --numbers: a CSV, or "-": standard output; empty: none
    PartArguments parts;            // of the image, to measure
    std::filesystem::path irradiance_vdb;
    bool quiet = false;
    ProgressForm progress = ProgressForm::text;

    /// Throws UsageError for words that do not exist.
    ExrOptions exr() const;
    /// Whether the scene itself is rendered, rather than its variations.
    bool is_scene_itself() const { return !variation_count && variations.empty(); }
    bool prints_numbers() const { return numbers == "-"; }
    ImageRequest image() const { return {quality, integrator, samples, error, size}; }
    PathRequest paths() const { return {.error = error, .orders = orders.value_or(0)}; }
};

/// What `uwvdb render --help` ends with.
extern const char* const k_render_examples;

/// The options of `uwvdb render`, written to `arguments`.
Options render_options(RenderArguments& arguments);

}  // namespace uw
