#include "core/geometry/obj_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <string_view>
#include <unordered_map>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/text.h"
#include "core/geometry/mesh_text.h"

namespace uw {

namespace {

/// Numbers names in the order in which they are first used.
class NameList {
  public:
    std::uint32_t number(const std::string& name) {
        const auto [found, is_new] =
            numbers_.try_emplace(name, static_cast<std::uint32_t>(names_.size()));
        if (is_new) names_.push_back(name);
        return found->second;
    }
    std::vector<std::string> take() { return std::move(names_); }

  private:
    std::unordered_map<std::string, std::uint32_t> numbers_;
    std::vector<std::string> names_;
};

class ObjText {
  public:
    explicit ObjText(const std::filesystem::path& file)
        : name_(file.string()), object_name_(file.stem().string()) {}

    ObjFile read(std::istream& in) {
        std::string text;
        while (std::getline(in, text)) {
            throw_if_stopped();
            ++line_;
            // A backslash at the end joins the next line.
            while (is_continued(text)) {
                text.erase(text.find_last_of('\\'));
                std::string more;
                if (!std::getline(in, more)) break;
                ++line_;
                text += ' ' + more;
            }
            read(TextLine(text));
        }
        if (in.bad()) throw IoError(name_ + ": cannot be read");
        result_.objects = objects_.take();
        result_.materials = materials_.take();
        return std::move(result_);
    }

  private:
    static bool is_continued(const std::string& text) {
        const auto last = text.find_last_not_of("\r ");
        return last != std::string::npos && text[last] == '\\';
    }

    [[noreturn]] void fail(std::string_view word, const char* what) const {
        throw InputError(fmt::format("{}:{}: '{}' is not {}; export the mesh again", name_, line_,
                                     printable(word), what));
    }

    float number(std::string_view word) const {
        const std::optional<float> value = mesh_number(word);
        if (!value) fail(word, "a number");
        return *value;
    }

    void read(TextLine line) {
        const std::string_view keyword = line.word();
        if (keyword == "v") {
            read_vertex(line);
        } else if (keyword == "vn") {
            for (int axis = 0; axis < 3; ++axis) result_.normals.push_back(number(line.word()));
        } else if (keyword == "vt") {
            result_.uvs.push_back(number(line.word()));
            result_.uvs.push_back(line.is_at_end() ? 0.0F : number(line.word()));
        } else if (keyword == "f") {
            read_face(line);
        } else if (keyword == "o" || (keyword == "g" && !has_objects_)) {
            has_objects_ = has_objects_ || keyword == "o";
            object_name_ = line.rest();
            is_object_known_ = false;
        } else if (keyword == "usemtl") {
            material_name_ = line.rest();
            is_material_known_ = false;
        } else if (keyword == "mtllib") {
            result_.libraries.push_back(line.rest());
        }
    }

    /// x y z, perhaps w, perhaps r g b.
    void read_vertex(TextLine& line) {
        std::array<float, 7> values{};
        std::size_t count = 0;
        for (; count < values.size() && !line.is_at_end(); ++count)
            values[count] = number(line.word());
        if (count < 3) fail(line.rest(), "three coordinates");
        const std::size_t vertices = result_.positions.size() / 3;
        if (vertices + 1 >= ObjFile::k_none)
            throw InputError(name_ + ": more than 2^32 vertices; split the mesh");
        result_.positions.insert(result_.positions.end(), values.begin(), values.begin() + 3);
        if (count < 6) {
            if (!result_.colors.empty()) result_.colors.resize(result_.positions.size(), 1.0F);
            return;
        }
        result_.colors.resize(3 * vertices, 1.0F);
        result_.colors.insert(result_.colors.end(), values.begin() + 3, values.begin() + 6);
    }

    /// A place in a list of `count`, counted from 1, or backwards from the last.
    std::uint32_t place(std::string_view word, std::size_t count) const {
        std::int64_t index = 0;
        const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), index);
        const bool is_whole =
            error != std::errc::invalid_argument && stop == word.data() + word.size();
        const bool is_too_large = error == std::errc::result_out_of_range;
        if (!is_whole || (index == 0 && !is_too_large)) fail(word, "a vertex");
        const std::int64_t at = index > 0 ? index - 1 : static_cast<std::int64_t>(count) + index;
        const bool is_possible = !is_too_large && at >= 0 && at < ObjFile::k_none;
        return is_possible ? static_cast<std::uint32_t>(at) : ObjFile::k_none;
    }

