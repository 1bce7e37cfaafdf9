#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "media/vdb/cells/cell_reader.h"
#include "media/vdb/cells/lattice_line.h"

namespace uw {

/// Integrals of the interpolated values along parts of a line, cell by cell, in units of its
/// parameter.
class LineIntegral {
  public:
    /// `line` must outlive this object.
    explicit LineIntegral(const LatticeLine& line);

    /// Over [begin, end], which lies within one cell.
    double over_cell(const CellCorners& corners, const nanovdb::Coord& cell, double begin,
                     double end) const;

    /// Over [begin, end], which lies within the block that `reader` has entered.
    double over_block(CellReader& reader, double begin, double end);

  private:
    // A line meets at most this many of a block's cells.
    static constexpr int k_most_pieces = 3 * CellReader::k_edge;

    void find_pieces(const nanovdb::Coord& low, double begin, double end);
    double over_piece(const CellCorners& corners, std::size_t i) const;

    const LatticeLine& line_;
    Vector3 products_{0};  // of the direction's components yz, xz and xy, over twelve
    Vector3 inverse_{0};   // 0 parallel to the axis's faces
    Vector3 across_{0};    // a cell, in the line's parameter
    Point3 origin_;        // of the line, counted from the block's first cell
    // The pieces of the block's last line: cells, counted from its first, with a hexadecimal digit
    // each for x, y and z, and where they begin and end.
    std::array<unsigned, k_most_pieces> cells_;
    std::array<double, k_most_pieces + 1> knots_;
    // Those of cells with all corners in the block, and those of others.
    std::array<std::uint8_t, k_most_pieces + 1> inside_, at_faces_;
    std::size_t inside_count_ = 0, face_count_ = 0;
};

}  // namespace uw
