// ctest labels: unit analytic
#include "media/phase/tabulated_phase.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "tests/support/phase_function_laws.h"

namespace uw {
namespace {

constexpr double k_table_degree = std::numbers::pi / 180;

TEST(TabulatedPhase, UserTablesObeyTheLaws) {
    for (const char* text :
         {"angle_deg,phase\n0,1\n180,1\n", "angle_deg,phase\n0,0\n90,1\n180,0\n",
          "angle_deg,phase\n10,5\n20,1\n170,0.1\n", "# steep\nangle_deg,phase\n1,1e6\n2,1\n180,1\n",
          "angle_deg,phase\n1e-7,3\n1,2\n179.9,0\n",
          "angle_deg,phase\r\n30 , 0\r\n60 , 2\r\n90 , 0\r\n"})
        test::expect_phase_function_laws(read_phase_table(text, "user.csv"));
}

// A power law psi^-1 from 1 to 100 degrees is met exactly between its samples, goes on below the
// first, and holds beyond the last.
TEST(TabulatedPhase, ContinuesBeyondItsEnds) {
    const TabulatedPhase p = read_phase_table("angle_deg,phase\n1,8\n2,4\n100,0.08\n", "t");
    const double at_1 = p.evaluate(1 * k_table_degree);
    EXPECT_NEAR(p.evaluate(1.5 * k_table_degree) / at_1, 1 / 1.5, 1e-12);
    EXPECT_NEAR(p.evaluate(0.01 * k_table_degree) / at_1, 100, 1e-9);
    EXPECT_NEAR(p.evaluate(170 * k_table_degree) / at_1, 0.01, 1e-12);
    EXPECT_EQ(p.evaluate(0.0), p.evaluate(0.5e-6));
    EXPECT_GT(p.extrapolated_fraction(), 0.1);  // all of the cone behind 100 degrees
}

TEST(TabulatedPhase, ConstantTableIsIsotropic) {
    const TabulatedPhase p = read_phase_table("angle_deg,phase\n0,7\n50,7\n180,7\n", "t");
    EXPECT_NEAR(p.table_integral(), 4 * std::numbers::pi * 7, 1e-10);
    for (const double psi : {0.0, 0.3, 2.0, std::numbers::pi})
        EXPECT_NEAR(p.evaluate(psi), 1 / (4 * std::numbers::pi), 1e-14);
}

// Dense tables have many knots to a look-up bucket; each must still find its own segment.
TEST(TabulatedPhase, DenseTablesFindTheirSegments) {
    SampledCurve table;
    for (int i = 0; i <= 9000; ++i) {
        table.x.push_back(i * 0.02);
        table.y.push_back(2 + std::sin(i * 0.7));
    }
    const TabulatedPhase p(table, "dense");
    const double scale = p.table_integral();
    for (std::size_t i = 0; i < table.x.size(); ++i)
        EXPECT_NEAR(p.evaluate(table.x[i] * k_table_degree) * scale, table.y[i], 1e-9);
    test::expect_phase_function_laws(p);
}

TEST(TabulatedPhase, RefusesImpossibleTables) {
    for (const char* text :
         {"", "angle_deg,phase\n", "angle_deg,phase\n1,2\n", "angle_deg,p\n0,1\n180,1\n",
          "angle_deg,phase\n0,1\n181,1\n", "angle_deg,phase\n-1,1\n180,1\n",
          "angle_deg,phase\n0,-1\n180,1\n", "angle_deg,phase\n0,0\n180,0\n",
          "angle_deg,phase\n0,nan\n180,1\n", "angle_deg,phase\n0,1e300\n180,1\n",
          "angle_deg,phase\n5,1\n5,1\n", "angle_deg,phase\n9,1\n5,1\n",
          "angle_deg,phase\n5,1\n5.0000000000001,1\n", "angle_deg,phase\n0,1,2\n180,1,2\n",
          "angle_deg,phase\n0,1x\n180,1\n", "angle_deg,phase\n0,1e-320\n180,1e-320\n"})
        EXPECT_THROW(read_phase_table(text, "user.csv"), InputError) << text;
    EXPECT_THROW(read_phase_table(std::string(300, ','), "user.csv"), InputError);
}

TEST(TabulatedPhase, SaysWhereAndWhat) {
    try {
        read_phase_table("# c\nangle_deg,phase\n0,1\n90,abc\n", "user.csv");
        FAIL();
    } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.find("user.csv:4: 'abc' in column 'phase'"), 0U) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos);
    }
}

}  // namespace
}  // namespace uw
