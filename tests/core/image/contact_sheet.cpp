// ctest labels: unit analytic
#include "core/image/contact_sheet.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/image/image_file.h"
#include "tests/support/temp_dir.h"

namespace uw {
namespace {

constexpr Srgb8 k_ground{32, 32, 32}, k_red_colour{200, 10, 10}, k_blue_colour{10, 10, 200};

class ContactSheet : public testing::Test {
  protected:
    std::filesystem::path picture(const std::string& name, const Preview& image) {
        write_png(folder_ / name, image, {});
        return folder_ / name;
    }
    test::TempDir folder_;
};

TEST_F(ContactSheet, ShowsSmallPicturesAsTheyAreRowByRow) {
    const std::vector<std::filesystem::path> files{picture("a.png", {8, 6, k_red_colour}),
                                                   folder_ / "missing.png",
                                                   picture("c.png", {8, 4, k_blue_colour})};
    const Preview sheet = contact_sheet(files, 2);
    ASSERT_EQ(sheet.width(), 2 * (8 + 4) + 4);
    ASSERT_EQ(sheet.height(), 2 * (6 + 4) + 4);
    for (int y = 0; y < sheet.height(); ++y)
        for (int x = 0; x < sheet.width(); ++x) {
            Srgb8 expected = k_ground;
            if (x >= 4 && x < 12 && y >= 4 && y < 10) expected = k_red_colour;
            if (x >= 4 && x < 12 && y >= 14 && y < 18) expected = k_blue_colour;
            ASSERT_EQ(sheet(x, y), expected) << x << " " << y;
        }
}

TEST_F(ContactSheet, AveragesLightNotCodes) {
    // Columns of black and white: half of the light is code 188 of sRGB, not 128.
    Preview stripes(1280, 720);
    for (int y = 0; y < 720; ++y)
        for (int x = 0; x < 1280; x += 2)
            stripes.row(y)[static_cast<std::size_t>(x)] = {255, 255, 255};
    const std::vector<std::filesystem::path> files{picture("s.png", stripes)};
    const Preview sheet = contact_sheet(files);
    ASSERT_EQ(sheet.width(), 320 + 8);
    ASSERT_EQ(sheet.height(), 180 + 8);
    for (int y = 4; y < 184; ++y)
        for (int x = 4; x < 324; ++x) ASSERT_EQ(sheet(x, y), (Srgb8{188, 188, 188}));
}

TEST_F(ContactSheet, OfManyPicturesIsAbout16By9) {
    const std::filesystem::path file = picture("a.png", {160, 90, k_red_colour});
    const std::vector<std::filesystem::path> files(25, file);
    const Preview sheet = contact_sheet(files);
    EXPECT_EQ(sheet.width(), 5 * 164 + 4);
    EXPECT_EQ(sheet.height(), 5 * 94 + 4);
}

TEST_F(ContactSheet, RefusesWhatIsNoImage) {
    const std::vector<std::filesystem::path> files{folder_ / "x.png"};
    std::ofstream(files.front()) << "text";
    EXPECT_THROW(contact_sheet(files), InputError);
}

}  // namespace
}  // namespace uw
