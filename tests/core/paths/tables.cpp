// ctest labels: analytic statistical
// Light of every order around a lamp in infinite water against exact tables; tables_in_full.cpp
// covers the whole tables.
#include <gtest/gtest.h>

#include "tests/support/paths/path_tables.h"

namespace uw::test {
namespace {

TEST(PathTables, RadianceByOrderAgreesWithTheTable) {
    Deviations deviations;
    for (const TableRow& row : read_path_table("point_lamp_hg09_albedo08_radiance.csv", false)) {
        const double psi = row.psi_degrees;
        if (row.r != 1 || (psi != 1 && psi != 5 && psi != 20 && psi != 60 && psi != 179.9))
            continue;
        compare_radiance(row, {32, 1 << 11, 64}, static_cast<std::uint64_t>(psi), deviations);
    }
    EXPECT_EQ(deviations.count(), 25);
    deviations.expect_within_errors();
    // A missing order or a factor of cos, sin or 2 would show.
    for (const char* what : {"L1", "L2", "total"}) deviations.expect_errors_below(0.01, what);
    deviations.expect_errors_below(0.1);
}

void compare_fluence_at(double r, const std::string& file, double g) {
    std::vector<TableRow> rows;
    for (const TableRow& row : read_path_table(file, true))
        if (row.r == r && (row.albedo == 0.5 || row.albedo == 0.95)) rows.push_back(row);
    ASSERT_EQ(rows.size(), 2);
    Deviations deviations;
    compare_fluence(rows, g, {32, 32, 64}, 7, deviations);
    deviations.expect_within_errors();
    deviations.expect_errors_below(0.06);
}

TEST(PathTables, FluenceByOrderAgreesForIsotropicScattering) {
    compare_fluence_at(1, "point_source_isotropic_fluence.csv", 0);
}

TEST(PathTables, FluenceByOrderAgreesForForwardScattering) {
    compare_fluence_at(1, "point_source_hg09_fluence.csv", 0.9);
}

}  // namespace
}  // namespace uw::test
