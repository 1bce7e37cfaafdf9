// ctest labels: analytic
// How residuals of pictures grow with the unknowns, against differences of residuals.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/scene/scene_desc.h"
#include "fit/picture_residuals.h"
#include "fit/unknowns.h"
#include "tests/support/fit_pictures.h"

namespace uw::test {
namespace {

// The step of differences, to either side, in scales of the unknowns and for tilts in degrees, and
// the error of derivatives. Light is interpolated in tables that move with lamps and coefficients,
// which smaller steps would measure. Left is that a cell's light, of two or three pixels, is
// differentiated at its centre: 1.4 % for tilts, as the light of a spot bends where its edge begins
// and ends; it was 2.5 % with cells twice as wide.
constexpr double k_step = 0.01, k_tilt = 0.1, k_error = 0.02;

class FitPictureDerivatives : public FitPictures {
  protected:
    /// Expects that the derivatives of all residuals of a picture by each unknown are not 0 and, in
    /// the RMS, have a relative error of no more than `most`. `settings` are of the scene that is
    /// fitted.
    void expect_derivatives(double most, const std::string& picture,
                            const std::vector<std::string>& keys,
                            const std::vector<std::string>& settings = {}) {
        const SceneUnknowns unknowns(scene_tree(read("dive.yaml"), "dive.yaml", settings),
                                     "dive.yaml", keys, std::vector<std::string>{picture});
        PictureResiduals residuals(unknowns, {{folder_ / picture, {1, 0}}}, 80);
        std::vector<double> values;
        for (const SceneUnknown& unknown : unknowns.all()) values.push_back(unknown.start);
        const std::size_t n = values.size(), colours = residuals.colours();
        const auto residuals_at = [&](std::span<const double> shared, double* by_shared) {
            EXPECT_TRUE(residuals.prepare(shared, by_shared != nullptr));
            std::vector<double> all(residuals.groups().size() * colours);
            for (std::size_t i = 0; i < residuals.groups().size(); ++i)
                EXPECT_TRUE(residuals.evaluate(
                    i, nullptr, &all[i * colours],
                    by_shared != nullptr ? &by_shared[i * colours * n] : nullptr, nullptr));
            return all;
        };
        std::vector<double> rows(residuals.groups().size() * colours * n);
        residuals_at(values, rows.data());
        for (std::size_t i = 0; i < n; ++i) {
            const SceneUnknown& unknown = unknowns.all()[i];
            const double step = unknown.unit == "deg" ? k_tilt : k_step * unknown.scale;
            std::vector<double> back = values, ahead = values;
            back[i] -= step;
            ahead[i] += step;
            const std::vector<double> less = residuals_at(back, nullptr),
                                      more = residuals_at(ahead, nullptr);
            double missing = 0, all = 0;
            for (std::size_t k = 0; k < less.size(); ++k) {
                const double difference = (more[k] - less[k]) / (2 * step);
                missing += std::pow(rows[k * n + i] - difference, 2);
                all += difference * difference;
            }
            EXPECT_GT(all, 0) << unknown.name;
            EXPECT_LE(std::sqrt(missing / all), most) << unknown.name;
        }
    }
};

const std::vector<std::string> k_of_light{"water.absorption",         "water.scattering.b",
                                          "water.scattering.phase.g", "geometry[0].reflectance",
                                          "lamps.*.position",         "lamps.*.direction",
                                          "lamps.*.intensity",        "lamps.left.profile.beam"};

TEST_F(FitPictureDerivatives, OfWaterLampsAndSurfaces) {
    take_pictures("");
    expect_derivatives(k_error, "dive_01.exr", k_of_light);
}

// Numbers of a sensor, whose colours see all bands; and what the renderer does not differentiate,
// sensor and port.
TEST_F(FitPictureDerivatives, OfRawNumbers) {
    take_pictures(k_raw_sensor);
    std::vector<std::string> keys = k_of_light;
    keys.insert(keys.end(), {"camera.sensor.gain", "camera.port.distance", "exposure"});
    expect_derivatives(k_error, "dive_01.sensor.png", keys);
}

// Bands that are not red, green and blue.
TEST_F(FitPictureDerivatives, OfFourBands) {
    const std::vector<std::string> bands{
        "water.bands=[620, 550, 480, 430]", "water.absorption=[0.3, 0.09, 0.05, 0.08]",
        "water.scattering.b=[0.3, 0.32, 0.35, 0.4]", "lamps.left.intensity=[30, 32, 28, 20]",
        "lamps.right.intensity=[25, 26, 24, 22]"};
    take_pictures("", bands);
    expect_derivatives(k_error, "dive_01.exr", {"water.absorption", "lamps.left.position"}, bands);
}

// The angle of a beam that ends at once changes nothing but where its edge is. The renderer's
// derivatives leave that out, and would have an error of 1.
TEST_F(FitPictureDerivatives, OfTheEdgeOfABeam) {
    const std::vector<std::string> sharp{"lamps.left.profile={type: spot, beam: 40, edge: 0}"};
    take_pictures("", sharp);
    expect_derivatives(0.1, "dive_01.exr", {"lamps.left.profile.beam"}, sharp);
}

}  // namespace
}  // namespace uw::test
