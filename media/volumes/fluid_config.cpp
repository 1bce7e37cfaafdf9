#include "media/volumes/fluid_config.h"

#include <zlib.h>

#include <cctype>
#include <cstring>
#include <string>

#include "core/files/input_files.h"

namespace uw {
namespace {

// The file is a gzip of 50 or 51 values of four bytes, little-endian: active fields, resolution
// (3), dx, dt, p0 (3), p1 (3), dp0 (3), shift (3), object shift (3), object matrix (16), domain's
// resolution (3), first (3) and last + 1 (3) voxel of the grids in it, colour (3), time, version.
constexpr std::size_t k_values = 50, k_resolution = 1, k_domain = 37, k_first = 40, k_end = 43;

std::filesystem::path config_of(const std::filesystem::path& data_file) {
    const std::string stem = data_file.stem().string();
    std::size_t begin = stem.size();
    while (begin > 0 && std::isdigit(static_cast<unsigned char>(stem[begin - 1])) != 0) --begin;
    if (begin == stem.size()) return {};
    return data_file.parent_path() / ".." / "config" / ("config_" + stem.substr(begin) + ".uni");
}

bool read_gzip(const std::filesystem::path& file, std::array<std::int32_t, k_values>& values) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return false;
    remember_input(file);
    const gzFile in = gzopen(file.c_str(), "rb");
    if (in == nullptr) return false;
    const int size = static_cast<int>(sizeof values);
    const bool is_whole = gzread(in, values.data(), static_cast<unsigned>(size)) == size;
    gzclose(in);
    return is_whole;
}

}  // namespace

std::optional<FluidConfig> read_fluid_config(const std::filesystem::path& data_file) {
    std::array<std::int32_t, k_values> values{};
    if (!read_gzip(config_of(data_file), values)) return std::nullopt;
    FluidConfig config;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        config.resolution[axis] = values[k_resolution + axis];
        config.domain[axis] = values[k_domain + axis];
        config.first[axis] = values[k_first + axis];
        const std::int64_t count = config.resolution[axis], first = config.first[axis];
        if (count <= 0 || first < 0 || first + count > config.domain[axis] ||
            first + count != values[k_end + axis])
            return std::nullopt;
    }
    return config;
}

}  // namespace uw
