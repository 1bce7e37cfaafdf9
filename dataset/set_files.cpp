#include "dataset/set_files.h"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/files/output_file.h"
#include "dataset/sha256.h"

namespace uw {

namespace fs = std::filesystem;

Json set_file_json(const SetFile& file) {
    return {
        {"role", file.role}, {"path", file.path}, {"bytes", file.bytes}, {"sha256", file.sha256}};
}

SetFile set_file_from_json(const Json& json) {
    return {json.at("role").get<std::string>(), json.at("path").get<std::string>(),
            json.at("bytes").get<std::uint64_t>(), json.at("sha256").get<std::string>()};
}

bool is_whole(const fs::path& folder, const SetFile& file, bool by_content) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(folder / file.path, error);
    if (error || size != file.bytes) return false;
    return !by_content || sha256_of_file(folder / file.path) == file.sha256;
}

void SetFiles::add(std::string role, std::string path,
                   const std::function<void(const fs::path& file)>& write) {
    const fs::path file = folder_ / path;
    write(file);
    std::error_code error;
    const std::uintmax_t size = fs::file_size(file, error);
    if (error) throw IoError(fmt::format("{}: {}", file.string(), error.message()));
    written_.push_back({std::move(role), std::move(path), size, sha256_of_file(file)});
}

void SetFiles::add_bytes(std::string role, std::string path, std::string_view bytes) {
    OutputFile out(folder_ / path);
    out.write(bytes);
    out.commit();
    written_.push_back({std::move(role), std::move(path), bytes.size(), sha256_of(bytes)});
}

void SetFiles::add_copy(std::string role, std::string path, const std::string& from) {
    std::ifstream in(folder_ / from, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    if (!in) throw IoError(fmt::format("{}: cannot be read", (folder_ / from).string()));
    add_bytes(std::move(role), std::move(path), bytes);
}

}  // namespace uw
