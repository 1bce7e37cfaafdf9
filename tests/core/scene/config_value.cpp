// ctest labels: unit
#include "core/scene/config_value.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/scene/yaml_document.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

constexpr auto k_give = "give it";

/// A document of one key, "k", and its value.
class OneValue {
  public:
    explicit OneValue(const std::string& yaml) : root_(parse_yaml("k: " + yaml, "s.yaml")) {}
    ConfigValue get() const { return {*root_.find("k"), "k"}; }

  private:
    ConfigNode root_;
};

template <class Read>
void expect_value_refused(const std::string& yaml, const Read& read, const std::string& what) {
    const OneValue value(yaml);
    EXPECT_EQ(test::message_of<InputError>([&] { read(value.get()); }), "s.yaml:1:4: k: " + what);
}

const auto k_number = [](const ConfigValue& value) { return value.number(k_give); };

TEST(ConfigValue, Numbers) {
    EXPECT_EQ(OneValue("-2.5e3").get().number(k_give), -2500);
    EXPECT_EQ(OneValue("+.5").get().number(k_give), 0.5);
    EXPECT_EQ(OneValue("1e12").get().number(k_give), 1e12);
    expect_value_refused("abc", k_number, "expected a number, found the text 'abc'; give it");
    expect_value_refused("'5'", k_number, "expected a number, found the quoted text '5'; give it");
    expect_value_refused("[1, 2]", k_number, "expected a number, found a list of 2; give it");
    expect_value_refused(".nan", k_number, ".nan is not a finite number; give it");
    expect_value_refused("1e999", k_number,
                         "1e999 is too large or too small for a number; give it");
    expect_value_refused("1.1e12", k_number,
                         "1100000000000 is larger than anything in a scene; give it");
    expect_value_refused("1,5", k_number,
                         "expected a number, found '1,5'; write the decimal point as '.'");
    expect_value_refused("2 m", k_number,
                         "expected a number, found '2 m'; write the number alone, without a unit "
                         "(give it)");
}

TEST(ConfigValue, WithoutAValueSaysSo) {
    const ConfigNode root = parse_yaml("k:\n", "s.yaml");
    const ConfigValue value(*root.find("k"), "k");
    const std::string message = test::message_of<InputError>([&] { value.number(k_give); });
    EXPECT_NE(message.find("k: has no value; give it, or remove the key"), std::string::npos)
        << message;
}

TEST(ConfigValue, Ranges) {
    const auto positive = [](const ConfigValue& value) { return value.positive(k_give); };
    const auto non_negative = [](const ConfigValue& value) { return value.non_negative(k_give); };
    const auto within = [](const ConfigValue& value) { return value.within(1, 3, k_give); };
    const auto between = [](const ConfigValue& value) { return value.between(1, 3, k_give); };
    const auto integer = [](const ConfigValue& value) { return value.integer(1, 3, k_give); };
    EXPECT_EQ(OneValue("1e-300").get().positive(k_give), 1e-300);
    EXPECT_EQ(OneValue("0").get().non_negative(k_give), 0);
    for (const char* end : {"1", "3"}) {
        EXPECT_NO_THROW(within(OneValue(end).get()));
        EXPECT_NO_THROW(integer(OneValue(end).get()));
        EXPECT_THROW(between(OneValue(end).get()), InputError);
    }
    EXPECT_EQ(OneValue("2.0").get().integer(1, 3, k_give), 2);
    expect_value_refused("0", positive, "must be greater than 0, found 0; give it");
    expect_value_refused("-1", non_negative, "must not be negative, found -1; give it");
    expect_value_refused("3.5", within, "must be from 1 to 3, found 3.5; give it");
    expect_value_refused("1", between, "must lie between 1 and 3, found 1; give it");
    expect_value_refused("4", integer, "must be from 1 to 3, found 4; give it");
    expect_value_refused("1.5", integer, "expected a whole number, found 1.5; give it");
}

TEST(ConfigValue, Texts) {
    const auto text = [](const ConfigValue& value) { return value.text(k_give); };
    EXPECT_EQ(OneValue("a b").get().text(k_give), "a b");
    EXPECT_EQ(OneValue("5").get().text(k_give), "5");
    expect_value_refused("''", text, "is empty; give it");
    expect_value_refused("[a]", text, "expected text, found a list of 1; give it");
}

TEST(ConfigValue, EntriesOfListsKnowTheirPaths) {
    const OneValue value("[1, two]");
    const auto entries = value.get().list(k_give);
    ASSERT_EQ(entries.size(), 2U);
    EXPECT_EQ(entries[0].path(), "k[0]");
    EXPECT_EQ(test::message_of<InputError>([&] { entries[1].number(k_give); }),
              "s.yaml:1:8: k[1]: expected a number, found the text 'two'; give it");
    expect_value_refused(
        "1", [](const ConfigValue& v) { v.list(k_give); },
        "expected a list, found the number 1; give it");
    expect_value_refused(
        "[1, 2]", [](const ConfigValue& v) { v.list_of(3, k_give); },
        "expected a list of 3, found a list of 2; give it");
}

TEST(ConfigValue, OnePerBandOrOneForAll) {
    EXPECT_EQ(OneValue("[1, 2, 0]").get().non_negative_per_band(3, k_give),
              (std::vector<double>{1, 2, 0}));
    EXPECT_EQ(OneValue("0.5").get().non_negative_per_band(2, k_give),
              (std::vector<double>{0.5, 0.5}));
    const auto three = [](const ConfigValue& v) { v.non_negative_per_band(3, k_give); };
    expect_value_refused("[1]", three,
                         "has 1 value, but water.bands has 3; give one value per band, or a single "
                         "number for all of them");
    const OneValue negative("[1, -1, 1]");
    EXPECT_NE(test::message_of<InputError>([&] { three(negative.get()); }).find("k[1]: must not"),
              std::string::npos);
}

TEST(ConfigValue, VectorsAndDirections) {
    EXPECT_EQ(OneValue("[1, -2, 3]").get().vector(k_give), Vector3(1, -2, 3));
    EXPECT_EQ(OneValue("[0, -3, 4]").get().direction(k_give), Vector3(0, -0.6, 0.8));
    EXPECT_EQ(OneValue("[1e12, 0, 0]").get().direction(k_give), Vector3(1, 0, 0));
    expect_value_refused(
        "[0, 0, 0]", [](const ConfigValue& v) { v.direction(k_give); },
        "[0, 0, 0] has no direction; give it");
    expect_value_refused(
        "[1, 2]", [](const ConfigValue& v) { v.vector(k_give); },
        "expected a list of 3, found a list of 2; give it");
}

TEST(ConfigValue, ChoicesAreWords) {
    constexpr std::array<std::pair<std::string_view, int>, 2> k_choices{{{"node", 7}, {"cell", 8}}};
    const auto choose = [&](const ConfigValue& value) { return value.choice(k_choices); };
    EXPECT_EQ(choose(OneValue("cell").get()), 8);
    expect_value_refused("cel", choose, "unknown value 'cel'; did you mean 'cell'?");
    expect_value_refused("middle", choose, "unknown value 'middle'; use one of: node, cell");
    expect_value_refused("[node]", choose,
                         "expected text, found a list of 1; use one of: node, cell");
}

}  // namespace
}  // namespace uw
