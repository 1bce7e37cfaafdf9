// ctest labels: unit
#include "core/geometry/gltf_import.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/base/error.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

class GltfItemsTest : public testing::Test {
  protected:
    /// The items of a file of one node, with `light` of the extension or `camera`.
    GltfItems with_light(const std::string& light) const {
        return read(R"("nodes":[{"extensions":{"KHR_lights_punctual":{"light":0}}}],
                    "extensions":{"KHR_lights_punctual":{"lights":[)" +
                    light + "]}}");
    }
    GltfItems with_camera(const std::string& camera) const {
        return read(R"("nodes":[{"camera":0}],"cameras":[)" + camera + "]");
    }
    GltfItems read(const std::string& parts) const {
        return read_gltf_items(
            folder_.write("m.gltf", R"({"asset":{"version":"2.0"},)" + parts + "}"));
    }
    void expect_light_refused(const std::string& light, const std::string& what) const {
        const std::string message = test::message_of<InputError>([&] { with_light(light); });
        EXPECT_NE(message.find(what), std::string::npos) << light << ": " << message;
    }
    test::MeshFolder folder_;
};

TEST_F(GltfItemsTest, HaveTheDefaultsOfTheExtension) {
    const GltfLight point = with_light(R"({"type":"point"})").lights.at(0);
    EXPECT_EQ(point.type, GltfLight::Type::point);
    EXPECT_EQ(point.color, (Rgb{1, 1, 1}));
    EXPECT_EQ(point.intensity, 1);
    EXPECT_FALSE(point.has_range);
    EXPECT_EQ(point.name, "light1");
    const GltfLight spot = with_light(R"({"type":"spot","spot":{}})").lights.at(0);
    EXPECT_EQ(spot.type, GltfLight::Type::spot);
    EXPECT_EQ(spot.inner_cone, 0);
    EXPECT_EQ(spot.outer_cone, std::numbers::pi / 4);
}

TEST_F(GltfItemsTest, HaveWhatTheFileSays) {
    const GltfLight sun = with_light(R"({"type":"directional","color":[1,0.5,0],"intensity":3,
                                         "range":10,"name":"sun"})")
                              .lights.at(0);
    EXPECT_EQ(sun.type, GltfLight::Type::directional);
    EXPECT_EQ(sun.color, (Rgb{1, 0.5, 0}));
    EXPECT_EQ(sun.intensity, 3);
    EXPECT_TRUE(sun.has_range);
    EXPECT_EQ(sun.name, "sun");
    const GltfCamera camera =
        with_camera(R"({"type":"perspective","perspective":{"yfov":0.9,"aspectRatio":1.5}})")
            .cameras.at(0);
    EXPECT_TRUE(camera.perspective);
    EXPECT_EQ(camera.yfov, 0.9);
    EXPECT_EQ(camera.aspect_ratio, 1.5);
    EXPECT_FALSE(with_camera(R"({"type":"orthographic"})").cameras.at(0).perspective);
}

TEST_F(GltfItemsTest, StandWhereTheirNodesStandInTheirOrder) {
    const GltfItems items = read(
        R"("nodes":[{"children":[1,2],"translation":[0,0,5]},
                    {"camera":0,"name":"left","translation":[-1,0,0]},
                    {"camera":0,"translation":[1,0,0]}],
           "cameras":[{"name":"pair","type":"perspective","perspective":{"yfov":1}}])");
    ASSERT_EQ(items.cameras.size(), 2U);
    EXPECT_EQ(items.cameras[0].name, "left");  // the node's name goes before its camera's
    EXPECT_EQ(items.cameras[1].name, "pair");
    EXPECT_EQ(items.cameras[0].file_from_camera.offset(), Vector3(-1, 0, 5));
    EXPECT_EQ(items.cameras[1].file_from_camera.offset(), Vector3(1, 0, 5));
    EXPECT_EQ(items.cameras[0].aspect_ratio, 0);  // the file does not say
}

TEST_F(GltfItemsTest, NoNodeNoItem) {
    const GltfItems items = read(R"("nodes":[{}],"cameras":[{"type":"orthographic"}])");
    EXPECT_TRUE(items.cameras.empty());
    EXPECT_TRUE(items.lights.empty());
}

TEST_F(GltfItemsTest, ConesRoundedToFloatsAreTakenBack) {
    const GltfLight wide =
        with_light(
            R"({"type":"spot","spot":{"innerConeAngle":1.5707964,"outerConeAngle":1.5707964}})")
            .lights.at(0);
    EXPECT_EQ(wide.outer_cone, std::numbers::pi / 2);
    EXPECT_EQ(wide.inner_cone, wide.outer_cone);
}

TEST_F(GltfItemsTest, ImpossibleOnesAreRefused) {
    expect_light_refused(R"({"type":"area"})", "neither point, spot nor directional");
    expect_light_refused("{}", "neither point, spot nor directional");
    for (const char* cone : {R"("outerConeAngle":1.6)", R"("outerConeAngle":0)",
                             R"("innerConeAngle":-0.1)", R"("innerConeAngle":0.8)"})
        expect_light_refused(R"({"type":"spot","spot":{)" + std::string(cone) + "}}",
                             "invalid cone angles");
    expect_light_refused(R"({"type":"point","intensity":-1})", "negative intensity or colour");
    expect_light_refused(R"({"type":"point","color":[1,1,-1]})", "negative intensity or colour");
    expect_light_refused(R"({"type":"point","color":"red"})", "the glTF description is broken");
    expect_light_refused("", "refers to a light that does not exist");
    for (const char* lens :
         {R"({"yfov":0})", R"({"yfov":3.2})", "{}", R"({"yfov":1,"aspectRatio":-1})"}) {
        const std::string message = test::message_of<InputError>([&] {
            with_camera(R"({"type":"perspective","perspective":)" + std::string(lens) + "}");
        });
        EXPECT_NE(message.find("invalid yfov or aspectRatio"), std::string::npos) << message;
    }
    EXPECT_THROW(read_gltf_items(folder_.path("none.gltf")), IoError);
}

}  // namespace
}  // namespace uw
