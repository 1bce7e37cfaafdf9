#pragma once

#include <filesystem>

/// Inputs made by formula: the same on every machine.
namespace uw::bench {

/// Writes a seabed, x -6..6, z -10..4, rough around y = 0, and 24 rocks floating in the water above
/// it and casting shadows: about `triangles` in all, half of them each. Binary PLY, y up, metres.
void write_seabed(const std::filesystem::path& file, int triangles);

/// Side of the box of fog [m]: x -1.35..1.05, y 0..2.4, z -1.2..1.2.
inline constexpr double k_fog_side = 2.4;

/// The contents of a box of fog, in values of about 0 to 1.
enum class Fog {
    dense,   // noise that is above 0 everywhere
    sparse,  // clouds of it, with nothing between them
    ball,    // 1 within a ball that fills half of the box's edge, 0 outside: an edge of one voxel
};

/// Writes a grid "density" of `voxels`^3 values.
void write_fog(const std::filesystem::path& file, int voxels, Fog fog);

}  // namespace uw::bench
