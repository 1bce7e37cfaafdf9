// ctest labels: unit statistical
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "core/base/error.h"
#include "core/base/random.h"
#include "core/base/text.h"
#include "core/scene/key_path.h"
#include "core/scene/variations.h"
#include "core/scene/yaml_document.h"
#include "tests/support/message_of.h"
#include "tests/support/scene_folder.h"

namespace uw {
namespace {

using test::message_of;

constexpr const char* k_lamps = "lamps: [{name: left, position: [0, 0, 0]}, {name: right}]\n";

VariationsDesc read(const std::string& section, const std::filesystem::path& file = "scene.yaml") {
    return *read_variations(parse_yaml(k_lamps + section, "scene.yaml"), file);
}

VariationsDesc of_keys(const std::string& keys) {
    return read("variations:\n  seed: 5\n  keys:\n    " + keys + "\n");
}

std::map<std::string, std::string> values_of(const VariationsDesc& variations, int variation) {
    std::map<std::string, std::string> values;
    for (const DrawnValue& value : draw(variations, variation)) values[value.key] = value.text;
    return values;
}

std::string refusal(const std::string& section) {
    return message_of<InputError>([&] { read(section); });
}

TEST(Variations, ASceneWithoutThemHasNone) {
    EXPECT_FALSE(read_variations(parse_yaml(k_lamps, "scene.yaml"), "scene.yaml"));
}

TEST(Variations, AValueDependsOnItsKeyAndNumberAlone) {
    const VariationsDesc one = of_keys("lamps.left.power: {uniform: [10, 30]}");
    const VariationsDesc more =
        of_keys("water.salinity: {uniform: [30, 40]}\n    lamps.left.power: {uniform: [10, 30]}");
    const std::string key = "lamps.left.power";
    EXPECT_NE(values_of(one, 0).at(key), values_of(one, 1).at(key));
    for (const int variation : {0, 1, 999'999})
        EXPECT_EQ(values_of(one, variation).at(key), values_of(more, variation).at(key));
}

TEST(Variations, NumbersReadBackAsTheSameNumber) {
    const VariationsDesc variations = of_keys("a: {log-uniform: [1e-9, 1e9]}");
    for (int i = 0; i < 1000; ++i) {
        const std::string text = values_of(variations, i).at("a");
        double value = 0;
        ASSERT_EQ(parse_number(text, value), NumberText::number) << text;
        EXPECT_EQ(quantile(std::get<NumberDistribution>(variations.keys[0].components[0]),
                           draw_random(5, "a", 0, i)),
                  value)
            << text;
    }
}

TEST(Variations, ListsAreDrawnEntryByEntry) {
    const VariationsDesc variations =
        of_keys("a: [{uniform: [0, 1]}, -0.5, {uniform: [0, 1]}, {choice: [x, 'y: z']}]");
    const std::string text = values_of(variations, 3).at("a");
    const ConfigNode list = parse_yaml_value(text, "test");
    ASSERT_EQ(list.items.size(), 4U) << text;
    EXPECT_EQ(list.items[1].scalar, "-0.5");
    EXPECT_NE(list.items[0].scalar, list.items[2].scalar);  // each has numbers of its own
    EXPECT_TRUE(list.items[3].scalar == "x" || list.items[3].scalar == "y: z") << text;
}

TEST(Variations, ChoicesAreAsFrequentAsTheirWeights) {
    const VariationsDesc variations =
        of_keys("a: {choice: [jerlov-II, [1, 2], {type: hg, g: 0.9}, '7'], weights: [1, 0, 2, 1]}");
    std::map<std::string, int> counts;
    constexpr int k_drawn = 40'000;
    for (int i = 0; i < k_drawn; ++i) ++counts[values_of(variations, i).at("a")];
    EXPECT_EQ(counts.size(), 3U);
    // Standard deviations are 87 and 100; 4.5 of them.
    EXPECT_NEAR(counts["jerlov-II"], k_drawn / 4, 390);
    EXPECT_NEAR(counts["'7'"], k_drawn / 4, 390);
    EXPECT_NEAR(counts["{type: hg, g: 0.9}"], k_drawn / 2, 450);
}

TEST(Variations, RowsAreDrawnTogetherWhetherInTheSceneOrInATable) {
    const test::SceneFolder folder;
    folder.write("sites.csv",
                 "# measured\nwater.preset,lamps[1].power,weight\njerlov-IB,5,1\njerlov-3C,9,3\n");
    const VariationsDesc table =
        read("variations: {together: [{table: sites.csv}]}", folder.path() / "scene.yaml");
    const VariationsDesc rows = read(
        "variations: {together: [{weights: [1, 3], rows: [{water.preset: jerlov-IB, "
        "'lamps[1].power': 5}, {'lamps[1].power': 9, water.preset: jerlov-3C}]}]}");
    int clear = 0;
    constexpr int k_drawn = 4000;
    for (int i = 0; i < k_drawn; ++i) {
        const auto values = values_of(table, i);
        EXPECT_EQ(values, values_of(rows, i));
        const bool is_clear = values.at("water.preset") == "jerlov-IB";
        EXPECT_EQ(values.at("lamps[1].power"), is_clear ? "5" : "9");
        clear += is_clear ? 1 : 0;
    }
    EXPECT_NEAR(clear, k_drawn / 4, 124);  // 4.5 standard deviations
}

TEST(Variations, ErrorsNameThePlaceAndTheHint) {
    const auto expect = [](const std::string& section, const std::string& message) {
        EXPECT_EQ(refusal(section), message);
    };
    expect("variations: {keys: {a: {unifrom: [0, 1]}}}",
           "scene.yaml:2:25: variations.keys.a.unifrom: unknown key; did you mean 'uniform'?");
    expect("variations: {keys: {a: 5}}",
           "scene.yaml:2:24: variations.keys.a: expected a map, found the number 5; give a "
           "distribution, such as {uniform: [0, 1]}");
    expect("variations: {keys: {a: {within: [0, 1]}}}",
           "scene.yaml:2:24: variations.keys.a: names no distribution; use one of uniform, "
           "log-uniform, normal, integer or choice");
    expect("variations: {keys: {a: {uniform: [1, 0]}}}",
           "scene.yaml:2:34: variations.keys.a.uniform: 1 is not below 0; give [lowest, highest]");
    expect("variations: {keys: {a: {log-uniform: [0, 1]}}}",
           "scene.yaml:2:38: variations.keys.a.log-uniform: logarithms need numbers above 0; give "
           "[lowest, highest]");
    expect("variations: {keys: {a: {normal: [0, 1], within: [8, 9]}}}",
           "scene.yaml:2:49: variations.keys.a.within: less than a millionth of the distribution "
           "lies within; widen it");
    expect("variations: {keys: {a: {uniform: [0, 1], within: [0, 1]}}}",
           "scene.yaml:2:42: variations.keys.a.within: is not used by 'uniform'; remove it");
    expect("variations: {keys: {a: {integer: [0, 1.5]}}}",
           "scene.yaml:2:38: variations.keys.a.integer[1]: expected a whole number, found 1.5; "
           "give two whole numbers, [lowest, highest]");
    expect("variations: {keys: {a: {choice: [x, y], weights: [0, 0]}}}",
           "scene.yaml:2:50: variations.keys.a.weights: no weight is above 0; give one that is");
    expect("variations: {keys: {a: [1, 2]}}",
           "scene.yaml:2:24: variations.keys.a: nothing in this list is drawn; give {choice: "
           "[...]} of values");
    expect("variations: {keys: {'a[': {uniform: [0, 1]}}}",
           "scene.yaml:2:21: variations: 'a[' is not the path of a key; write it as for --set, "
           "such as lamps[0].power");
    expect("variations: {seed: 3}",
           "scene.yaml:2:13: variations: draws nothing; give keys: {lamps[0].power: {uniform: [10, "
           "30]}}");
    expect("variations: {together: [{rows: [{a: 1}, {b: 1}]}]}",
           "scene.yaml:2:41: variations.together[0].rows[1]: 'a' is missing; all rows have the "
           "same keys");
}

TEST(Variations, AnOverrideReplacesWhatAKeyIsDrawnFrom) {
    ConfigNode tree = parse_yaml("variations: {keys: {lamps.left.power: {uniform: [1, 2]}}}", "x");
    apply_override(tree, "variations.keys.lamps.left.power.uniform[1]=1.5");
    apply_override(tree, "variations.seed=8");
    const VariationsDesc variations = *read_variations(tree, "scene.yaml");
    EXPECT_EQ(variations.seed, 8U);
    ASSERT_EQ(variations.keys.size(), 1U);
    EXPECT_EQ(variations.keys[0].text, "{uniform: [1, 1.5]}");
}

TEST(Variations, NothingIsDrawnTwiceHoweverItsPathIsWritten) {
    EXPECT_NE(refusal("variations: {keys: {lamps.left.position: {choice: [[0, 0, 1]]}, "
                      "'lamps[0].position[2]': {uniform: [0, 1]}}}")
                  .find("draws both 'lamps.left.position' and 'lamps[0].position[2]', of which "
                        "one is part of the other; draw one of them"),
              std::string::npos);
    EXPECT_NE(refusal("variations: {keys: {'lamps.*.power': {uniform: [1, 2]}, lamps.left.power: "
                      "{uniform: [0, 1]}}}")
                  .find("draws both 'lamps.*.power' and 'lamps.left.power'"),
              std::string::npos);
    const VariationsDesc apart =
        of_keys("lamps.left.power: {uniform: [0, 1]}\n    'lamps[1].power': {uniform: [0, 1]}");
    EXPECT_EQ(apart.keys.size(), 2U);
}

}  // namespace
}  // namespace uw
