#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/render/frame_sequence.h"
#include "cli/render/render_arguments.h"
#include "core/scene/variations/draw.h"

namespace uw {

/// What the variations of a whole set drew, and which images show it: SCENE.variations.csv, a row
/// per image, and SCENE.variations.json, beside the images (docs/command-line.md). It is of the
/// whole set, whichever of it is rendered, so that runs that share a set write the same.
class VariationManifest {
  public:
    /// Writes nothing unless a whole set is requested. Refers to the arguments.
    explicit VariationManifest(const RenderArguments& arguments);

    /// Adds one of these variations: its scene's hash and its images.
    void add(int variation, const VariationsDesc& variations, std::string hash,
             const FrameSequence& images);

    /// Enters the manifest's files in the sequence, to be checked with the others.
    void name_files(FrameSequence& sequence) const;

    /// Writes both files, if there are to be any. Throws IoError.
    void write(bool quiet) const;

  private:
    struct Image {
        std::string file;  // relative to the manifest
        std::optional<int> frame;
        std::string camera;
    };
    struct Entry {
        int variation;
        std::vector<DrawnValue> values;
        std::string hash;
        std::vector<Image> images;
    };

    std::string csv() const;
    std::string json() const;

    const RenderArguments& arguments_;
    std::uint64_t seed_ = 0;
    std::filesystem::path csv_file_, json_file_;  // empty: none
    std::vector<Entry> entries_;
};

}  // namespace uw
