#include "tests/bench/support/generated_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <numbers>
#include <vector>

#include "core/base/error.h"
#include "core/base/output_files.h"
#include "core/base/vector_math.h"
#include "media/volumes/vdb_writer.h"
#include "tests/bench/support/value_noise.h"

namespace uw::bench {
namespace {

constexpr int k_rocks = 24;

struct Mesh {
    std::vector<float> positions;
    std::vector<std::uint32_t> corners;

    std::uint32_t add(const Point3& p) {
        for (int axis = 0; axis < 3; ++axis) positions.push_back(static_cast<float>(p[axis]));
        return static_cast<std::uint32_t>(positions.size() / 3 - 1);
    }
};

// A lattice of (columns + 1) x (rows + 1) vertices, two triangles per cell.
template <class Position>
void add_sheet(Mesh& mesh, int columns, int rows, const Position& position) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size() / 3);
    const auto pitch = static_cast<std::uint32_t>(columns + 1);
    for (int row = 0; row <= rows; ++row)
        for (int column = 0; column <= columns; ++column)
            mesh.add(
                position(static_cast<double>(column) / columns, static_cast<double>(row) / rows));
    for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(rows); ++row)
        for (std::uint32_t column = 0; column + 1 < pitch; ++column) {
            const std::uint32_t a = first + row * pitch + column, b = a + 1, c = a + pitch;
            mesh.corners.insert(mesh.corners.end(), {a, b, c + 1, a, c + 1, c});
        }
}

void add_rock(Mesh& mesh, int rock, int cells) {
    const Point3 center{-2.5 + 5 * hashed(rock, 1, 0), 0.1 + 1.5 * hashed(rock, 2, 0),
                        -4 + 5.5 * hashed(rock, 3, 0)};
    const double radius = 0.08 + 0.17 * hashed(rock, 4, 0);
    add_sheet(mesh, cells, cells, [&](double u, double v) {
        // The sheet ends just off the poles: no triangle is degenerate.
        const double azimuth = 2 * std::numbers::pi * u;
        const double polar = std::numbers::pi * (0.001 + 0.998 * v);
        const Vector3 d{std::sin(polar) * std::cos(azimuth), std::cos(polar),
                        std::sin(polar) * std::sin(azimuth)};
        const Vector3 at = 3.0 * d + Vector3(rock, 0, 0);
        return center + radius * (0.75 + 0.5 * value_noise(at, 3)) * d;
    });
}

void write_ply(const std::filesystem::path& file, const Mesh& mesh) {
    AtomicFile target(file);
    std::ofstream out(target.temporary_path(), std::ios::binary);
    const std::size_t triangles = mesh.corners.size() / 3;
    out << fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
        "property float y\nproperty float z\nelement face {}\n"
        "property list uchar uint vertex_indices\nend_header\n",
        mesh.positions.size() / 3, triangles);
    out.write(reinterpret_cast<const char*>(mesh.positions.data()),
              static_cast<std::streamsize>(mesh.positions.size() * sizeof(float)));
    for (std::size_t i = 0; i < triangles; ++i) {
        out.put(3);
        out.write(reinterpret_cast<const char*>(&mesh.corners[3 * i]), 3 * sizeof(std::uint32_t));
    }
    out.close();
    if (!out) throw IoError(file.string() + ": cannot write");
    target.commit();
}

}  // namespace

void write_seabed(const std::filesystem::path& file, int triangles) {
    Mesh mesh;
    const int floor_cells = static_cast<int>(std::lround(std::sqrt(triangles / 4.0)));
    add_sheet(mesh, floor_cells, floor_cells, [](double u, double v) {
        const double x = -6 + 12 * u, z = -10 + 14 * v;
        return Point3{x, 0.3 * (value_noise({x, 0, z}, 5) - 0.5), z};
    });
    const int rock_cells = static_cast<int>(std::lround(std::sqrt(triangles / (4.0 * k_rocks))));
    for (int rock = 0; rock < k_rocks; ++rock) add_rock(mesh, rock, rock_cells);
    write_ply(file, mesh);
}

void write_fog(const std::filesystem::path& file, int voxels, Fog fog) {
    const auto noise = [voxels](int i, int j, int k) {
        const double scale = 6.0 / voxels;  // lumps of the first octave along an edge
        return value_noise({scale * i, scale * j, scale * k}, 3);
    };
    const auto value = [&](int i, int j, int k) {
        switch (fog) {
            case Fog::dense:
                return 0.05 + noise(i, j, k);
            case Fog::sparse:
                return 4 * std::max(0.0, noise(i, j, k) - 0.6);
            case Fog::ball:
                return glm::length(Vector3(i, j, k) - Vector3(0.5 * voxels)) < 0.25 * voxels ? 1.0
                                                                                             : 0.0;
        }
        throw InputError("unknown kind of fog");
    };
    VdbOutputGrid grid;
    grid.name = "density";
    grid.size = {voxels, voxels, voxels};
    grid.voxel_size = k_fog_side / voxels;
    grid.origin = {-1.35, 0, -1.2};
    grid.value = [&](int i, int j, int k) { return static_cast<float>(value(i, j, k)); };
    write_vdb(file, {grid}, {{"creator", "uwvdb bench"}});
}

}  // namespace uw::bench
