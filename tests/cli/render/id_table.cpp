// ctest labels: unit
#include "render/image_header.h"

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "core/base/csv_table.h"
#include "tests/support/cli_test.h"
#include "tests/support/meshes/mesh_fixtures.h"

namespace uw {
namespace {

TEST(IdTable, IsWrittenForLayersOfNumbers) {
    for (const char* layers : {"id", "all", "depth, material", "normal,id "})
        EXPECT_TRUE(requests_ids(layers)) << layers;
    for (const char* layers : {"", "default", "depth", "lamp.id", "identity,albedo", ","})
        EXPECT_FALSE(requests_ids(layers)) << layers;
    EXPECT_EQ(id_table_beside("a.b/out.0001.exr"), "a.b/out.0001_ids.csv");
}

/// A square of 72 triangles, 1 m wide, in the plane z = 0: too many to be copied to each node.
std::string squares_text() {
    std::vector<float> positions;
    std::vector<std::uint16_t> corners;
    for (int k = 0; k < 49; ++k)
        for (const double p : {k % 7 / 6.0 - 0.5, k / 7 / 6.0 - 0.5, 0.0})
            positions.push_back(static_cast<float>(p));
    for (int k = 0; k < 36; ++k) {
        const int a = k / 6 * 7 + k % 6;
        for (const int corner : {a, a + 1, a + 8, a, a + 8, a + 7})
            corners.push_back(static_cast<std::uint16_t>(corner));
    }
    const std::string buffer = test::bytes_of(positions) + test::bytes_of(corners);
    return test::gltf_text(
        {{"scenes", R"([{"nodes":[0,1,2]}])"},
         {"nodes", R"([{"name":"left, \"port\"","mesh":0,"translation":[-1,0,3]},
                       {"name":"right\n","mesh":0,"translation":[1,0,3]},
                       {"name":"low","mesh":1,"translation":[0,1,3]}])"},
         {"materials", R"([{"name":"steel"},{"name":"Größe"}])"},
         {"meshes", R"([{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":1}]},
                        {"primitives":[{"attributes":{"POSITION":0},"indices":1}]}])"},
         {"accessors", R"([{"bufferView":0,"componentType":5126,"count":49,"type":"VEC3"},
                           {"bufferView":1,"componentType":5123,"count":216,"type":"SCALAR"}])"},
         {"bufferViews", R"([{"buffer":0,"byteLength":588},
                             {"buffer":0,"byteOffset":588,"byteLength":432}])"},
         {"buffers", R"([{"byteLength":1020,"uri":"data:application/octet-stream;base64,)" +
                         test::base64(buffer) + R"("}])"}});
}

class IdTableFile : public test::CliTest {
  protected:
    IdTableFile() { write("squares.gltf", squares_text()); }
    const std::vector<std::string> squares_{
        "--set",
        "geometry=[{type: sphere, center: [0, 0, 9], radius: 2}, {file: squares.gltf, material: "
        "diffuse}]"};
};

TEST_F(IdTableFile, NamesTheInstancesThatTheImageShows) {
    std::vector<std::string> arguments = squares_;
    arguments.insert(arguments.end(), {"--layers", "id,material"});
    const test::ImageFile image = render(arguments);
    EXPECT_EQ(image.names.size(), 6U);
    // 60 degrees over 33 pixels: 28.6 pixels per metre at 1 m, 9.5 at 3 m.
    EXPECT_EQ(image.at("id.V", 16 - 9, 9), 2);
    EXPECT_EQ(image.at("id.V", 16 + 9, 9), 3);
    EXPECT_EQ(image.at("id.V", 16, 9 + 9), 4);
    EXPECT_EQ(image.at("id.V", 16, 9), 1);
    EXPECT_EQ(image.at("id.V", 0, 0), 0);
    EXPECT_EQ(image.at("material.V", 16 - 9, 9), 2);
    EXPECT_EQ(image.at("material.V", 16, 9 + 9), 0);
    EXPECT_EQ(image.at("material.V", 16, 9), 0);
    EXPECT_EQ(read("out_ids.csv"),
              "layer,number,name,geometry\n"
              "id,1,sphere,0\n"
              "id,2,\"left, \"\"port\"\"\",1\n"
              "id,3,right?,1\n"
              "id,4,low,1\n"
              "material,1,steel,1\n"
              "material,2,Größe,1\n");
    const auto ids = nlohmann::json::parse(image.metadata.at("uwvdb/id_names"));
    EXPECT_EQ(ids.size(), 4U);
    EXPECT_EQ(ids.at("2"), "left, \"port\"");
    EXPECT_EQ(ids.at("3"), "right\n");
    EXPECT_EQ(nlohmann::json::parse(image.metadata.at("uwvdb/material_names")).at("2"), "Größe");
}

