#include "core/geometry/gltf_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <exception>
#include <iterator>
#include <numeric>
#include <utility>

#include "core/base/text.h"
#include "core/geometry/gltf_deformation.h"
#include "core/geometry/gltf_document.h"
#include "core/geometry/gltf_inspection.h"
#include "core/geometry/gltf_nodes.h"
#include "core/geometry/gltf_primitives.h"

namespace uw {

std::vector<std::filesystem::path> files_named_by_gltf(const std::filesystem::path& file) {
    std::vector<std::filesystem::path> files;
    try {
        const GltfDocument document(file);
        for (const char* const list : {"buffers", "images"})
            for (const nlohmann::json& entry : document.list(list)) {
                const std::string& uri = gltf_uri(entry);
                if (!uri.empty() && !uri.starts_with("data:"))
                    files.push_back(gltf_uri_path(file, uri));
            }
    } catch (const std::exception&) {
        return {};
    }
    return files;
}

namespace {

using Json = nlohmann::json;

/// The first or last time of a sampler, which the format requires beside its keys.
double bound_of(const Json& input, const char* key) {
    return input.at(key).at(0).get<double>();
}

/// The times of the samplers that move nodes, as accessors.
std::vector<const Json*> key_accessors(const GltfDocument& document) {
    std::vector<const Json*> inputs;
    for (const Json& animation : document.list("animations"))
        for (const Json& channel : document.list(animation, "channels")) {
            if (!moves_node(document, channel)) continue;
            const Json& sampler = document.list(animation, "samplers")
                                      .at(document.whole_number(channel, "sampler", 0));
            inputs.push_back(&document.element("accessors", sampler, "input"));
        }
    return inputs;
}

/// All times of these accessors, ascending, each once.
std::vector<double> times_in(const GltfDocument& document, std::vector<const Json*> inputs) {
    try {
        inspect_gltf(document, {});
        std::ranges::sort(inputs);
        inputs.erase(std::unique(inputs.begin(), inputs.end()), inputs.end());
        GltfBytes bytes(document);
        std::vector<double> times;
        for (const Json* input : inputs)
            std::ranges::copy(bytes.floats(*input, 1), std::back_inserter(times));
        std::ranges::sort(times);
        times.erase(std::unique(times.begin(), times.end()), times.end());
        return times;
    } catch (const std::exception&) {
        return {};
    }
}

}  // namespace

std::optional<GltfKeys> gltf_keys(const std::filesystem::path& file) {
    try {
        // Without that word the file, which may be 100 MB, need not be parsed.
        if (read_gltf_text(file).find("\"animations\"") == std::string::npos) return std::nullopt;
        const GltfDocument document(file);
        const std::vector<const Json*> inputs = key_accessors(document);
        if (inputs.empty()) return std::nullopt;
        TimeRange range{bound_of(*inputs.front(), "min"), bound_of(*inputs.front(), "max")};
        for (const Json* input : inputs)
            range = {std::min(range.first, bound_of(*input, "min")),
                     std::max(range.last, bound_of(*input, "max"))};
        return GltfKeys{range, times_in(document, inputs)};
    } catch (const std::exception&) {
        return std::nullopt;
    }
}

bool are_whole_frames(const std::vector<double>& times, double rate) {
    // Files contain times as 32-bit floats, which exporters may have summed up.
    constexpr double k_tolerance = 0.01;  // [frames]
    constexpr double k_relative = 2.5e-7;
    return std::ranges::all_of(times, [&](double time) {
        const double frame = time * rate;
        return std::abs(frame - std::round(frame)) <= k_tolerance + k_relative * std::abs(frame);
    });
}

std::optional<double> frame_rate_of(const std::vector<double>& key_times) {
    // Television's rates come last: over few frames they cannot be told from whole numbers.
    constexpr double k_television = 1000.0 / 1001;
    constexpr std::array<double, 14> k_rates{12,
                                             15,
                                             24,
                                             25,
                                             30,
                                             48,
                                             50,
                                             60,
                                             100,
                                             120,
                                             240,
                                             24 * k_television,
                                             30 * k_television,
                                             60 * k_television};
    for (const double rate : k_rates) {
        if (!are_whole_frames(key_times, rate)) continue;
        // If all keys are at even frames, say, they are also at whole frames of half the rate.
        long long common = 0;
        for (const double time : key_times) common = std::gcd(common, std::llround(time * rate));
        if (common == 1) return rate;
    }
    return std::nullopt;
}

namespace {

using Json = nlohmann::json;

// A copy of a triangle takes some 100 bytes with Embree's structure over it, an instance a thousand
// and more of every ray's time: meshes up to this size are copied to each node.
constexpr std::uint64_t k_max_copied_triangles = 32;

constexpr std::uint64_t k_triangle_mode = 4, k_last_mode = 6;

/// One node that shows a mesh.
struct MeshUse {
    Affine file_from_node;
    std::uint32_t object = 0;
    const GltfDeformation* deformation = nullptr;  // null: it is rigid
};

/// Names the objects of a file and sorts its meshes into those that deform, those used once and
/// those that several nodes share.
class GltfContents {
  public:
    GltfContents(const GltfDocument& document, GltfBytes& bytes, const GltfPoses& poses)
        : document_(document), bytes_(bytes), uses_(document.list("meshes").size()) {
        const std::vector<GltfNode> nodes = gltf_nodes(document, poses);
        const GltfDeformations deformations(document, bytes, poses, nodes);
        for (const GltfNode& node : nodes) {
            if (node.json->contains("mesh")) add(node, deformations.of(node));
        }
        for (const Json& material : document.list("materials")) {
            materials_.push_back(material.value("name", ""));
            if (materials_.back().empty())
                materials_.back() = fmt::format("material{}", materials_.size());
        }
    }

