#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "core/base/error.h"
#include "media/volumes/vdb_file.h"
#include "media/volumes/vdb_header.h"
#include "tests/support/file_bytes.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw::test {

/// The position in the scene file at which the volume is named.
inline constexpr const char* k_where = "scene.yaml:3:5: volumes[0]";

inline LoadedGrid load(const std::filesystem::path& file, const std::string& grid,
                       std::size_t slab_bytes = k_default_slab_bytes) {
    return load_grid(read_vdb_header(file, k_where), grid, k_where, slab_bytes);
}

/// The message of the InputError thrown by loading; fails the test if there is none, or if it is
/// not one line that begins with the position in the scene file.
inline std::string refusal(const std::filesystem::path& file, const std::string& grid) {
    try {
        load(file, grid);
    } catch (const InputError& error) {
        const std::string what = error.what();
        EXPECT_TRUE(what.starts_with(k_where)) << what;
        EXPECT_EQ(what.find('\n'), std::string::npos) << what;
        EXPECT_NE(what.find(file.string()), std::string::npos) << what;
        return what;
    }
    ADD_FAILURE() << "not refused: " << grid << " of " << file;
    return "";
}

inline void expect_contains(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is missing in: " << text;
}

inline void write_file_bytes(const std::filesystem::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

/// One active voxel, at (1, 1, 1).
inline VdbFixture single_voxel(const std::string& name, double value = 1) {
    VdbFixture fixture;
    fixture.name = name;
    fixture.min = {1, 1, 1};
    fixture.max = {1, 1, 1};
    fixture.value = [value](int, int, int) { return value; };
    return fixture;
}

}  // namespace uw::test
