#include <algorithm>
#include <array>
#include <cstring>
#include <vector>

#include "tests/fuzz/volume_fuzzing.h"
#include "tests/support/file_bytes.h"
#include "tests/support/vdb/vdb_fixtures.h"

// A file of NanoVDB; or "patch", a byte that chooses a kind of numbers, and changes of a whole file
// of that kind. The nodes of even the smallest grid take 300 kB, nearly all of it zero: changes
// name only places where something is.
namespace {

constexpr std::string_view k_patch = "patch";
constexpr std::array k_precisions{"float", "fp4", "fp8", "fp16", "fpN"};
constexpr std::size_t k_block = 16;  // bytes

/// A whole file, and its blocks that are not all zero.
struct Base {
    std::string bytes;
    std::vector<std::size_t> blocks;
};

Base make_base(const uw::fuzz::InputFolder& folder, const char* precision) {
    uw::test::VdbFixture blob;  // across a corner of leaves
    blob.min = {6, 6, 6};
    blob.max = {9, 9, 9};
    blob.value = [](int i, int j, int k) { return 0.1 * (i + 2 * j + 3 * k); };
    blob.boxes = {{{16, 0, 0}, {23, 7, 7}, 0.5}};
    const std::filesystem::path file = folder.write("base.nvdb", "");
    uw::test::write_nvdb_fixture(file, blob, precision);
    Base base{uw::test::file_bytes(file), {}};
    // Without a checksum, which no change would leave true.
    const std::size_t grid = base.bytes.rfind("NanoVDB0");
    std::fill_n(base.bytes.begin() + static_cast<std::ptrdiff_t>(grid + 8), 8, '\0');
    const std::string_view bytes = base.bytes;
    for (std::size_t at = 0; at < bytes.size(); at += k_block)
        if (bytes.substr(at, k_block).find_first_not_of('\0') != bytes.npos)
            base.blocks.push_back(at);
    return base;
}

/// Each change: the number of a block in two bytes; a byte whose halves are the first byte in the
/// block and the number of bytes less 1; those bytes.
std::string patched(const Base& base, std::string_view changes) {
    std::string bytes = base.bytes;
    const auto byte = [&](std::size_t at) {
        return std::size_t{static_cast<unsigned char>(changes[at])};
    };
    while (changes.size() > 3) {
        const std::size_t block = base.blocks[(byte(0) + 256 * byte(1)) % base.blocks.size()];
        const std::size_t at = std::min(block + byte(2) % 16, bytes.size());
        const std::size_t count =
            std::min({byte(2) / 16 + 1, changes.size() - 3, bytes.size() - at});
        std::memcpy(bytes.data() + at, changes.data() + 3, count);
        changes.remove_prefix(3 + count);
    }
    return bytes;
}

}  // namespace

UWVDB_FUZZ(data, size) {
    using namespace uw;
    static const fuzz::InputFolder folder;
    static const auto bases = [] {
        std::array<Base, k_precisions.size()> all;
        std::ranges::transform(k_precisions, all.begin(),
                               [](const char* kind) { return make_base(folder, kind); });
        return all;
    }();
    std::string_view text = fuzz::text_of(data, size);
    if (text.starts_with(k_patch) && text.size() > k_patch.size()) {
        const auto kind = static_cast<unsigned char>(text[k_patch.size()]);
        fuzz::read_volume_file(folder.write(
            "volume.nvdb", patched(bases[kind % bases.size()], text.substr(k_patch.size() + 1))));
    } else {
        fuzz::read_volume_file(folder.write("volume.nvdb", text));
    }
    return 0;
}
