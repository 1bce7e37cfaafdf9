#include "core/geometry/gltf_inspection.h"

#include <fmt/format.h>

#include <cstdint>
#include <set>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/geometry/gltf_document.h"
#include "core/geometry/gltf_nodes.h"

namespace uw {
namespace {

using Json = nlohmann::json;

class Inspection {
  public:
    Inspection(const GltfDocument& document, const GltfUse& use) : document_(document), use_(use) {}

    std::vector<std::string> run() {
        check_extensions();
        gltf_nodes(document_);  // a strict tree
        check_sizes();
        for (const Json& mesh : document_.list("meshes")) {
            const Json& primitives = document_.list(mesh, "primitives");
            for (const Json& primitive : primitives) {
                check_primitive(primitive);
                if (document_.list(primitive, "targets").size() !=
                    document_.list(primitives[0], "targets").size())
                    document_.fail(
                        "the primitives of a glTF mesh do not have the same number of morph "
                        "targets");
            }
        }
        for (const Json& material : document_.list("materials")) inspect_material(material);
        return {ignored_.begin(), ignored_.end()};
    }

  private:
    const Json& accessor(const Json& index) const {
        const Json& accessors = document_.list("accessors");
        if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= accessors.size()) {
            document_.fail("glTF refers to an accessor that does not exist");
        }
        return accessors[index.get<std::size_t>()];
    }

    void check_extensions() {
        // Ignoring extensions that define how to read the geometry would change it; ignoring those
        // that only add lights or materials does not.
        for (const Json& required : document_.list("extensionsRequired")) {
            const std::string extension = required.get<std::string>();
            if (extension != "KHR_lights_punctual" && extension != "KHR_texture_transform" &&
                !extension.starts_with("KHR_materials_")) {
                document_.fail(
                    fmt::format("needs the glTF extension {}, which is not supported; export "
                                "without it",
                                printable(extension)));
            }
        }
        for (const Json& used : document_.list("extensionsUsed")) {
            const std::string extension = used.get<std::string>();
            if (extension == "KHR_materials_ior") {
                if (!use_.pbr) ignored_.insert(extension);
            } else if (extension != "KHR_lights_punctual" && extension != "KHR_texture_transform" &&
                       extension != "KHR_materials_transmission" &&
                       extension != "KHR_materials_volume" &&
                       extension != "KHR_materials_emissive_strength") {
                ignored_.insert(extension);
            }
        }
    }

    /// Bytes available for a buffer: those of its own file, or of the glTF file.
    std::uint64_t source_size(const Json& buffer, std::uint64_t own_size) const {
        const std::string& uri = gltf_uri(buffer);
        if (uri.empty() || uri.starts_with("data:")) return own_size;
        const std::filesystem::path source = gltf_uri_path(document_.file(), uri);
        std::error_code status;
        // The system would take a name up to its first NUL.
        if (source.native().find('\0') != std::string::npos ||
            !std::filesystem::is_regular_file(source, status)) {
            throw IoError(fmt::format("{}: its buffer {} is missing; put it beside the glTF file",
                                      document_.name(), printable(uri, 200)));
        }
        return std::filesystem::file_size(source);
    }

    void check_sizes() {
        const std::uint64_t own_size = std::filesystem::file_size(document_.file());
        std::uint64_t total = own_size;
        for (const Json& buffer : document_.list("buffers")) {
            const std::uint64_t size = source_size(buffer, own_size);
            if (document_.whole_number(buffer, "byteLength", 0) > size) {
                document_.fail("a glTF buffer is longer than its file; the file is truncated");
            }
            total += size;
        }
        for (const Json& view : document_.list("bufferViews")) check_view(view);
        for (const Json& entry : document_.list("accessors")) check_accessor(entry, total);
    }

