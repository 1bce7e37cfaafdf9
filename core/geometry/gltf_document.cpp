#include "core/geometry/gltf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/text.h"

namespace uw {

std::filesystem::path gltf_uri_path(const std::filesystem::path& gltf_file,
                                    const std::string& uri) {
    std::string decoded;
    for (std::size_t k = 0; k < uri.size(); ++k) {
        unsigned code = 0;
        const char* digits = uri.data() + k + 1;
        if (uri[k] == '%' && k + 2 < uri.size() &&
            std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2) {
            decoded.push_back(static_cast<char>(code));
            k += 2;
        } else {
            decoded.push_back(uri[k]);
        }
    }
    return gltf_file.parent_path() / decoded;
}

const std::string& gltf_uri(const nlohmann::json& entry) {
    static const std::string none;
    if (entry.is_object() && !entry.contains("uri")) return none;
    return entry.at("uri").get_ref<const std::string&>();
}

namespace {

constexpr int k_max_nesting = 100;                   // more than any exporter writes
constexpr std::size_t k_longest_printed_name = 300;  // in messages
constexpr std::uint64_t k_glb_header = 20;  // magic, version, length, chunk length, chunk type

std::string read_bytes(std::ifstream& in, std::uint64_t count) {
    std::string bytes(count, '\0');
    in.read(bytes.data(), static_cast<std::streamsize>(count));
    bytes.resize(static_cast<std::size_t>(in.gcount()));
    return bytes;
}

std::uint32_t little_endian(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t k = 4; k-- > 0;) {
        value = (value << 8) | static_cast<unsigned char>(bytes[at + k]);
    }
    return value;
}

std::string printed_name(const std::filesystem::path& file) {
    return printable(file.string(), k_longest_printed_name);
}

/// The end of the string whose first character is at `begin`: its quote, npos if there is none.
std::size_t end_of_string(std::string_view json, std::size_t begin) {
    std::size_t quote = json.find('"', begin);
    std::size_t slash = json.substr(0, quote).find('\\', begin);
    while (slash != std::string_view::npos) {
        begin = slash + 2;
        if (quote < begin) quote = json.find('"', begin);
        slash = json.substr(0, quote).find('\\', begin);
    }
    return quote;
}

/// Data URIs longer than this are kept from the parser, which takes seconds for 100 MB of text.
constexpr std::size_t k_longest_parsed = std::size_t{1} << 16;
constexpr std::string_view k_stand_in = "data:left out by uwvdb ";

/// A document without its long data URIs, and these.
struct ShortenedJson {
    std::string text;
    std::vector<std::string> uris;  // number n is where the text has k_stand_in and n
};

ShortenedJson shorten(std::string json, const std::string& name) {
    const std::string_view all = json;
    const bool shortens = all.find(k_stand_in) == std::string_view::npos;
    ShortenedJson result;
    std::size_t copied = 0;
    int depth = 0;
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (all[k] == '{' || all[k] == '[') {
            if (++depth > k_max_nesting) throw InputError(name + ": the glTF is nested too deeply");
        } else if (all[k] == '}' || all[k] == ']') {
            --depth;
        }
        if (all[k] != '"') continue;
        const std::size_t begin = k + 1;
        k = end_of_string(all, begin);
        if (k == std::string_view::npos) break;  // the parser reports it
        const std::string_view text = all.substr(begin, k - begin);
        if (!shortens || text.size() <= k_longest_parsed || !text.starts_with("data:") ||
            text.find('\\') != std::string_view::npos)
            continue;
        result.text += all.substr(copied, begin - copied);
        result.text += fmt::format("{}{}", k_stand_in, result.uris.size());
        result.uris.emplace_back(text);
        copied = k;
    }
    if (copied == 0)
        result.text = std::move(json);
    else
        result.text += all.substr(copied);
    return result;
}

/// Puts the URIs of the elements of `list` back.
void put_back(nlohmann::json& list, std::vector<std::string>& uris) {
    if (!list.is_array()) return;
    for (nlohmann::json& entry : list) {
        if (!entry.is_object() || !entry.contains("uri") || !entry["uri"].is_string()) continue;
        auto& uri = entry["uri"].get_ref<std::string&>();
        if (!uri.starts_with(k_stand_in)) continue;
        std::size_t number = uris.size();
        std::from_chars(uri.data() + k_stand_in.size(), uri.data() + uri.size(), number);
        if (number < uris.size()) uri = std::move(uris[number]);
    }
}

}  // namespace