    /// "7", "7/2", "7//3" or "7/2/3".
    ObjCorner corner(std::string_view word) const {
        ObjCorner corner{ObjFile::k_none, ObjFile::k_none, ObjFile::k_none};
        const std::array<std::uint32_t*, 3> parts{&corner.position, &corner.uv, &corner.normal};
        const std::array<std::size_t, 3> counts{result_.positions.size() / 3,
                                                result_.uvs.size() / 2, result_.normals.size() / 3};
        for (std::size_t part = 0; part < 3; ++part) {
            const std::size_t end = std::min(word.find('/'), word.size());
            const std::string_view index = word.substr(0, end);
            if (part == 0 || !index.empty()) *parts[part] = place(index, counts[part]);
            if (end == word.size()) break;
            word.remove_prefix(end + 1);
        }
        return corner;
    }

    void read_face(TextLine& line) {
        const std::size_t first = result_.corners.size();
        while (!line.is_at_end() && !line.next().starts_with('#'))
            result_.corners.push_back(corner(line.word()));
        const std::size_t count = result_.corners.size() - first;
        if (count < 3) {  // a point or line
            result_.corners.resize(first);
            return;
        }
        if (!is_object_known_) object_ = objects_.number(object_name_);
        if (!is_material_known_)
            material_ =
                material_name_.empty() ? ObjFile::k_none : materials_.number(material_name_);
        is_object_known_ = is_material_known_ = true;
        result_.faces.push_back({static_cast<std::uint32_t>(count), material_, object_});
    }

    std::string name_;
    std::uint64_t line_ = 0;
    ObjFile result_;
    NameList objects_, materials_;
    bool has_objects_ = false;
    // What the faces to come belong to.
    std::string object_name_, material_name_;
    bool is_object_known_ = false, is_material_known_ = false;
    std::uint32_t object_ = 0, material_ = ObjFile::k_none;
};

}  // namespace

ObjFile read_obj_file(const std::filesystem::path& file) {
    std::ifstream in = open_input(file, file.string(), "mesh");
    return ObjText(file).read(in);
}

std::vector<std::string> libraries_of_obj(const std::filesystem::path& file) {
    std::vector<std::string> libraries;
    std::ifstream in = open_input(file, file.string(), "mesh");
    for (std::string text; std::getline(in, text);) {
        throw_if_stopped();
        if (text.find("mtllib") == std::string::npos) continue;
        TextLine line(text);
        if (line.word() == "mtllib") libraries.push_back(line.rest());
    }
    return libraries;
}

namespace {

constexpr std::size_t k_max_library = std::size_t{16} << 20;

/// Describes what is lost with a statement that is not supported; empty if nothing is.
std::string_view loss_of(std::string_view keyword) {
    static const std::map<std::string_view, std::string_view> k_losses{
        {"bump", "bump maps"},    {"map_bump", "bump maps"},   {"norm", "bump maps"},
        {"disp", "bump maps"},    {"map_d", "transparency"},   {"map_tr", "transparency"},
        {"map_pr", "gloss maps"}, {"map_pm", "gloss maps"},    {"map_ns", "gloss maps"},
        {"refl", "reflections"},  {"map_refl", "reflections"}, {"decal", "decals"}};
    const auto found = k_losses.find(keyword);
    return found == k_losses.end() ? std::string_view() : found->second;
}

class Library {
  public:
    explicit Library(const std::filesystem::path& file) : name_(file.string()) {
        const std::string text = read_text_file(file, name_, k_max_library, "material library");
        is_of_blender_ = text.starts_with("# Blender");
        for (std::size_t begin = 0; begin < text.size();) {
            const std::size_t end = std::min(text.find('\n', begin), text.size());
            ++line_;
            read(TextLine(std::string_view(text).substr(begin, end - begin)));
            begin = end + 1;
        }
    }
    std::vector<MtlMaterial> take() && { return std::move(materials_); }

  private:
    double number(TextLine& line) const {
        double value = 0;
        const std::string_view word = line.word();
        if (parse_number(word, value) != NumberText::number) {
            throw InputError(fmt::format("{}:{}: '{}' is not a number; export the materials again",
                                         name_, line_, printable(word)));
        }
        return value;
    }

