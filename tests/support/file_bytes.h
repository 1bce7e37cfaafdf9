#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace uw::test {

/// All of a file; empty if there is none.
inline std::string file_bytes(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace uw::test
