// ctest labels: unit
#include "core/geometry/ply_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "core/base/error.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

using test::bytes_of;

template <class T>
void expect_numbers(PlyType type, const std::vector<T>& numbers) {
    std::string little = bytes_of(numbers), big;
    for (const T number : numbers) {
        const std::string bytes = bytes_of<T>({number});
        big.append(bytes.rbegin(), bytes.rend());
    }
    std::istringstream little_in(little), big_in(big);
    PlySource little_source(little_in, PlyEncoding::little_endian, "m.ply");
    PlySource big_source(big_in, PlyEncoding::big_endian, "m.ply");
    for (const T number : numbers) {
        EXPECT_EQ(little_source.next(type), static_cast<double>(number));
        EXPECT_EQ(big_source.next(type), static_cast<double>(number));
    }
    EXPECT_THROW(little_source.next(type), InputError);
}

TEST(PlySource, ReadsEachTypeInBothOrders) {
    expect_numbers<std::int8_t>(PlyType::int8, {0, 1, -1, 127, -128});
    expect_numbers<std::uint8_t>(PlyType::uint8, {0, 1, 255});
    expect_numbers<std::int16_t>(PlyType::int16, {258, -2, 32767, -32768});
    expect_numbers<std::uint16_t>(PlyType::uint16, {258, 65535});
    expect_numbers<std::int32_t>(PlyType::int32, {16909060, -1, 2147483647});
    expect_numbers<std::uint32_t>(PlyType::uint32, {16909060, 4294967295});
    expect_numbers<float>(PlyType::float32, {0.1F, -3e38F});
    expect_numbers<double>(PlyType::float64, {0.1, 1e300});
}

TEST(PlySource, ReadsTextOfAnySpacing) {
    std::istringstream in("1 -2.5e3\t+7\r\n\n  0.25 1e-3");
    PlySource source(in, PlyEncoding::ascii, "m.ply");
    for (const double number : {1.0, -2500.0, 7.0, 0.25, 0.001})
        EXPECT_EQ(source.next(PlyType::uint8), number);  // text has no types
    EXPECT_THROW(source.next(PlyType::float32), InputError);
}

TEST(PlySource, PassesTheEndsOfItsBuffer) {
    // Some three megabytes, so that numbers lie across the ends of a buffer of one.
    std::string text, bytes;
    constexpr int k_count = 400000;
    std::vector<float> numbers(2 * k_count);
    for (int i = 0; i < k_count; ++i) text += std::to_string(i) + (i % 7 == 0 ? "\n" : " ");
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(i);
    bytes = "x" + bytes_of(numbers);
    std::istringstream text_in(text), bytes_in(bytes);
    PlySource from_text(text_in, PlyEncoding::ascii, "m.ply");
    for (int i = 0; i < k_count; ++i) ASSERT_EQ(from_text.next(PlyType::int32), i);
    PlySource from_bytes(bytes_in, PlyEncoding::little_endian, "m.ply");
    from_bytes.next(PlyType::uint8);
    for (const float number : numbers) ASSERT_EQ(from_bytes.next(PlyType::float32), number);
}

TEST(PlySource, SaysWhatIsNoNumber) {
    for (const char* word : {"zero", "1.5x", "0x10", "--1", "1,5"}) {
        std::istringstream in(std::string("3 ") + word + " 4");
        PlySource source(in, PlyEncoding::ascii, "m.ply");
        source.next(PlyType::int32);
        EXPECT_EQ(test::message_of<InputError>([&] { source.next(PlyType::int32); }),
                  std::string("m.ply: not a number in the PLY file: '") + word + "'");
    }
    std::istringstream in(std::string(100000, '9'));
    PlySource source(in, PlyEncoding::ascii, "m.ply");
    EXPECT_EQ(test::message_of<InputError>([&] { source.next(PlyType::int32); }),
              "m.ply: not a number in the PLY file: '" + std::string(20, '9') + "'");
}

TEST(PlySource, NoticesEachMissingByte) {
    const std::string whole = bytes_of<double>({1.0});
    for (std::size_t length = 0; length < whole.size(); ++length) {
        std::istringstream in(whole.substr(0, length));
        PlySource source(in, PlyEncoding::little_endian, "m.ply");
        EXPECT_EQ(test::message_of<InputError>([&] { source.next(PlyType::float64); }),
                  "m.ply: the PLY file is truncated; export the mesh again");
    }
}

}  // namespace
}  // namespace uw
