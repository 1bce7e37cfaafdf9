#include "core/meshes/files/obj_materials.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/files/input_files.h"
#include "core/image/image_reader.h"
#include "core/meshes/files/mtl_file.h"
#include "core/meshes/files/obj_file.h"
#include "core/meshes/files/text_line.h"

namespace uw {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t k_most_names = 6;  // of a warning

bool is_file(const fs::path& file) {
    std::error_code status;
    return fs::is_regular_file(file, status);
}

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

/// What an OBJ file says of its libraries, sorted by what can be done with them.
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
        // One name that may hold spaces, or several between them.
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

bool is_readable_picture(const fs::path& file) {
    std::string ending = file.extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) {
        return static_cast<char>(c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c);
    });
    return ending == ".png" || ending == ".jpg" || ending == ".jpeg";
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
        const auto warn = [&](const auto& names, const char* what, const char* mend) {
            if (!names.empty())
                warnings.push_back(fmt::format("{}: {}: {}; {}", obj, what, listed(names), mend));
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
        warn(other_formats_, "textures that are neither PNG nor JPEG",
             "their surfaces have the colour Kd; convert them");
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
            if (count++ == k_most_names) {
                text += fmt::format(" and {} more", names.size() - k_most_names);
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
        if (!is_readable_picture(*file)) {
            other_formats_.insert(map.file);
            return use;
        }
        auto& picture = pictures_[*file];
        if (!picture) {
            remember_input(*file);
            picture = std::make_shared<Texture>(read_image(*file));
        }
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

}  // namespace uw
