#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/scene/scene_context.h"
#include "core/scene/yaml_document.h"
#include "tests/support/message_of.h"
#include "tests/support/scene_folder.h"

namespace uw::test {

/// Reads sections of scenes with three bands, and what is wrong with them.
template <class Desc>
class SectionReader : public testing::Test {
  protected:
    using Read = Desc (*)(const ConfigValue&, const SceneContext&);

    /// `name`: of the section, by its keys.
    SectionReader(std::string name, Read reader) : name_(std::move(name)), read_(reader) {}

    Desc read(const std::string& text) const {
        const ConfigNode node = parse_yaml(text, "scene.yaml");
        return read_(ConfigValue(node, name_), context_);
    }
    void expect_refused(const std::string& text, const std::string& part) const {
        const std::string message = message_of<InputError>([&] { read(text); });
        EXPECT_NE(message.find(part), std::string::npos) << text << "\n  gave: " << message;
        EXPECT_EQ(message.find("scene.yaml:1:"), 0U) << message;
    }

    SceneFolder folder_;
    std::vector<std::string> warnings_;
    SceneContext context_{folder_.path(), 3, &warnings_, std::nullopt};

  private:
    std::string name_;
    Read read_;
};

}  // namespace uw::test
