// ctest labels: unit analytic
#include "core/geometry/gltf_nodes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "core/base/error.h"
#include "core/geometry/gltf_import.h"
#include "core/geometry/gltf_reader.h"
#include "core/geometry/mesh_reader.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/meshes/vehicle_gltf.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

class GltfAnimation : public testing::Test {
  protected:
    /// A file of a camera whose `path` is animated over the times 1, 2 and 4 by `values`, with the
    /// keys of a sampler in `sampler` and what else in `parts`.
    std::filesystem::path write(const std::string& path, const std::string& sampler,
                                const std::vector<float>& values,
                                std::vector<float> times = {1, 2, 4},
                                const std::string& node = "") const {
        std::vector<float> all = times;
        all.insert(all.end(), values.begin(), values.end());
        std::string bytes(all.size() * sizeof(float), '\0');
        std::memcpy(bytes.data(), all.data(), bytes.size());
        folder_.write("m.bin", bytes);
        const std::size_t width = path == "rotation" ? 4 : 3;
        const auto number = [](std::size_t n) { return std::to_string(n); };
        return folder_.write(
            "m.gltf",
            R"({"asset":{"version":"2.0"},"nodes":[{"camera":0,"translation":[9,8,7])" + node +
                R"(}],"cameras":[{"type":"perspective","perspective":{"yfov":1}}],)"
                R"("animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":")" +
                path + R"("}}],"samplers":[{"input":0,"output":1)" + sampler +
                R"(}]}],"accessors":[{"bufferView":0,"componentType":5126,"type":"SCALAR","min":[1],)"
                R"("max":[4],"count":)" +
                number(times.size()) + R"(},{"bufferView":1,"componentType":5126,"type":"VEC)" +
                number(width) + R"(","count":)" + number(values.size() / width) +
                R"(}],"bufferViews":[{"buffer":0,"byteLength":)" + number(4 * times.size()) +
                R"(},{"buffer":0,"byteOffset":)" + number(4 * times.size()) + R"(,"byteLength":)" +
                number(4 * values.size()) + R"(}],"buffers":[{"uri":"m.bin","byteLength":)" +
                number(bytes.size()) + "}]}");
    }
    static Affine camera_at(const std::filesystem::path& file, double time) {
        return read_gltf_items(file, time).cameras.at(0).file_from_camera;
    }
    test::MeshFolder folder_;
};

void expect_near(const Vector3& found, const Vector3& expected, double tolerance) {
    EXPECT_LT(glm::length(found - expected), tolerance)
        << found.x << " " << found.y << " " << found.z;
}

/// Rows of a matrix against the map.
void expect_rows(const Affine& map, const std::array<std::array<double, 4>, 3>& rows) {
    for (std::size_t i = 0; i < 3; ++i) {
        const int row = static_cast<int>(i);
        for (int j = 0; j < 3; ++j)
            EXPECT_NEAR(map.linear()[j][row], rows[i][static_cast<std::size_t>(j)], 1e-6);
        EXPECT_NEAR(map.offset()[row], rows[i][3], 1e-6);
    }
}

// The file's numbers have single precision, of values up to 3.
TEST_F(GltfAnimation, HasThePosesOfBlender) {
    const auto file = folder_.write("vehicle.gltf", test::vehicle_gltf());
    const auto keys = gltf_keys(file);
    ASSERT_TRUE(keys);
    EXPECT_EQ(keys->range, (TimeRange{0, 0.5}));
    ASSERT_EQ(keys->times.size(), 13U);
    for (int frame = 0; frame <= 12; ++frame)
        EXPECT_NEAR(keys->times[static_cast<std::size_t>(frame)], frame / 24.0, 1e-7);
    for (const test::VehicleFrame& frame : test::k_vehicle_frames) {
        const double time = frame.frame / 24.0;
        const GltfItems items = read_gltf_items(file, time);
        expect_rows(items.cameras.at(0).file_from_camera, frame.eye);
        expect_rows(items.lights.at(0).file_from_light, frame.torch);
        std::vector<std::string> warnings;
        const MeshFile meshes = read_mesh(file, warnings, {.diffuse_meant = true, .time = time});
        EXPECT_TRUE(warnings.empty()) << warnings.front();
        ASSERT_EQ(meshes.mesh.vertex_count(), 4U);
        for (std::size_t k = 0; k < 4; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis)
                EXPECT_NEAR(double{meshes.mesh.positions[3 * k + axis]}, frame.crate[k][axis],
                            1e-6);
    }
    // Without a time the nodes are as they are written: as in frame 5, or before they move.
    expect_near(read_gltf_items(file).cameras.at(0).file_from_camera.offset(), {0.1, 1.3, 0.2},
                1e-6);
}

