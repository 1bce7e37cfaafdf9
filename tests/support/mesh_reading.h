#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/meshes/files/mesh_reader.h"
#include "tests/support/mesh_fixtures.h"

namespace uw::test {

/// The corners of all triangles in order, x y z of each.
inline std::vector<float> corner_positions(const TriangleMesh& mesh) {
    std::vector<float> values;
    for (const std::uint32_t v : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) values.push_back(mesh.positions[3 * v + k]);
    }
    return values;
}

/// Reads meshes that a test writes down as bytes.
class MeshReading : public testing::Test {
  protected:
    TriangleMesh read(const std::string& name, const std::string& bytes) {
        return read_mesh(folder_.write(name, bytes), warnings_);
    }
    /// What the file is refused with, one line; empty if it is read.
    std::string error_of(const std::string& name, const std::string& bytes) {
        try {
            read(name, bytes);
        } catch (const InputError& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            return error.what();
        }
        return "";
    }

    MeshFolder folder_;
    std::vector<std::string> warnings_;
};

}  // namespace uw::test
