#pragma once

#include <filesystem>
#include <span>

#include "core/image/pixel_image.h"

namespace uw {

/// Small pictures of images, in the order given, row by row from the top left: all the same width,
/// at most 320 pixels each and some 3840 together. They are averaged in linear light, never
/// enlarged. A file that does not exist leaves its place empty. `columns` >= 1; 0: as many as make
/// the sheet about 16:9. Throws as read_image.
Preview contact_sheet(std::span<const std::filesystem::path> pictures, int columns = 0);

}  // namespace uw
