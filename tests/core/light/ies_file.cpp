// ctest labels: unit
#include "core/light/photometric_files.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/ies_files.h"
#include "tests/support/scene_folder.h"

namespace uw {
namespace {

test::IesWriter narrow() {
    test::IesWriter writer;
    writer.polar = {0, 45, 90};
    writer.candelas = [](double polar, double) { return 90 - polar; };
    return writer;
}

std::string error_of(const std::string& text) {
    try {
        parse_ies(text, "lamp.ies");
    } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        return error.what();
    }
    return "";
}

TEST(IesFile, EveryYearOfTheStandard) {
    const auto year_of = [](const std::string& first_line) {
        test::IesWriter writer = narrow();
        writer.first_line = first_line;
        return parse_ies(writer.text(), "lamp.ies").year;
    };
    EXPECT_EQ(year_of("Fixture of 1986, which has no first line of its own"), 1986);
    EXPECT_EQ(year_of("IESNA91"), 1991);
    EXPECT_EQ(year_of("IESNA:LM-63-1995"), 1995);
    EXPECT_EQ(year_of("IESNA:LM-63-2002"), 2002);
    EXPECT_EQ(year_of("IESNA:LM-63-2019"), 2019);
}

TEST(IesFile, FactorsAreAppliedAsTheirYearSays) {
    test::IesWriter writer = narrow();
    writer.multiplier = 4.8;
    writer.ballast = 0.9;
    writer.second = 0.5;
    // From 1995 on the number behind the ballast factor means nothing.
    EXPECT_DOUBLE_EQ(parse_ies(writer.text(), "lamp.ies").candelas[1], 45 * 4.8 * 0.9);
    writer.first_line = "IESNA91";
    EXPECT_DOUBLE_EQ(parse_ies(writer.text(), "lamp.ies").candelas[1], 45 * 4.8 * 0.9 * 0.5);
}

TEST(IesFile, LumensAreOfAllLampsOrNotTold) {
    test::IesWriter writer = narrow();
    EXPECT_LT(parse_ies(writer.text(), "lamp.ies").lumens, 0);  // absolute photometry
    writer.lumens = 750;
    EXPECT_EQ(parse_ies(writer.text(), "lamp.ies").lumens, 750);
}

TEST(IesFile, NumbersStandBetweenBlanksCommasAndLineEnds) {
    const IesFile file = parse_ies(
        "\xEF\xBB\xBFIESNA91\r\n[TEST]\r\ntilt=none\r\n1,68\r\n1\t2 1 1\r\n1 0 0 0\r\n1 1 "
        "5.4000\r\n0,90\r\n0\r\n1.5e2,.5\r\n\x1A",
        "lamp.ies");
    EXPECT_EQ(file.candelas, (std::vector<double>{150, 0.5}));
    EXPECT_EQ(file.polar, (std::vector<double>{0, 90}));
    EXPECT_TRUE(file.warnings.empty());
}

TEST(IesFile, TiltIsReadPastAndWarnedOf) {
    test::IesWriter writer = narrow();
    writer.tilt = "TILT=INCLUDE\n1\n3\n0 45 90\n1 0.9 0.8";
    const IesFile included = parse_ies(writer.text(), "lamp.ies");
    EXPECT_EQ(included.candelas, (std::vector<double>{90, 45, 0}));
    ASSERT_EQ(included.warnings.size(), 1U);
    EXPECT_NE(included.warnings[0].find("TILT"), std::string::npos);
    writer.tilt = "TILT=factors.tlt";
    EXPECT_EQ(parse_ies(writer.text(), "lamp.ies").warnings.size(), 1U);
}

TEST(IesFile, OtherTypesOfPhotometryAreNamed) {
    test::IesWriter writer = narrow();
    writer.type = 2;
    EXPECT_EQ(error_of(writer.text()),
              "lamp.ies:4: its photometry is of type B; only type C is supported: convert it to "
              "type C, or ask the manufacturer for a type C file");
    writer.type = 3;
    EXPECT_NE(error_of(writer.text()).find("type A"), std::string::npos);
    writer.type = 7;
    EXPECT_NE(error_of(writer.text()).find("must be 1 (type C), found 7"), std::string::npos);
}

TEST(IesFile, HostileFilesAreOneLine) {
    const std::string head = "IESNA91\nTILT=NONE\n1 100 1 ";
    const std::string tail = " 1 1 0 0 0\n1 1 1\n";
    struct Case {
        std::string text, says;
    };
    const std::vector<Case> cases{
        {"", "no line 'TILT='"},
        {"# a YAML file\nlamps: []\n", "no line 'TILT='"},
        {"IESNA91\nTILT=NONE\n", "ends before the number of lamps"},
        {head + "999999999 1" + tail, "the number of vertical angles must be a whole number"},
        {head + "3 1e300" + tail,
         "expected a number for the number of horizontal angles, found '1e300'"},
        {head + "-2 1" + tail, "the number of vertical angles must be"},
        {head + "2.5 1" + tail, "the number of vertical angles must be"},
        {head + "nan 1" + tail, "expected a number for the number of vertical angles, found 'nan'"},
        {head + "6 6" + tail, "more candelas than this file can hold"},
        {head + "2 1" + tail + "0 90 0 5", "ends before a candela value"},
        {head + "2 1" + tail + "0 90 0 5 inf",
         "expected a number for a candela value, found 'inf'"},
        {head + "2 1" + tail + "0 90 0 5 five",
         "expected a number for a candela value, found 'five'"},
        {head + "2 1" + tail + "0 90 0 5 -1", "a candela value must not be negative, found -1"},
        {head + "2 1" + tail + "0 90 0 0 0", "this luminaire is dark"},
        {head + "2 1" + tail + "90 0 0 5 5", "vertical angles must ascend, found 0 after 90"},
        {head + "2 1" + tail + "0 270 0 5 5", "vertical angles must be from 0 to 180 degrees"},
        {head + "1 1" + tail + "0 0 5 5 5 5 5 5 5", "has only one vertical angle"},
        {head + "2 2" + tail + "0 90 0 45 5 5 5 5", "its horizontal angles go from 0 to 45"},
        {head + "2 2" + tail + "0 90 10 10 5 5 5 5", "horizontal angles must ascend"},
    };
    for (const Case& c : cases)
        EXPECT_NE(error_of(c.text).find(c.says), std::string::npos) << c.says << "\n"
                                                                    << error_of(c.text);
}

TEST(IesFile, WarnsOfWhatIsOdd) {
    test::IesWriter writer = narrow();
    writer.polar = {10, 80};
    EXPECT_EQ(parse_ies(writer.text(), "lamp.ies").warnings.size(), 1U);
    EXPECT_EQ(parse_ies(narrow().text() + " 17", "lamp.ies").warnings.size(), 1U);
}

TEST(IesFile, FilesOfTheDiskAreLimited) {
    const test::SceneFolder folder;
    EXPECT_THROW(read_ies(folder.path() / "none.ies"), IoError);
    EXPECT_THROW(read_ies(folder.path()), IoError);
    EXPECT_THROW(read_ies(folder.write("large.ies", std::string(5 << 20, ' '))), InputError);
    EXPECT_EQ(read_ies(folder.write("lamp.ies", narrow().text())).candelas[0], 90);
}

}  // namespace
}  // namespace uw