    double fraction(TextLine& line) const { return std::clamp(number(line), 0.0, 1.0); }

    /// Reads three numbers; a single one counts for all three.
    Rgb color(TextLine& line, double most) const {
        Rgb rgb{};
        rgb[0] = std::clamp(number(line), 0.0, most);
        for (std::size_t k = 1; k < 3; ++k)
            rgb[k] = line.is_at_end() ? rgb[0] : std::clamp(number(line), 0.0, most);
        return rgb;
    }

    /// Options, then the file's name, which may contain spaces.
    MtlMap map(TextLine& line) const {
        static const std::map<std::string_view, int> k_words_after{
            {"-blendu", 1}, {"-blendv", 1},  {"-cc", 1},   {"-bm", 1}, {"-boost", 1},
            {"-texres", 1}, {"-imfchan", 1}, {"-type", 1}, {"-mm", 2}};
        MtlMap result;
        for (std::string_view option = line.next(); option.starts_with('-'); option = line.next()) {
            if (option == "-s" || option == "-o" || option == "-t") {
                line.word();
                std::array<double, 2> uv = option == "-s" ? result.scale : result.offset;
                // One to three numbers.
                for (std::size_t k = 0; k < 3; ++k) {
                    double value = 0;
                    if (parse_number(line.next(), value) != NumberText::number) break;
                    line.word();
                    if (k < 2) uv[k] = value;
                }
                if (option == "-s") result.scale = uv;
                if (option == "-o") result.offset = uv;
            } else if (option == "-clamp") {
                line.word();
                result.clamp = line.word() == "on";
            } else if (const auto found = k_words_after.find(option);
                       found != k_words_after.end()) {
                for (int word = 0; word <= found->second; ++word) line.word();
            } else {
                break;  // part of a name
            }
        }
        result.file = line.rest();
        return result;
    }

    double roughness_of_exponent(double exponent) const {
        const double n = std::max(exponent, 0.0);
        if (is_of_blender_) return 1 - std::sqrt(std::min(n, 1000.0) / 1000);
        return std::sqrt(std::sqrt(2 / (n + 2)));
    }

    void read(TextLine line) {
        std::string keyword(line.word());
        std::ranges::transform(keyword, keyword.begin(), [](unsigned char c) {
            return static_cast<char>(c >= 'A' && c <= 'Z' ? c + ('a' - 'A') : c);
        });
        if (keyword.empty() || keyword.starts_with('#')) return;
        if (keyword == "newmtl") {
            materials_.emplace_back().name = line.rest();
            has_roughness_ = false;
            return;
        }
        if (materials_.empty()) return;
        read_statement(keyword, line, materials_.back());
    }

    void read_statement(const std::string& keyword, TextLine& line, MtlMaterial& material) {
        constexpr double k_any = 1e30;
        if (keyword == "kd" || keyword == "ke") {
            // Spectral curves and CIE XYZ are spelled out.
            if (line.next() == "spectral" || line.next() == "xyz") {
                material.lost.insert("colours that are not RGB");
            } else {
                (keyword == "kd" ? material.diffuse : material.emission) =
                    color(line, keyword == "kd" ? 1 : k_any);
            }
        } else if (keyword == "map_kd") {
            material.diffuse_map = map(line);
        } else if (keyword == "map_ke") {
            material.emission_map = map(line);
        } else if (keyword == "pr") {
            material.roughness = fraction(line);
            has_roughness_ = true;
        } else if (keyword == "ns") {
            const double exponent = number(line);
            if (!has_roughness_) material.roughness = roughness_of_exponent(exponent);
        } else if (keyword == "pm") {
            material.metallic = fraction(line);
        } else if (keyword == "ni") {
            material.ior = std::max(number(line), 1.0);
        } else if (keyword == "d") {
            if (line.next() != "-halo" && number(line) < 1) material.lost.insert("transparency");
        } else if (keyword == "tr") {
            if (number(line) > 0) material.lost.insert("transparency");
        } else if (const std::string_view loss = loss_of(keyword); !loss.empty()) {
            material.lost.insert(std::string(loss));
        }
    }

    std::string name_;
    int line_ = 0;
    bool is_of_blender_ = false, has_roughness_ = false;
    std::vector<MtlMaterial> materials_;
};

}  // namespace

std::vector<MtlMaterial> read_mtl(const std::filesystem::path& file) {
    return Library(file).take();
}

}  // namespace uw
