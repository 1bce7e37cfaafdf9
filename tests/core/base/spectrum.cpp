// ctest labels: unit
#include "core/base/spectrum.h"

#include <gtest/gtest.h>

#include <vector>

namespace uw::test {
namespace {

TEST(Spectrum, ArithmeticGoesBandByBand) {
    constexpr Spectrum a{{1, 2, 4}}, b{{8, -3, 0.5}};
    constexpr Spectrum sum = a + b;
    static_assert(sum == Spectrum{{9, -1, 4.5}});
    EXPECT_EQ(a - b, (Spectrum{{-7, 5, 3.5}}));
    EXPECT_EQ(a * b, (Spectrum{{8, -6, 2}}));
    EXPECT_EQ(2 * a, (Spectrum{{2, 4, 8}}));
    EXPECT_EQ(a * 2, 2 * a);
    EXPECT_EQ(a / 4, (Spectrum{{0.25, 0.5, 1}}));
}

TEST(Spectrum, OperatorsThatAssignGiveTheSame) {
    const Spectrum a{{1, 2, 4}}, b{{8, -3, 0.5}};
    Spectrum value = a;
    value += b;
    EXPECT_EQ(value, a + b);
    value -= b;
    EXPECT_EQ(value, a);
    value *= b;
    EXPECT_EQ(value, a * b);
    value *= 3;
    EXPECT_EQ(value, 3 * (a * b));
    value /= 3;
    EXPECT_EQ(value, a * b);
}

// Whatever a scene does not have stays zero: an image of three bands holds nothing in the others.
TEST(Spectrum, BandsBeyondThoseInUseStayZero) {
    const Spectrum t = per_band(3, [](std::size_t band) { return 1.0 / (1.0 + double(band)); });
    EXPECT_EQ(t, (Spectrum{{1, 0.5, 1.0 / 3}}));
    const Spectrum all = 5 * t * t - t / 2 + t;
    for (std::size_t band = 3; band < all.values.size(); ++band) EXPECT_EQ(all[band], 0.0);
}

TEST(Spectrum, ViewsOfTheBandsInUseLeaveTheOthers) {
    Spectrum sum{{1, 1, 1, 1}};
    const Spectrum more{{1, 2, 3, 4}};
    add(sum.first(2), more.first(2));
    EXPECT_EQ(sum, (Spectrum{{2, 3, 1, 1}}));
    subtract(sum.first(1), more.first(1));
    EXPECT_EQ(sum, (Spectrum{{1, 3, 1, 1}}));
    add_scaled(sum.first(3), 10, more.first(3));
    EXPECT_EQ(sum, (Spectrum{{11, 23, 31, 1}}));
}

TEST(Spectrum, ExtremesAreThoseOfTheBandsInUse) {
    const Spectrum positive{{3, 2, 5}}, negative{{-3, -2, -5}};
    EXPECT_EQ(positive.least(3), 2);
    EXPECT_EQ(negative.greatest(3), -2);
}

}  // namespace
}  // namespace uw::test