/// The times of these frames as a file has them.
std::vector<double> times_of(const std::vector<int>& frames, double rate) {
    std::vector<double> times;
    for (const int frame : frames) times.push_back(double{static_cast<float>(frame / rate)});
    return times;
}

TEST(GltfFrameRate, IsThatOfItsKeys) {
    std::vector<int> all;
    for (int frame = 0; frame <= 20000; ++frame) all.push_back(frame);
    for (const double rate : {12.0, 24.0, 25.0, 30.0, 50.0, 60.0, 24000 / 1001.0, 30000 / 1001.0}) {
        ASSERT_TRUE(frame_rate_of(times_of(all, rate))) << rate;
        EXPECT_NEAR(*frame_rate_of(times_of(all, rate)), rate, 1e-9);
    }
    // Few keys, but not at round times.
    EXPECT_EQ(frame_rate_of(times_of({0, 7, 24}, 24)), 24);
    EXPECT_EQ(frame_rate_of(times_of({1, 2}, 25)), 25);
    // They suit many rates, or none.
    EXPECT_EQ(frame_rate_of({0, 0.5, 2}), std::nullopt);
    EXPECT_EQ(frame_rate_of({0, 1}), std::nullopt);
    EXPECT_EQ(frame_rate_of({0}), std::nullopt);
    EXPECT_EQ(frame_rate_of({}), std::nullopt);
    EXPECT_EQ(frame_rate_of({0, 0.123, 0.777}), std::nullopt);
}

TEST(GltfFrameRate, FitsWhereKeysAreWholeFrames) {
    EXPECT_TRUE(are_whole_frames(times_of({0, 7, 13}, 24), 24));
    EXPECT_TRUE(are_whole_frames(times_of({0, 7, 13}, 24), 48));
    EXPECT_FALSE(are_whole_frames(times_of({0, 7, 13}, 24), 25));
    EXPECT_FALSE(are_whole_frames(times_of({0, 7, 13}, 24), 12));
    EXPECT_TRUE(are_whole_frames({0, 0.5, 2}, 24));
}

TEST_F(GltfAnimation, InterpolatesLinearly) {
    const auto file = write("translation", "", {0, 0, 0, 2, 4, 6, 2, 0, -2});
    expect_near(camera_at(file, 1.25).offset(), {0.5, 1, 1.5}, 1e-14);
    expect_near(camera_at(file, 3).offset(), {2, 2, 2}, 1e-14);
    // Held before the first and after the last key.
    expect_near(camera_at(file, 0).offset(), {0, 0, 0}, 1e-14);
    expect_near(camera_at(file, 9).offset(), {2, 0, -2}, 1e-14);
}

TEST_F(GltfAnimation, Steps) {
    const auto file =
        write("translation", R"(,"interpolation":"STEP")", {0, 0, 0, 2, 4, 6, 2, 0, -2});
    expect_near(camera_at(file, 1.99).offset(), {0, 0, 0}, 1e-14);
    expect_near(camera_at(file, 2).offset(), {2, 4, 6}, 1e-14);
    expect_near(camera_at(file, 3.99).offset(), {2, 4, 6}, 1e-14);
    expect_near(camera_at(file, 4).offset(), {2, 0, -2}, 1e-14);
}

