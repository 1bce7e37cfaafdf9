// ctest labels: unit
#include "cli/info/vdb_advice.h"

#include <gtest/gtest.h>

namespace uw {
namespace {

TEST(ConcentrationLikelihood, IsToldByTheName) {
    for (const char* name : {"density", "Smoke_Density", "density_noise"})
        EXPECT_EQ(concentration_likelihood(name), 4) << name;
    for (const char* name : {"smoke", "Sediment", "dye2"})
        EXPECT_EQ(concentration_likelihood(name), 3) << name;
    for (const char* name : {"x", "", "amount"})
        EXPECT_EQ(concentration_likelihood(name), 2) << name;
    for (const char* name : {"temperature", "heat", "flame"})
        EXPECT_EQ(concentration_likelihood(name), 1) << name;
    for (const char* name : {"vel", "Cd", "phi_in", "surface", "shadow_density"})
        EXPECT_EQ(concentration_likelihood(name), 0) << name;
}

}  // namespace
}  // namespace uw
