// ctest labels: unit
#include "core/scene/yaml_document.h"

#include <gtest/gtest.h>

#include <utility>

namespace uw {
namespace {

ConfigNode yaml_node(std::string_view text) {
    return parse_yaml(text, "s.yaml");
}

TEST(ConfigNode, findsTheKeysOfAMap) {
    ConfigNode node = yaml_node("{a: 1, b: {c: 2}}");
    ASSERT_NE(node.find("b"), nullptr);
    EXPECT_EQ(node.find("b")->find("c")->scalar, "2");
    EXPECT_EQ(node.find("c"), nullptr);
    EXPECT_EQ(node.find("a")->find("b"), nullptr) << "a number has no keys";
    node.find("a")->scalar = "5";
    EXPECT_EQ(std::as_const(node).find("a")->scalar, "5");
}

TEST(ConfigNode, describesItselfForMessages) {
    EXPECT_EQ(yaml_node("[1, 2, 3]").description(), "a list of 3");
    EXPECT_EQ(yaml_node("{a: 1}").description(), "a map");
    EXPECT_EQ(yaml_node("abc").description(), "the text 'abc'");
    EXPECT_EQ(yaml_node("5").description(), "the number 5");
    EXPECT_EQ(yaml_node("'5'").description(), "the quoted text '5'");
}

TEST(ConfigNode, positionsAreFileLineAndColumn) {
    const ConfigNode node = yaml_node("a: 1\nb:\n  c: 2\n");
    EXPECT_EQ(node.find("b")->find("c")->position.text(), "s.yaml:3:6");
    EXPECT_EQ(node.entries.at(1).position.text(), "s.yaml:2:1");
    const auto origin = std::make_shared<const std::string>("--set a=1");
    EXPECT_EQ((ConfigPosition{origin, 0, 0}).text(), "--set a=1");
}

TEST(ConfigNode, hashTellsTextFromNumbersAndNesting) {
    const auto hash = [](std::string_view text) { return config_hash(parse_yaml(text, "s")); };
    EXPECT_EQ(hash("{a: 1, b: 2}"), hash("b: 2.0\na: 1e0"));
    EXPECT_NE(hash("{a: 1}"), hash("{a: '1'}"));
    EXPECT_NE(hash("[[1], 2]"), hash("[1, [2]]"));
    EXPECT_NE(hash("[ab, c]"), hash("[a, bc]"));
    EXPECT_NE(hash("{a: 1}"), hash("{a: 2}"));
}

}  // namespace
}  // namespace uw
