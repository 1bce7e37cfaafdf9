// ctest labels: statistical slow
// The fast form of multiple scattering against light paths, band by band and block by block, where
// water that scatters and water that does not lie behind one another, and where surfaces emit.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "tests/support/paths/fast_form.h"

namespace uw::test {
namespace {

struct Layered {
    const char* name;
    const char* b;  // of the water around [1/m]
    int width, height;
};

std::ostream& operator<<(std::ostream& out, const Layered& layered) {
    return out << layered.name << ", b = " << layered.b << ", " << layered.width << " x "
               << layered.height;
}

constexpr const char* k_plume = R"(
volumes:
  - {file: ones.vdb, grids: {density: {absorption: 0.1, scattering: [1, 2, 3], phase: {type: hg, g: 0}}}}
)";
constexpr const char* k_two_plumes = R"(
  - {file: ones.vdb, transform: {translate: [0, 0, 2]}, grids: {density: {absorption: 0.1, scattering: [0.5, 0.7, 1], phase: {type: hg, g: 0.5}}}}
geometry:
  - {type: plane, point: [0, 0, -1], normal: [0, 0, 1], reflectance: 0.5}
)";
constexpr const char* k_ground = R"(
geometry:
  - {type: plane, point: [0, 0, -1], normal: [0, 0, 1], reflectance: 0.5}
)";

class LayersOfWater : public testing::TestWithParam<Layered> {
  protected:
    LayersOfWater() {
        write_ones(folder_);
        folder_.write("below.csv",
                      fmt::format("depth_m,absorption,scattering\n0,0.1,{0}\n2,0.1,{0}\n"
                                  "2.2,0.1,1\n50,0.1,1\n",
                                  GetParam().b));
        folder_.write("above.csv", fmt::format("depth_m,absorption,scattering\n0,0.1,1\n1.5,0.1,1\n"
                                               "1.7,0.1,{0}\n50,0.1,{0}\n",
                                               GetParam().b));
    }

    SceneDesc scene() const {
        const std::string name = GetParam().name;
        const bool is_profile = name == "clear above" || name == "clear below";
        std::string text = fmt::format(
            "uwvdb: 1\nwater: {{absorption: 0.1, scattering: {{b: {}, phase: {{type: hg, g: "
            "0}}}}}}\n",
            GetParam().b);
        if (is_profile)
            text = fmt::format(
                "uwvdb: 1\nwater: {{surface: {{point: [0, 0, 2], normal: [0, 0, 1]}}, profile: "
                "{}.csv, scattering: {{phase: {{type: hg, g: 0}}}}}}\n",
                name == "clear above" ? "below" : "above");
        // Of the water every pixel sees one ray: silhouettes are as coarse as the pixels, and so
        // plumes fill small images.
        const bool is_small = GetParam().width < 10;
        const double camera_z = name == "within" ? 0.8 : is_profile ? 1 : is_small ? 1.9 : 4;
        text += fmt::format(
            "camera: {{resolution: [{}, {}], intrinsics: {{fov_x: 50}}, pose: {{position: [0.5, "
            "0.45, {}], look_at: [0.5, 0.5, -2]}}}}\n"
            "lamps:\n  - {{name: lamp, position: [1.6, 0.5, {}], intensity: 100, frame: world}}\n",
            GetParam().width, GetParam().height, camera_z, is_profile ? 0.7 : 1.5);
        if (!is_profile) text += k_plume;
        if (name == "two plumes")
            text += k_two_plumes;
        else if (name != "plume")
            text += k_ground;
        text += "render: {scattering: multiple, samples: 4}\n";
        SceneDesc desc = load_scene(folder_.write("scene.yaml", text), {});
        desc.render.quality = RenderDesc::Quality::draft;
        return desc;
    }

    SceneFolder folder_;
};

