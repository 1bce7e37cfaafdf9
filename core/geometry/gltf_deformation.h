#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/base/vector_math.h"
#include "core/geometry/gltf_document.h"
#include "core/geometry/gltf_nodes.h"

namespace uw {

/// The shape of a node's mesh at a moment: its morph targets, then its skin (glTF 2.0, 3.7.2.2 and
/// 3.7.3.3). For gltf_*.cpp only, as all of this header.
struct GltfDeformation {
    std::vector<double> weights;         ///< of the morph targets; empty: there are none
    std::vector<Affine> file_from_bind;  ///< by joint of the skin; empty: it has none
    std::string skin;                    ///< its name, for messages
};

/// Finds the deformations of the nodes at a moment. A mesh whose targets have no weight at any time
/// does not deform, so that it costs what a rigid one does; which ones deform is the same at all
/// times.
class GltfDeformations {
  public:
    /// Refers to all of them. `nodes` are those of the scene with the same `poses`.
    GltfDeformations(const GltfDocument& document, GltfBytes& bytes, const GltfPoses& poses,
                     const std::vector<GltfNode>& nodes);

    /// The deformation of the mesh of a node; none if it is rigid. Throws InputError for weights
    /// that are not as many as targets, and for a skin whose joints are not nodes of the scene, or
    /// whose matrices are too few or not finite.
    std::optional<GltfDeformation> of(const GltfNode& node) const;

  private:
    std::vector<double> weights_of(const GltfNode& node) const;
    std::vector<Affine> joints_of(const nlohmann::json& skin, const std::string& name) const;

    const GltfDocument& document_;
    GltfBytes& bytes_;
    const GltfPoses& poses_;
    std::map<std::size_t, Affine> file_from_node_;
    std::set<std::size_t> animated_;  // nodes whose weights some animation changes
};

/// How many vertices of skins had to be normalised.
struct NormalisedWeights {
    std::uint64_t unweighted = 0;  ///< have no weight; they follow the joint that is named first
    std::uint64_t unbalanced = 0;  ///< weights whose sum is not 1 by more than 1 %; scaled to it

    /// One warning line per kind that occurred, each starting with `name`.
    void report(const std::string& name, std::vector<std::string>& warnings) const;
};

/// The vertices of one primitive of a deforming mesh, in the file's space.
class DeformedPrimitive {
  public:
    /// Refers to all but the two maps. `file_from_mesh` places what has no skin: a skin's joints
    /// replace it. Throws InputError for joints that the skin does not have and for weights that
    /// are negative or not finite.
    DeformedPrimitive(const GltfDocument& document, GltfBytes& bytes,
                      const nlohmann::json& primitive, const GltfDeformation& deformation,
                      const Affine& file_from_mesh, const std::string& mesh_name);

    /// x, y, z per vertex.
    std::vector<float> positions() const;
    /// Unit normals x, y, z, and tangents x, y, z, side; all zero for a vertex that has none.
    /// Normals are transformed by the inverse transpose of their vertex's matrix. Precondition: the
    /// primitive has them.
    std::vector<float> normals() const;
    std::vector<float> tangents() const;
    /// Whether the map of the whole mirrors it; false for a skin.
    bool is_mirrored() const { return !has_skin() && file_from_mesh_.determinant() < 0; }
    const NormalisedWeights& normalised() const { return normalised_; }

  private:
    bool has_skin() const { return !joints_.empty(); }
    void read_skin(const std::string& mesh_name);
    void normalise(std::size_t vertex, const std::string& mesh_name);
    /// An attribute after the morph targets, `width` numbers per vertex, of which they change
    /// three.
    std::vector<double> morphed(const char* semantic, std::size_t width) const;
    /// The map of a vertex.
    Affine file_from(std::size_t vertex) const;

    const GltfDocument& document_;
    GltfBytes& bytes_;
    const nlohmann::json& primitive_;
    const GltfDeformation& deformation_;
    Affine file_from_mesh_;
    std::size_t per_vertex_ = 0;         // joints
    std::vector<std::uint32_t> joints_;  // empty: no skin
    std::vector<float> joint_weights_;   // of the joints; their sum is 1 up to rounding
    NormalisedWeights normalised_;
};

}  // namespace uw
