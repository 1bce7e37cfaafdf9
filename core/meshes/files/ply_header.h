#pragma once

#include <cstdint>
#include <istream>
#include <string>
#include <vector>

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

}  // namespace uw
