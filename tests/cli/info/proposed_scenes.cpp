// ctest labels: slow
//
// What `uwvdb info FILE --scene` prints, rendered as it is: the plume is plain to see in it, and
// not black, for all files of other programs and for whatever else OpenVDB can write.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>

#include "tests/support/cli_test.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw {
namespace {

constexpr int k_width = 192, k_height = 108;

double percentile(std::vector<double> values, double share) {
    std::ranges::sort(values);
    return values.at(static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

class ProposedScenes : public test::CliTest {
  protected:
    test::ImageFile render(const std::string& scene, const std::vector<std::string>& more) const {
        std::vector<std::string> arguments{"render", scene,     "-o",          "out.exr",
                                           "--size", "192x108", "--precision", "float"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const test::ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return test::read_exr(folder_ / "out.exr");
    }

    /// Prints the scene of `file`, renders it with and without its volume, at final quality, and
    /// compares: the contrast as the documentation defines it, over the part of the picture that
    /// changes.
    void expect_plain_to_see(const std::filesystem::path& file,
                             const std::vector<std::string>& more = {}) const {
        SCOPED_TRACE(file.filename());
        const test::ProgramResult printed = run({"info", file.string(), "--scene"});
        ASSERT_EQ(printed.exit_code, 0) << printed.err;
        write("with.yaml", printed.out);
        write("without.yaml", printed.out.substr(0, printed.out.find("\nvolumes:") + 1));
        const test::ImageFile with = render("with.yaml", more),
                              without = render("without.yaml", {});
        test::expect_finite_and_lit(with);
        const auto light = [](const test::ImageFile& image, int x, int y) {
            return 0.2126 * image.at("R", x, y) + 0.7152 * image.at("G", x, y) +
                   0.0722 * image.at("B", x, y);
        };
        double mean = 0;
        for (int y = 0; y < k_height; ++y)
            for (int x = 0; x < k_width; ++x) mean += light(without, x, y) / (k_width * k_height);
        std::vector<double> contrasts, lit, all;
        for (int y = 0; y < k_height; ++y)
            for (int x = 0; x < k_width; ++x) {
                const double before = light(without, x, y), after = light(with, x, y);
                const double contrast = std::abs(after - before) / std::max(before, mean);
                all.push_back(after);
                if (contrast < 0.05) continue;
                contrasts.push_back(contrast);
                lit.push_back(after);
            }
        ASSERT_FALSE(contrasts.empty());
        EXPECT_GE(percentile(contrasts, 0.99), 0.3);
        // A preview shows the 99th percentile as 0.8: this as no less than a dark grey.
        EXPECT_GE(percentile(lit, 0.5), 0.02 * percentile(all, 0.99));
    }

    /// A grid of one value or another in the voxels 0..max.
    std::filesystem::path fixture(const std::array<int, 3>& max, double voxel,
                                  const std::function<double(int, int, int)>& value,
                                  const Vector3& place = Vector3(0)) const {
        test::VdbFixture grid;
        grid.max = max;
        grid.value = value;
        grid.file_from_index = Affine(Matrix3(voxel), place);
        test::write_fixture(folder_ / "made.vdb", {grid});
        return "made.vdb";
    }
};

double ball(int i, int j, int k) {
    const double r = std::hypot(i - 16, j - 16, k - 16) / 16;
    return r < 1 ? (1 - r * r) * (0.7 + 0.3 * std::sin(i) * std::sin(0.7 * j)) : 0;
}

TEST_F(ProposedScenes, ShowTheProjectsPlume) {
    const std::string plume = UWVDB_SOURCE_DIR "/assets/grids/plume128_blosc_half_0030.vdb";
    expect_plain_to_see(plume);
    const test::ProgramResult result = run({"info", plume, "--picture", "thumbnail.png"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(read("thumbnail.png").starts_with("\x89PNG"));
}

TEST_F(ProposedScenes, ShowAnySizePlaceAndValue) {
    for (const double voxel : {2e-3, 0.05, 0.25, 1.0, 250.0})
        expect_plain_to_see(fixture({32, 32, 32}, voxel, ball));
    expect_plain_to_see(fixture({32, 32, 32}, 0.05, ball, {652000, 12, 5300000}));
    for (const double amplitude : {1e-6, 1e6})
        expect_plain_to_see(fixture(
            {32, 32, 32}, 0.05, [&](int i, int j, int k) { return amplitude * ball(i, j, k); }));
}

TEST_F(ProposedScenes, ShowWhatIsThinOrSparseOrUneven) {
    const auto one = [](int, int, int) { return 1.0; };
    expect_plain_to_see(fixture({60, 40, 0}, 0.03, one));
    expect_plain_to_see(fixture({60, 0, 40}, 0.03, one));
    expect_plain_to_see(fixture({4, 4, 120}, 0.01, one));
    expect_plain_to_see(fixture({0, 0, 0}, 0.1, one));
    expect_plain_to_see(fixture({32, 32, 32}, 0.05, one));
    expect_plain_to_see(fixture({300, 40, 40}, 0.01, [](int i, int j, int k) {
        const bool is_on = j == std::lround(20 + 20 * std::sin(0.05 * i)) &&
                           k == std::lround(20 + 20 * std::cos(0.05 * i));
        return is_on ? 1.0 : 0.0;
    }));
    expect_plain_to_see(fixture({30, 30, 30}, 0.05, [](int i, int j, int k) {
        return i == 15 && j == 15 && k == 15 ? 1.0 : 0.001;
    }));
}

TEST_F(ProposedScenes, ShowTheFilesOfOtherPrograms) {
    const char* const folder = std::getenv("UWVDB_SAMPLES");
    if (folder == nullptr) GTEST_SKIP() << "UWVDB_SAMPLES is not set";
    int shown = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".vdb") continue;
        // Level sets, points and vectors, which info_samples.cpp is about.
        const std::string name = entry.path().stem().string();
        if (name == "arnold_pointgrid" || name == "oiio_sphereCd" ||
            name == "openvdb_sphere_houdini")
            continue;
        expect_plain_to_see(entry.path());
        ++shown;
    }
    EXPECT_EQ(shown, 14);
    // All frames of a sequence by one scene.
    const std::string frames = std::string(folder) + "/blender_adaptive_domain/fluid_data_####.vdb";
    for (const char* frame : {"5", "12", "20"}) expect_plain_to_see(frames, {"--frames", frame});
}

}  // namespace
}  // namespace uw
