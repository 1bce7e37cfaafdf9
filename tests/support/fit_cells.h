#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "fit/picture_residuals.h"
#include "fit/robust_fit.h"
#include "fit/unknowns.h"
#include "render/scene_loading.h"
#include "tests/support/cli_test.h"

namespace uw::test {

/// A plane that two lamps light from either side, in three raw pictures of a mosaic with shot noise
/// of some 100 electrons.
inline constexpr const char* k_noisy_dive = R"(uwvdb: 1
camera:
  resolution: [160, 120]
  intrinsics: {fov_x: 60}
  port: {type: flat, distance: 0.025, thickness: 0.012}
  trajectory:
    keyframes:
      - {time: 0, position: [0, 0, 1.0], look_at: [0, 0, 3], up: [0, -1, 0]}
      - {time: 1, position: [0, 0, 0.3], look_at: [0, 0, 3], up: [0, -1, 0]}
      - {time: 2, position: [0.3, 0, -0.8], look_at: [0, 0, 3], up: [0, -1, 0]}
  lens: {focal_length: 0.008, f_number: 2.8}
  sensor:
    exposure: 0.00001
    mosaic: rggb
    quantum_efficiency: [0.4, 0.55, 0.5]
    full_well: 10500
    read_noise: 3
    gain: 0.38
    black_level: 64
    bit_depth: 12
    image: raw
water: {absorption: [0.30, 0.08, 0.06], scattering: {b: [0.20, 0.22, 0.25], phase: {type: petzold}}}
geometry: [{type: plane, point: [0, 0, 2], normal: [0, 0, -1], reflectance: 0.3}]
lamps:
  - {name: left, position: [-0.4, -0.1, 0], intensity: 30}
  - {name: right, position: [0.4, -0.1, 0], intensity: 30}
render: {fps: 1, samples: 4}
)";

/// Fits of the lamps' brightness and of all six coefficients to pictures whose truth is known.
class FitCells : public CliTest {
  protected:
    static constexpr std::size_t k_unknowns = 8;

    /// What 8 unknowns of some fits are off by: the squares in units of their covariances, which
    /// are of chi^2 with as many degrees of freedom as there are unknowns in all, and the sums of
    /// what both lamps are off by in their standard errors.
    struct Off {
        double squares = 0, degrees = 0;
        std::array<double, 2> lamps{};
        double fits = 0;
        void expect_is_noise(const std::string& what) const {
            // Four standard deviations: one test in 16 000 fails for no reason. Below, errors would
            // be stated too great.
            EXPECT_NEAR(squares, degrees, 4 * std::sqrt(2 * degrees)) << what;
            for (const double sum : lamps) EXPECT_LT(std::abs(sum), 4 * std::sqrt(fits)) << what;
        }
    };

    void take_noisy_pictures(int seed, const std::string& mosaic = "rggb") {
        text_ = k_noisy_dive;
        text_.replace(text_.find("rggb"), 4, mosaic);
        write("dive.yaml", text_);
        const ProgramResult result =
            run({"render", "dive.yaml", "-o", "noisy_%02d.sensor.png", "--frames", "0-2", "--quiet",
                 "--set", "camera.sensor.seed=" + std::to_string(seed)});
        ASSERT_EQ(result.exit_code, 0) << result.err;
    }

    /// Adds a fit with cells of about so many pixels.
    void add_fit(double side, Off& off) const {
        const std::vector<std::string> keys{"lamps.left.intensity", "lamps.right.intensity",
                                            "water.absorption", "water.scattering.b"};
        const std::vector<std::string> start{"lamps.left.intensity=26", "lamps.right.intensity=35",
                                             "water.absorption=[0.25, 0.1, 0.05]",
                                             "water.scattering.b=[0.25, 0.2, 0.2]"};
        const double truths[k_unknowns] = {30, 30, 0.30, 0.08, 0.06, 0.20, 0.22, 0.25};
        const SceneUnknowns unknowns(scene_tree(text_, folder_ / "dive.yaml", start),
                                     folder_ / "dive.yaml", keys);
        PictureResiduals pictures(unknowns, pictures_called(folder_ / "noisy_%02d.sensor.png"),
                                  static_cast<int>(std::lround(160 / side)));
        const FitResult found = robust_fit(pictures, unknowns, {});
        ASSERT_EQ(found.values.size(), k_unknowns);
        std::array<double, k_unknowns> z{};  // in standard errors
        for (std::size_t i = 0; i < k_unknowns; ++i)
            z[i] = (found.values[i].value - truths[i]) / found.values[i].error;
        // z^T R^-1 z by Cholesky's factor of the correlations R: the sum of L^-1 z squared.
        std::array<std::array<double, k_unknowns>, k_unknowns> lower{};
        std::array<double, k_unknowns> solved{};
        for (std::size_t i = 0; i < k_unknowns; ++i) {
            for (std::size_t j = 0; j <= i; ++j) {
                double sum = found.correlations[i * k_unknowns + j];
                for (std::size_t k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k];
                lower[i][j] = i == j ? std::sqrt(sum) : sum / lower[j][j];
            }
            double sum = z[i];
            for (std::size_t k = 0; k < i; ++k) sum -= lower[i][k] * solved[k];
            solved[i] = sum / lower[i][i];
            off.squares += solved[i] * solved[i];
        }
        off.degrees += k_unknowns;
        off.fits += 1;
        off.lamps[0] += z[0];
        off.lamps[1] += z[1];
    }

    std::string text_;
};

}  // namespace uw::test
