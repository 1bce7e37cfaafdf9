#pragma once

#include <cstdint>
#include <istream>
#include <string>
#include <vector>

#include "core/meshes/files/ply_header.h"

namespace uw {

/// Reads the body of a PLY file number by number, in any of its encodings.
class PlySource {
  public:
    PlySource(std::istream& in, PlyEncoding encoding, std::string name);

    /// The next number. Throws InputError at the end of the file or on text that is not a number.
    double next(PlyType type);

  private:
    double next_text();
    bool fill();

    std::istream* in_;
    PlyEncoding encoding_;
    std::string name_;
    std::vector<char> buffer_;
    std::size_t at_ = 0, end_ = 0;
};

}  // namespace uw
