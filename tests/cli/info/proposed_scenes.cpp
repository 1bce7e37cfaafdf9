// ctest labels: slow
//
// The scene that `uwvdb info FILE` proposes, rendered as it is: the plume is plain to see in it, as
// plain as the command says, and not black, for all files of other programs and for whatever else
// OpenVDB can write.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>

#include "tests/support/cli_test.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw {
namespace {

constexpr int k_width = 480, k_height = 270;  // those of --picture

double percentile(std::vector<double> values, double share) {
    std::ranges::sort(values);
    return values.at(static_cast<std::size_t>(share * static_cast<double>(values.size() - 1)));
}

double luminance_at(const test::ImageFile& image, int x, int y) {
    return 0.2126 * double(image.at("R", x, y)) + 0.7152 * double(image.at("G", x, y)) +
           0.0722 * double(image.at("B", x, y));
}

std::vector<double> luminances(const test::ImageFile& image) {
    std::vector<double> values;
    for (int y = 0; y < k_height; ++y)
        for (int x = 0; x < k_width; ++x) values.push_back(luminance_at(image, x, y));
    return values;
}

/// The luminances that a preview shows, 0 to 1 (IEC 61966-2-1).
std::vector<double> shown_luminances(test::ImageFile image) {
    for (auto& [name, values] : image.channels)
        for (float& value : values)
            value = value <= 0.04045F ? value / 12.92F : std::pow((value + 0.055F) / 1.055F, 2.4F);
    return luminances(image);
}

/// |with - without| / max(without, its mean), per pixel.
std::vector<double> contrasts(const std::vector<double>& with, const std::vector<double>& without) {
    double mean = 0;
    for (const double light : without) mean += light / static_cast<double>(without.size());
    std::vector<double> result;
    for (std::size_t n = 0; n < with.size(); ++n)
        result.push_back(std::abs(with[n] - without[n]) / std::max(without[n], mean));
    return result;
}

class ProposedScenes : public test::CliTest {
  protected:
    test::ImageFile render(const std::string& scene, const std::vector<std::string>& more) const {
        std::vector<std::string> arguments{"render", scene, "-o", "out.exr", "--size", "480x270"};
        for (const char* word : {"--quality", "draft", "--precision", "float"})
            arguments.emplace_back(word);
        arguments.insert(arguments.end(), more.begin(), more.end());
        const test::ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return test::read_exr(folder_ / "out.exr");
    }

    /// Asks for the scene of `file` and its picture, renders the scene with and without its volume
    /// in the light that it asks for, and compares: the contrast that was said is that of the
    /// pictures, as the documentation defines it, which makes the volume plain to see.
    void expect_plain_to_see(const std::filesystem::path& file,
                             const std::vector<std::string>& more = {}) const {
        SCOPED_TRACE(file.filename());
        const test::ProgramResult asked =
            run({"info", file.string(), "--json", "--picture", "shown.png"});
        ASSERT_EQ(asked.exit_code, 0) << asked.err;
        const auto advice = nlohmann::json::parse(asked.out).at("advice");
        const std::string scene = advice.at("scene");
        write("with.yaml", scene);
        const std::size_t begin = scene.find("\nvolumes:") + 1, end = scene.find("render:", begin);
        write("without.yaml",
              scene.substr(0, begin) + (end == std::string::npos ? "" : scene.substr(end)));
        const test::ImageFile image = render("with.yaml", more);
        test::expect_finite_and_lit(image);
        const std::vector<double> with = luminances(image),
                                  without = luminances(render("without.yaml", {}));
        // Which pixels see the volume does not depend on the light.
        const test::ProgramResult surveyed =
            run({"info", "with.yaml", "--json", "--set", "render.scattering=single"});
        ASSERT_EQ(surveyed.exit_code, 0) << surveyed.err;
        const double seen =
            nlohmann::json::parse(surveyed.out).at("contrast").at("seen").get<double>();
        // The brightest hundredth of the pixels that see the volume.
        const double rank = 1 - 0.01 * std::max(seen, 1.0 / (k_width * k_height));
        const double measured = percentile(contrasts(with, without), rank),
                     said = advice.at("contrast").get<double>();
        if (more.empty()) {  // other frames than the one that was judged are as clear as they are
            // Concentrations are rounded to two digits, and shadows beside the volume count here.
            EXPECT_NEAR(measured, said, 0.1 * said);
        }
        EXPECT_GE(measured, 0.3);
        // A preview shows the 99th percentile as 0.8: what changes as no less than a dark grey.
        std::vector<double> lit;
        const std::vector<double> changes = contrasts(with, without);
        for (std::size_t n = 0; n < with.size(); ++n)
            if (changes[n] >= 0.05) lit.push_back(with[n]);
        ASSERT_FALSE(lit.empty());
        EXPECT_GE(percentile(lit, 0.5), 0.02 * percentile(with, 0.99));
        if (!more.empty()) return;
        // And the picture shows it: with the volume, and plainly different from one without.
        const std::vector<double> shown = shown_luminances(test::read_exr(folder_ / "shown.png"));
        double shown_sum = 0, with_sum = 0;
        for (std::size_t n = 0; n < with.size(); ++n) {
            if (shown[n] > 0.95) continue;
            shown_sum += shown[n];
            with_sum += with[n];
        }
        std::vector<double> shown_without;
        for (const double light : without)
            shown_without.push_back(std::min(1.0, light * shown_sum / with_sum));
        EXPECT_GE(percentile(contrasts(shown, shown_without), rank), 0.5 * said);
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
    expect_plain_to_see(UWVDB_SOURCE_DIR "/assets/grids/plume128_blosc_half_0030.vdb");
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
