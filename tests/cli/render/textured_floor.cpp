// ctest labels: statistical
// A floor with a fine texture, near and far: few samples against very many.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "tests/support/cli_test.h"
#include "tests/support/image_file.h"

namespace uw {
namespace {

class TexturedFloor : public test::CliTest {
  protected:
    TexturedFloor() {
        write("floor.obj",
              "mtllib floor.mtl\nv -20 1 0.5\nv 20 1 0.5\nv 20 1 40.5\nv -20 1 40.5\n"
              "vt 0 0\nvt 4 0\nvt 4 4\nvt 0 4\nusemtl mosaic\nf 1/1 2/2 3/3 4/4\n");
        write("floor.mtl", "newmtl mosaic\nKd 1 1 1\nmap_Kd mosaic.png\n");
        constexpr int k_size = 512;
        std::mt19937 random(1);
        std::vector<int> values;
        for (int i = 0; i < k_size * k_size; ++i)
            values.insert(values.end(), 3, static_cast<int>(random() % 256));
        write("mosaic.png", test::encoded_image("png", k_size, k_size, 3, values));
        write("scene.yaml",
              "uwvdb: 1\ncamera:\n  resolution: [96, 54]\n  intrinsics: {fov_x: 60}\n"
              "  pose: {position: [0, 0, 0], look_at: [0, 0.25, 1], up: [0, -1, 0]}\n"
              "water: {absorption: [0.03, 0.03, 0.03], scattering: {b: [0, 0, 0], phase: {type: "
              "hg, g: 0.9}},\n  surface: {point: [0, -10, 0], normal: [0, -1, 0]}}\n"
              "geometry: [{file: floor.obj}]\n"
              "lamps: [{name: sun, type: sun, direction: [0, 1, 0.2], irradiance: [9, 9, 9]}]\n");
    }
    std::vector<float> green(int samples) const {
        return render({"--samples", std::to_string(samples), "--layers", "default", "--precision",
                       "float"})
            .channels.at("G");
    }
};

TEST_F(TexturedFloor, IsItsMeanOverEachPixel) {
    const std::vector<float> truth = green(1024);
    for (const int samples : {1, 4}) {
        const std::vector<float> image = green(samples);
        double square = 0, off = 0;
        int pixels = 0;
        for (std::size_t i = 0; i < image.size(); ++i) {
            if (truth[i] <= 0) continue;  // above the horizon
            const auto t = static_cast<double>(truth[i]);
            square += t * t;
            off += (static_cast<double>(image[i]) - t) * (static_cast<double>(image[i]) - t);
            ++pixels;
        }
        ASSERT_GT(pixels, 96 * 54 / 2);
        // Looked up at points it was 53 % with one sample, and 21 % with four.
        EXPECT_LT(std::sqrt(off / square), 0.12) << samples;
    }
}

}  // namespace
}  // namespace uw
