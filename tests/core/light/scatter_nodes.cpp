// ctest labels: unit analytic
#include "core/light/volume_integrator.h"

#include <gtest/gtest.h>

#include <cmath>

namespace uw {
namespace {

TEST(ScatterNodes, LookUpIsLinearInConcentrationAndExactInItsIntegral) {
    // Concentration 2 s of the first constituent, 4 - s of the second from 1 on, constant 3 before.
    ConcentrationProfile profile;
    profile.constituent_count = 2;
    profile.s = {0, 1, 3};
    profile.concentration = {0, 3, 2, 3, 6, 1};
    profile.column = {0, 0, 1, 3, 9, 7};
    ScatterNodes nodes;
    nodes.s = {0.5, 1, 2, 3};
    nodes.lamp_column = {10, 20, 11, 21, 12, 22, 13, 23};
    nodes.look_up(profile);
    const std::size_t count = nodes.size();
    for (std::size_t i = 0; i < count; ++i) {
        const double s = nodes.s[i];
        EXPECT_NEAR(nodes.concentration[i], 2 * s, 1e-14);
        EXPECT_NEAR(nodes.concentration[count + i], s < 1 ? 3 : 4 - s, 1e-14);
        EXPECT_NEAR(nodes.column[i], 10 + static_cast<double>(i) + s * s, 1e-14);
        const double second = s < 1 ? 3 * s : 3 + 4 * (s - 1) - 0.5 * (s * s - 1);
        EXPECT_NEAR(nodes.column[count + i], 20 + static_cast<double>(i) + second, 1e-14);
    }
}

TEST(ScatterNodes, WithoutConstituentsThereIsNothingToLookUp) {
    ScatterNodes nodes;
    nodes.s = {1, 2};
    ConcentrationProfile profile;
    profile.s = {0, 5};
    nodes.look_up(profile);
    EXPECT_TRUE(nodes.column.empty());
    nodes.clear();
    EXPECT_EQ(nodes.size(), 0U);
}

/// Nodes with every number of its own.
ScatterNodes varied_nodes(std::size_t count, std::size_t constituents, std::size_t phases) {
    ScatterNodes nodes;
    for (std::size_t i = 0; i < count; ++i) {
        const double x = 0.1 + 0.3 * static_cast<double>(i);
        nodes.s.push_back(x);
        nodes.radius.push_back(2 * x);
        nodes.weight.push_back(1 / (1 + x));
        nodes.distance.push_back(i % 3);
    }
    for (std::size_t i = 0; i < count * constituents; ++i) {
        nodes.column.push_back(0.05 * static_cast<double>(i));
        nodes.concentration.push_back(1 + 0.02 * static_cast<double>(i));
    }
    for (std::size_t i = 0; i < count * phases; ++i)
        nodes.phase.push_back(0.01 * static_cast<double>(i + 1));
    return nodes;
}

TEST(ScatterSum, IsTheSumOverNodesTermByTerm) {
    Medium medium;
    medium.wavelengths_nm = {620, 450};
    medium.phase_functions.resize(2);
    medium.uniform.absorption[0] = 0.3;
    medium.uniform.absorption[1] = 0.1;
    medium.uniform.scattering.resize(2);
    medium.uniform.scattering[0][0] = 0.05;
    medium.uniform.scattering[0][1] = 0.07;
    medium.constituents.resize(2);
    for (Constituent& constituent : medium.constituents) constituent.per_unit.scattering.resize(2);
    medium.constituents[0].per_unit.absorption[0] = 0.02;
    medium.constituents[0].per_unit.scattering[1][1] = 0.5;
    medium.constituents[1].per_unit.scattering[0][0] = 0.4;

    constexpr std::size_t k_count = 7;
    const ScatterNodes nodes = varied_nodes(k_count, 2, 2);
    Spectrum intensity{};
    intensity[0] = 100;
    intensity[1] = 50;
    std::vector<Spectrum> radiance(3);
    radiance[1][0] = 7;  // what was there stays
    ScatterSum(medium).add(nodes, intensity, radiance);

    for (std::size_t band = 0; band < 2; ++band) {
        std::vector<double> truth{0, band == 0 ? 7.0 : 0.0, 0};
        for (std::size_t i = 0; i < k_count; ++i) {
            double tau =
                medium.uniform.attenuation(static_cast<int>(band)) * (nodes.s[i] + nodes.radius[i]);
            double beta = 0;
            for (std::size_t m = 0; m < 2; ++m)
                beta += medium.uniform.scattering[m][band] * nodes.phase[m * k_count + i];
            for (std::size_t k = 0; k < 2; ++k) {
                const OpticalCoefficients& per_unit = medium.constituents[k].per_unit;
                tau += per_unit.attenuation(static_cast<int>(band)) * nodes.column[k * k_count + i];
                for (std::size_t m = 0; m < 2; ++m)
                    beta += per_unit.scattering[m][band] * nodes.concentration[k * k_count + i] *
                            nodes.phase[m * k_count + i];
            }
            truth[nodes.distance[i]] += intensity[band] * nodes.weight[i] * std::exp(-tau) * beta;
        }
        for (std::size_t end = 0; end < 3; ++end)
            EXPECT_NEAR(radiance[end][band], truth[end], 1e-10 * (1 + truth[end]));
    }
}

}  // namespace
}  // namespace uw
