#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json.h"

namespace uw {

/// One image of a data set, by its places in DatasetDefinition::draws, frames and cameras.
struct View {
    std::size_t draw = 0, frame = 0, camera = 0;

    friend bool operator==(const View&, const View&) = default;
};

/// The factors on images before they are encoded as sRGB, the same for all of a set.
struct Exposures {
    double image = 1;
    double clean = 1;  // of the images without water

    friend bool operator==(const Exposures&, const Exposures&) = default;
};

/// The definition of a data set: its views and the files written for each. All processes that work
/// on the same folder use the same, by its file `dataset.json`.
struct DatasetDefinition {
    std::string program;     // "uwvdb 1.0.0"
    std::string command;     // by which it can be made again
    std::string scene;       // its file's name, without folder
    std::string scene_hash;  // SceneDesc::hash
    /// Values of the scene that differ from draw to draw, as `--set` takes them. At least one draw.
    std::vector<std::vector<std::string>> draws{{}};
    std::vector<std::optional<int>> frames{std::nullopt};  // numbers; none: the scene as it is
    std::vector<std::string> cameras{""};                  // of a rig, by name; "": no rig
    std::vector<std::string> formats;                      // names in the table of formats
    std::string size, quality, samples;                    // empty: the scene's
    std::string layers;                                    // of EXR and NumPy; empty: their default
    bool is_16_bit = false;                                // of tone-mapped images
    std::optional<double> exposure;                        // of tone-mapped images; none: automatic
    double depth_scale = 1000;        // of 16-bit depth [1/m], but for formats with their own
    std::optional<double> depth_far;  // beyond, depth images have nothing [m]
    bool pinhole_fit = false;         // of cameras with ports, in formats that know none
    std::string licence;              // empty: not stated

    std::size_t view_count() const { return draws.size() * frames.size() * cameras.size(); }
    /// The places of a view in the order of draws, then frames, then cameras.
    View view(std::size_t index) const;
    std::size_t index(const View& view) const;
    /// The place of the frame with this number; none if the set does not have it.
    std::optional<std::size_t> place_of_frame(int number) const;

    bool has_format(std::string_view name) const;
    bool has_rig() const { return !cameras.front().empty(); }

    /// The folder of a draw's files within that of the set, with a slash at its end; empty if there
    /// is one draw.
    std::string folder(std::size_t draw) const;
    /// "000012", or "left/000012" in a rig: what the names of a view's files have in common.
    std::string stem(const View& view) const;
    /// The file of a view, relative to the set's folder: "images/left/000012.png".
    std::string file(const View& view, std::string_view kind, std::string_view ending) const;

    friend bool operator==(const DatasetDefinition&, const DatasetDefinition&) = default;
};

/// An interval of views, by their indices.
struct ViewRange {
    std::size_t begin = 0, end = 0;
};

/// Part `number` of `count`, from 1, of the views: consecutive frames with all of their cameras,
/// as many in each part to within one.
ViewRange shard_of(const DatasetDefinition& definition, std::size_t number, std::size_t count);

Json definition_json(const DatasetDefinition& definition);
/// Throws InputError of one line that begins with `subject` for anything else than
/// definition_json's.
DatasetDefinition definition_from_json(const Json& json, const std::string& subject);

/// The differences between two definitions, for a message: "its frames are 0-48 there, 0-20 here";
/// empty if nothing differs but, perhaps, the spelling of the command.
std::string difference(const DatasetDefinition& there, const DatasetDefinition& here);

/// The contents of the file `dataset.json`, by which all processes that work on a set agree.
struct DatasetFile {
    DatasetDefinition definition;
    Exposures exposures;
    Json facts;  // about water, lamps and cameras, for the data card

    friend bool operator==(const DatasetFile&, const DatasetFile&) = default;
};

inline constexpr const char* k_dataset_file = "dataset.json";

std::string dataset_text(const DatasetFile& file);

/// The file of the set in a folder; none if the folder does not exist or has nothing in it. Throws
/// UsageError for a folder with other files and no set; InputError for one that is damaged.
std::optional<DatasetFile> read_dataset_file(const std::filesystem::path& folder);

/// Throws UsageError of one line, what differs and how to fix it, unless `there` is the set that is
/// wanted.
void check_same_set(const std::filesystem::path& folder, const DatasetDefinition& there,
                    const DatasetDefinition& wanted);

}  // namespace uw
