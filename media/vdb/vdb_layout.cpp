#include "media/vdb/vdb_layout.h"

#include <array>
#include <bit>
#include <set>
#include <vector>

#include "media/vdb/byte_reader.h"

namespace uw {
namespace {

using Mask = std::vector<std::uint64_t>;
using Key = std::array<std::int32_t, 3>;

constexpr std::int64_t k_leaf_values = 512, k_lower_values = 4096, k_upper_values = 32768;
constexpr std::uint32_t k_first_with_mask_compression = 222;
constexpr std::uint32_t k_zip = 1, k_active_mask = 2, k_blosc = 4;

std::int64_t count_on(const Mask& mask) {
    std::int64_t count = 0;
    for (const std::uint64_t word : mask) count += std::popcount(word);
    return count;
}

bool is_on(const Mask& mask, std::int64_t n) {
    return (mask[static_cast<std::size_t>(n / 64)] >> (n % 64) & 1U) != 0;
}

std::int64_t components_of(const std::string& value_type) {
    return value_type.starts_with("vec3") ? 3 : 1;
}

std::int64_t bytes_of_value(const std::string& value_type) {
    const bool wide = value_type == "double" || value_type == "int64" || value_type == "vec3d";
    return components_of(value_type) * (wide ? 8 : 4);
}

class LayoutWalk {
  public:
    LayoutWalk(ByteReader& in, const VdbHeader& header, const GridSummary& grid)
        : in_(in),
          old_(header.version < k_first_with_mask_compression),
          compression_(grid.compression),
          value_bytes_(bytes_of_value(grid.value_type)),
          stored_bytes_(grid.half ? 2 * components_of(grid.value_type) : value_bytes_),
          half_(grid.half) {}

    void walk_tree() {
        if (in_.get<std::int32_t>() != 1) in_.fail_damaged();  // buffers; 1 since OpenVDB 1.0
        in_.skip(value_bytes_);                                // background
        const auto tiles = in_.get<std::uint32_t>();
        const auto children = in_.get<std::uint32_t>();
        // Leaves are stored in the order of a sorted table of tiles and children: an out-of-order
        // or duplicate key would pair masks with other leaves' values.
        std::set<Key> tile_keys;
        for (std::uint32_t n = 0; n < tiles; ++n) {
            tile_keys.insert(in_.get<Key>());
            in_.skip(value_bytes_);
            // Whether it is active: OpenVDB reads the byte into a bool as it is.
            if (in_.get<std::uint8_t>() > 1) in_.fail_damaged();
        }
        Key last{};
        for (std::uint32_t n = 0; n < children; ++n) {
            const Key key = in_.get<Key>();
            if ((n > 0 && key <= last) || tile_keys.contains(key)) in_.fail_damaged();
            last = key;
            walk_upper();
        }
        for (const std::int64_t count_of_leaf : leaf_counts_) walk_leaf(count_of_leaf);
    }

  private:
    Mask read_mask(std::int64_t values) {
        Mask mask(static_cast<std::size_t>(values / 64));
        in_.read(reinterpret_cast<char*>(mask.data()), mask.size() * sizeof mask[0]);
        return mask;
    }

    /// One node's values: an indicator, inactive values, a mask between them, and the data.
    void walk_values(std::int64_t values, std::int64_t active) {
        constexpr std::int8_t one_inactive = 2, mask_only = 3, mask_one = 4, mask_two = 5, all = 6;
        const std::int8_t indicator = old_ ? all : in_.get<std::int8_t>();
        if (indicator == one_inactive || indicator == mask_one) in_.skip(value_bytes_);
        if (indicator == mask_two) in_.skip(2 * value_bytes_);
        if (indicator >= mask_only && indicator <= mask_two) in_.skip(values / 8);
        const bool active_only = (compression_ & k_active_mask) != 0 && indicator != all;
        const std::int64_t count = active_only ? active : values;
        if (half_ && count < 1) return;
        const std::int64_t bytes = count * stored_bytes_;
        if ((compression_ & (k_zip | k_blosc)) == 0) {
            in_.skip(bytes);
            return;
        }
        const auto packed = in_.get<std::int64_t>();  // negative: stored uncompressed
        if (packed <= 0 && packed != -bytes) in_.fail_damaged();
        in_.skip(packed > 0 ? packed : bytes);
    }

    /// The masks and values of an internal node; returns the mask of its children.
    Mask walk_internal(std::int64_t values) {
        Mask children = read_mask(values);
        const Mask active = read_mask(values);
        walk_values(old_ ? values - count_on(children) : values, count_on(active));
        return children;
    }
    void walk_upper() {
        const Mask children = walk_internal(k_upper_values);
        for (std::int64_t n = 0; n < k_upper_values; ++n)
            if (is_on(children, n)) walk_lower();
    }
    void walk_lower() {
        const std::int64_t children = count_on(walk_internal(k_lower_values));
        for (std::int64_t n = 0; n < children; ++n)
            leaf_counts_.push_back(count_on(read_mask(k_leaf_values)));
    }
    void walk_leaf(std::int64_t active) {
        in_.skip(k_leaf_values / 8);  // its mask, repeated
        if (old_) {
            in_.skip(sizeof(Key));
            if (in_.get<std::int8_t>() != 1) in_.fail_damaged();
        }
        walk_values(k_leaf_values, active);
    }

    ByteReader& in_;
    bool old_;
    std::uint32_t compression_;
    std::int64_t value_bytes_, stored_bytes_;
    bool half_;
    std::vector<std::int64_t> leaf_counts_;  // active values of each leaf, in the file's order
};

}  // namespace

void check_layout(const VdbHeader& header, const GridSummary& grid, std::int64_t tree_offset,
                  const SourceLocation& where) {
    ByteReader in(header.file, where);
    in.seek(tree_offset);
    LayoutWalk(in, header, grid).walk_tree();
}

void check_transform(const VdbHeader& header, const GridSummary& grid,
                     const SourceLocation& where) {
    constexpr const char* k_frustum = "NonlinearFrustumMap";
    if (grid.map_type != k_frustum) return;
    ByteReader in(header.file, where);
    in.seek(grid.transform_offset);
    in.text();                    // that name
    in.skip(8 * sizeof(double));  // its box, taper and depth
    if (in.text() == k_frustum) in.fail_damaged();
}

}  // namespace uw
