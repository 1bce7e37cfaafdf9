#include "core/meshes/files/obj_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <unordered_map>

#include "core/base/error.h"
#include "core/base/stop.h"
#include "core/base/text.h"
#include "core/files/input_files.h"
#include "core/meshes/files/mesh_number.h"
#include "core/meshes/files/text_line.h"

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
    // Of the faces to come.
    std::string object_name_, material_name_;
    bool is_object_known_ = false, is_material_known_ = false;
    std::uint32_t object_ = 0, material_ = ObjFile::k_none;
};

}  // namespace

ObjFile read_obj_file(const std::filesystem::path& file) {
    remember_input(file);
    std::ifstream in(file, std::ios::binary);
    if (!in) {
        throw IoError(file.string() + ": cannot open the mesh; check the name and its permissions");
    }
    return ObjText(file).read(in);
}

std::vector<std::string> libraries_of_obj(const std::filesystem::path& file) {
    std::vector<std::string> libraries;
    std::error_code status;
    if (!std::filesystem::is_regular_file(file, status)) return libraries;
    std::ifstream in(file, std::ios::binary);
    for (std::string text; std::getline(in, text);) {
        throw_if_stopped();
        if (text.find("mtllib") == std::string::npos) continue;
        TextLine line(text);
        if (line.word() == "mtllib") libraries.push_back(line.rest());
    }
    return libraries;
}

}  // namespace uw