// Of light paths each block has an error of some per cent, which is independent; so that the mean
// of the squares is about 1 if the errors are what they are said to be, and less where they are
// more.
TEST_P(LayersOfWater, HaveTheLightOfPathsWithinTheErrorsOfBoth) {
    SceneDesc desc = scene();
    const LightOfImage fast(desc);
    desc.render.integrator = RenderDesc::Integrator::path;
    desc.render.samples = GetParam().width < 10 ? 1024 : 128;
    const LightOfImage paths(desc);
    // The light between the nodes and the rays of a draft.
    const FastFormDeviations deviations(fast, paths, GetParam().width / 4, 0.01);
    for (std::size_t b = 0; b < fast.bands; ++b) {
        std::cout << "band " << b << ": mean square " << deviations.mean_square(b) << ", greatest "
                  << deviations.greatest(b) << ", mean " << deviations.of_mean[b] << ", stated "
                  << fast.stated_of_bands[b] << "\n";
        EXPECT_LT(deviations.mean_square(b), 3);
        EXPECT_LT(deviations.greatest(b), 5);
        // Nor is there less or more in all than the image states, but for a little at edges.
        EXPECT_LT(std::abs(deviations.of_mean[b]), 0.01 + 1.5 * fast.stated_of_bands[b]);
    }
}

constexpr std::array k_layered{
    Layered{"plume", "0", 8, 6},           Layered{"plume", "1e-6", 8, 6},
    Layered{"plume", "1e-3", 8, 6},        Layered{"plume", "0", 32, 24},
    Layered{"plume", "1e-6", 32, 24},      Layered{"two plumes", "0", 8, 6},
    Layered{"two plumes", "1e-6", 32, 24}, Layered{"two plumes", "0", 32, 24},
    Layered{"within", "0", 8, 6},          Layered{"within", "1e-6", 32, 24},
    Layered{"within", "1e-3", 32, 24},     Layered{"clear above", "0", 8, 6},
    Layered{"clear above", "0", 32, 24},   Layered{"clear above", "1e-6", 32, 24},
    Layered{"clear below", "0", 8, 6},     Layered{"clear below", "0", 32, 24},
    Layered{"clear below", "1e-3", 32, 24}};
INSTANTIATE_TEST_SUITE_P(, LayersOfWater, testing::ValuesIn(k_layered));

/// Scenes whose light varies much within an image, or that only surfaces light.
class StatedErrors : public testing::TestWithParam<const char*> {
  protected:
    StatedErrors() {
        write_ones(folder_);
        folder_.write("wall.mtl", "newmtl e\nKd 0 0 0\nKe 1 1 1\n");
        folder_.write("wall.obj",
                      "mtllib wall.mtl\nusemtl e\nv -200 -200 3\nv 200 -200 3\nv 200 200 3\n"
                      "v -200 200 3\nf 1 2 3 4\n");
    }

    SceneDesc scene(const std::string& text) const {
        return load_scene(folder_.write("scene.yaml", text + "render: {scattering: multiple}\n"),
                          {});
    }

    SceneFolder folder_;
};

constexpr const char* k_emissive_wall = R"(
uwvdb: 1
camera: {resolution: [32, 24], intrinsics: {fov_x: 30}}
water: {absorption: [0.2, 1, 5], scattering: {b: [0.3, 0.5, 1], phase: {type: hg, g: 0.5}}}
geometry:
  - {file: wall.obj}
)";
constexpr const char* k_two_spots = R"(
uwvdb: 1
camera: {resolution: [48, 32], intrinsics: {fov_x: 50}, pose: {position: [0, -6, 2.5], look_at: [0.8, 0.4, 1.3], up: [0, 0, 1]}}
water: {preset: jerlov-II}
geometry:
  - {type: plane, point: [0, 0, 0], normal: [0, 0, 1], reflectance: 0.5}
lamps:
  - {name: a, position: [-2.2, -3, 3.2], direction: [3, 3.4, -2], frame: world, profile: {type: spot, beam: 80, edge: 12}, intensity: 120}
  - {name: b, position: [3, 3, 2.5], direction: [-2.2, -2.6, -1.3], frame: world, profile: {type: spot, beam: 80, edge: 12}, intensity: 64}
)";
constexpr const char* k_plume_in_haze = R"(
uwvdb: 1
camera: {resolution: [48, 32], intrinsics: {fov_x: 50}, pose: {position: [0.5, 0.45, 4], look_at: [0.5, 0.5, -2]}}
water: {absorption: [0.3, 0.1, 0.1], scattering: {b: [0.2, 0.2, 0.3], phase: {type: hg, g: 0.8}}}
volumes:
  - {file: ones.vdb, grids: {density: {absorption: 0.1, scattering: [1, 2, 3], phase: {type: hg, g: 0.8}}}}
