#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/json/json.h"
#include "dataset/definition.h"

namespace uw {

/// What the file `dataset.json` says, by which every process that works on a set has the same.
struct DatasetFile {
    DatasetDefinition definition;
    Exposures exposures;
    Json facts;  // about water, lamps and cameras, for the data card

    friend bool operator==(const DatasetFile&, const DatasetFile&) = default;
};

inline constexpr const char* k_dataset_file = "dataset.json";

std::string dataset_text(const DatasetFile& file);

/// That of the set in a folder; none if the folder does not exist or has nothing in it. Throws
/// UsageError for a folder with other files and no set; InputError for one that is damaged.
std::optional<DatasetFile> read_dataset_file(const std::filesystem::path& folder);

/// Throws UsageError of one line, what differs and how to mend it, unless `there` is the set that
/// is wanted.
void check_same_set(const std::filesystem::path& folder, const DatasetDefinition& there,
                    const DatasetDefinition& wanted);

}  // namespace uw
