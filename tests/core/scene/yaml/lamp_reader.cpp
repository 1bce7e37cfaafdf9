// ctest labels: unit
#include "core/scene/yaml/lamp_reader.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/scene/yaml/yaml_document.h"
#include "tests/support/scene_folder.h"

namespace uw {
namespace {

class LampReader : public ::testing::Test {
  protected:
    std::vector<LampDesc> read(const std::string& text) const {
        const ConfigNode node = parse_yaml(text, "scene.yaml");
        return read_lamps(ConfigValue(node, "lamps"), context_);
    }
    /// The profile of a lamp that is whole but for it.
    template <class Desc>
    Desc profile(const std::string& text) const {
        const std::string lamp = "[{position: [0, 0, 0], intensity: 1, profile: " + text + "}]";
        return std::get<Desc>(read(lamp).at(0).profile);
    }

    test::SceneFolder folder_;
    std::vector<std::string> warnings_;
    SceneContext context_{folder_.path(), 3, &warnings_, std::nullopt};
};

TEST_F(LampReader, ReadsEachProfile) {
    profile<IsotropicProfileDesc>("{type: isotropic}");
    const auto spot = profile<SpotProfileDesc>("{type: spot, beam: 60, edge: 5, falloff: gltf}");
    EXPECT_EQ(spot.beam, 60);
    EXPECT_EQ(spot.edge, 5);
    EXPECT_EQ(spot.falloff, SpotProfileDesc::Falloff::gltf);
    EXPECT_EQ(profile<SpotProfileDesc>("{type: spot, beam: 60, falloff: blender}").falloff,
              SpotProfileDesc::Falloff::blender);
    EXPECT_EQ(profile<SpotProfileDesc>("{type: spot, beam: 60, falloff: blender-3.4}").falloff,
              SpotProfileDesc::Falloff::blender_3_4);
    EXPECT_EQ(profile<SpotProfileDesc>("{type: spot, beam: 60}").falloff,
              SpotProfileDesc::Falloff::smooth);
    EXPECT_EQ(profile<CosineProfileDesc>("{type: cosine, fwhm: 70}").fwhm, 70);
    const std::filesystem::path file = folder_.write("lamp.ies", "x");
    const auto ies = profile<IesProfileDesc>("{type: ies, file: lamp.ies, rotate: 30, tilt: -20}");
    EXPECT_EQ(ies.file, file);
    EXPECT_EQ(ies.rotate, 30);
    EXPECT_EQ(ies.tilt, -20);
    EXPECT_NE(ies.where.find("lamps[0].profile"), std::string::npos) << ies.where;
    EXPECT_TRUE(std::holds_alternative<IsotropicProfileDesc>(
        read("[{position: [0, 0, 0], intensity: 1}]").at(0).profile));
}

TEST_F(LampReader, OnlyAbsoluteProfilesNeedNoOutput) {
    folder_.write("lamp.ies", "x");
    EXPECT_NO_THROW(read("[{position: [0, 0, 0], profile: {type: ies, file: lamp.ies}}]"));
    for (const char* const other :
         {"{type: isotropic}", "{type: spot, beam: 60}", "{type: cosine, fwhm: 60}"})
        EXPECT_THROW(read(std::string("[{position: [0, 0, 0], profile: ") + other + "}]"),
                     InputError)
            << other;
}

TEST_F(LampReader, NamesAllProfiles) {
    try {
        profile<IsotropicProfileDesc>("{type: laser}");
        FAIL();
    } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("lamps[0].profile.type: unknown value 'laser'; use one of: "
                               "isotropic, spot, cosine, ies"),
                  std::string::npos)
            << message;
    }
}

}  // namespace
}  // namespace uw
