#pragma once

#include <filesystem>

#include "core/base/progress.h"
#include "dataset/definition.h"

namespace uw {

/// Writes what a set has once all of its views are there: the tables of its formats, manifest, data
/// card, contact sheet, page and checksums; and removes what processes that were killed have left.
/// What it writes depends on the set alone, not on how its views were made. With `check` the
/// checksums of all views' files are computed again. Throws InputError that names the frames which
/// are missing or damaged; IoError; Interrupted.
void complete_dataset(const std::filesystem::path& folder, const DatasetFile& set, bool check,
                      const ProgressCallback& progress);

}  // namespace uw