    MeshFile read(GltfJoiner& joiner) {
        MeshFile file;
        // Those that deform come first, so that their vertices are the same ones at all times: what
        // is shared may change as nodes are scaled to zero.
        std::vector<GltfPlacement> once = deforming();
        const auto rigid = static_cast<std::ptrdiff_t>(once.size());
        for (std::size_t mesh = 0; mesh < uses_.size(); ++mesh) {
            if (is_shared(mesh)) {
                file.shared.push_back(share(mesh, joiner, once));
            } else {
                for (const MeshUse& use : uses_[mesh]) place(mesh, use, once);
            }
        }
        // In the order of the nodes, as far as one mesh is built of them.
        std::ranges::stable_sort(once.begin() + rigid, once.end(), {}, &GltfPlacement::object);
        file.mesh = joiner.join(once);
        file.objects = std::move(objects_);
        file.materials = std::move(materials_);
        return file;
    }

    const std::vector<Affine>& placements() const { return placements_; }

    GltfMoment moment() const {
        GltfMoment result{placements_, std::vector<bool>(objects_.size()), {}};
        for (const GltfPlacement& placement : deforming()) {
            result.deforms[placement.object] = true;
            const std::vector<float> positions = deformed(document_, bytes_, placement).positions();
            result.vertices.insert(result.vertices.end(), positions.begin(), positions.end());
        }
        return result;
    }

  private:
    void add(const GltfNode& node, std::optional<GltfDeformation> deformation) {
        const Json& mesh = document_.element("meshes", *node.json, "mesh");
        const std::uint64_t index = document_.whole_number(*node.json, "mesh", 0);
        std::string name = node.json->value("name", "");
        if (name.empty()) name = mesh.value("name", "");
        if (name.empty()) name = fmt::format("node{}", node.index);
        MeshUse use{node.file_from_node, static_cast<std::uint32_t>(objects_.size())};
        if (deformation) {
            use.deformation = &deformations_.emplace_back(*std::move(deformation));
            deforming_.emplace_back(index, use);
        } else {
            uses_[index].push_back(use);
        }
        objects_.push_back(std::move(name));
        placements_.push_back(node.file_from_node);
    }

    std::vector<GltfPlacement> deforming() const {
        std::vector<GltfPlacement> placements;
        for (const auto& [mesh, use] : deforming_) place(mesh, use, placements);
        return placements;
    }

    std::uint64_t triangles_of(std::size_t mesh) const {
        std::uint64_t corners = 0;
        for (const Json& primitive : document_.list(document_.list("meshes")[mesh], "primitives")) {
            const bool is_indexed = primitive.contains("indices");
            const Json& of = is_indexed ? primitive : primitive["attributes"];
            corners += document_.whole_number(
                document_.element("accessors", of, is_indexed ? "indices" : "POSITION"), "count",
                0);
        }
        return corners / 3;
    }

