#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/colour/rgb.h"

namespace uw {

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
