#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/base/vector_math.h"

/// VDB files made for tests, with OpenVDB itself.
namespace uw::test {

enum class VdbNumbers { float32, half, float64 };

/// A region filled at once, so that OpenVDB keeps most of it as tiles.
struct VdbBox {
    std::array<int, 3> min{}, max{};  // both included
    double value = 0;
};

struct VdbFixture {
    std::string name = "density";
    VdbNumbers numbers = VdbNumbers::float32;
    std::string grid_class = "fog volume";
    double background = 0;
    std::array<int, 3> min{0, 0, 0}, max{-1, -1, -1};  // of `value`, both included
    std::function<double(int i, int j, int k)> value;  // set active where not 0
    std::vector<VdbBox> boxes;                         // active
    std::vector<VdbBox> inactive_boxes;                // values left in inactive voxels
    Affine file_from_index;
    bool blender_metadata = false;  // as Blender's fluid solver adds to its grids:
    std::array<int, 3> base_resolution{128, 64, 51};
    std::map<std::string, std::string> metadata;  // further texts
};

/// Writes the grids; an empty `creator` writes no file metadata.
void write_fixture(const std::filesystem::path& file, const std::vector<VdbFixture>& grids,
                   const std::string& creator = "uwvdb tests");

/// One grid each: points, a vector grid "vel", a bool grid "flag", an int grid "flags", a level set
/// of class level set or unknown, and a fog volume in a camera frustum.
void write_point_grid(const std::filesystem::path& file);
void write_vector_grid(const std::filesystem::path& file);
void write_bool_and_int_grids(const std::filesystem::path& file);
void write_level_set(const std::filesystem::path& file, bool with_class);
void write_frustum_grid(const std::filesystem::path& file);
/// Two grids "density" and "copy" that share one tree in the file but differ in transform.
void write_instanced_grids(const std::filesystem::path& file);

/// How velocities are stored.
enum class VelocityKind { vectors, staggered, three_numbers };
/// `density` with a grid "vel" (or "vel.x", "vel.y", "vel.z") of one velocity throughout [-64,
/// 63]^3, on the same voxels.
void write_moving_grid(const std::filesystem::path& file, const VdbFixture& density,
                       const Vector3& velocity, VelocityKind kind);

/// NanoVDB file of `density` (its values, place and name). `precision`: "float", "fp4", "fp8",
/// "fp16", "fpN"; `codec` 0 none, 1 zip, 2 blosc.
void write_nvdb_fixture(const std::filesystem::path& file, const VdbFixture& density,
                        const std::string& precision, int codec = 0);

}  // namespace uw::test
