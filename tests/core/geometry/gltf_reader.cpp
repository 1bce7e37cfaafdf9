// ctest labels: unit
#include "core/geometry/gltf_reader.h"

#include <gtest/gtest.h>

#include "core/geometry/mesh_reader.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/meshes/mesh_reading.h"

namespace uw {
namespace {

using test::bytes_of;
using test::corner_positions;
using test::gltf_text;

class MeshReaderGltf : public test::MeshReading {};

TEST_F(MeshReaderGltf, TransformsByTheNodeHierarchy) {
    // Parent: 90 degrees about z, then up by 10 in z. Child: scale (2, 3, 4), moved 1 along x.
    const TriangleMesh mesh =
        read("nodes.gltf", gltf_text({{"nodes", R"([{"children":[1],"translation":[0,0,10],
                                       "rotation":[0,0,0.70710678118654752,0.70710678118654752]},
                                      {"mesh":0,"scale":[2,3,4],"translation":[1,0,0]}])"}}));
    // (x, y) -> scaled and moved (1 + 2x, 3y) -> turned (-3y, 1 + 2x).
    const std::vector<float> expected = {0, 1, 10, 0, 3, 10, -3, 1, 10};
    const std::vector<float> actual = corner_positions(mesh);
    ASSERT_EQ(actual.size(), expected.size());
    // Single precision of coordinates up to 10.
    for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(actual[k], expected[k], 2e-6);
    EXPECT_TRUE(mesh.normals.empty());  // none in the file, none made up
}

TEST_F(MeshReaderGltf, RepeatsAMeshThatSeveralNodesUse) {
    const TriangleMesh mesh = read(
        "twice.gltf", gltf_text({{"scenes", R"([{"nodes":[0,1]}])"},
                                 {"nodes", R"([{"mesh":0},{"mesh":0,"translation":[0,0,5]}])"}}));
    EXPECT_EQ(mesh.triangle_count(), 2U);
    EXPECT_EQ(corner_positions(mesh)[9 + 2], 5.0F);
}

TEST_F(MeshReaderGltf, MultipliesNothingButKeepsFactorTextureAndColors) {
    folder_.write("four texels.png", test::four_texel_png());
    const TriangleMesh mesh =
        read("look.gltf",
             gltf_text({{"meshes", R"([{"primitives":[{"attributes":
                        {"POSITION":0,"TEXCOORD_0":2,"COLOR_0":3},"indices":1,"material":0}]}])"},
                        {"materials", R"([{"doubleSided":true,"pbrMetallicRoughness":
                        {"metallicFactor":0,"baseColorFactor":[0.5,0.25,0.125,1],
                         "baseColorTexture":{"index":0}}}])"},
                        {"textures", R"([{"source":0,"sampler":0}])"},
                        {"images", R"([{"uri":"four%20texels.png"}])"},
                        {"samplers", R"([{"magFilter":9728,"wrapS":33071,"wrapT":33648}])"}}));
    ASSERT_TRUE(mesh.triangle_materials.empty());
    const MeshMaterial& material = mesh.materials[0];
    EXPECT_EQ(material.base_color, (Rgb{0.5, 0.25, 0.125}));
    EXPECT_TRUE(material.double_sided);
    EXPECT_EQ(material.base_map.lookup.filter, TextureFilter::nearest);
    EXPECT_EQ(material.base_map.lookup.wrap_u, TextureWrap::clamp);
    EXPECT_EQ(material.base_map.lookup.wrap_v, TextureWrap::mirror);
    ASSERT_TRUE(material.base_map.texture);
    ASSERT_EQ(mesh.uvs[0].size(), 6U);
    EXPECT_NEAR(mesh.uvs[0][1], 0.25, 1e-7);
    // (0.25, 0.25) is the middle of the top left texel, which is red.
    const Rgb texel =
        material.base_map.texture->sample(mesh.uvs[0][0], mesh.uvs[0][1], material.base_map.lookup);
    EXPECT_EQ(texel, (Rgb{1, 0, 0}));
    EXPECT_EQ(mesh.colors, (std::vector<float>{.5F, .25F, 1, .5F, .25F, 1, .5F, .25F, 1}));
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(MeshReaderGltf, ReadsColorsStoredAsShorts) {
    const std::string buffer = bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}) +
                               bytes_of<std::uint16_t>({65535, 0, 13107, 65535, 65535, 0, 13107,
                                                        65535, 65535, 0, 13107, 65535});
    const TriangleMesh mesh = read(
        "shorts.gltf",
        gltf_text({{"meshes", R"([{"primitives":[{"attributes":{"POSITION":0,"COLOR_0":1}}]}])"},
                   {"accessors",
                    R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
                             {"bufferView":1,"componentType":5123,"normalized":true,"count":3,
                              "type":"VEC4"}])"},
                   {"bufferViews", R"([{"buffer":0,"byteLength":36},
                                            {"buffer":0,"byteOffset":36,"byteLength":24}])"},
                   {"buffers", R"([{"byteLength":60,"uri":"data:application/octet-stream;base64,)" +
                                   test::base64(buffer) + R"("}])"}}));
    ASSERT_EQ(mesh.colors.size(), 9U);
    EXPECT_NEAR(mesh.colors[0], 1.0, 1e-6);
    EXPECT_NEAR(mesh.colors[1], 0.0, 1e-6);
    EXPECT_NEAR(mesh.colors[2], 0.2, 1e-6);
    EXPECT_EQ(mesh.materials[0].base_color, (Rgb{1, 1, 1}));  // no material: the colours alone
}

