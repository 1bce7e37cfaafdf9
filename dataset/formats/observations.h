#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "dataset/view_images.h"

namespace uw {

/// Where a view sees one of its set's surface points.
struct Observation {
    std::uint32_t point = 0;  // its place in the list of points
    double x = 0, y = 0;      // [pixels]
    std::array<int, 3> rgb{};
};

/// The points that the view sees: through lens and port, within the image and not hidden.
std::vector<Observation> observations(const ViewImages& images);

std::string observations_csv(const std::vector<Observation>& observations);
/// Throws IoError, and InputError for anything but observations_csv's.
std::vector<Observation> read_observations(const std::filesystem::path& file);

}  // namespace uw
