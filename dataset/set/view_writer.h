#pragma once

#include <filesystem>
#include <string>

#include "dataset/definition.h"
#include "dataset/view_images.h"
#include "dataset/view_record.h"

namespace uw {

/// The layers that a set's formats are made of, as LayerPlan takes them.
std::string layers_of(const DatasetDefinition& definition);

/// Whether any of its formats needs ViewImages::points.
bool needs_points(const DatasetDefinition& definition);

/// Writes the files of a view in every format of its set, then its record. Throws IoError and
/// InputError.
void write_view(const std::filesystem::path& folder, const std::string& sum,
                const ViewImages& images);

/// Whether a view's record is there and all of its files are as they were written, by their
/// checksums.
bool is_view_complete(const std::filesystem::path& folder, const DatasetDefinition& definition,
                      const std::string& sum, const View& view);

}  // namespace uw