TEST_F(MeshReaderGltf, NamesWhatItIgnoresInOneLine) {
    read("ignored.gltf",
         gltf_text({{"cameras", R"([{"type":"perspective","perspective":{"yfov":1,"znear":1}}])"},
                    {"materials", R"([{"emissiveFactor":[1,0,0],"alphaMode":"BLEND",
                                     "occlusionTexture":{"index":0}}])"},
                    {"extensionsUsed", R"(["KHR_lights_punctual"])"}}));
    ASSERT_EQ(warnings_.size(), 1U);
    EXPECT_NE(warnings_[0].find("ignored: alpha blending, metallic, occlusion maps"),
              std::string::npos)
        << warnings_[0];
}

TEST_F(MeshReaderGltf, NodesAreObjectsWithTheirNames) {
    const MeshFile file = read_file(
        "names.gltf",
        gltf_text({{"scenes", R"([{"nodes":[3,0,2]}])"},
                   {"nodes", R"([{"name":"rock","mesh":0,"children":[1]},
                                 {"mesh":1,"translation":[0,0,5]},{"mesh":0},
                                 {"name":"empty"},{"name":"not shown","mesh":0}])"},
                   {"materials", R"([{"name":"steel"},{}])"},
                   {"meshes", R"([{"primitives":[{"attributes":{"POSITION":0},"indices":1},
                                  {"attributes":{"POSITION":0},"indices":1,"material":1}]},
                                  {"name":"stone","primitives":[{"attributes":{"POSITION":0}}]}])"}}));
    EXPECT_EQ(file.objects, (std::vector<std::string>{"rock", "stone", "node2"}));
    EXPECT_EQ(file.materials, (std::vector<std::string>{"steel", "material2"}));
    EXPECT_EQ(file.mesh.triangle_objects, (std::vector<std::uint32_t>{0, 0, 1, 2, 2}));
    ASSERT_EQ(file.mesh.materials.size(), 2U);  // those in use, and none
    EXPECT_EQ(file.mesh.materials[0].number, 2U);
    EXPECT_EQ(file.mesh.materials[1].number, 0U);
    EXPECT_EQ(file.mesh.triangle_materials, (std::vector<std::uint32_t>{1, 0, 1, 1, 0}));
    EXPECT_TRUE(file.shared.empty());  // too small
}

TEST_F(MeshReaderGltf, LargeMeshesOfSeveralNodesAreKeptOnce) {
    // 33 triangles in one mesh: a strip over the three vertices, again and again.
    std::vector<std::uint16_t> corners;
    for (int k = 0; k < 33; ++k) corners.insert(corners.end(), {0, 1, 2});
    const std::string buffer = bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}) + bytes_of(corners);
    const MeshFile file = read_file(
        "shared.gltf",
        gltf_text(
            {{"scenes", R"([{"nodes":[0,1,2,3]}])"},
             {"nodes", R"([{"mesh":0,"name":"a"},{"mesh":1,"name":"b"},
                                 {"mesh":0,"name":"c","translation":[0,0,5]},
                                 {"mesh":0,"name":"flat","scale":[1,1,0]}])"},
             {"meshes", R"([{"primitives":[{"attributes":{"POSITION":0},"indices":1}]},
                                  {"primitives":[{"attributes":{"POSITION":0}}]}])"},
             {"accessors", R"([{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
                        {"bufferView":1,"componentType":5123,"count":99,"type":"SCALAR"}])"},
             {"bufferViews", R"([{"buffer":0,"byteLength":36},
                                       {"buffer":0,"byteOffset":36,"byteLength":198}])"},
             {"buffers", R"([{"byteLength":234,"uri":"data:application/octet-stream;base64,)" +
                             test::base64(buffer) + R"("}])"}}));
    ASSERT_EQ(file.shared.size(), 1U);
    EXPECT_EQ(file.shared[0].mesh.triangle_count(), 33U);
    ASSERT_EQ(file.shared[0].placements.size(), 2U);
    EXPECT_EQ(file.shared[0].placements[1].object, 2U);
    EXPECT_EQ(file.shared[0].placements[1].file_from_mesh.offset(), Vector3(0, 0, 5));
    // What is there once, and what no transform could be undone of.
    ASSERT_EQ(file.mesh.triangle_objects.size(), 1U + 33U);
    EXPECT_EQ(file.mesh.triangle_objects.front(), 1U);
    EXPECT_EQ(file.mesh.triangle_objects.back(), 3U);
    EXPECT_EQ(file.objects, (std::vector<std::string>{"a", "b", "c", "flat"}));
}

