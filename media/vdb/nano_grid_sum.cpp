#include <nanovdb/NanoVDB.h>

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "core/base/parallel.h"
#include "media/vdb/nano_grid.h"

namespace uw {

double NanoGrid::stored_sum() const {
    const auto& tree = static_cast<const nanovdb::NanoGrid<nanovdb::Fp16>*>(grid_)->tree();
    const nanovdb::NanoLeaf<nanovdb::Fp16>* blocks = tree.getFirstLeaf();
    const std::size_t count = tree.nodeCount(0);
    constexpr std::size_t k_chunk = 128;
    std::vector<double> sums((count + k_chunk - 1) / k_chunk);
    parallel_for(sums.size(), [&](std::size_t chunk) {
        const std::size_t end = std::min(count, (chunk + 1) * k_chunk);
        for (std::size_t i = chunk * k_chunk; i < end; ++i) {
            const auto* block = blocks[i].data();
            // 512 codes of 16 bits do not overflow.
            const std::uint32_t codes =
                std::accumulate(std::begin(block->mCode), std::end(block->mCode), 0U);
            sums[chunk] +=
                static_cast<double>(block->mQuantum) * codes +
                static_cast<double>(block->mMinimum) * static_cast<double>(std::size(block->mCode));
        }
    });
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace uw
