#include "media/water/species_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <mutex>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/output_files.h"

namespace uw {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t k_max_files = 2000;  // of some 6 kB each
constexpr std::size_t k_max_bytes = 1 << 20;

std::mutex& folder_mutex() {
    static std::mutex mutex;
    return mutex;
}

fs::path& folder_in_use() {
    static fs::path folder;
    return folder;
}

fs::path usable_folder() {
    if (inputs_are_confined()) return {};
    const std::scoped_lock lock(folder_mutex());
    return folder_in_use();
}

/// FNV-1a, of 64 bits: it names files, and finds those that were damaged.
std::uint64_t digest(std::string_view bytes) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char c : bytes) {
        hash ^= static_cast<unsigned char>(c);
        hash *= 0x100000001b3;
    }
    return hash;
}

fs::path file_of(const fs::path& folder, const std::string& key) {
    return folder / fmt::format("{:016x}.mie", digest(key));
}

std::string bytes_of(const void* data, std::size_t count) {
    return {static_cast<const char*>(data), count};
}

/// The file's contents but for the digest at its end: its key, then the numbers as they are in
/// memory, so that a machine of another byte order finds another key.
std::string contents(const std::string& key, std::span<const double> results) {
    const double one = 1;
    return "uwvdb species 1\n" + bytes_of(&one, sizeof one) + key + '\0' +
           bytes_of(results.data(), results.size_bytes());
}

/// Makes room in a full folder: removes the oldest half.
void thin_out(const fs::path& folder) {
    std::error_code error;
    std::vector<std::pair<fs::file_time_type, fs::path>> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
        if (entry.path().extension() == ".mie")
            files.emplace_back(entry.last_write_time(error), entry.path());
    if (files.size() < k_max_files) return;
    std::ranges::sort(files);
    for (std::size_t i = 0; i < files.size() / 2; ++i) fs::remove(files[i].second, error);
}

}  // namespace

fs::path user_cache_folder() {
    const auto folder_in = [](const char* variable) {
        const char* const text = std::getenv(variable);
        const fs::path folder = text ? text : "";
        return folder.is_absolute() ? folder : fs::path();
    };
    if (fs::path cache = folder_in("XDG_CACHE_HOME"); !cache.empty()) return cache;
    const fs::path home = folder_in("HOME");
    return home.empty() ? home : home / ".cache";
}

void keep_species_in(const fs::path& folder) {
    const std::scoped_lock lock(folder_mutex());
    folder_in_use() = folder;
}

std::optional<std::vector<double>> kept_results(const std::string& key, std::size_t count) {
    const fs::path folder = usable_folder();
    if (folder.empty()) return {};
    std::ifstream file = open_own_file(file_of(folder, key));
    std::string bytes(k_max_bytes, '\0');
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(file.gcount()));
    std::vector<double> results(count);
    const std::string wanted = contents(key, {});
    const std::size_t size = wanted.size() + count * sizeof(double);
    std::uint64_t sum = 0;
    if (bytes.size() != size + sizeof sum || !bytes.starts_with(wanted)) return {};
    std::memcpy(&sum, bytes.data() + size, sizeof sum);
    if (sum != digest(std::string_view(bytes).substr(0, size))) return {};
    std::memcpy(results.data(), bytes.data() + wanted.size(), count * sizeof(double));
    const bool is_sane =
        std::ranges::all_of(results, [](double v) { return std::isfinite(v) && v >= 0; });
    return is_sane ? std::optional(std::move(results)) : std::nullopt;
}

void keep_results(const std::string& key, const std::vector<double>& results) {
    const fs::path folder = usable_folder();
    if (folder.empty()) return;
    const std::string whole = contents(key, results);
    const std::uint64_t sum = digest(whole);
    try {
        thin_out(folder);
        OutputFile file(file_of(folder, key));
        file.write(whole + bytes_of(&sum, sizeof sum));
        file.commit();
    } catch (const std::exception&) {
        // A full disk or a read-only home costs time, but must not fail the render.
    }
}

}  // namespace uw
