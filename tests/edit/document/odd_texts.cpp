// ctest labels: unit
#include <gtest/gtest.h>

#include <optional>
#include <random>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/scene/key_path.h"
#include "core/scene/yaml_document.h"
#include "edit/document/scene_text.h"
#include "tests/support/edited_scenes.h"

namespace uw::test {
namespace {

std::vector<std::string> all_paths(const ConfigNode& node, const std::string& path) {
    std::vector<std::string> paths;
    if (!path.empty()) paths.push_back(path);
    const auto add = [&paths](const ConfigNode& child, const std::string& child_path) {
        const std::vector<std::string> more = all_paths(child, child_path);
        paths.insert(paths.end(), more.begin(), more.end());
    };
    for (const ConfigNode::Entry& entry : node.entries)
        add(entry.value, path + (path.empty() ? "" : ".") + entry.key);
    for (std::size_t i = 0; i < node.items.size(); ++i)
        add(node.items[i], path + "[" + std::to_string(i) + "]");
    return paths;
}

/// A scene with up to five slips of the hand.
std::string with_slips(std::string text, std::mt19937& random) {
    constexpr std::string_view k_keys = " \n\t#:,[]{}&*'\"-?|>a1!%";
    for (std::size_t slip = random() % 6; slip > 0; --slip) {
        const std::size_t at = random() % text.size();
        const std::size_t kind = random() % 3;
        if (kind == 0) text.insert(at, 1, k_keys[random() % k_keys.size()]);
        if (kind == 1) text.erase(at, 1 + random() % 3);
        if (kind == 2) text.insert(at, text.substr(random() % text.size(), random() % 20));
    }
    return text;
}

// Texts that are YAML by chance: every value of them replaced by something, or removed. Each edit
// is refused, in one line and with the text as before, or the tree is that which an override makes.
TEST(OddTexts, AreChangedAsIntendedOrNotAtAll) {
    std::mt19937 random(5);
    const std::vector<std::string> scenes{k_commented,
                                          k_anchored,
                                          k_flow,
                                          k_json,
                                          with_windows_lines(k_commented),
                                          with_windows_lines(k_flow),
                                          without_last_break(k_anchored)};
    const std::vector<std::string> values{
        "17.25", "[1, 2]", "{beam: 3, type: spot}", "word", "[{name: x, position: [0, 0, 0]}]", ""};
    std::size_t changed = 0, refused = 0;
    for (int round = 0; round < 200; ++round) {
        const std::string text = with_slips(scenes[random() % scenes.size()], random);
        std::optional<SceneText> scene;
        try {
            scene.emplace(text, "scene.yaml");
        } catch (const InputError&) {
            continue;
        }
        for (const std::string& path : all_paths(scene->tree(), "")) {
            const std::string& value = values[random() % values.size()];
            SCOPED_TRACE(text + "\n" + path + " = " + value);
            SceneText edited = *scene;
            try {
                edited.set(path, value);
                ConfigNode intended = parse_yaml(text, "scene.yaml");
                apply_override(intended, path + "=" + value);
                EXPECT_EQ(config_hash(parse_yaml(edited.text(), "")), config_hash(intended));
                ++changed;
            } catch (const InputError& error) {
                EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
                EXPECT_EQ(edited.text(), text);
                ++refused;
            } catch (const UsageError&) {  // a key that no path can name
                EXPECT_EQ(edited.text(), text);
            }
            try {
                SceneText less = *scene;
                less.remove(path);
                EXPECT_NE(config_hash(less.tree()), config_hash(scene->tree()));
            } catch (const InputError&) {
                ++refused;
            } catch (const UsageError&) {  // as above
            }
        }
    }
    EXPECT_GT(changed, 1500U);
    // Two in a thousand of the sets, and a little more of the removals.
    EXPECT_LT(refused, changed / 50);
}

}  // namespace
}  // namespace uw::test
