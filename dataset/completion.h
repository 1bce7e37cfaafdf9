#pragma once

#include <filesystem>

#include "core/base/progress.h"
#include "dataset/definition.h"

namespace uw {

/// Completes a set once all of its views exist: writes the tables of its formats, manifest, data
/// card, contact sheet, page and checksums, and removes files that killed processes have left. The
/// output depends on the set alone, not on how its views were made. With `check` the checksums of
/// all views' files are computed again. Throws InputError that names the frames which are missing
/// or damaged; IoError; Interrupted.
void complete_dataset(const std::filesystem::path& folder, const DatasetFile& set, bool check,
                      const ProgressCallback& progress);

}  // namespace uw