geometry:
  - {type: plane, point: [0, 0, -1], normal: [0, 0, 1], reflectance: 0.5}
lamps:
  - {name: lamp, position: [1.6, 0.5, 1.5], intensity: 100, frame: world}
)";

// Two images with other random numbers deviate from that of light paths by about as much as they
// say, everywhere: over the darkest third of the blocks, over the brightest and over all of them.
// Errors of neighbouring blocks are alike, so that the mean of a third is good to a factor of two.
// What the halves of the estimates show is more than what is wrong where neighbouring nodes were
// smoothed alike; less than half the error stated is not tolerated.
TEST_P(StatedErrors, AreThoseOfTheDeviationsFromLightPaths) {
    SceneDesc desc = scene(GetParam());
    const LightOfImage first(desc), second = upside_down(LightOfImage(upside_down(desc)));
    desc.render.integrator = RenderDesc::Integrator::path;
    desc.render.samples = 256;
    const LightOfImage paths(desc);
    const FastFormDeviations a(first, paths, 4, 0), b(second, paths, 4, 0);
    for (std::size_t band = 0; band < first.bands; ++band) {
        const auto mean = [&](double from, double to) {
            return 0.5 * (a.mean_square(band, from, to) + b.mean_square(band, from, to));
        };
        std::cout << "band " << band << ": dark " << mean(0, 1.0 / 3) << ", bright "
                  << mean(2.0 / 3, 1) << ", all " << mean(0, 1) << ", stated "
                  << first.stated_of_bands[band] << "\n";
        EXPECT_LT(mean(0, 1), 2);
        EXPECT_GT(mean(0, 1), 0.25);
        for (const double from : {0.0, 2.0 / 3}) EXPECT_LT(mean(from, from + 1.0 / 3), 3);
        // The error of the image is that of its pixels.
        double squares = 0;
        for (std::size_t k = band; k < first.error.size(); k += first.bands)
            squares += first.error[k] * first.error[k];
        squares /= static_cast<double>(first.width * first.height);
        EXPECT_NEAR(first.stated_of_bands[band], std::sqrt(squares) / first.total[band],
                    1e-4 * first.stated_of_bands[band]);  // floats
    }
}

// Squares of a tenth of the height, each relative to its own light by band, or to a hundredth of
// the image's mean.
TEST_P(StatedErrors, OfPartsAreRelativeToTheirLight) {
    const LightOfImage image(scene(GetParam()));
    const int side = image.height / 10;
    double sum = 0, worst = 0;
    int parts = 0;
    for (int y0 = 0; y0 < image.height; y0 += side) {
        for (int x0 = 0; x0 < image.width; x0 += side) {
            double of_part = 0;
            for (std::size_t band = 0; band < image.bands; ++band) {
                double light = 0, squares = 0, pixels = 0;
                for (int y = y0; y < std::min(y0 + side, image.height); ++y)
                    for (int x = x0; x < std::min(x0 + side, image.width); ++x) {
                        light += image.all[image.index(x, y, band)];
                        squares += std::pow(image.error[image.index(x, y, band)], 2);
                        ++pixels;
                    }
                const double mean = std::max(light / pixels, 0.01 * image.total[band]);
                of_part += squares / pixels / (mean * mean) / static_cast<double>(image.bands);
            }
            sum += of_part;
            worst = std::max(worst, of_part);
            ++parts;
        }
    }
    // Floats.
    EXPECT_NEAR(image.stated_of_parts, std::sqrt(sum / parts), 1e-4 * image.stated_of_parts);
    EXPECT_NEAR(image.stated_of_worst_part, std::sqrt(worst), 1e-4 * image.stated_of_worst_part);
}

INSTANTIATE_TEST_SUITE_P(, StatedErrors,
                         testing::Values(k_emissive_wall, k_two_spots, k_plume_in_haze));

}  // namespace
}  // namespace uw::test
