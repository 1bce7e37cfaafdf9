// ctest labels: unit
#include "core/geometry/obj_reader.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "tests/support/meshes/mesh_fixtures.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

using Names = std::vector<std::string>;

class ObjMaterials : public testing::Test {
  protected:
    /// The materials of a library m.mtl beside the OBJ file.
    std::vector<MeshMaterial> read(const std::string& library, const Names& names,
                                   bool is_pbr = false) {
        folder_.write("m.mtl", library);
        warnings_.clear();
        return read_obj_materials(folder_.path("m.obj"), {"m.mtl"}, names, is_pbr, warnings_);
    }
    void expect_warning(const std::string& part) {
        ASSERT_EQ(warnings_.size(), 1U);
        EXPECT_NE(warnings_[0].find(part), std::string::npos) << warnings_[0];
        EXPECT_TRUE(warnings_[0].starts_with(folder_.path("m.obj").string())) << warnings_[0];
    }
    test::MeshFolder folder_;
    Names warnings_;
};

TEST_F(ObjMaterials, ColoursAreTheLibrarys) {
    const auto materials = read(
        "# a comment\nKd 9 9 9\nnewmtl red paint\r\nKd 0.5 0.25 0.125\r\n\nnewmtl grey\nKd 0.3\n"
        "Ke 2 3 4\nnewmtl red paint\nKd 0 0 0\n",
        {"grey", "red paint"});
    ASSERT_EQ(materials.size(), 2U);
    EXPECT_EQ(materials[1].base_color, (Rgb{0.5, 0.25, 0.125}));  // the first of that name
    EXPECT_EQ(materials[0].base_color, (Rgb{0.3, 0.3, 0.3}));     // one number for three
    EXPECT_EQ(materials[0].emission, (Rgb{2, 3, 4}));             // W m^-2 sr^-1
    EXPECT_EQ(materials[0].number, 1U);
    EXPECT_EQ(materials[1].number, 2U);
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(ObjMaterials, TexturesAreWhereTheFileSaysUpsideUp) {
    folder_.write("four texels.png", test::four_texel_png());
    folder_.write("m.mtl",
                  "newmtl a\nKd 0.5 1 1\nmap_Kd -s 1 1 1 -o 0 0 0 four texels.png\n"
                  "newmtl b\nmap_Kd -clamp on -s 2 0.5 -o 0.1 -0.2 four texels.png\n");
    const auto file = folder_.write(
        "m.obj",
        "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.25 0.75\nusemtl a\nf 1/1 2/1 3/1\n"
        "usemtl b\nf 1/1 2/1 3/1\n");
    const TriangleMesh mesh = read_obj(file, false, warnings_).mesh;
    EXPECT_TRUE(warnings_.empty());
    ASSERT_EQ(mesh.uvs[0].size(), 6U);
    const TextureUse& plain = mesh.materials[0].base_map;
    // v is up: three quarters up is the middle of the top row, whose left texel is red.
    EXPECT_EQ(plain.sample(mesh.uvs[0][0], mesh.uvs[0][1]), (Rgb{1, 0, 0}));
    EXPECT_EQ(mesh.materials[0].base_color, (Rgb{0.5, 1, 1}));
    // (2 u + 0.1, v / 2 - 0.2) of (0.25, 0.75) is (0.6, 0.175), in the bottom right texel; as the
    // picture is counted, 0.825 down.
    const TextureUse& moved = mesh.materials[1].base_map;
    EXPECT_NEAR(moved.transform[0] * 0.25 + moved.transform[2], 0.6, 1e-12);
    EXPECT_NEAR(moved.transform[4] * (1 - 0.75) + moved.transform[5], 1 - 0.175, 1e-12);
    EXPECT_EQ(moved.lookup.wrap_u, TextureWrap::clamp);
    EXPECT_EQ(mesh.materials[1].base_color, (Rgb{1, 1, 1}));  // without Kd the texture alone
    EXPECT_EQ(plain.texture, moved.texture);                  // read once
}

TEST_F(ObjMaterials, RoughnessIsThatOfTheExponentOrItsOwn) {
    const auto materials = read(
        "newmtl phong\nNs 98\nNi 1.4\nnewmtl own\nPr 0.3\nPm 0.9\nNs 98\nmap_Pr r.png\n"
        "newmtl none\n",
        {"phong", "own", "none"}, true);
    EXPECT_NEAR(materials[0].roughness, std::sqrt(std::sqrt(0.02)), 1e-12);  // alpha^2 = 2 / 100
    EXPECT_EQ(materials[0].ior, 1.4);
    EXPECT_EQ(materials[1].roughness, 0.3);
    EXPECT_EQ(materials[1].metallic, 0.9);
    EXPECT_EQ(materials[2].roughness, 1);
    expect_warning("gloss maps");
    // Blender's exporter writes 1000 (1 - roughness)^2.
    EXPECT_NEAR(
        read("# Blender 3.4.1 MTL File: 'None'\nnewmtl a\nNs 250\n", {"a"}, true)[0].roughness, 0.5,
        1e-12);
    // Diffuse surfaces have no gloss to lose.
    EXPECT_EQ(read("newmtl own\nPr 0.3\nmap_Pr r.png\n", {"own"})[0].roughness, 1);
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(ObjMaterials, WhatIsLostIsNamedInOneLine) {
    read(
        "newmtl a\nd 0.5\nmap_Bump -bm 1 b.png\nnorm n.png\nrefl sphere.png\nd 1\n"
        "newmtl b\nTr 0.3\n",
        {"a", "b"});
    expect_warning("ignored of its materials: bump maps, reflections, transparency");
    read("newmtl a\nd 1\nTr 0\nillum 2\nKa 1 1 1\nKs 0.5 0.5 0.5\n", {"a"});
    EXPECT_TRUE(warnings_.empty());
}

TEST_F(ObjMaterials, MissingTexturesLeaveTheColour) {
    folder_.write("old.iff", "FORM");
    folder_.write("copy.png", test::four_texel_png());
    const auto materials = read(
        "newmtl a\nKd 0.2 0.2 0.2\nmap_Kd gone.png\nnewmtl b\nmap_Kd old.iff\n"
        "newmtl c\nmap_Kd C:\\pictures\\copy.png\n",
        {"a", "b", "c"});
    EXPECT_FALSE(materials[0].base_map);
    EXPECT_EQ(materials[0].base_color, (Rgb{0.2, 0.2, 0.2}));
    EXPECT_EQ(materials[1].base_color, (Rgb{0.5, 0.5, 0.5}));
    EXPECT_TRUE(materials[2].base_map);  // beside the library
    ASSERT_EQ(warnings_.size(), 2U);
    EXPECT_NE(warnings_[0].find("textures are missing: 'gone.png'"), std::string::npos);
    EXPECT_NE(warnings_[1].find("unknown formats: 'old.iff'"), std::string::npos);
}

TEST_F(ObjMaterials, LibrariesThatAreMissingOrUnknownAreNamed) {
    const auto materials =
        read_obj_materials(folder_.path("m.obj"), {"gone.mtl"}, {"red"}, false, warnings_);
    EXPECT_EQ(materials[0].base_color, (Rgb{0.5, 0.5, 0.5}));
    expect_warning("material libraries are missing: 'gone.mtl'");
    read("newmtl blue\n", {"red", "blue"});
    expect_warning("that no library (mtllib) has: 'red'");
}

TEST_F(ObjMaterials, LibrariesOutsideTheFolderAreNotRead) {
    std::filesystem::create_directory(folder_.path("inside"));
    folder_.write("secret.mtl", "newmtl red\nKd 1 0 0\n");
    for (const std::string& name :
         {std::string("../secret.mtl"), folder_.path("secret.mtl").string(),
          std::string("sub/../../secret.mtl"), std::string("..\\secret.mtl"),
          std::string("C:\\secret.mtl")}) {
        warnings_.clear();
        const auto materials =
            read_obj_materials(folder_.path("inside/m.obj"), {name}, {"red"}, false, warnings_);
        EXPECT_EQ(materials[0].base_color, (Rgb{0.5, 0.5, 0.5})) << name;
        ASSERT_EQ(warnings_.size(), 1U) << name;
        EXPECT_NE(warnings_[0].find("outside the OBJ's folder are not read"), std::string::npos)
            << warnings_[0];
    }
}

TEST_F(ObjMaterials, SeveralLibrariesAndNamesWithSpacesAreFound) {
    folder_.write("a.mtl", "newmtl a\nKd 0.1\n");
    folder_.write("b c.mtl", "newmtl b\nKd 0.2\n");
    folder_.write("d.mtl", "newmtl d\nKd 0.3\n");
    const auto materials = read_obj_materials(folder_.path("m.obj"), {"b c.mtl", "a.mtl d.mtl"},
                                              {"a", "b", "d"}, false, warnings_);
    EXPECT_TRUE(warnings_.empty());
    EXPECT_EQ(materials[0].base_color[0], 0.1);
    EXPECT_EQ(materials[1].base_color[0], 0.2);
    EXPECT_EQ(materials[2].base_color[0], 0.3);
}

TEST_F(ObjMaterials, BrokenLibrariesAndPicturesAreRefused) {
    const std::string message =
        test::message_of<InputError>([&] { read("newmtl a\nKd 1 x 0\n", {"a"}); });
    EXPECT_TRUE(message.starts_with(folder_.path("m.mtl").string() + ":2: 'x'")) << message;
    folder_.write("broken.png", "this is no picture");
    EXPECT_THROW(read("newmtl a\nmap_Kd broken.png\n", {"a"}), InputError);
}

TEST_F(ObjMaterials, FilesAreListedForThoseWhoWatchThem) {
    folder_.write("t.png", test::four_texel_png());
    folder_.write("m.mtl", "newmtl a\nmap_Kd t.png\nmap_Ke gone.png\n");
    const auto obj = folder_.write("m.obj", "v 0 0 0\nmtllib m.mtl\n");
    EXPECT_EQ(files_named_by_obj(obj),
              (std::vector<std::filesystem::path>{folder_.path("m.mtl"), folder_.path("t.png")}));
    EXPECT_TRUE(files_named_by_obj(folder_.path("none.obj")).empty());
}

}  // namespace
}  // namespace uw
