#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "media/volumes/loaded_grid.h"
#include "media/volumes/vdb_header.h"

/// Dense arrays of all values in a box, as used by numerical software.
namespace uw {

/// A view of values in memory: value (i, j, k) is data[i * steps[0] + j * steps[1] + k * steps[2]].
struct ArrayView {
    const float* data = nullptr;
    std::array<std::size_t, 3> size{};
    std::array<std::ptrdiff_t, 3> steps{};

    float at(std::size_t i, std::size_t j, std::size_t k) const {
        return data[static_cast<std::ptrdiff_t>(i) * steps[0] +
                    static_cast<std::ptrdiff_t>(j) * steps[1] +
                    static_cast<std::ptrdiff_t>(k) * steps[2]];
    }
};

/// Makes a grid of the values, as load_grid does from a file: value (i, j, k) has that index;
/// outside it is 0, and values that are not finite or negative become 0 with a warning. `place`:
/// LoadedGrid's file_from_index. Throws InputError, which starts with `where`, for voxels without
/// volume, sizes beyond 2^30, and too little memory.
LoadedGrid grid_of_array(const ArrayView& values, const Affine& place, std::string name,
                         const SourceLocation& where);

/// All values of a grid in the box of its active voxels; 0 where it has none.
struct GridArray {
    std::string name;
    std::array<int, 3> first{};         // index of the first value
    std::array<std::size_t, 3> size{};  // 0 without active voxels
    std::vector<float> values;          // k fastest, then j
    Affine file_from_index;             // as LoadedGrid's
};

/// Reads the values of a grid as they are stored, 64-bit ones rounded. Throws as load_grid, and
/// InputError for a box that is too large for the memory there is.
GridArray read_grid_array(const VdbHeader& header, const std::string& name,
                          const SourceLocation& where);

}  // namespace uw
