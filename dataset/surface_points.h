#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dataset/definition.h"
#include "dataset/view_images.h"

namespace uw {

/// The file of a draw's surface points, relative to the set's folder.
std::string points_file(const DatasetDefinition& definition, std::size_t draw);

std::string points_csv(const std::vector<SurfacePoint>& points);
/// Throws IoError, and InputError for anything but points_csv's.
std::vector<SurfacePoint> read_points(const std::filesystem::path& file);

}  // namespace uw
