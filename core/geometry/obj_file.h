#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/geometry/mesh.h"

namespace uw {

/// One corner of a face: places in the file's lists, from 0; ObjFile::k_none if it names none or
/// one before the first.
struct ObjCorner {
    std::uint32_t position = 0, uv = 0, normal = 0;
};

/// The text of an OBJ file as numbers; nothing is checked against anything.
struct ObjFile {
    static constexpr std::uint32_t k_none = UINT32_MAX;

    struct Face {
        std::uint32_t corners = 0;  // how many, 3 or more
        std::uint32_t material = k_none, object = 0;
    };
    std::vector<float> positions, normals;  // x, y, z
    std::vector<float> uvs;                 // u, v; v up
    /// r, g, b per position, sRGB-encoded, 0..1; empty if no vertex has a colour, white for those
    /// that have none.
    std::vector<float> colors;
    std::vector<ObjCorner> corners;  // of all faces in order
    std::vector<Face> faces;
    std::vector<std::string> objects;    // those with faces; at least one if there are any
    std::vector<std::string> materials;  // those that faces use
    std::vector<std::string> libraries;  // mtllib, as written
};

/// Reads an OBJ file: vertices, polygons, the names of objects and materials. An object begins with
/// "o", and in files without one with "g"; what comes before the first is named after the file.
/// Points, lines, smoothing groups and curves are skipped. Throws IoError; InputError
/// "<file>:<line>: ..." for broken numbers.
ObjFile read_obj_file(const std::filesystem::path& file);

/// The material libraries that an OBJ file names, as written. None for one that cannot be read.
std::vector<std::string> libraries_of_obj(const std::filesystem::path& file);

/// A texture as a material library names it.
struct MtlMap {
    std::string file;                                 // as written; empty: none
    std::array<double, 2> scale{1, 1}, offset{0, 0};  // of u and v, v up
    bool clamp = false;                               // else it repeats
};

/// One material of a library, as far as it can be used.
struct MtlMaterial {
    std::string name;
    std::optional<Rgb> diffuse, emission;  // Kd and Ke, linear
    MtlMap diffuse_map, emission_map;
    std::optional<double> roughness;  // Pr, else that of the exponent Ns; 0..1
    double metallic = 0;              // Pm
    double ior = 1.5;                 // Ni
    std::set<std::string> lost;       // kinds of statements that cannot be used: "bump maps"
};

/// Reads a material library (.mtl). Statements that matter to no renderer of light are skipped.
///
/// Ns is the exponent of a Phong or Blinn lobe, alpha^2 = 2 / (Ns + 2) (Walter et al. 2007), whose
/// root is the roughness; but Blender's exporter, known by the file's first line, writes
/// 1000 (1 - roughness)^2.
///
/// Throws IoError if it cannot be read; InputError "<file>:<line>: ..." for broken numbers.
std::vector<MtlMaterial> read_mtl(const std::filesystem::path& file);

}  // namespace uw