std::string read_gltf_text(const std::filesystem::path& file) {
    const std::string name = printed_name(file);
    std::ifstream in = open_input(file, name, "mesh");
    const std::uint64_t size = std::filesystem::file_size(file);
    std::string header = read_bytes(in, std::min<std::uint64_t>(size, k_glb_header));
    if (!header.starts_with("glTF")) {
        in.clear();
        in.seekg(0);
        return read_bytes(in, size);
    }
    if (header.size() < k_glb_header || little_endian(header, 4) != 2) {
        throw InputError(name + ": not a GLB file of version 2; export it as glTF 2.0");
    }
    const std::uint64_t length = little_endian(header, 12);
    if (header.substr(16, 4) != "JSON" || length > size - k_glb_header) {
        throw InputError(name + ": the GLB file is truncated; export the mesh again");
    }
    return read_bytes(in, length);
}

nlohmann::json load_gltf_json(const std::filesystem::path& file) {
    const std::string name = printed_name(file);
    ShortenedJson json = shorten(read_gltf_text(file), name);
    nlohmann::json document = nlohmann::json::parse(json.text);
    if (!document.is_object() || !document.contains("asset")) {
        throw InputError(name + ": not a glTF file (it has no 'asset')");
    }
    if (!document["asset"].value("version", "").starts_with("2")) {
        throw InputError(name + ": not glTF 2; export it as glTF 2.0");
    }
    if (!json.uris.empty())
        for (const char* list : {"buffers", "images"})
            if (document.contains(list)) put_back(document[list], json.uris);
    return document;
}

void fail_broken_gltf(const std::filesystem::path& file, const nlohmann::json::exception& error) {
    throw InputError(fmt::format("{}: the glTF description is broken: {}", printed_name(file),
                                 printable(error.what(), k_longest_printed_name)));
}

using Json = nlohmann::json;

GltfDocument::GltfDocument(const std::filesystem::path& file)
    : file_(file), root_(load_gltf_json(file)) {}

std::string GltfDocument::name() const {
    return printed_name(file_);
}

void GltfDocument::fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", name(), what));
}

const Json& GltfDocument::list(const Json& parent, const char* key) const {
    static const Json none = Json::array();
    const auto found = parent.is_object() ? parent.find(key) : parent.end();
    if (!parent.is_object() || found == parent.end()) return none;
    if (!found->is_array()) fail(fmt::format("glTF '{}' is not a list", key));
    return *found;
}

const Json& GltfDocument::object(const Json& parent, const char* key) const {
    static const Json none = Json::object();
    const auto found = parent.is_object() ? parent.find(key) : parent.end();
    if (!parent.is_object() || found == parent.end()) return none;
    if (!found->is_object()) fail(fmt::format("glTF '{}' is not an object", key));
    return *found;
}

const Json& GltfDocument::extension(const Json& parent, const char* key) const {
    return object(object(parent, "extensions"), key);
}

std::uint64_t GltfDocument::whole_number(const Json& parent, const char* key,
                                         std::uint64_t otherwise) const {
    const auto found = parent.find(key);
    if (found == parent.end()) return otherwise;
    if (!found->is_number_unsigned()) fail(fmt::format("glTF '{}' is not a whole number", key));
    return found->get<std::uint64_t>();
}

const Json& GltfDocument::element(const char* key, const Json& parent,
                                  const char* index_key) const {
    const Json& all = list(key);
    const std::uint64_t index = whole_number(parent, index_key, UINT64_MAX);
    if (index >= all.size())
        fail(fmt::format("glTF '{}' refers to an item that does not exist", index_key));
    return all[index];
}

