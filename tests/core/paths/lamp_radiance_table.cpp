// ctest labels: analytic
// The table of radiance around a lamp that guides light paths, against exact tables and
// conservation of energy.
#include "core/paths/lamp_radiance_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/paths/scattering_tables.h"
#include "tests/support/paths/path_scene.h"
#include "tests/support/paths/path_tables.h"

namespace uw::test {
namespace {

const std::vector<BandOptics> k_clear_and_turbid{{0.8, 0.2}, {0.01, 0.99}};

TEST(LampRadianceTable, ApproximatesTheExactTables) {
    const ScatteringTables tables(PathScene({{0.2, 0.8}}, 0.9).medium);
    int count = 0;
    for (const TableRow& row : read_path_table("point_lamp_hg09_albedo08_radiance.csv", false)) {
        const double h = std::tan(0.5 * row.psi_degrees * std::numbers::pi / 180);
        const LampRadianceTable& field = tables.lamp_radiance();
        const LampRadianceTable::Place place = field.at(row.r, 0.8);
        // A guide may be off by a third, as the numbers of paths depend on its square root.
        EXPECT_NEAR(field.radiance(place, h) / row.total, 1, 0.35)
            << row.r << " " << row.psi_degrees;
        EXPECT_LT(field.multiple(place, h), field.radiance(place, h));
        ++count;
    }
    EXPECT_EQ(count, 45);
}

// Energy is lost with distance and never gained, however little the water absorbs, and also beyond
// the table's end.
TEST(LampRadianceTable, LosesEnergyWithDistance) {
    for (const double g : {0.0, 0.9, 0.98}) {
        const ScatteringTables tables(PathScene(k_clear_and_turbid, g).medium);
        for (const double albedo : {0.2, 0.6, 0.99}) {
            double before = 1 + 1e-12;
            for (double r = 0x1p-9; r < 100; r *= 1.07) {
                const double flux =
                    tables.lamp_radiance().flux(tables.lamp_radiance().at(r, albedo));
                EXPECT_LE(flux, before) << g << " " << albedo << " " << r;
                EXPECT_GE(flux, std::exp(-std::max(r, 0x1p-8)) * (1 - 1e-3))
                    << g << " " << albedo << " " << r;
                before = flux;
            }
        }
    }
}

}  // namespace
}  // namespace uw::test
