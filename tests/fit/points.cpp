// ctest labels: analytic
// Ports and lenses from corners whose truth is known: exactly, with noise, with outliers, and where
// they cannot tell.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "camera/camera.h"
#include "cli/fit/fit_report.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "core/scene/scene_desc.h"
#include "core/scene/trajectory.h"
#include "fit/point_residuals.h"
#include "fit/robust_fit.h"
#include "fit/unknowns.h"
#include "render/scene_loading.h"

namespace uw::test {
namespace {

constexpr const char* k_rig = R"(uwvdb: 1
camera:
  resolution: [1280, 960]
  intrinsics: {fx: 1100, fy: 1100, cx: 640, cy: 480}
  port: {type: flat, normal: [0.05, -0.03, 1], distance: 0.03, thickness: 0.012, n_glass: 1.5, n_water: 1.334}
water: {bands: [550], absorption: [0], scattering: {b: [0], phase: {type: hg, g: 0.9}}}
lamps: [{name: l, position: [0, 0, 0.2], intensity: [1]}]
)";

/// A board of 7 x 5 corners, 4 cm apart, as the rig sees it from eight places, with normal errors
/// of `noise` [px] drawn by `seed`.
PointTable boards(double noise, int seed) {
    const Camera camera(read_scene_text(k_rig, "rig.yaml").camera);
    PointTable table;
    const auto drawn = [&](const std::string& key, int i) {
        return draw_random(static_cast<std::uint64_t>(seed), key, static_cast<std::size_t>(i), 0);
    };
    constexpr int k_images = 8;
    for (int image = 0; image < k_images; ++image) {
        table.images.push_back(std::to_string(image));
        // Near and far, tilted to and fro.
        const Matrix3 turn = rotation_by({0.4 * std::sin(2.4 * image), 0.4 * std::cos(1.7 * image),
                                          0.3 * std::sin(image)})
                                 .matrix();
        const Vector3 place{0.1 * std::cos(3 * image), 0.08 * std::sin(2 * image),
                            0.35 + 0.09 * image};
        for (int row = 0; row < 5; ++row)
            for (int column = 0; column < 7; ++column) {
                const Vector3 corner{0.04 * (column - 3), 0.04 * (row - 2), 0};
                const auto seen = camera.project(at_origin_plus(turn * corner + place));
                if (!seen) continue;
                const int index = (image * 5 + row) * 7 + column;
                // Box and Muller
                const double length = std::sqrt(-2 * std::log(1 - drawn("length", index)));
                const double angle = 2 * std::numbers::pi * drawn("angle", index);
                table.points.push_back({static_cast<std::size_t>(image),
                                        {corner.x, corner.y, corner.z},
                                        {seen->x + noise * length * std::cos(angle),
                                         seen->y + noise * length * std::sin(angle)}});
            }
    }
    return table;
}

FitResult fit_boards(const PointTable& table, const std::vector<std::string>& keys,
                     const std::vector<std::string>& start = {}) {
    const SceneUnknowns unknowns(scene_tree(k_rig, "rig.yaml", start), "rig.yaml", keys);
    PointResiduals points(unknowns, table);
    return robust_fit(points, unknowns, {});
}

const std::vector<std::string> k_port{"camera.port.distance", "camera.port.normal",
                                      "camera.intrinsics.fx"};
const std::vector<std::string> k_guess{"camera.port.distance=0.01", "camera.port.normal=[0, 0, 1]",
                                       "camera.intrinsics.fx=1150"};

TEST(FitPoints, FindThePortAndTheLensExactly) {
    const FitResult found = fit_boards(boards(0, 0), k_port, k_guess);
    ASSERT_EQ(found.values.size(), 4U);
    EXPECT_NEAR(found.values[0].value, 0.03, 1e-6);
    EXPECT_NEAR(found.values[3].value, 1100, 1e-3);
    EXPECT_LT(found.rms, 1e-5);
}

// Of 50 draws the truth is to lie within one standard error in 68 %, and within two in 95 %. For
// 200 numbers, of which those of a draw hang together (so 50 count), three standard deviations are
// 20 % and 9 %.
TEST(FitPoints, StandardErrorsAreTrue) {
    int within_one = 0, within_two = 0, all = 0;
    for (int seed = 1; seed <= 50; ++seed) {
        const FitResult found = fit_boards(boards(0.2, seed), k_port, k_guess);
        ASSERT_EQ(found.values.size(), 4U);
        EXPECT_NEAR(found.deviation, 0.2, 0.02);  // of 560 numbers: 3 %, and three times that
        // The tilts are those between the guess and the truth.
        const Vector3 truth = glm::normalize(Vector3{0.05, -0.03, 1});
        const double tilts[] = {std::atan(truth.x / truth.z) / k_degree,
                                std::atan(truth.y / truth.z) / k_degree};
        const double truths[] = {0.03, tilts[0], tilts[1], 1100};
        for (std::size_t i = 0; i < 4; ++i) {
            const double off = std::abs(found.values[i].value - truths[i]) / found.values[i].error;
            within_one += off < 1 ? 1 : 0;
            within_two += off < 2 ? 1 : 0;
            ++all;
        }
    }
    EXPECT_NEAR(within_one / double{200}, 0.683, 0.20);
    EXPECT_NEAR(within_two / double{200}, 0.954, 0.09);
    EXPECT_EQ(all, 200);
}

// One corner in ten is another's: what is found stays within its errors.
TEST(FitPoints, OutliersDoNotSpoilThem) {
    PointTable table = boards(0.2, 7);
    std::size_t moved = 0;
    for (std::size_t i = 0; i < table.points.size(); i += 10, ++moved)
        table.points[i].seen.x += 25 + static_cast<double>(i % 17);
    const FitResult found = fit_boards(table, k_port, k_guess);
    EXPECT_EQ(std::ranges::count(found.outliers, true), static_cast<std::ptrdiff_t>(moved));
    EXPECT_LT(std::abs(found.values[0].value - 0.03), 3 * found.values[0].error);
    EXPECT_LT(std::abs(found.values[3].value - 1100), 3 * found.values[3].error);
    EXPECT_NEAR(found.deviation, 0.2, 0.02);
}

// Glass without thickness bends nothing: its index could be any.
TEST(FitPoints, SayWhatTheyCannotTell) {
    const FitResult found =
        fit_boards(boards(0.2, 3), {"camera.port.distance", "camera.port.n_glass"},
                   {"camera.port.thickness=0"});
    ASSERT_EQ(found.values.size(), 2U);
    EXPECT_TRUE(std::isinf(found.values[1].error));
    EXPECT_TRUE(std::isfinite(found.values[0].error));
    ASSERT_EQ(found.free_directions.size(), 1U);
    EXPECT_EQ(found.free_directions[0].unknowns, std::vector<std::size_t>{1});
    EXPECT_EQ(doubts(found).front(),
              "camera.port.n_glass is not determined by these observations: leave it out, or give "
              "a --prior.");
}

// Of 40 draws the truth of each camera's place and turn is within its errors: for 240 numbers, of
// which those of a draw hang together (so 40 count), three standard deviations are 22 % and 10 %.
TEST(FitPoints, StandardErrorsOfPosesAreTrue) {
    const Camera camera(read_scene_text(k_rig, "rig.yaml").camera);
    const SceneUnknowns unknowns(scene_tree(k_rig, "rig.yaml", k_guess), "rig.yaml", k_port);
    // Corners without noise tell where the cameras are.
    PointResiduals exact(unknowns, boards(0, 0));
    const std::vector<FoundPose> truth = exact.found_poses(robust_fit(exact, unknowns, {}));
    double within_one = 0, within_two = 0, all = 0;
    for (int seed = 1; seed <= 40; ++seed) {
        PointResiduals noisy(unknowns, boards(0.2, seed));
        const std::vector<FoundPose> found = noisy.found_poses(robust_fit(noisy, unknowns, {}));
        const std::size_t image = static_cast<std::size_t>(seed) % found.size();
        const Vector3 place =
            found[image].world_from_camera.offset() - truth[image].world_from_camera.offset();
        const Vector3 turn =
            rotation_vector(rotation_of(glm::transpose(truth[image].world_from_camera.linear()) *
                                        found[image].world_from_camera.linear())) /
            k_degree;
        for (int axis = 0; axis < 3; ++axis)
            for (const auto& [off, error] :
                 {std::pair{place[axis], found[image].position_error[axis]},
                  {turn[axis], found[image].turn_error[axis]}}) {
                ASSERT_GT(error, 0);
                within_one += std::abs(off) < error ? 1 : 0;
                within_two += std::abs(off) < 2 * error ? 1 : 0;
                ++all;
            }
    }
    EXPECT_EQ(all, 240);
    EXPECT_NEAR(within_one / all, 0.683, 0.22);
    EXPECT_NEAR(within_two / all, 0.954, 0.10);
}

/// One number as it is observed directly, with this error.
class Observed final : public Observations {
  public:
    Observed(double number, double error) : number_(number), error_(error) {}
    bool prepare(std::span<const double> shared, bool /*with_derivatives*/) override {
        value_ = shared[0];
        return true;
    }
    // Of two observations that disagree the mean is found, with an error of 1 / sqrt(2) of theirs.
    bool evaluate(std::size_t group, const Block* /*block*/, double* residuals, double* by_shared,
                  double* /*by_block*/) const override {
        const double seen = number_ + (group == 0 ? error_ : -error_);
        residuals[0] = (value_ - seen) / deviation();
        if (by_shared != nullptr) by_shared[0] = 1 / deviation();
        return true;
    }
    std::vector<ResidualGroup> groups() const override { return {{1}, {1}}; }
    std::size_t block_count() const override { return 0; }
    const std::vector<std::string>& images() const override { return images_; }
    Place place(std::size_t /*group*/) const override { return {}; }
    const char* noun() const override { return "number"; }
    const char* unit() const override { return ""; }
    double of_group(double rms) const override { return rms; }

