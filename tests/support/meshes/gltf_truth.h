#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/ray.h"
#include "core/base/vector_math.h"

namespace uw::test {

/// A glTF file read for tests straight from its JSON and bytes, without the program's own reader.
/// Supports what Blender writes for meshes of floats: no strides, no sparse data.
struct GltfTruth {
    struct Triangle {
        Point3 a, b, c;
        Vector3 normals[3];  // unit, of the corners
    };
    struct Node {
        std::string name;
        Affine world;  // file from node
        int camera = -1, light = -1;
    };
    std::vector<Triangle> triangles;
    std::vector<Node> nodes;  // with a camera or light
    double yfov = 0;          // of the first camera

    explicit GltfTruth(const std::filesystem::path& file);
    const Node& node(const std::string& name) const;
};

/// Where a ray first meets a triangle.
struct TruthHit {
    double t = 1e300;
    double rim = 0;       // barycentric distance from the triangle's edges
    Vector3 flat{0.0};    // unit, of the triangle
    Vector3 normal{0.0};  // unit, interpolated, on the ray's side
    bool found() const { return t < 1e300; }
};

/// All triangles one after the other (Moeller & Trumbore 1997).
TruthHit first_hit(const GltfTruth& truth, const Ray& ray);

}  // namespace uw::test
