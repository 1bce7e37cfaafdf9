#include "media/vdb/cells/cell_reader.h"

namespace uw {

bool CellReader::find(unsigned side) {
    static constexpr std::array<std::uint16_t, k_edge * k_edge * k_edge> k_zeros{};
    const auto offset = [&](unsigned bit) { return (side & bit) != 0 ? k_edge : 0; };
    const Coord voxel = low_.offsetBy(offset(4), offset(2), offset(1));
    known_ |= 1U << side;
    const auto* leaf = accessor_.probeLeaf(voxel);
    if (leaf != nullptr)
        blocks_[side] = {leaf->data()->mCode, leaf->data()->mMinimum, leaf->data()->mQuantum};
    else
        blocks_[side] = {k_zeros.data(), accessor_.getValue(voxel), 0};
    return leaf != nullptr;
}

CellCorners CellReader::one_by_one(const Coord& cell) const {
    CellCorners::Four at_z{}, at_next_z{};
    for (int i = 0; i < 4; ++i) {
        at_z[i] = accessor_.getValue(cell.offsetBy(i >> 1, i & 1, 0));
        at_next_z[i] = accessor_.getValue(cell.offsetBy(i >> 1, i & 1, 1));
    }
    return {at_z, at_next_z};
}

}  // namespace uw
