// ctest labels: unit
#include <gtest/gtest.h>

#include "tests/support/cli_test.h"

namespace uw {
namespace {

constexpr auto k_triangle = R"(ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
0 0 3
1 0 3
0 1 3
3 0 1 2
)";

/// A scene in a folder of its own, "given", beside files that are none of its business.
class Confine : public test::CliTest {
  protected:
    Confine() {
        std::filesystem::create_directories(folder_ / "given/meshes");
        write("given/meshes/own.ply", k_triangle);
        write("secret.ply", k_triangle);
        write("secret.csv", "angle_deg,phase\n0,1\n180,1\n");
    }
    void write_scene(const std::string& water, const std::string& mesh) const {
        write("given/s.yaml",
              "uwvdb: 1\ncamera: {resolution: [16, 9], intrinsics: {fov_x: 60}}\n"
              "water: {" +
                  water + "}\ngeometry: [{file: " + mesh +
                  "}]\nlamps: [{position: [1, 0, 0], intensity: 50}]\n");
    }
    void expect_refused(const std::vector<std::string>& command, const std::string& file) const {
        std::vector<std::string> arguments = command;
        arguments.push_back("--confine");
        expect_failure(arguments, 3, file + ": lies outside '");
        EXPECT_FALSE(exists("out.exr"));
    }
};

const std::vector<std::string> k_render{"render", "given/s.yaml", "-o", "out.exr"};

TEST_F(Confine, FilesInAndBelowTheScenesFolderAreRead) {
    write_scene("salinity: 30", "meshes/own.ply");
    const auto result = run({"render", "given/s.yaml", "--confine", "-o", "out.exr"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(exists("out.exr"));
}

TEST_F(Confine, OthersAreNot) {
    write_scene("salinity: 30", "../secret.ply");
    expect_refused(k_render, "secret.ply");
    expect_refused({"info", "given/s.yaml"}, "secret.ply");
    write_scene("salinity: 30", (folder_ / "secret.ply").string());
    expect_refused(k_render, "secret.ply");
    write_scene("scattering: {b: 1, phase: {type: table, file: ../secret.csv}}", "meshes/own.ply");
    expect_refused(k_render, "secret.csv");
    EXPECT_EQ(run(k_render).exit_code, 0);  // without --confine
}

TEST_F(Confine, InfoNamesOthers) {
    write_scene("salinity: 30", "meshes/own.ply");
    EXPECT_EQ(run({"info", "given/s.yaml"}).out.find("outside the scene's folder"),
              std::string::npos);
    std::filesystem::create_symlink("../secret.ply", folder_ / "given/link.ply");
    for (const char* mesh : {"../secret.ply", "link.ply"}) {
        write_scene("scattering: {b: 1, phase: {type: table, file: ../secret.csv}}", mesh);
        const std::string named = std::filesystem::canonical(folder_.path()).string();
        EXPECT_NE(run({"info", "given/s.yaml"})
                      .out.find("files outside the scene's folder, which --confine refuses\n  " +
                                named + "/secret.csv\n  " + named + "/secret.ply\n"),
                  std::string::npos);
        EXPECT_NE(run({"info", "given/s.yaml", "--json"}).out.find("\"files_outside\": "),
                  std::string::npos);
    }
}

TEST_F(Confine, LinksDoNotLeadOut) {
    std::filesystem::create_symlink("../secret.ply", folder_ / "given/link.ply");
    write_scene("salinity: 30", "link.ply");
    expect_refused(k_render, "link.ply");
}

TEST_F(Confine, WhatFilesNameIsConfinedToo) {
    write("given/m.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
        "nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
        "bufferViews":[{"buffer":0,"byteLength":36}],
        "buffers":[{"byteLength":36,"uri":"../secret.bin"}]})");
    write("secret.bin", std::string(36, '\0'));
    write_scene("salinity: 30", "m.gltf");
    const auto result = run({"render", "given/s.yaml", "--confine", "-o", "out.exr"});
    EXPECT_EQ(result.exit_code, 3) << result.err;
}

}  // namespace
}  // namespace uw
