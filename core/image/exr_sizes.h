#pragma once

#include <filesystem>

namespace uw {

/// Whether each attribute in the headers of an EXR file is as long as it says: OpenEXR makes room
/// for an attribute, and fills it with zeros, before it looks whether the file holds as much. What
/// else may be wrong is left to OpenEXR. False if the file cannot be read.
bool exr_attributes_fit(const std::filesystem::path& file);

}  // namespace uw
