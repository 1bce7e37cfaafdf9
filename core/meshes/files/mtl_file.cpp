#include "core/meshes/files/mtl_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/files/text_file.h"
#include "core/meshes/files/text_line.h"

namespace uw {
namespace {

constexpr std::size_t k_largest_library = std::size_t{16} << 20;

/// What is lost with a statement that cannot be used; empty if nothing is.
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
        const std::string text = read_text_file(file, name_, k_largest_library, "material library");
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

    double share(TextLine& line) const { return std::clamp(number(line), 0.0, 1.0); }

    /// One number stands for three.
    Rgb color(TextLine& line, double most) const {
        Rgb rgb{};
        rgb[0] = std::clamp(number(line), 0.0, most);
        for (std::size_t k = 1; k < 3; ++k)
            rgb[k] = line.is_at_end() ? rgb[0] : std::clamp(number(line), 0.0, most);
        return rgb;
    }

    /// Options, then the file's name, which may hold spaces.
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
            material.roughness = share(line);
            has_roughness_ = true;
        } else if (keyword == "ns") {
            const double exponent = number(line);
            if (!has_roughness_) material.roughness = roughness_of_exponent(exponent);
        } else if (keyword == "pm") {
            material.metallic = share(line);
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
