#include "core/geometry/obj_reader.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <unordered_map>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/text.h"
#include "core/base/vector_math.h"
#include "core/geometry/mesh_text.h"
#include "core/geometry/obj_file.h"
#include "core/geometry/polygon.h"
#include "core/image/image_file.h"
#include "core/image/image_formats.h"

namespace uw {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t k_max_names = 6;  // of a warning

/// A name as some other system may have written it.
fs::path path_of(std::string name) {
    if (name.size() > 1 && name.front() == '"' && name.back() == '"')
        name = name.substr(1, name.size() - 2);
    std::ranges::replace(name, '\\', '/');
    return name;
}

bool is_inside(const fs::path& relative) {
    const fs::path normal = relative.lexically_normal();
    const std::string text = normal.string();
    const bool has_drive = text.size() > 1 && text[1] == ':';
    return !normal.is_absolute() && !has_drive && !normal.empty() && *normal.begin() != "..";
}

/// The libraries that an OBJ file names, sorted by how they can be used.
struct Libraries {
    std::vector<fs::path> files;
    std::vector<std::string> missing, outside;
};

Libraries find_libraries(const fs::path& obj_file, const std::vector<std::string>& statements) {
    Libraries result;
    std::set<fs::path> known;
    const auto add = [&](const std::string& name) {
        const fs::path relative = path_of(name);
        const fs::path file = obj_file.parent_path() / relative;
        if (!is_inside(relative)) {
            result.outside.push_back(name);
        } else if (!is_file(file)) {
            result.missing.push_back(name);
        } else if (known.insert(file.lexically_normal()).second) {
            result.files.push_back(file);
        }
    };
    for (const std::string& statement : statements) {
        // One name that may contain spaces, or several between them.
        const fs::path whole = path_of(statement);
        if (is_inside(whole) && is_file(obj_file.parent_path() / whole)) {
            add(statement);
            continue;
        }
        TextLine names(statement);
        const bool has_several = statement.find(".mtl ") != std::string::npos;
        if (!has_several && !statement.empty()) add(statement);
        while (has_several && !names.is_at_end()) add(std::string(names.word()));
    }
    return result;
}

/// The picture of that name: where the library says, else beside the library, where exporters that
/// write full names of their own machine put copies.
std::optional<fs::path> texture_file(const fs::path& library, const std::string& name) {
    const fs::path written = path_of(name);
    const fs::path folder = library.parent_path();
    for (const fs::path& file : {folder / written, folder / written.filename()}) {
        if (is_file(file)) return file;
    }
    return std::nullopt;
}

class Materials {
  public:
    explicit Materials(bool is_pbr) : is_pbr_(is_pbr) {}

    void read_library(const fs::path& file) {
        for (MtlMaterial& material : read_mtl(file)) {
            std::string name = material.name;
            found_.try_emplace(std::move(name), Entry{file, std::move(material)});
        }
    }

    MeshMaterial material(const std::string& name) {
        MeshMaterial result;
        const auto found = found_.find(name);
        if (found == found_.end()) {
            unknown_.insert(name);
            return result;
        }
        const MtlMaterial& source = found->second.material;
        const fs::path& library = found->second.library;
        result.base_map = texture(library, source.diffuse_map);
        if (result.base_map) result.base_color = {1, 1, 1};
        if (source.diffuse) result.base_color = *source.diffuse;
        result.emission_map = texture(library, source.emission_map);
        if (result.emission_map) result.emission = {1, 1, 1};
        if (source.emission) result.emission = *source.emission;
        if (result.emission == Rgb{0, 0, 0}) result.emission_map = {};
        lost_.insert(source.lost.begin(), source.lost.end());
        if (!is_pbr_) return result;
        result.roughness = source.roughness.value_or(1);
        result.metallic = source.metallic;
        result.ior = source.ior;
        return result;
    }

    void report(const std::string& obj, const Libraries& libraries,
                std::vector<std::string>& warnings) const {
        const auto warn = [&](const auto& names, const char* what, const char* hint) {
            if (!names.empty())
                warnings.push_back(fmt::format("{}: {}: {}; {}", obj, what, listed(names), hint));
        };
        warn(libraries.missing, "material libraries are missing", "put them beside the OBJ file");
        warn(libraries.outside, "material libraries outside the OBJ's folder are not read",
             "put them beside the OBJ file");
        const bool has_all = libraries.missing.empty() && libraries.outside.empty();
        if (has_all)
            warn(unknown_, "materials that no library (mtllib) has",
                 "their surfaces have reflectance 0.5");
        warn(missing_, "textures are missing",
             "their surfaces have the colour Kd; put them beside the library");
        warn(other_formats_, "textures of unknown formats",
             "their surfaces have the colour Kd; save them as PNG or JPEG");
        std::set<std::string> lost = lost_;
        if (!is_pbr_) lost.erase("gloss maps");
        if (!lost.empty()) {
            warnings.push_back(
                fmt::format("{}: ignored of its materials: {}", obj, fmt::join(lost, ", ")));
        }
    }

