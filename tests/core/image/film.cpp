// ctest labels: unit
#include "core/image/film.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "core/base/error.h"

namespace uw {
namespace {

TEST(Film, PixelsOfTheWindowInImageCoordinates) {
    Film film(10, 8, {2, 3, 5, 7}, {"R", "G", "B", "A", "id.V"});
    EXPECT_EQ(film.values().size(), 3u * 4u * 5u);
    for (const float value : film.values()) EXPECT_EQ(value, 0);
    film.pixel(2, 3)[0] = 1;
    film.pixel(4, 6)[4] = 2;
    film.pixel(3, 4)[k_alpha] = 3;
    EXPECT_EQ(film.values().front(), 1);
    EXPECT_EQ(film.values().back(), 2);
    EXPECT_EQ(film.values()[(1 * 3 + 1) * 5 + 3], 3);  // row 1, column 1 of the window
    EXPECT_EQ(film.pixel(3, 4).size(), 5u);
}

TEST(Film, RefusesWindowsOutsideTheImage) {
    for (const PixelWindow& window :
         {PixelWindow{0, 0, 11, 8}, {-1, 0, 5, 5}, {0, 0, 0, 5}, {3, 5, 6, 5}, {0, 0, 10, 9}}) {
        EXPECT_THROW(Film(10, 8, window, {"R", "G", "B", "A"}), UsageError);
    }
}

TEST(Film, GivesSomeOfItsChannels) {
    Film film(4, 3, {1, 1, 3, 3}, {"R", "G", "B", "A", "direct.R", "id.V"});
    for (int y = 1; y < 3; ++y)
        for (int x = 1; x < 3; ++x)
            for (std::size_t c = 0; c < 6; ++c)
                film.pixel(x, y)[c] = static_cast<float>(100 * y + 10 * x) + static_cast<float>(c);
    const Film part = with_channels(film, {"R", "G", "B", "A", "id.V"}, film.window());
    EXPECT_EQ(part.channel_names(), (std::vector<std::string>{"R", "G", "B", "A", "id.V"}));
    EXPECT_EQ(part.window(), film.window());
    for (int y = 1; y < 3; ++y)
        for (int x = 1; x < 3; ++x) {
            EXPECT_EQ(part.pixel(x, y)[2], film.pixel(x, y)[2]);
            EXPECT_EQ(part.pixel(x, y)[4], film.pixel(x, y)[5]);
        }
}

TEST(Film, RefusesWhatMemoryCannotHold) {
    const int side = 1 << 30;  // with 16 channels the count of values is 0 modulo 2^64
    const std::vector<std::string> names(16, "R");
    EXPECT_THROW(Film(side, side, {0, 0, side, side}, names), InputError);
    const int large = 1 << 21;  // 281 TB
    EXPECT_THROW(Film(large, large, {0, 0, large, large}, names), InputError);
    // More than the machine has, less than the address space: Linux grants it, and then ends the
    // program that makes use of it.
    const double machine = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) *
                           static_cast<double>(::sysconf(_SC_PAGESIZE));
    const int rows = static_cast<int>(4 * machine / (4.0 * 16 * 100000)) + 1;
    EXPECT_THROW(Film(100000, rows, {0, 0, 100000, rows}, names), InputError);
}

}  // namespace
}  // namespace uw
