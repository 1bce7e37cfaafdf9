#include "render/id_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/base/text.h"
#include "core/json/json.h"

namespace uw {

namespace {

using NameList = std::vector<SurfaceName>;

constexpr std::size_t k_longest_name = 4096;

std::string names_by_number(const NameList& list) {
    std::string text = "{";
    for (std::size_t k = 0; k < list.size(); ++k) {
        text +=
            fmt::format("{}\"{}\":{}", k == 0 ? "" : ",", k + 1,
                        Json(list[k].name).dump(-1, ' ', false, Json::error_handler_t::replace));
    }
    return text + "}";
}

// RFC 4180, on one line.
std::string csv_field(const std::string& text) {
    const std::string line = printable(text, k_longest_name);
    if (line.find_first_of(",\"") == std::string::npos) return line;
    std::string quoted = "\"";
    for (const char c : line) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

}  // namespace

bool requests_ids(std::string_view layers) {
    while (!layers.empty()) {
        const std::size_t end = std::min(layers.find(','), layers.size());
        std::string_view item = layers.substr(0, end);
        const auto is_space = [](char c) { return c == ' ' || c == '\t'; };
        while (!item.empty() && is_space(item.front())) item.remove_prefix(1);
        while (!item.empty() && is_space(item.back())) item.remove_suffix(1);
        if (item == "id" || item == "material" || item == "all") return true;
        layers.remove_prefix(std::min(end + 1, layers.size()));
    }
    return false;
}

std::filesystem::path id_table_beside(const std::filesystem::path& image) {
    std::filesystem::path table = image;
    table.replace_extension();
    table += "_ids.csv";
    return table;
}

void add_id_names(const SurfaceNames& names, ImageMetadata& metadata) {
    metadata["uwvdb/id_names"] = names_by_number(names.objects);
    metadata["uwvdb/material_names"] = names_by_number(names.materials);
}

void write_id_table(OutputFile& out, const SurfaceNames& names) {
    out.write("layer,number,name,geometry\n");
    const auto write = [&](const char* layer, const NameList& list) {
        for (std::size_t k = 0; k < list.size(); ++k)
            out.write(
                fmt::format("{},{},{},{}\n", layer, k + 1, csv_field(list[k].name), list[k].entry));
    };
    write("id", names.objects);
    write("material", names.materials);
}

}  // namespace uw
