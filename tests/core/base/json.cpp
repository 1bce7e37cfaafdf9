// ctest labels: unit
#include "core/base/json.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>
#include <utility>

#include "core/base/json_string.h"

namespace uw {
namespace {

constexpr double k_infinite = std::numeric_limits<double>::infinity();

TEST(JsonOutput, NumbersThatAreNoneAreNull) {
    EXPECT_EQ(number_json(0.1), 0.1);
    for (const double value : {k_infinite, -k_infinite, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_TRUE(number_json(value).is_null());
    EXPECT_EQ(list_json(std::array{1.0, k_infinite, 2.5}).dump(), "[1.0,null,2.5]");
    EXPECT_EQ(list_json({}).dump(), "[]");
}

TEST(JsonOutput, PlacesAndBoxes) {
    EXPECT_EQ(vector_json({1, 2, k_infinite}).dump(), "[1.0,2.0,null]");
    EXPECT_EQ(point_json({0.5, 0, -1}).dump(), "[0.5,0.0,-1.0]");
    EXPECT_EQ(bounds_json({{0, 1, 2}, {3, 4, 5}}).dump(),
              R"({"min":[0.0,1.0,2.0],"max":[3.0,4.0,5.0]})");
    EXPECT_TRUE(bounds_json(Bounds()).is_null());
}

TEST(JsonOutput, KeysKeepTheirOrderAndNumbersTheirDigits) {
    Json json;
    json["z"] = 1.0 / 3;
    json["a"] = 1;
    const std::string text = json_text(json);
    EXPECT_EQ(text, "{\n  \"z\": 0.3333333333333333,\n  \"a\": 1\n}\n");
    EXPECT_EQ(Json::parse(text).at("z").get<double>(), 1.0 / 3);
}

TEST(JsonOutput, BytesThatAreNoTextAreReplaced) {
    Json json;
    json["name"] = "plume\xff";
    EXPECT_EQ(Json::parse(json_text(json)).at("name"), "plume\xEF\xBF\xBD");
    EXPECT_EQ(json_line(json), "{\"name\":\"plume\xEF\xBF\xBD\"}");
}

TEST(JsonString, IsWhatRfc8259SaysOfEachByte) {
    for (int byte = 0; byte < 256; ++byte) {
        const char c = static_cast<char>(byte);
        std::string expected = fmt::format("\\u{:04x}", byte);  // control characters
        if (byte >= 0x80) expected = "\xEF\xBF\xBD";            // alone no UTF-8: U+FFFD
        if (byte >= 0x20 && byte < 0x80) expected = std::string(1, c);
        for (const auto& [plain, escaped] :
             {std::pair('"', "\\\""), std::pair('\\', "\\\\"), std::pair('\b', "\\b"),
              std::pair('\f', "\\f"), std::pair('\n', "\\n"), std::pair('\r', "\\r"),
              std::pair('\t', "\\t")})
            if (c == plain) expected = escaped;
        EXPECT_EQ(json_string(std::string(1, c)), '"' + expected + '"') << byte;
    }
    EXPECT_EQ(json_string("Kelp ä"), "\"Kelp ä\"");
}

}  // namespace
}  // namespace uw
