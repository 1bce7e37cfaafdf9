// ctest labels: unit slow
// Grids whose values or names no program of plumes would give: what info says of them, and that the
// scene that it proposes shows them.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/cli_test.h"
#include "tests/support/vdb/vdb_fixtures.h"

namespace uw {
namespace {

using ParsedJson = nlohmann::json;

class OddGrids : public test::CliTest {
  protected:
    static test::VdbFixture ball(const std::string& name, double amplitude) {
        test::VdbFixture grid;
        grid.name = name;
        grid.max = {12, 12, 12};
        grid.file_from_index = Affine(Matrix3(0.1), Vector3(0));
        grid.value = [amplitude](int i, int j, int k) {
            const double r = std::hypot(i - 6, j - 6, k - 6) / 6;
            return r < 1 ? amplitude * (1 - r * r) : 0;
        };
        return grid;
    }

    /// The advice on a file, whose proposed scene must render.
    std::string advice_on(const std::string& file) const {
        const test::ProgramResult result = run({"info", file, "--json"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        if (result.exit_code != 0) return "";
        const ParsedJson advice = ParsedJson::parse(result.out).at("advice");
        std::string lines;
        for (const ParsedJson& line : advice.at("lines")) lines += line.get<std::string>() + "\n";
        write("proposed.yaml", advice.at("scene").get<std::string>());
        const test::ProgramResult rendered =
            run({"render", "proposed.yaml", "-o", "out.exr", "--size", "32x18", "--quality",
                 "draft", "--set", "render.scattering=single"});
        EXPECT_EQ(rendered.exit_code, 0) << rendered.err;
        return lines;
    }
    /// The contrast, in per cent, that the advice promises.
    static double contrast_in(const std::string& lines) {
        const std::string before = "and a contrast of ";
        const std::size_t at = lines.find(before);
        return at == std::string::npos ? 0 : std::stod(lines.substr(at + before.size()));
    }
};

// A million particles in a drop of water, or a billionth of a fraction, are told as such.
TEST_F(OddGrids, SayWhatUnitTheirValuesMayHave) {
    for (const double amplitude : {1e8, 1e12, 1e15}) {
        test::write_fixture(folder_ / "count.vdb", {ball("count", amplitude)});
        const std::string lines = advice_on("count.vdb");
        EXPECT_NE(lines.find("they may be numbers of particles"), std::string::npos) << lines;
        EXPECT_NE(lines.find("count: {silt: 1 /m3}"), std::string::npos) << lines;
        EXPECT_GE(contrast_in(lines), 30) << lines;
    }
    for (const double amplitude : {1e-8, 1e-12}) {
        test::write_fixture(folder_ / "tiny.vdb", {ball("tiny", amplitude)});
        const std::string lines = advice_on("tiny.vdb");
        EXPECT_NE(lines.find("they may be fractions by volume"), std::string::npos) << lines;
    }
    test::write_fixture(folder_ / "usual.vdb", {ball("density", 1)});
    EXPECT_EQ(advice_on("usual.vdb").find("they may be"), std::string::npos);
}

// What is advised for particles per m3 can be written as it stands: pi/6 (10 um)^3 of 1e9 particles
// is 0.52 ppm.
TEST_F(OddGrids, OfParticlesPerCubicMetreAreASpecies) {
    test::write_fixture(folder_ / "count.vdb", {ball("count", 1e9)});
    write("species.yaml",
          "uwvdb: 1\ncamera: {resolution: [16, 9], intrinsics: {fov_x: 60}, pose: {position: [0.6, "
          "0.6, 4], look_at: [0.6, 0.6, 0]}}\n"
          "water: {species: {silt: {library: silt}}}\n"
          "volumes:\n- {file: count.vdb, grids: {count: {silt: 1 /m3}}}\n"
          "lamps:\n- {name: left, position: [-0.5, 0, 0], intensity: 50}\n");
    const test::ProgramResult result =
        run({"render", "species.yaml", "-o", "out.exr", "--quality", "draft"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(OddGrids, HaveAProposedSceneWhateverTheyAreCalled) {
    for (const char* name : {"", "it's", "[0]", "*", "null", "12", "a: b", "#", "dens\xc3\xa9"}) {
        SCOPED_TRACE(name);
        test::write_fixture(folder_ / "a.vdb", {ball(name, 1)});
        advice_on("a.vdb");
    }
    test::write_fixture(folder_ / "a.vdb", {ball("", 1), ball("", 1)});
    const std::string lines = advice_on("a.vdb");
    EXPECT_NE(lines.find("'[0]', '[1]'"), std::string::npos) << lines;
    test::write_nvdb_fixture(folder_ / "a.nvdb", ball("", 1), "float");
    advice_on("a.nvdb");
    // So it is called in --set, too.
    write("proposed.yaml", run({"info", "a.nvdb", "--scene"}).out);
    const auto rendered =
        run({"render", "proposed.yaml", "-o", "out.exr", "--size", "32x18", "--quality", "draft",
             "--set", "volumes[0].grids[0].large=0", "--set", "volumes.*.grids.*.small=1"});
    EXPECT_EQ(rendered.exit_code, 0) << rendered.err;
}

}  // namespace
}  // namespace uw