TEST_F(IdTableFile, IsThereForEachImageThatHasNumbersAlone) {
    const test::ImageFile image = render({"--layers", "default"});
    EXPECT_FALSE(exists("out_ids.csv"));
    EXPECT_EQ(image.metadata.count("uwvdb/id_names"), 0U);
    ASSERT_EQ(run({"render", "scene.yaml", "-o", "s.####.exr", "--frames", "1-2", "--layers", "id"})
                  .exit_code,
              0);
    EXPECT_EQ(read("s.0001_ids.csv"), read("s.0002_ids.csv"));
    EXPECT_EQ(read("s.0001_ids.csv"), "layer,number,name,geometry\nid,1,plane,0\nid,2,box,1\n");
    // One that is missing is rendered again.
    std::filesystem::remove(folder_ / "s.0002_ids.csv");
    const test::ProgramResult again = run({"render", "scene.yaml", "-o", "s.####.exr", "--frames",
                                           "1-2", "--layers", "id", "--resume"});
    EXPECT_EQ(again.exit_code, 0);
    EXPECT_NE(again.err.find("resume: frame 1 is there already, 1 left"), std::string::npos);
    EXPECT_TRUE(exists("s.0002_ids.csv"));
}

TEST_F(IdTableFile, NumbersAreOfNodesAndOfWholeFiles) {
    const auto numbers_of = [&](const std::string& object) {
        std::vector<std::string> arguments = squares_;
        arguments.insert(arguments.end(),
                         {"--layers", "id", "--numbers", "n.csv", "--object", object});
        const test::ImageFile image = render(arguments);
        const CsvTable table(read("n.csv"), "n.csv");
        const std::vector<std::string> parts = table.text("part");
        const auto row = std::ranges::find(parts, object == "2" ? "squares" : object);
        EXPECT_NE(row, parts.end()) << object;
        const auto& ids = image.channels.at("id.V");
        const auto pixels_with = [&](float least, float most) {
            return std::ranges::count_if(ids, [&](float id) { return id >= least && id <= most; });
        };
        const double pixels =
            table.numbers("pixels").at(static_cast<std::size_t>(row - parts.begin()));
        return std::pair{pixels, object == "low" ? pixels_with(4, 4) : pixels_with(2, 4)};
    };
    for (const char* object : {"low", "squares", "2"}) {
        const auto [pixels, expected] = numbers_of(object);
        EXPECT_GT(expected, 20);
        EXPECT_EQ(pixels, static_cast<double>(expected)) << object;
    }
    std::vector<std::string> arguments{"render", "scene.yaml", "--quiet"};
    arguments.insert(arguments.end(), squares_.begin(), squares_.end());
    arguments.insert(arguments.end(), {"--numbers", "n.csv", "--object", "hull"});
    expect_failure(arguments, 2,
                   "--object hull: no such object; the scene has 1 (sphere), 2 (squares)");
}

TEST_F(IdTableFile, ReplacesNoFileThatIsReadOrWritten) {
    expect_failure(
        {"render", "scene.yaml", "-o", "out.exr", "--layers", "id", "--stats", "out_ids.csv"}, 2,
        "the table of ids would replace --stats");
}

}  // namespace
}  // namespace uw
