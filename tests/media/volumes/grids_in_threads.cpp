// ctest labels: unit threads
// OpenVDB and NanoVDB loop over a grid's blocks with oneTBB, on whatever thread makes the grid.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <thread>
#include <vector>

#include "media/volumes/array_grid.h"

namespace uw {
namespace {

TEST(GridsInThreads, AreMadeByThreadsThatBeginAndEnd) {
    constexpr std::size_t k_side = 16;
    constexpr int k_rounds = 20, k_threads = 4;
    for (int round = 0; round < k_rounds; ++round) {
        std::vector<LoadedGrid> grids(k_threads);
        std::vector<std::thread> threads;
        for (std::size_t n = 0; n < k_threads; ++n)
            threads.emplace_back([&grid = grids[n], n] {
                // Half of the values are n + 1, the others 0.
                std::vector<float> values(k_side * k_side * k_side);
                for (std::size_t i = 0; i < values.size(); i += 2)
                    values[i] = static_cast<float>(n + 1);
                constexpr auto k_step = static_cast<std::ptrdiff_t>(k_side);
                grid = grid_of_array({.data = values.data(),
                                      .size = {k_side, k_side, k_side},
                                      .steps = {k_step * k_step, k_step, 1}},
                                     Affine{}, "grid", "here");
            });
        for (std::thread& thread : threads) thread.join();
        for (std::size_t n = 0; n < k_threads; ++n) {
            EXPECT_EQ(grids[n].statistics.active_voxels,
                      std::int64_t{k_side * k_side * k_side / 2});
            EXPECT_EQ(grids[n].statistics.max, static_cast<double>(n + 1));
            EXPECT_EQ(grids[n].bricks.size(), 1U);
        }
    }
}

}  // namespace
}  // namespace uw