// Keys of t^3, 3 t^2 - 1 and 5 - t, whose tangents are their derivatives: a cubic Hermite curve is
// exact.
TEST_F(GltfAnimation, FollowsCubicSplines) {
    std::vector<float> values;
    for (const float t : {1.0F, 2.0F, 4.0F})
        for (const int part : {0, 1, 2})
            for (const float v : part == 1 ? std::array{t * t * t, 3 * t * t - 1, 5 - t}
                                           : std::array{3 * t * t, 6 * t, -1.0F})
                values.push_back(v);
    const auto file = write("translation", R"(,"interpolation":"CUBICSPLINE")", values);
    for (const double t : {1.0, 1.3, 2.0, 3.7, 4.0})
        expect_near(camera_at(file, t).offset(), {t * t * t, 3 * t * t - 1, 5 - t}, 1e-12);
}

// Turns of 0, 90 and, the longer way round in its quaternion, -90 degrees about y.
TEST_F(GltfAnimation, TurnsTheShorterWayRoundAtASteadyRate) {
    const auto r = static_cast<float>(std::numbers::sqrt2 / 2);
    const auto file = write("rotation", "", {0, 0, 0, 1, 0, r, 0, r, 0, r, 0, -r});
    const auto ahead = [&](double time) {
        return camera_at(file, time).apply_to_vector({0, 0, -1});
    };
    const double angle = std::numbers::pi / 2 * 0.2;
    // The numbers r are single.
    expect_near(ahead(1.2), {-std::sin(angle), 0, -std::cos(angle)}, 1e-7);
    expect_near(camera_at(file, 1.2).offset(), {9, 8, 7}, 1e-14);
}

TEST_F(GltfAnimation, SeveralMoveTogetherAndTheFirstOfRivalsDoes) {
    const std::string text = test::vehicle_gltf();
    // The crate's channels once more, as those of the vehicle.
    const std::string::size_type at = text.find("\"name\":\"CrateAction\"");
    ASSERT_NE(at, std::string::npos);
    std::string rivals = text;
    const std::string::size_type channels = rivals.find("\"node\":3,\"path\":\"translation\"");
    ASSERT_NE(channels, std::string::npos);
    rivals.replace(channels, 8, "\"node\":2");
    const auto file = folder_.write("rivals.gltf", rivals);
    expect_rows(read_gltf_items(file, 12 / 24.0).cameras.at(0).file_from_camera,
                test::k_vehicle_frames.back().eye);
}

TEST_F(GltfAnimation, RefusesWhatIsDamaged) {
    const auto refused = [&](const std::filesystem::path& file, const std::string& what) {
        const std::string message = test::message_of<InputError>([&] { camera_at(file, 2); });
        EXPECT_NE(message.find(what), std::string::npos) << message;
    };
    const std::vector<float> fine{0, 0, 0, 2, 4, 6, 2, 0, -2};
    refused(write("translation", "", {0, 0, 0}), "not as many values as times");
    refused(write("translation", R"(,"interpolation":"CUBICSPLINE")", fine),
            "not as many values as times");
    refused(write("translation", R"(,"interpolation":"QUINTIC")", fine), "unknown interpolation");
    refused(write("translation", "", fine, {1, 1, 2}), "do not ascend");
    refused(write("translation", "", fine, {1, NAN, 2}), "not finite");
    refused(write("translation", "", {0, 0, 0, 2, INFINITY, 6, 2, 0, -2}), "not finite");
    refused(write("rotation", "", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}), "rotation is zero");
    refused(
        write("translation", "", fine, {1, 2, 4}, R"(,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1])"),
        "a matrix is animated");
    std::string text = test::vehicle_gltf();
    text.replace(text.find("\"output\":3"), 10, "\"output\":4");
    refused(folder_.write("misfit.gltf", text), "do not fit what it moves");
}

}  // namespace
}  // namespace uw
