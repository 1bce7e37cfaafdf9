// ctest labels: unit analytic
#include "render/navigation/pressure.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "render/navigation/sensor_record.h"
#include "render/scene_loading.h"

namespace uw {
namespace {

struct DensityCheck {
    double salinity, temperature, bar, density;
};

// The check values of the equation of state: Gill 1982, "Atmosphere-Ocean Dynamics", appendix 3,
// and Fofonoff and Millard 1983, p. 19 (40 PSU, 40 degrees, 1000 bar).
constexpr std::array<DensityCheck, 9> k_checks{{{0, 5, 0, 999.96675},
                                                {0, 5, 1000, 1044.12802},
                                                {0, 25, 0, 997.04796},
                                                {0, 25, 1000, 1037.90204},
                                                {35, 5, 0, 1027.67547},
                                                {35, 5, 1000, 1069.48914},
                                                {35, 25, 0, 1023.34306},
                                                {35, 25, 1000, 1062.53817},
                                                {40, 40, 1000, 1059.82037}}};

TEST(WaterPressure, DensityIsThatOfTheEquationOfState) {
    // The published values have five decimals, the last of which one cuts instead of rounding.
    for (const DensityCheck& check : k_checks)
        EXPECT_NEAR(sea_water_density(check.salinity, check.temperature, check.bar * 1e5),
                    check.density, 1e-5);
}

// Against the sum of thin layers, by the midpoint method over 6 km in steps of 10 cm, which is
// right to 1e-12 or so.
TEST(WaterPressure, IsTheWeightOfTheCompressedWaterAbove) {
    const WaterColumn column(35, 4, 9.81);
    double pressure = 0;
    constexpr double k_step = 0.1;
    for (int layer = 0; layer < 60'000; ++layer) {
        const double middle = pressure + 0.5 * k_step * 9.81 * sea_water_density(35, 4, pressure);
        pressure += k_step * 9.81 * sea_water_density(35, 4, middle);
        if ((layer + 1) % 10'000 != 0) continue;
        const double depth = (layer + 1) * k_step;
        EXPECT_NEAR(column.pressure_at(depth) / pressure, 1, 1e-10);
        EXPECT_NEAR(column.depth_at(column.pressure_at(depth)), depth, 1e-8);
    }
    // Of that, 1.4 % is due to compression: water is not taken to be as dense as at the surface.
    EXPECT_NEAR(pressure / (sea_water_density(35, 4, 0) * 9.81 * 6000), 1.014, 0.001);
    EXPECT_EQ(column.pressure_at(-3), 0);
}

// A gauge 2 m below a camera that sinks from 5 to 9 m below the surface, in fresh water with a
// tide.
TEST(PressureSensor, ReadsDepthAndTide) {
    const SceneDesc scene = load_scene_text(
        "uwvdb: 1\ncamera:\n  resolution: [4, 4]\n  intrinsics: {fx: 4}\n  trajectory:\n"
        "    keyframes: [{time: 0, position: [0, 15, 0], rotate: [0, 0, 0]}, {time: 8, position: "
        "[0, 11, 0], rotate: [0, 0, 0]}]\n"
        "water: {salinity: 0, temperature: 5, surface: {height: 20}}\n"
        "sensors:\n  - {type: pressure, update_rate: 4, pose: {position: [0, -2, 0]}, tide: "
        "{amplitude: 0.5, period: 16, phase: 0.25}, noise: 50, bias: 1000, resolution: 10}\n",
        "scene.yaml");
    const SensorRecord record = record_sensor(scene, scene.navigation.front(), {0, 32});
    ASSERT_EQ(record.numbers.size(), 33U);
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < 33; ++i) {
        const double* const row = &record.values[i * 4];
        const double time = 0.25 * static_cast<double>(i);
        const double depth = 7 + 0.5 * time + 0.5 * std::cos(2 * M_PI * time / 16);
        EXPECT_NEAR(row[3], depth, 1e-12);
        // Fresh water of 5 degrees, which ten metres compress by 2e-5 in the mean.
        EXPECT_NEAR(row[2], 101'325 + 999.96675 * 9.81 * depth, 5);
        EXPECT_NEAR(std::remainder(row[0], 10), 0, 1e-6);
        EXPECT_NEAR(row[1], depth + (row[0] - row[2]) / (999.97 * 9.81), 1e-4);
        sum += row[0] - row[2] - 1000;
        squares += (row[0] - row[2] - 1000) * (row[0] - row[2] - 1000);
    }
    // 33 readings know their mean to 50/sqrt(33) Pa and their spread to 12 %: four of these.
    EXPECT_LT(std::abs(sum / 33), 4 * 50 / std::sqrt(33));
    EXPECT_NEAR(std::sqrt(squares / 33), 50, 4 * 0.12 * 50);
}

}  // namespace
}  // namespace uw