    void check_view(const Json& view) const {
        const Json& buffer = document_.element("buffers", view, "buffer");
        const std::uint64_t size = document_.whole_number(buffer, "byteLength", 0);
        const std::uint64_t length = document_.whole_number(view, "byteLength", 0);
        if (length > size || document_.whole_number(view, "byteOffset", 0) > size - length) {
            document_.fail("a glTF bufferView reaches past its buffer; the file is truncated");
        }
    }

    /// `source` names a bufferView and an offset in it; `count` elements must lie inside.
    void check_range(const Json& source, std::uint64_t count, std::uint64_t element_size) const {
        const Json& view = document_.element("bufferViews", source, "bufferView");
        const std::uint64_t length = document_.whole_number(view, "byteLength", 0);
        const std::uint64_t offset = document_.whole_number(source, "byteOffset", 0);
        const std::uint64_t stride = document_.whole_number(view, "byteStride", element_size);
        // glTF 2.0, 3.6.2.1: a stride is at most 252. It is below element_size for interleaved
        // matrices only, which no mesh uses.
        const bool sane = count == 0 || (offset <= length && stride <= 252 &&
                                         stride >= element_size && element_size <= length - offset);
        if (!sane || (count > 0 && (count - 1) * stride > length - offset - element_size)) {
            document_.fail("a glTF accessor reaches past its bufferView; the file is truncated");
        }
    }

    void check_accessor(const Json& entry, std::uint64_t total) const {
        const std::uint64_t count = document_.whole_number(entry, "count", 0);
        if (count > total)
            document_.fail("a glTF accessor has a larger count than its file can hold");
        const std::uint64_t size =
            gltf_component_count(entry.value("type", "")) * component_size(entry);
        if (size == 0) document_.fail("a glTF accessor has an invalid type");
        if (entry.contains("bufferView")) check_range(entry, count, size);
        if (!entry.contains("sparse")) return;
        const Json& sparse = entry.at("sparse");
        const std::uint64_t patches = document_.whole_number(sparse, "count", 0);
        if (patches > count) document_.fail("a glTF accessor has more sparse values than values");
        check_range(sparse.at("indices"), patches, component_size(sparse.at("indices")));
        check_range(sparse.at("values"), patches, size);
    }

    std::uint64_t component_size(const Json& entry) const {
        return gltf_component_size(document_.whole_number(entry, "componentType", 0));
    }

    /// Numbers of joints are whole, and weights floats or fractions of the largest whole number.
    void check_skin_attribute(const std::string& semantic, const Json& entry) const {
        const std::uint64_t type = document_.whole_number(entry, "componentType", 0);
        const bool is_unsigned = type == k_gltf_unsigned_byte || type == k_gltf_unsigned_short;
        const bool is_normalised = entry.value("normalized", false);
        const bool is_fine = semantic.starts_with("JOINTS_")
                                 ? is_unsigned && !is_normalised
                                 : type == k_gltf_float || (is_unsigned && is_normalised);
        if (!is_fine)
            document_.fail(
                fmt::format("glTF {} has an invalid component type; export the mesh "
                            "again",
                            printable(semantic)));
    }

    void check_attribute(const std::string& semantic, const Json& entry, bool is_of_target) const {
        const std::string type = entry.value("type", "");
        const bool is_float = document_.whole_number(entry, "componentType", 0) == k_gltf_float;
        const bool is_vector = semantic == "POSITION" || semantic == "NORMAL";
        const bool is_uv = semantic.starts_with("TEXCOORD_");
        const bool is_color = semantic.starts_with("COLOR_");
        const bool is_normalised = is_uv && entry.value("normalized", false);
        if ((is_vector || is_uv) && !is_float && !is_normalised) {
            document_.fail(fmt::format("glTF {} is quantised; export it as 32-bit floats",
                                       printable(semantic)));
        }
        const std::string tangent = is_of_target ? "VEC3" : "VEC4";  // targets leave its side
        if ((is_vector && type != "VEC3") || (is_uv && type != "VEC2") ||
            (semantic == "TANGENT" && (type != tangent || !is_float)) ||
            (is_color && type != "VEC3" && type != "VEC4") ||
            (semantic.starts_with("JOINTS_") && type != "VEC4") ||
            (semantic.starts_with("WEIGHTS_") && type != "VEC4")) {
            document_.fail(fmt::format("glTF {} has the invalid type '{}'", printable(semantic),
                                       printable(type)));
        }
        if (semantic.starts_with("JOINTS_") || semantic.starts_with("WEIGHTS_"))
            check_skin_attribute(semantic, entry);
    }

