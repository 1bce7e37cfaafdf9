// ctest labels: analytic statistical slow
// The whole of the exact tables around a lamp in infinite water, within stated errors. These are
// largest for orders that are a small fraction of the light.
#include <gtest/gtest.h>

#include "tests/support/paths/path_tables.h"

namespace uw::test {
namespace {

TEST(PathTablesInFull, RadianceByOrderFromOneTo180Degrees) {
    Deviations deviations;
    std::uint64_t seed = 0;
    for (const TableRow& row : read_path_table("point_lamp_hg09_albedo08_radiance.csv", false))
        compare_radiance(row, {64, 1 << 11, 64}, ++seed, deviations);
    EXPECT_EQ(deviations.count(), 45 * 5);
    deviations.expect_within_errors();
    // Three standard errors are 0.3 %.
    deviations.expect_errors_below(0.001, "L1");
    deviations.expect_errors_below(0.001, "L2");
    // Twice the errors that were measured.
    deviations.expect_errors_below(0.04, "L3");
    deviations.expect_errors_below(0.15, "L4");
    deviations.expect_errors_below(0.02, "total");
}

void compare_fluence_tables(const std::string& file, double g) {
    Deviations deviations;
    const std::vector<TableRow> table = read_path_table(file, true);
    // Rows are computed one by one, not as bands of the same paths: otherwise an order would
    // deviate at every albedo by the same number of errors and count more than once.
    std::uint64_t seed = 0;
    for (const TableRow& row : table)
        if ((row.albedo == 0.5 || row.albedo == 0.95) &&
            (row.r == 0.5 || row.r == 1 || row.r == 3 || row.r == 5))
            // Far from the lamp hardly any light is of order 2, and few paths carry it.
            compare_fluence({row}, g, {64, row.r < 3 ? 1U << 6 : 1U << 11, 64}, ++seed, deviations);
    EXPECT_EQ(deviations.count(), 8 * 6);
    deviations.expect_within_errors();
    deviations.expect_errors_below(0.001, "order 1");
    deviations.expect_errors_below(0.002, "order 2");
    // Twice the errors that were measured.
    deviations.expect_errors_below(0.05, "total");
}

TEST(PathTablesInFull, FluenceByOrderForIsotropicScattering) {
    compare_fluence_tables("point_source_isotropic_fluence.csv", 0);
}

TEST(PathTablesInFull, FluenceByOrderForForwardScattering) {
    compare_fluence_tables("point_source_hg09_fluence.csv", 0.9);
}

}  // namespace
}  // namespace uw::test