  private:
    struct Entry {
        fs::path library;
        MtlMaterial material;
    };

    static std::string listed(const auto& names) {
        std::string text;
        std::size_t count = 0;
        for (const std::string& name : names) {
            if (count++ == k_max_names) {
                text += fmt::format(" and {} more", names.size() - k_max_names);
                break;
            }
            text += fmt::format("{}'{}'", text.empty() ? "" : ", ", printable(name));
        }
        return text;
    }

    TextureUse texture(const fs::path& library, const MtlMap& map) {
        TextureUse use;
        if (map.file.empty()) return use;
        const auto file = texture_file(library, map.file);
        if (!file) {
            missing_.insert(map.file);
            return use;
        }
        if (!has_ending_of_image(*file)) {
            other_formats_.insert(map.file);
            return use;
        }
        auto& picture = pictures_[*file];
        if (!picture) picture = read_texture(*file);
        use.texture = picture;
        if (map.clamp) use.lookup.wrap_u = use.lookup.wrap_v = TextureWrap::clamp;
        // (u, v) -> (s u + o, t v + p) with v up; ours points down.
        const auto& [s, t] = map.scale;
        const auto& [o, p] = map.offset;
        use.transform = {s, 0, o, 0, t, 1 - t - p};
        return use;
    }

    bool is_pbr_;
    std::unordered_map<std::string, Entry> found_;
    std::map<fs::path, std::shared_ptr<const Texture>> pictures_;
    std::set<std::string> unknown_, missing_, other_formats_, lost_;
};

}  // namespace

std::vector<MeshMaterial> read_obj_materials(const fs::path& obj_file,
                                             const std::vector<std::string>& libraries,
                                             const std::vector<std::string>& names, bool is_pbr,
                                             std::vector<std::string>& warnings) {
    const Libraries found = find_libraries(obj_file, libraries);
    Materials materials(is_pbr);
    for (const fs::path& file : found.files) materials.read_library(file);
    std::vector<MeshMaterial> result;
    for (const std::string& name : names) {
        result.push_back(materials.material(name));
        result.back().number = static_cast<std::uint32_t>(result.size());
    }
    materials.report(obj_file.string(), found, warnings);
    return result;
}

std::vector<fs::path> files_named_by_obj(const fs::path& obj_file) {
    std::vector<fs::path> files;
    try {
        for (const fs::path& library : find_libraries(obj_file, libraries_of_obj(obj_file)).files) {
            files.push_back(library);
            for (const MtlMaterial& material : read_mtl(library)) {
                for (const MtlMap* map : {&material.diffuse_map, &material.emission_map}) {
                    if (map->file.empty()) continue;
                    if (const auto file = texture_file(library, map->file)) files.push_back(*file);
                }
            }
        }
    } catch (const std::exception&) {
        return files;
    }
    return files;
}

namespace {

// What fits a large machine, not the format's limit.
constexpr std::size_t k_max_obj_corners = 1'500'000'000;
// The number of combinations at one position that are searched for a corner's own. Where more meet,
// some vertices are duplicated, which is harmless; time stays proportional to the corners.
constexpr int k_max_compared = 64;

/// Makes vertices of the file's positions, texture coordinates and normals, each combination once.
class ObjMesh {
  public:
    ObjMesh(const ObjFile& source, std::vector<MeshMaterial> materials, std::string name)
        : source_(source), name_(std::move(name)) {
        // Faces without a material come last.
        stand_in_ = static_cast<std::uint32_t>(materials.size());
        has_uvs_ = std::ranges::any_of(materials, [](const MeshMaterial& material) {
            return material.base_map || material.emission_map;
        });
        has_normals_ = !source.normals.empty();
        mesh_.materials = std::move(materials);
        const bool needs_stand_in =
            mesh_.materials.empty() || std::ranges::any_of(source.faces, [](const auto& face) {
                return face.material == ObjFile::k_none;
            });
        if (needs_stand_in) mesh_.materials.emplace_back();
        if (needs_stand_in && !source.colors.empty()) mesh_.materials.back().base_color = {1, 1, 1};
    }

