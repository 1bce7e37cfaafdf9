#pragma once

#include <string>
#include <vector>

#include "fit/board_corners.h"

namespace uw {

/// A sheet to print and photograph: a checkerboard, grey patches beside it, and below it a ruler of
/// 100 mm, by which the print's scale is checked, and how to fit with it.

/// A size of paper, across.
struct Paper {
    std::string name;
    double width = 0, height = 0;  // [mm]
};

/// "a4", "a3" or "letter". Throws UsageError for other words.
Paper read_paper(const std::string& word);

/// A board of 10 x 7 squares of whole millimetres that fills the paper.
BoardDesc board_for(const Paper& paper);

/// The sheet as a PDF of one page, drawn as rectangles and Helvetica, which asks not to be scaled
/// when it is printed. Squares are black and paper; patches have PDF's DeviceGray in fifths. Throws
/// UsageError for a board that does not fit on the paper.
std::string target_pdf(const BoardDesc& board, const Paper& paper);

/// The same sheet as a surface, without its letters and ruler: OBJ and its materials, whose
/// reflectances (Kd) are those of printed paper, roughly. In the axes of find_board_corners [m], z
/// into the sheet. `name`: of the file with the materials. Throws as target_pdf.
struct TargetMesh {
    std::string obj, mtl;
};
TargetMesh target_mesh(const BoardDesc& board, const Paper& paper, const std::string& name);

}  // namespace uw