    void check_primitive(const Json& primitive) {
        if (!primitive.contains("attributes") || !primitive["attributes"].contains("POSITION")) {
            document_.fail("a glTF mesh has no POSITION");
        }
        const Json& attributes = primitive["attributes"];
        const Json& positions = accessor(attributes["POSITION"]);
        // Without data an accessor is all zeros, with any forged count.
        if (!positions.contains("bufferView")) document_.fail("a glTF POSITION has no data");
        const std::uint64_t count = document_.whole_number(positions, "count", 0);
        const auto check_set = [&](const Json& set, bool is_target) {
            for (const auto& [semantic, index] : set.items()) {
                const Json& entry = accessor(index);
                check_attribute(semantic, entry, is_target);
                if (document_.whole_number(entry, "count", 0) != count) {
                    document_.fail(fmt::format("glTF {} does not have the same count as POSITION",
                                               printable(semantic)));
                }
            }
        };
        check_set(attributes, false);
        for (const Json& target : document_.list(primitive, "targets")) check_set(target, true);
        if (primitive.contains("indices")) {
            const Json& entry = accessor(primitive["indices"]);
            const std::uint64_t type = document_.whole_number(entry, "componentType", 0);
            if (entry.value("type", "") != "SCALAR" ||
                (type != 5121 && type != 5123 && type != 5125)) {
                document_.fail("glTF indices are not whole numbers");
            }
        }
        if (document_.whole_number(primitive, "mode", 4) < 4) ignored_.insert("points and lines");
    }

    void inspect_material(const Json& material) {
        const Json& surface = document_.object(material, "pbrMetallicRoughness");
        const Json& transmission = document_.extension(material, "KHR_materials_transmission");
        if (is_gltf_glass(transmission)) {
            inspect_glass(material, surface, transmission);
        } else if (transmission.value("transmissionFactor", 0.0) > 0) {
            ignored_.insert("transmission below 0.5");
        } else if (!use_.pbr && !use_.diffuse_meant &&
                   (surface.value("metallicFactor", 1.0) > 0 ||
                    surface.contains("metallicRoughnessTexture"))) {
            ignored_.insert("metallic");
        }
        if (material.contains("occlusionTexture")) ignored_.insert("occlusion maps");
        if (material.value("alphaMode", "OPAQUE") == "BLEND") ignored_.insert("alpha blending");
    }

    void inspect_glass(const Json& material, const Json& surface, const Json& transmission) {
        // Less is hardly seen.
        constexpr double k_smooth = 0.1;
        if (surface.value("roughnessFactor", 1.0) > k_smooth) ignored_.insert("roughness of glass");
        if (transmission.contains("transmissionTexture"))
            ignored_.insert("textures of transmission");
        const Json& volume = document_.extension(material, "KHR_materials_volume");
        const bool is_solid = volume.value("thicknessFactor", 0.0) > 0;
        if (is_solid && surface.contains("baseColorFactor") &&
            surface["baseColorFactor"] != Json{1, 1, 1, 1} &&
            surface["baseColorFactor"] != Json{1.0, 1.0, 1.0, 1.0})
            ignored_.insert("the base colour of solid glass (its attenuationColor is used)");
        if (surface.contains("baseColorTexture")) ignored_.insert("textures of glass");
    }

    const GltfDocument& document_;
    GltfUse use_;
    std::set<std::string> ignored_;
};

}  // namespace

std::vector<std::string> inspect_gltf(const GltfDocument& document, const GltfUse& use) {
    return Inspection(document, use).run();
}

}  // namespace uw