TEST_F(MeshReaderGltf, FilesWithoutAMeshAreReadForTheirCameraOrLamps) {
    const std::string text =
        R"({"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"camera":0}],
            "cameras":[{"type":"perspective","perspective":{"yfov":1,"znear":1}}]})";
    for (const std::string& bytes : {text, test::glb_bytes(text)}) {
        const auto file = folder_.write(bytes == text ? "eye.gltf" : "eye.glb", bytes);
        EXPECT_FALSE(read_mesh(file, warnings_, {.camera_or_lamps = true}).has_triangles());
        EXPECT_THROW(read_mesh(file, warnings_), InputError);
    }
    EXPECT_NE(error_of("eye.gltf", text).find("camera: true"), std::string::npos);
}

TEST_F(MeshReaderGltf, NamesWhatWouldMoveInOneLine) {
    read("moves.gltf",
         gltf_text({{"scenes", R"([{"nodes":[0,1,2]}])"},
                    {"nodes", R"([{"mesh":0,"name":"fish","skin":0},{"name":"lid"},{}])"},
                    {"skins", R"([{"joints":[1]}])"},
                    {"animations", R"([{"channels":[{"target":{"node":1,"path":"rotation"}},
                        {"target":{"node":2,"path":"scale"}},{"target":{"node":99}},{}]},
                        {"channels":[{"target":{"node":1,"path":"translation"}}]}])"}}));
    ASSERT_EQ(warnings_.size(), 1U);
    EXPECT_NE(warnings_[0].find("animations of 'lid', 'node2' stand still"), std::string::npos)
        << warnings_[0];
}

TEST_F(MeshReaderGltf, ManyNodesAreNamedInShort) {
    std::string nodes, channels;
    for (int k = 0; k < 9; ++k) {
        nodes += std::string(k == 0 ? "" : ",") + R"({"mesh":0})";
        channels +=
            std::string(k == 0 ? "" : ",") + R"({"target":{"node":)" + std::to_string(k) + "}}";
    }
    read("many.gltf", gltf_text({{"nodes", "[" + nodes + "]"},
                                 {"animations", R"([{"channels":[)" + channels + "]}]"}}));
    ASSERT_EQ(warnings_.size(), 1U);
    EXPECT_NE(warnings_[0].find("'node5' and 3 more stand still"), std::string::npos)
        << warnings_[0];
}

TEST_F(MeshReaderGltf, RefusesGltfThatContradictsItself) {
    const auto refused = [&](const std::map<std::string, std::string>& changes) {
        return error_of("bad.gltf", gltf_text(changes));
    };
    EXPECT_NE(refused({{"nodes", R"([{"mesh":0,"children":[0]}])"}}).find("cycle"),
              std::string::npos);
    EXPECT_NE(refused({{"nodes", R"([{"children":[2]},{"children":[2]},{"mesh":0}])"}})
                  .find("two parents"),
              std::string::npos);
    EXPECT_NE(refused({{"extensionsRequired", R"(["KHR_draco_mesh_compression"])"}})
                  .find("KHR_draco_mesh_compression"),
              std::string::npos);
    EXPECT_NE(refused({{"accessors",
                        R"([{"bufferView":0,"componentType":5126,"count":4000000000,"type":"VEC3"},
                            {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}])"}})
                  .find("larger count"),
              std::string::npos);
    EXPECT_NE(refused({{"accessors",
                        R"([{"bufferView":0,"byteOffset":24,"componentType":5126,"count":3,
                             "type":"VEC3"},
                            {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}])"}}),
              "");
    EXPECT_NE(refused({{"accessors",
                        R"([{"bufferView":0,"componentType":5122,"count":3,"type":"VEC3"},
                            {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}])"}})
                  .find("quantised"),
              std::string::npos);
    EXPECT_NE(refused({{"asset", std::string(5000, '[')}}), "");
}

}  // namespace
}  // namespace uw