    bool is_shared(std::size_t mesh) const {
        return uses_[mesh].size() > 1 && triangles_of(mesh) > k_max_copied_triangles;
    }

    void place(std::size_t mesh, const MeshUse& use, std::vector<GltfPlacement>& to) const {
        const Json& json = document_.list("meshes")[mesh];
        const std::size_t materials = document_.list("materials").size();
        for (const Json& primitive : document_.list(json, "primitives")) {
            const std::uint64_t mode = document_.whole_number(primitive, "mode", k_triangle_mode);
            if (mode < k_triangle_mode) continue;  // points and lines
            if (mode > k_last_mode) document_.fail("a glTF primitive has an unknown mode");
            GltfPlacement placement{&json,     &primitive, use.file_from_node,
                                    materials, use.object, use.deformation};
            if (primitive.contains("material")) {
                placement.material = document_.whole_number(primitive, "material", 0);
                if (placement.material >= materials) {
                    document_.fail("glTF refers to a material that does not exist");
                }
            }
            to.push_back(placement);
        }
    }

    /// Nodes that flatten the mesh are added to `once`: their triangles are dropped and counted.
    SharedMesh share(std::size_t mesh, GltfJoiner& joiner, std::vector<GltfPlacement>& once) const {
        SharedMesh shared;
        std::vector<GltfPlacement> primitives;
        place(mesh, {}, primitives);
        shared.mesh = joiner.join(primitives);
        for (const MeshUse& use : uses_[mesh]) {
            const double volume = use.file_from_node.determinant();
            if (volume != 0 && std::isfinite(volume))
                shared.placements.push_back({use.file_from_node, use.object});
            else
                place(mesh, use, once);
        }
        return shared;
    }

    const GltfDocument& document_;
    GltfBytes& bytes_;
    std::vector<std::vector<MeshUse>> uses_;                  // by mesh; of those that are rigid
    std::vector<std::pair<std::size_t, MeshUse>> deforming_;  // and the numbers of their meshes
    std::deque<GltfDeformation> deformations_;                // in place, for the uses
    std::vector<std::string> objects_, materials_;
    std::vector<Affine> placements_;  // by object
};

}  // namespace

/// What a source keeps. Its parts refer to each other.
struct GltfSource::Parts {
    Parts(const std::filesystem::path& file, const GltfUse& use)
        : document(file),
          ignored(inspect_gltf(document, use)),
          bytes(document),
          materials(document, bytes, use) {}

    GltfContents contents(const std::optional<double>& time) {
        GltfPoses poses;
        if (time) poses = gltf_poses(document, bytes, *time);
        return {document, bytes, poses};
    }

    GltfDocument document;
    std::vector<std::string> ignored;
    GltfBytes bytes;
    GltfMaterials materials;
};

GltfSource::GltfSource(std::filesystem::path file, const GltfUse& use)
    : use_(use), file_(std::move(file)) {
    try {
        parts_ = std::make_unique<Parts>(file_, use_);
    } catch (const Json::exception& error) {
        fail_broken_gltf(file_, error);
    }
}

GltfSource::~GltfSource() = default;

MeshFile GltfSource::read(const std::optional<double>& time, std::vector<std::string>& warnings) {
    try {
        const GltfDocument& document = parts_->document;
        if (!parts_->ignored.empty()) {
            warnings.push_back(
                fmt::format("{}: ignored: {}", document.name(),
                            printable(fmt::format("{}", fmt::join(parts_->ignored, ", ")), 1000)));
        }
        use_.time = time;
        if (const std::string motion = unused_motion_of(document, use_); !motion.empty()) {
            warnings.push_back(fmt::format("{}: {}", document.name(), motion));
        }
        GltfJoiner joiner(document, parts_->bytes, parts_->materials);
        MeshFile meshes = parts_->contents(time).read(joiner);
        joiner.normalised().report(document.name(), warnings);
        return meshes;
    } catch (const Json::exception& error) {
        fail_broken_gltf(file_, error);
    }
}

std::vector<Affine> GltfSource::placements(double time) {
    try {
        return parts_->contents(time).placements();
    } catch (const Json::exception& error) {
        fail_broken_gltf(file_, error);
    }
}

GltfMoment GltfSource::moment(double time) {
    try {
        return parts_->contents(time).moment();
    } catch (const Json::exception& error) {
        fail_broken_gltf(file_, error);
    }
}

}  // namespace uw