namespace {

using Json = nlohmann::json;

template <typename T>
double number_at(const std::byte* bytes) {
    T value{};
    std::memcpy(&value, bytes, sizeof(value));
    return static_cast<double>(value);
}

/// One stored number, and the divisor if it is normalised (glTF 2.0, 3.11).
double stored(const std::byte* bytes, std::uint64_t type) {
    switch (type) {
        case k_gltf_byte:
            return number_at<std::int8_t>(bytes);
        case k_gltf_unsigned_byte:
            return number_at<std::uint8_t>(bytes);
        case k_gltf_short:
            return number_at<std::int16_t>(bytes);
        case k_gltf_unsigned_short:
            return number_at<std::uint16_t>(bytes);
        case k_gltf_unsigned_int:
            return number_at<std::uint32_t>(bytes);
        default:
            return number_at<float>(bytes);
    }
}

double largest(std::uint64_t type) {
    switch (type) {
        case k_gltf_byte:
            return 127;
        case k_gltf_unsigned_byte:
            return 255;
        case k_gltf_short:
            return 32767;
        case k_gltf_unsigned_short:
            return 65535;
        default:
            return 1;
    }
}

/// The value of each base64 digit, -1 for other characters.
std::array<int, 256> base64_digits() {
    constexpr std::string_view k_digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::array<int, 256> values{};
    values.fill(-1);
    for (std::size_t i = 0; i < k_digits.size(); ++i) {
        values[static_cast<unsigned char>(k_digits[i])] = static_cast<int>(i);
    }
    return values;
}

std::vector<std::byte> read_range(const std::filesystem::path& file, std::uint64_t offset,
                                  std::uint64_t size) {
    std::ifstream in = open_input(file, printed_name(file), "glTF buffer");
    std::vector<std::byte> bytes(size);
    in.seekg(static_cast<std::streamoff>(offset));
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    if (!in || static_cast<std::uint64_t>(in.gcount()) != size) {
        throw IoError(fmt::format("{}: cannot read {} bytes at {}; the file is truncated",
                                  printed_name(file), size, offset));
    }
    return bytes;
}

/// The second chunk of a .glb file (glTF 2.0, 4.4.3).
std::vector<std::byte> read_binary_chunk(const GltfDocument& document, std::uint64_t size) {
    constexpr std::uint64_t k_first_chunk = 12;
    std::uint64_t at = k_first_chunk;
    const std::uint64_t file_size = std::filesystem::file_size(document.file());
    while (at + 8 <= file_size) {
        const std::vector<std::byte> header = read_range(document.file(), at, 8);
        const auto length = static_cast<std::uint64_t>(number_at<std::uint32_t>(header.data()));
        constexpr std::string_view k_bin("BIN\0", 4);
        if (std::memcmp(header.data() + 4, k_bin.data(), 4) == 0) {
            if (size > length) document.fail("a glTF buffer is longer than its chunk");
            return read_range(document.file(), at + 8, size);
        }
        at += 8 + length;
    }
    document.fail("its glTF buffer is not in the file; export it as .glb");
}

}  // namespace