    TriangleMesh build() {
        first_of_.assign(source_.positions.size() / 3, ObjFile::k_none);
        mesh_.positions.reserve(source_.positions.size() + 4);  // Embree reads past the last one
        std::span<const ObjCorner> left(source_.corners);
        std::vector<std::uint32_t> corners;
        for (const ObjFile::Face& face : source_.faces) {
            throw_if_stopped();
            corners.clear();
            const std::span<const ObjCorner> own = left.first(face.corners);
            left = left.subspan(face.corners);
            for (const ObjCorner& corner : own) corners.push_back(vertex(corner));
            append(corners);
            const std::uint32_t material =
                face.material == ObjFile::k_none ? stand_in_ : face.material;
            if (mesh_.materials.size() > 1)
                mesh_.triangle_materials.resize(mesh_.triangle_count(), material);
            if (source_.objects.size() > 1)
                mesh_.triangle_objects.resize(mesh_.triangle_count(), face.object);
            const MeshMaterial& used = mesh_.materials[material];
            if (!used.base_map && !used.emission_map) continue;
            const bool lacks_uvs = std::ranges::any_of(
                own, [&](const ObjCorner& corner) { return corner.uv >= source_.uvs.size() / 2; });
            faces_without_uvs_ += lacks_uvs ? 1 : 0;
        }
        return std::move(mesh_);
    }

    std::size_t faces_without_uvs() const { return faces_without_uvs_; }

  private:
    /// A combination of texture coordinates and normal at a position, and the next there.
    struct Vertex {
        std::uint32_t uv = 0, normal = 0, next = ObjFile::k_none;
    };

    std::uint32_t vertex(const ObjCorner& corner) {
        if (corner.position >= first_of_.size()) return ObjFile::k_none;
        const std::uint32_t uv = has_uvs_ ? corner.uv : 0;
        const std::uint32_t normal = has_normals_ ? corner.normal : 0;
        std::uint32_t& first = first_of_[corner.position];
        std::uint32_t known = first;
        for (int k = 0; k < k_max_compared && known != ObjFile::k_none; ++k) {
            const Vertex& vertex = vertices_[known];
            if (vertex.uv == uv && vertex.normal == normal) return known;
            known = vertex.next;
        }
        const auto number = static_cast<std::uint32_t>(vertices_.size());
        vertices_.push_back({uv, normal, first});
        first = number;
        append_vertex(corner.position, uv, normal);
        return number;
    }

    void append_vertex(std::uint32_t position, std::uint32_t uv, std::uint32_t normal) {
        const auto append = [](const std::vector<float>& from, std::size_t width, std::uint32_t at,
                               std::vector<float>& to) {
            const bool is_there = at < from.size() / width;
            for (std::size_t k = 0; k < width; ++k)
                to.push_back(is_there ? from[width * at + k] : 0.0F);
        };
        append(source_.positions, 3, position, mesh_.positions);
        if (has_uvs_) {
            append(source_.uvs, 2, uv, mesh_.uvs[0]);
            mesh_.uvs[0].back() = 1 - mesh_.uvs[0].back();  // the file's v is up
        }
        if (!source_.colors.empty()) {
            for (std::size_t k = 0; k < 3; ++k) {
                const double code = source_.colors[3 * std::size_t{position} + k];
                mesh_.colors.push_back(static_cast<float>(linear_from_srgb(code)));
            }
        }
        if (!has_normals_) return;
        append(source_.normals, 3, normal, mesh_.normals);
        float* n = &mesh_.normals[mesh_.normals.size() - 3];
        const double length = glm::length(Vector3(n[0], n[1], n[2]));
        for (int axis = 0; axis < 3; ++axis)
            n[axis] = length > 0 ? static_cast<float>(n[axis] / length) : 0.0F;
    }

    void append(const std::vector<std::uint32_t>& corners) {
        if (std::ranges::find(corners, ObjFile::k_none) == corners.end()) {
            triangulate_polygon(corners, mesh_.positions, name_, mesh_.triangles);
        } else {
            mesh_.triangles.insert(mesh_.triangles.end(), 3, ObjFile::k_none);
        }
    }

    const ObjFile& source_;
    std::string name_;
    std::uint32_t stand_in_ = 0;
    bool has_uvs_ = false, has_normals_ = false;
    std::vector<std::uint32_t> first_of_;  // vertex by position
    std::vector<Vertex> vertices_;
    std::size_t faces_without_uvs_ = 0;
    TriangleMesh mesh_;
};

}  // namespace

MeshFile read_obj(const std::filesystem::path& file, bool is_pbr,
                  std::vector<std::string>& warnings) {
    ObjFile source = read_obj_file(file);
    if (source.corners.size() > k_max_obj_corners) {
        throw InputError(file.string() +
                         ": more than 500 million triangles; split or thin out the mesh");
    }
    ObjMesh builder(source,
                    read_obj_materials(file, source.libraries, source.materials, is_pbr, warnings),
                    file.string());
    MeshFile result;
    result.mesh = builder.build();
    if (builder.faces_without_uvs() > 0) {
        warnings.push_back(
            fmt::format("{}: {} faces have a texture but no coordinates for it (vt); they have "
                        "the colour of its corner",
                        file.string(), builder.faces_without_uvs()));
    }
    result.objects = std::move(source.objects);
    result.materials = std::move(source.materials);
    return result;
}

}  // namespace uw
