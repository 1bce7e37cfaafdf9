// ctest labels: unit
#include "core/scene/config_value.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "core/base/error.h"
#include "core/scene/yaml_document.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

ConfigMap port_map(const ConfigNode& root) {
    return {ConfigValue(root, "port"), {"type", "radius", "center"}, "write {type: dome}"};
}

std::string map_error(const ConfigNode& root) {
    return test::message_of<InputError>([&] { port_map(root); });
}

TEST(ConfigMap, FindsWhatIsThere) {
    const ConfigNode root = parse_yaml("{type: dome, radius: 2}", "s.yaml");
    ConfigMap map = port_map(root);
    EXPECT_TRUE(map.has("radius"));
    EXPECT_FALSE(map.has("center"));
    EXPECT_EQ(map.find("radius")->number(""), 2);
    EXPECT_EQ(map.find("radius")->path(), "port.radius");
    EXPECT_FALSE(map.find("center"));
    EXPECT_EQ(map.require("type", "give it").text(""), "dome");
    EXPECT_EQ(test::message_of<InputError>([&] { map.require("center", "give it"); }),
              "s.yaml:1:1: port: 'center' is missing; give it");
}

TEST(ConfigMap, RefusesKeysThatItDoesNotKnow) {
    EXPECT_EQ(map_error(parse_yaml("{type: dome, radios: 2}", "s.yaml")),
              "s.yaml:1:14: port.radios: unknown key; did you mean 'radius'?");
    EXPECT_EQ(map_error(parse_yaml("{colour: red}", "s.yaml")),
              "s.yaml:1:2: port.colour: unknown key; use one of: type, radius, center");
}

TEST(ConfigMap, RefusesWhatIsNoMap) {
    EXPECT_EQ(map_error(parse_yaml("[1, 2]", "s.yaml")),
              "s.yaml:1:1: port: expected a map, found a list of 2; write {type: dome}");
    const ConfigNode root = parse_yaml("port:\n", "s.yaml");
    EXPECT_NE(map_error(*root.find("port"))
                  .find("port: has no value; write {type: dome}, or remove the key"),
              std::string::npos);
}

TEST(ConfigMap, EveryKeyMustBeUsed) {
    const ConfigNode root = parse_yaml("{type: flat, radius: 2}", "s.yaml");
    ConfigMap map = port_map(root);
    map.require("type", "");
    EXPECT_EQ(test::message_of<InputError>([&] { map.finish("type 'flat'"); }),
              "s.yaml:1:14: port.radius: is not used by type 'flat'; remove it");
    map.find("radius");
    EXPECT_NO_THROW(map.finish("type 'flat'"));
}

TEST(ConfigMap, ReadingWhatIsNotAllowedIsAFaultOfTheProgram) {
    const ConfigNode root = parse_yaml("{type: flat}", "s.yaml");
    ConfigMap map = port_map(root);
    EXPECT_THROW(map.find("thickness"), std::logic_error);
}

}  // namespace
}  // namespace uw
