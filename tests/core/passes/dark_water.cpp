// ctest labels: unit statistical
// Dark water beside what is bright, in the fast form of multiple scattering: its noise relative to
// its own light.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/paths/fast_form.h"

namespace uw::test {
namespace {

constexpr const char* k_spot_on_a_plume = R"(
uwvdb: 1
camera: {resolution: [48, 32], intrinsics: {fov_x: 70}, pose: {position: [0.5, 0.45, 4], look_at: [1.2, 0.5, -2]}}
water: {absorption: [0.3, 0.1, 0.1], scattering: {b: [0.05, 0.05, 0.1], phase: {type: hg, g: 0.9}}}
volumes:
  - {file: ones.vdb, grids: {density: {absorption: 0.1, scattering: [1, 2, 3], phase: {type: hg, g: 0.9}}}}
lamps:
  - {name: lamp, position: [-1, 0.5, 1.5], direction: [1.5, 0, -1], intensity: 100, frame: world, profile: {type: spot, beam: 40, edge: 10}}
render: {scattering: multiple}
)";

// Two images with other random numbers differ by twice the variance of one.
TEST(DarkWater, HasLittleMoreNoiseThanItsOwnLight) {
    const SceneFolder folder;
    write_ones(folder);
    SceneDesc desc = load_scene(folder.write("scene.yaml", k_spot_on_a_plume), {});
    desc.render.quality = RenderDesc::Quality::draft;
    const LightOfImage first(desc), second = upside_down(LightOfImage(upside_down(desc)));
    constexpr int k_block = 4;
    struct Block {
        double light = 0, square = 0;
    };
    std::vector<Block> blocks;
    for (int top = 0; top < first.height; top += k_block)
        for (int left = 0; left < first.width; left += k_block) {
            double a = 0, b = 0;
            for (int y = top; y < top + k_block; ++y)
                for (int x = left; x < left + k_block; ++x) {
                    a += first.light[first.index(x, y, 1)];
                    b += second.light[first.index(x, y, 1)];
                }
            blocks.push_back({a + b, 0.5 * std::pow(2 * (a - b) / (a + b), 2)});
        }
    std::ranges::sort(blocks, {}, &Block::light);
    const auto rms = [&](std::size_t from, std::size_t to) {
        double sum = 0;
        for (std::size_t k = from; k < to; ++k) sum += blocks[k].square;
        return std::sqrt(sum / static_cast<double>(to - from));
    };
    const std::size_t third = blocks.size() / 3;
    EXPECT_LT(blocks[third / 2].light, 0.005 * blocks.back().light);
    // 15 % in the darkest third, 11 % in the brightest. If paths are measured against what is
    // typical of the image, it is 29 %.
    EXPECT_LT(rms(0, third), 0.2);
    EXPECT_LT(rms(2 * third, blocks.size()), 0.2);
}

}  // namespace
}  // namespace uw::test
