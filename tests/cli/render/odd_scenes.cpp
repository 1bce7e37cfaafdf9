// ctest labels: unit slow
#include <gtest/gtest.h>

#include "tests/support/cli_test.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw {
namespace {

using test::ImageFile;

class OddScenes : public test::CliTest {
  protected:
    OddScenes() {
        // A cloud of 1 m about (0, 0, 2.2), denser in its middle.
        test::VdbFixture cloud;
        cloud.min = {-10, -10, -10};
        cloud.max = {10, 10, 10};
        cloud.value = [](int i, int j, int k) { return std::exp(-(i * i + j * j + k * k) / 30.0); };
        cloud.file_from_index = Affine::translation({0, 0, 2.2}) * Affine::scale(Vector3(0.05));
        test::write_fixture(folder_ / "cloud.vdb", {cloud});
        write("cloud.yaml", std::string(test::k_small_scene) +
                                "volumes: [{file: cloud.vdb, grids: {density: {large: 5}}}]\n");
    }

    // Renders with both integrators; both are finite and agree on the image's mean.
    ImageFile expect_agreement(const std::string& scene, std::vector<std::string> more,
                               double tolerance) const {
        more.insert(more.begin(),
                    {"render", scene, "-o", "out.exr", "--samples", "1", "--layers", "all"});
        std::vector<ImageFile> images;
        for (const char* integrator : {"reference", "volume"}) {
            std::vector<std::string> arguments = more;
            arguments.insert(arguments.end(), {"--integrator", integrator});
            const test::ProgramResult result = run(arguments);
            EXPECT_EQ(result.exit_code, 0) << result.err;
            images.push_back(test::read_exr(folder_ / "out.exr"));
            test::expect_finite_and_lit(images.back());
        }
        for (const char* band : {"R", "G", "B"}) {
            double reference = 0, volume = 0;
            for (const float value : images[0].channels.at(band)) reference += double(value);
            for (const float value : images[1].channels.at(band)) volume += double(value);
            EXPECT_NEAR(volume, reference, tolerance * reference) << band;
        }
        return images[1];
    }
};

// Both integrate to a part in a thousand; a deep shadow map's column map adds as much again where
// its texels are as wide as the voxels of a cloud.
constexpr double k_uniform = 1e-3, k_through_cloud = 5e-3;
// A pixel that looks at a lamp has nearly all of the image's light from the last millimetres before
// it, and the reference's samples do not end where a lamp's sphere begins.
constexpr double k_lamp_in_view = 3e-3;

TEST_F(OddScenes, LampAndCameraInPlacesThatDivideByZero) {
    expect_agreement("scene.yaml", {"--set", "lamps.left.position=[0, 0, 0]"}, k_uniform);
    expect_agreement("scene.yaml", {"--set", "lamps.left.position=[0, 0, 1.0]"}, k_lamp_in_view);
    expect_agreement("scene.yaml",
                     {"--set", "lamps=[{position: [0, 0, 1.5], intensity: 50}]", "--set",
                      "geometry=[{type: plane, point: [0, 0, 4], normal: [0, 0, -1]}]"},
                     k_lamp_in_view);
}

TEST_F(OddScenes, CameraAndLampInsideAClosedBox) {
    const ImageFile image = expect_agreement(
        "scene.yaml", {"--set", "geometry=[{type: box, min: [-1, -1, -1], max: [1, 1, 1]}]"},
        k_uniform);
    for (const float id : image.channels.at("id.V")) ASSERT_EQ(id, 1);
    EXPECT_NEAR(image.at("depth.Z", 16, 9), 1, 1e-6);
}

TEST_F(OddScenes, NothingToBeSeenButWater) {
    const ImageFile image = expect_agreement("scene.yaml", {"--set", "geometry=[]"}, k_uniform);
    for (const float alpha : image.channels.at("A")) ASSERT_EQ(alpha, 1);
    for (const float direct : image.channels.at("direct.G")) ASSERT_EQ(direct, 0);
    for (const float depth : image.channels.at("depth.Z")) ASSERT_EQ(depth, 0);
}

TEST_F(OddScenes, WaterThatDoesNothing) {
    const std::string clear = "water={absorption: 0, scattering: {b: 0, phase: {type: hg, g: 0}}}";
    const ImageFile image = expect_agreement("scene.yaml", {"--set", clear}, 1e-6);
    EXPECT_EQ(image.channels.at("R"), image.channels.at("clean.R"));
    for (const float value : image.channels.at("backscatter.R")) ASSERT_EQ(value, 0);
    // Light without end: rays that meet nothing, in water that takes nothing away.
    expect_agreement("scene.yaml",
                     {"--set", "geometry=[]", "--set",
                      "water={absorption: 0, scattering: {b: 0.1, phase: {type: hg, g: 0.5}}}"},
                     0.02);  // the reference stops where the fast one goes on to infinity
}

TEST_F(OddScenes, SlabsThatHoldHardlyAnyLight) {
    const ImageFile image = render({"--samples", "1", "--layers", "backscatter_first", "--set",
                                    "render.planes={near: 3.9999999, far: 4}"});
    for (const char* band : {"R", "G", "B"})
        for (const float value : image.channels.at(std::string("backscatter_first.") + band))
            ASSERT_GE(value, 0) << band;
}

TEST_F(OddScenes, CameraOrLampInsideTheCloud) {
    expect_agreement("cloud.yaml", {}, k_through_cloud);
    expect_agreement(
        "cloud.yaml",
        {"--set", "camera.pose.position=[0, 0, 2]", "--set", "camera.pose.look_at=[0, 0, 3]"},
        k_through_cloud);
    expect_agreement("cloud.yaml", {"--set", "lamps=[{position: [0.1, 0.1, 2.3], intensity: 50}]"},
                     k_through_cloud);
}

TEST_F(OddScenes, CloudsOutOfReachChangeNothing) {
    const ImageFile without = render({"--samples", "1"});
    for (const char* transform :
         {"{translate: [0, 0, 1e5]}", "{translate: [1e5, 0, -3]}", "{scale: 1e-7}"}) {
        const ImageFile image = expect_agreement(
            "cloud.yaml", {"--set", std::string("volumes[0].transform=") + transform}, k_uniform);
        for (int y = 0; y < 19; ++y)
            for (int x = 0; x < 33; ++x)
                ASSERT_NEAR(image.at("G", x, y), without.at("G", x, y),
                            1e-3 * without.at("G", x, y))
                    << transform;
    }
}

TEST_F(OddScenes, OpaqueCloudsAndManyBands) {
    expect_agreement("cloud.yaml", {"--set", "volumes[0].grids.density.large=1e5"},
                     k_through_cloud);
    std::string bands;
    for (int i = 0; i < 32; ++i) bands += (i == 0 ? "" : ", ") + std::to_string(400 + 9 * i);
    const ImageFile many =
        render({"--set", "water={bands: [" + bands + "]}", "--set", "lamps.left.intensity=50",
                "--set", "geometry[1].reflectance=0.5", "--layers", "all"});
    EXPECT_EQ(many.names.size(), 4U + 10 * 32 + 12 + 32);
    for (const auto& [name, values] : many.channels)
        for (const float value : values) ASSERT_TRUE(std::isfinite(value)) << name;
}

TEST_F(OddScenes, LensesAtTheirLimits) {
    // Rays that just pass the lamp across the edge of its cone, where the reference is uncertain.
    expect_agreement("scene.yaml", {"--set", "camera.intrinsics={fov_x: 179.9}"}, 3 * k_uniform);
    expect_agreement("scene.yaml", {"--set", "camera.intrinsics={fx: 1e7}"}, k_uniform);
    expect_agreement("scene.yaml",
                     {"--set",
                      "camera.port={distance: 0, thickness: 0, n_air: 1, n_glass: 1, "
                      "n_water: 1}"},
                     k_uniform);
    expect_agreement("scene.yaml",
                     {"--set", "camera.port={normal: [1, 0, 0.2], distance: 0.1, thickness: 0.1}"},
                     k_uniform);
    expect_failure({"render", "scene.yaml", "--set", "camera.port={normal: [0, 0, -1]}"}, 3,
                   "camera.port.normal: must point away from the camera");
}

}  // namespace
}  // namespace uw