std::size_t gltf_component_count(const std::string& type) {
    static const std::map<std::string, std::size_t> counts = {
        {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
        {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
    const auto found = counts.find(type);
    return found == counts.end() ? 0 : found->second;
}

std::size_t gltf_component_size(std::uint64_t component_type) {
    switch (component_type) {
        case k_gltf_byte:
        case k_gltf_unsigned_byte:
            return 1;
        case k_gltf_short:
        case k_gltf_unsigned_short:
            return 2;
        case k_gltf_unsigned_int:
        case k_gltf_float:
            return 4;
        default:
            return 0;
    }
}

std::vector<std::byte> decode_data_uri(const GltfDocument& document, const std::string& uri) {
    constexpr std::string_view k_mark = ";base64,";
    const std::size_t mark = uri.substr(0, 200).find(k_mark);
    if (mark == std::string::npos) document.fail("a glTF data URI is not base64");
    static const std::array<int, 256> digits = base64_digits();
    std::string_view text = std::string_view(uri).substr(mark + k_mark.size());
    text = text.substr(0, text.find('='));
    // Each group of four digits is three bytes; the rest is up to two.
    std::vector<std::byte> bytes(text.size() / 4 * 3 + text.size() % 4 * 3 / 4);
    std::byte* to = bytes.data();
    int bad = 0;
    for (std::size_t at = 0; at < text.size(); at += 4) {
        const std::size_t count = std::min<std::size_t>(text.size() - at, 4);
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const int digit = k < count ? digits[static_cast<unsigned char>(text[at + k])] : 0;
            bad |= digit;
            bits = (bits << 6) | static_cast<std::uint32_t>(digit & 0x3f);
        }
        for (std::size_t k = 0; k < count * 3 / 4; ++k)
            *to++ = static_cast<std::byte>((bits >> (16 - 8 * k)) & 0xff);
    }
    if (bad < 0) document.fail("a glTF data URI is not base64");
    return bytes;
}

const std::vector<std::byte>& GltfBytes::buffer(std::size_t index) {
    std::vector<std::byte>& bytes = buffers_[index];
    const Json& json = document_.list("buffers")[index];
    const std::uint64_t size = document_.whole_number(json, "byteLength", 0);
    if (!bytes.empty() || size == 0) return bytes;
    const std::string& uri = gltf_uri(json);
    if (uri.empty()) {
        bytes = read_binary_chunk(document_, size);
    } else if (uri.starts_with("data:")) {
        bytes = decode_data_uri(document_, uri);
        if (bytes.size() < size) document_.fail("a glTF buffer is truncated");
    } else {
        bytes = read_range(gltf_uri_path(document_.file(), uri), 0, size);
    }
    return bytes;
}

std::span<const std::byte> GltfBytes::view(const Json& parent, const char* key) {
    const Json& view = document_.element("bufferViews", parent, key);
    const auto index = document_.whole_number(view, "buffer", UINT64_MAX);
    if (index >= buffers_.size())
        document_.fail("glTF 'buffer' refers to an item that does not exist");
    const std::span<const std::byte> all = buffer(index);
    const std::uint64_t offset = document_.whole_number(view, "byteOffset", 0);
    const std::uint64_t length = document_.whole_number(view, "byteLength", 0);
    if (offset > all.size() || length > all.size() - offset) {
        document_.fail("a glTF bufferView reaches past its buffer; the file is truncated");
    }
    return all.subspan(offset, length);
}

std::vector<float> GltfBytes::floats(const Json& accessor, std::size_t width) {
    const std::uint64_t count = document_.whole_number(accessor, "count", 0);
    const std::uint64_t type = document_.whole_number(accessor, "componentType", 0);
    const std::size_t components =
        std::min(width, gltf_component_count(accessor.value("type", "")));
    const std::size_t element =
        gltf_component_count(accessor.value("type", "")) * gltf_component_size(type);
    const bool normalized = accessor.value("normalized", false);
    const double divisor = normalized ? largest(type) : 1;
    std::vector<float> values(count * width, 0.0F);
    const auto put = [&](std::size_t at, const std::byte* source) {
        throw_if_stopped();
        for (std::size_t k = 0; k < components; ++k) {
            const double value = stored(source + k * gltf_component_size(type), type) / divisor;
            values[at * width + k] = static_cast<float>(normalized ? std::max(value, -1.0) : value);
        }
    };
    if (accessor.contains("bufferView") && count > 0) {
        const std::span<const std::byte> bytes =
            view(accessor, "bufferView").subspan(document_.whole_number(accessor, "byteOffset", 0));
        const std::uint64_t stride = document_.whole_number(
            document_.element("bufferViews", accessor, "bufferView"), "byteStride", element);
        for (std::size_t i = 0; i < count; ++i) put(i, bytes.data() + i * stride);
    }
    if (!accessor.contains("sparse")) return values;
    const Json& sparse = accessor.at("sparse");
    const Json& places = sparse.at("indices");
    const std::uint64_t patches = document_.whole_number(sparse, "count", 0);
    const std::uint64_t place_type = document_.whole_number(places, "componentType", 0);
    const auto offset = [&](const Json& source) {
        return view(source, "bufferView").data() + document_.whole_number(source, "byteOffset", 0);
    };
    for (std::size_t i = 0; i < patches; ++i) {
        const auto at = static_cast<std::uint64_t>(
            stored(offset(places) + i * gltf_component_size(place_type), place_type));
        if (at >= count) document_.fail("a sparse glTF accessor changes values that do not exist");
        put(at, offset(sparse.at("values")) + i * element);
    }
    return values;
}

std::vector<std::uint32_t> GltfBytes::indices(const Json& accessor) {
    const std::uint64_t count = document_.whole_number(accessor, "count", 0);
    const std::uint64_t type = document_.whole_number(accessor, "componentType", 0);
    if (accessor.contains("sparse"))
        document_.fail("glTF indices are sparse; export them without sparse accessors");
    std::vector<std::uint32_t> values(count, 0);
    if (!accessor.contains("bufferView") || count == 0) return values;
    const std::span<const std::byte> bytes =
        view(accessor, "bufferView").subspan(document_.whole_number(accessor, "byteOffset", 0));
    const std::size_t size = gltf_component_size(type);
    for (std::size_t i = 0; i < count; ++i) {
        throw_if_stopped();
        values[i] = static_cast<std::uint32_t>(stored(bytes.data() + i * size, type));
    }
    return values;
}

}  // namespace uw
