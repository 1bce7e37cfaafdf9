// ctest labels: unit
#include "core/scene/water_desc.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/section_reader.h"

namespace uw {
namespace {

class PhaseReader : public test::SectionReader<PhaseDesc> {
  protected:
    PhaseReader() : SectionReader("water.scattering.phase", read_phase) {}
};

TEST_F(PhaseReader, ReadsEachType) {
    EXPECT_EQ(read("{type: hg, g: 0.9}").function, PhaseFunctionDesc(HenyeyGreensteinDesc{0.9}));
    EXPECT_EQ(read("{type: fournier-forand}").function,
              PhaseFunctionDesc(FournierForandDesc{1.10, 3.5835}));
    EXPECT_EQ(read("{type: fournier-forand, n: 1.2, mu: 4}").function,
              PhaseFunctionDesc(FournierForandDesc{1.2, 4}));
    EXPECT_EQ(read("{type: petzold}").function, PhaseFunctionDesc(PetzoldDesc{}));
    EXPECT_EQ(read("{type: water}").function, PhaseFunctionDesc(MolecularPhaseDesc{}));
    const std::filesystem::path file = folder_.write("phase.csv", "angle_deg,phase\n");
    EXPECT_EQ(read("{type: table, file: phase.csv}").function,
              PhaseFunctionDesc(TabulatedPhaseDesc{file}));
    EXPECT_EQ(read("{type: petzold}").where, "scene.yaml:1:1: water.scattering.phase");
}

TEST_F(PhaseReader, TwoSpellingsOfAFileAreEqual) {
    folder_.write("phase.csv", "angle_deg,phase\n");
    folder_.write("a/other.csv", "angle_deg,phase\n");
    const PhaseDesc phase = read("{type: table, file: phase.csv}");
    EXPECT_EQ(read("{type: table, file: ./a/../phase.csv}"), phase);
    EXPECT_NE(read("{type: table, file: a/other.csv}"), phase);
}

TEST_F(PhaseReader, NamesAllTypes) {
    expect_refused("{type: isotropic}",
                   "water.scattering.phase.type: unknown value 'isotropic'; use one of: hg, "
                   "fournier-forand, petzold, table, water");
}

}  // namespace
}  // namespace uw
