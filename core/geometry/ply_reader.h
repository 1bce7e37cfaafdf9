#pragma once

#include <cstdint>
#include <filesystem>
#include <istream>
#include <string>
#include <vector>

#include "core/geometry/mesh.h"

namespace uw {

/// Scalar types of PLY, by their size and kind.
enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_of(PlyType type);  // bytes

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    bool is_list = false;
    PlyType count_type = PlyType::uint8;  // of a list's length
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

enum class PlyEncoding { ascii, little_endian, big_endian };

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::ascii;
    std::vector<PlyElement> elements;
};

/// Reads up to and including the line "end_header". Throws InputError; messages call the file
/// `name`.
PlyHeader read_ply_header(std::istream& in, const std::string& name);

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

/// Reads a PLY file (ascii, binary of either byte order): positions, normals if all three
/// components are present, vertex colours (sRGB-encoded, of 8 or 16 bits or floats of 0..1), faces.
/// Other colours are skipped with a warning; alpha, texture coordinates, and elements other than
/// vertices and faces, without one. Corners past the last vertex are kept for
/// drop_bad_triangles to count. Throws IoError, InputError (also for a header that promises more
/// than the file contains).
TriangleMesh read_ply(const std::filesystem::path& file, std::vector<std::string>& warnings);

}  // namespace uw