  private:
    double number_, error_, value_ = 0;
    std::vector<std::string> images_{"one"};
};

// Wherever a fit begins, what it cannot tell is held against what it found.
TEST(FitPoints, DoubtsAreOfWhatWasFound) {
    const auto doubts_of = [](double start, double truth, double error) {
        const SceneUnknowns unknowns(
            scene_tree(k_rig, "rig.yaml", {"lamps.l.intensity=[" + std::to_string(start) + "]"}),
            "rig.yaml", std::vector<std::string>{"lamps.l.intensity"});
        Observed observed(truth, error);
        FitOptions options;
        options.keeps_outliers = true;
        const FitResult found = robust_fit(observed, unknowns, options);
        EXPECT_NEAR(found.values[0].value, truth, 1e-6 * truth);
        return doubts(found);
    };
    // Known to 1 %, and a hundred times as great as where it began.
    EXPECT_TRUE(doubts_of(0.01, 1, 0.01).empty());
    // Ten times less than where it began, and known to no better than several times its size.
    const std::vector<std::string> vague = doubts_of(10, 1, 5);
    ASSERT_EQ(vague.size(), 1U);
    EXPECT_NE(vague[0].find("lamps.l.intensity[0] is not determined to better than 5"),
              std::string::npos)
        << vague[0];
}

/// What a fit of the port asks of a table whose numbers are read in another way, or refuses it
/// with.
std::vector<std::string> questions_of(const std::function<void(PhotographedPoint&)>& read) {
    PointTable table = boards(0.1, 5);
    for (PhotographedPoint& point : table.points) read(point);
    const SceneUnknowns unknowns(scene_tree(k_rig, "rig.yaml", {}), "rig.yaml",
                                 std::vector<std::string>{"camera.port.distance"});
    try {
        PointResiduals points(unknowns, table);
        const FitResult found = robust_fit(points, unknowns, {});
        return points.questions(found, {});
    } catch (const InputError& refused) {
        return {refused.what()};
    }
}

TEST(FitPoints, AskWhatATableMeans) {
    EXPECT_TRUE(questions_of([](PhotographedPoint&) {}).empty());
    const std::vector<std::string> millimetres = questions_of([](PhotographedPoint& point) {
        point.point = at_origin_plus(1000.0 * from_origin(point.point));
    });
    ASSERT_FALSE(millimetres.empty());
    EXPECT_EQ(millimetres[0],
              "The points of an image are up to 288 m apart: are they in millimetres or "
              "centimetres? Give metres, as x, y and z or as the side of a square.");
    const std::vector<std::string> kilometres = questions_of([](PhotographedPoint& point) {
        point.point = at_origin_plus(0.001 * from_origin(point.point));
    });
    ASSERT_FALSE(kilometres.empty());
    EXPECT_NE(kilometres[0].find("metres"), std::string::npos) << kilometres[0];
    const std::vector<std::string> swapped =
        questions_of([](PhotographedPoint& point) { std::swap(point.seen.x, point.seen.y); });
    ASSERT_EQ(swapped.size(), 1U);
    EXPECT_NE(swapped[0].find("u counts to the right"), std::string::npos) << swapped[0];
}

// A prior that is far more certain than the corners is what is found, with its error.
TEST(FitPoints, PriorsCount) {
    const SceneUnknowns unknowns(scene_tree(k_rig, "rig.yaml", {}), "rig.yaml",
                                 std::vector<std::string>{"camera.port.distance"});
    PointResiduals points(unknowns, boards(0.2, 3));
    FitOptions options;
    options.priors = {Prior{0.031, 1e-6}};
    const FitResult found = robust_fit(points, unknowns, options);
    EXPECT_NEAR(found.values[0].value, 0.031, 3e-6);
    EXPECT_NEAR(found.values[0].error, 1e-6, 1e-8);
}

}  // namespace
}  // namespace uw::test
