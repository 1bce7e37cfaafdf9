#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/geometry/mesh_reader.h"
#include "tests/support/meshes/mesh_fixtures.h"

namespace uw::test {

/// The vertices of all triangles in order, x y z of each.
inline std::vector<float> corner_positions(const TriangleMesh& mesh) {
    std::vector<float> values;
    for (const std::uint32_t v : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) values.push_back(mesh.positions[3 * v + k]);
    }
    return values;
}

/// Sum of the triangles' areas projected along z: clockwise ones count as negative.
inline double area_about_z(const TriangleMesh& mesh) {
    const std::vector<float> p = corner_positions(mesh);
    double area = 0;
    for (std::size_t t = 0; t < p.size(); t += 9) {
        const double ax = p[t + 3] - p[t], ay = p[t + 4] - p[t + 1];
        const double bx = p[t + 6] - p[t], by = p[t + 7] - p[t + 1];
        area += 0.5 * (ax * by - ay * bx);
    }
    return area;
}

/// Reads meshes that a test writes down as bytes.
class MeshReading : public testing::Test {
  protected:
    MeshFile read_file(const std::string& name, const std::string& bytes) {
        return read_mesh(folder_.write(name, bytes), warnings_);
    }
    /// What is there once.
    TriangleMesh read(const std::string& name, const std::string& bytes) {
        return read_file(name, bytes).mesh;
    }
    /// The one-line message that refuses the file; empty if it is read.
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
