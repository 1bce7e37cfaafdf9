#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include "core/base/csv_table.h"
#include "core/light/phase_function.h"

/// Published values of phase functions, tabulated in tests/data.
namespace uw::test {

/// A table of tests/data.
inline CsvTable phase_test_table(const std::string& name) {
    std::ifstream stream(UWVDB_SOURCE_DIR "/tests/data/" + name);
    std::stringstream text;
    text << stream.rdbuf();
    return CsvTable(text.str(), name);
}

/// Expects that `p` times `scale` is the column `column` of `table` to its printed digits: 6
/// significant, so 1e-5 relative covers the rounding of the last one.
inline void expect_phase_column(const PhaseFunction& p, const CsvTable& table, const char* column,
                                double scale = 1) {
    const SampledCurve expected = table.curve("angle_deg", column);
    for (std::size_t i = 0; i < expected.x.size(); ++i)
        EXPECT_NEAR(p.eval(expected.x[i] * (std::numbers::pi / 180)) * scale, expected.y[i],
                    1e-5 * expected.y[i])
            << column << " at " << expected.x[i];
}

}  // namespace uw::test
