// ctest labels: unit analytic
#include "core/geometry/gltf_primitives.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "core/geometry/geometry_scene.h"
#include "core/geometry/glass.h"
#include "core/geometry/mesh_reader.h"
#include "tests/support/image_file.h"
#include "tests/support/meshes/mesh_reading.h"
#include "tests/support/meshes/textured_gltf.h"
#include "tests/support/surface_probes.h"

namespace uw {
namespace {

using test::build;
using test::TexturedGltf;

constexpr double k_beyond = 1e6;
constexpr auto k_base = R"({"pbrMetallicRoughness":{"metallicFactor":0,"baseColorTexture":)";

class GltfMaterials : public test::MeshReading {
  protected:
    GltfMaterials() {
        // Top row red and green, bottom row blue and white with alphas 0, 100, 200, 255.
        folder_.write("t.png", test::encoded_image("png", 2, 2, 4,
                                                   {255, 0, 0, 0, 0, 255, 0, 100,  //
                                                    0, 0, 255, 200, 255, 255, 255, 255}));
    }
    GeometryDesc desc(const TexturedGltf& gltf) {
        GeometryDesc result;
        result.file = folder_.write("x.gltf", gltf.text());
        return result;
    }
    /// What a ray along -z (or, from behind, along z) meets at (x, y).
    static SurfaceHit hit_at(const Surfaces& surfaces, double x, double y, bool behind = false) {
        SurfaceHit hit;
        const double side = behind ? -1 : 1;
        EXPECT_TRUE(
            surfaces.closest_hit({Point3{x, y, side}, Vector3(0, 0, -side)}, k_beyond, hit));
        return hit;
    }
    Rgb color_at(const std::string& texture_info, double x, double y) {
        TexturedGltf gltf;
        gltf.material = k_base + texture_info + "}}";
        const SurfaceHit hit = hit_at(*build({desc(gltf)}), x, y);
        return {hit.reflectance[0], hit.reflectance[1], hit.reflectance[2]};
    }
};

const Rgb k_red{1, 0, 0}, k_green{0, 1, 0}, k_blue{0, 0, 1}, k_white{1, 1, 1};

TEST_F(GltfMaterials, TextureTransformsMoveScaleAndTurn) {
    // v runs along y here, down the picture.
    EXPECT_EQ(color_at(R"({"index":0})", 0.25, 0.25), k_red);
    EXPECT_EQ(color_at(R"({"index":0})", 0.75, 0.25), k_green);
    EXPECT_EQ(color_at(R"({"index":0})", 0.25, 0.75), k_blue);
    const auto transformed = [](const std::string& transform) {
        return R"({"index":0,"extensions":{"KHR_texture_transform":)" + transform + "}}";
    };
    EXPECT_EQ(color_at(transformed(R"({"offset":[0.5,0]})"), 0.25, 0.25), k_green);
    EXPECT_EQ(color_at(transformed(R"({"offset":[0,0.5]})"), 0.25, 0.25), k_blue);
    // Scaled about the origin: 0.3 becomes 0.6.
    EXPECT_EQ(color_at(transformed(R"({"scale":[2,1]})"), 0.3, 0.25), k_green);
    // A quarter turn, counter-clockwise with v pointing down, takes (u, v) to (v, -u).
    EXPECT_EQ(color_at(transformed(R"({"rotation":1.5707963267948966})"), 0.25, 0.25), k_blue);
    // Scale first, then turn, then move: (0.3, 0.3) -> (0.6, 0.3) -> (0.3, -0.6) -> (0.3, 0.4).
    EXPECT_EQ(
        color_at(transformed(R"({"rotation":1.5707963267948966,"scale":[2,1],"offset":[0,1]})"),
                 0.3, 0.3),
        k_red);
    EXPECT_EQ(color_at(transformed(R"({"texCoord":1})"), 0.25, 0.25), k_white);
}

TEST_F(GltfMaterials, TheSecondSetOfCoordinatesIsReadAndAThirdRefused) {
    EXPECT_EQ(color_at(R"({"index":0,"texCoord":1})", 0.25, 0.25), k_white);
    TexturedGltf gltf;
    gltf.material = std::string(k_base) + R"({"index":0,"texCoord":2}}})";
    EXPECT_NE(error_of("y.gltf", gltf.text()).find("baseColorTexture uses TEXCOORD_2"),
              std::string::npos);
}

TEST_F(GltfMaterials, RaysAndShadowsPassTheHolesOfAMask) {
    TexturedGltf gltf;
    gltf.material = std::string(k_base) + R"({"index":0}},"alphaMode":"MASK"})";
    GeometryDesc wall;
    wall.type = GeometryDesc::Type::plane;
    wall.point = {0, 0, -3};
    for (const bool replaced : {false, true}) {
        GeometryDesc sheet = desc(gltf);
        if (replaced) sheet.reflectance = PerBand{0.5, 0.5, 0.5};  // its colour, not its shape
        const auto surfaces = build({sheet, wall});
        // Alphas 0 and 100/255 are less than the default cutoff of 0.5; 200/255 and 1 are not.
        const double hole_y = 0.25, cloth_y = 0.75;
        for (const double x : {0.1, 0.4, 0.6, 0.9}) {
            EXPECT_EQ(hit_at(*surfaces, x, hole_y).object_id, 2U);
            EXPECT_EQ(hit_at(*surfaces, x, cloth_y).object_id, 1U);
            EXPECT_EQ(surfaces->hit_distance({Point3{x, hole_y, 1}, Vector3(0, 0, -1)}), 4);
            EXPECT_FALSE(surfaces->occluded({x, hole_y, 1}, {x, hole_y, -1}));
            EXPECT_TRUE(surfaces->occluded({x, cloth_y, 1}, {x, cloth_y, -1}));
            EXPECT_TRUE(surfaces->occluded({x, cloth_y, -1}, {x, cloth_y, 1}));
        }
        // In packets, the same to the bit.
        std::vector<Ray> rays;
        std::vector<Point3> ends;
        for (int i = 0; i < 400; ++i) {
            rays.push_back(
                {Point3{0.5, 0.5, 1},
                 glm::normalize(Vector3((i % 20) / 20.0 - 0.47, i / 20 / 20.0 - 0.47, -1))});
            ends.push_back(rays.back().at(2));
        }
        std::vector<SurfaceHit> hits(rays.size());
        std::vector<char> found(rays.size()), blocked(rays.size());
        surfaces->closest_hits(rays, k_beyond, hits, found);
        surfaces->occluded_many(rays[0].origin, ends, blocked);
        int holes = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            SurfaceHit one;
            ASSERT_EQ(surfaces->closest_hit(rays[i], k_beyond, one), found[i] != 0);
            EXPECT_EQ(one.distance, hits[i].distance);
            EXPECT_EQ(one.object_id, hits[i].object_id);
            EXPECT_EQ(surfaces->occluded(rays[i].origin, ends[i]), blocked[i] != 0);
            holes += hits[i].object_id == 2 ? 1 : 0;
        }
        EXPECT_EQ(holes, 200);
    }
}

TEST_F(GltfMaterials, MasksMultiplyFactorTextureAndVertexAlpha) {
    TexturedGltf gltf;
    gltf.material = R"({"alphaMode":"MASK","alphaCutoff":0.3,"pbrMetallicRoughness":
        {"baseColorFactor":[1,1,1,0.5],"baseColorTexture":{"index":0}}})";
    // Vertex alpha 0.8 at x = 0, 0.4 at x = 1; the lower row's texels have 200/255 and 1.
    gltf.colors = {1, 1, 1, .8F, 1, 1, 1, .4F, 1, 1, 1, .4F, 1, 1, 1, .8F};
    const auto surfaces = build({desc(gltf)});
    const auto is_hole = [&](double x, double y) {
        return !(surfaces->hit_distance({Point3{x, y, 1}, Vector3(0, 0, -1)}) < k_beyond);
    };
    EXPECT_FALSE(is_hole(0.05, 0.75));  // 0.5 * 0.784 * 0.78 = 0.306
    EXPECT_TRUE(is_hole(0.20, 0.75));   // 0.5 * 0.784 * 0.72 = 0.282
    EXPECT_TRUE(is_hole(0.51, 0.75));   // 0.5 * 1 * 0.596 = 0.298
}

TEST_F(GltfMaterials, BlendingIsOpaqueAndSaidToBe) {
    TexturedGltf gltf;
    gltf.material = std::string(k_base) + R"({"index":0}},"alphaMode":"BLEND"})";
    read("x.gltf", gltf.text());
    ASSERT_EQ(warnings_.size(), 1U);
    EXPECT_NE(warnings_[0].find("ignored: alpha blending"), std::string::npos);
    EXPECT_EQ(hit_at(*build({desc(gltf)}), 0.25, 0.25).object_id, 1U);
}

TEST_F(GltfMaterials, EmissionIsFactorTimesTextureTimesStrength) {
    TexturedGltf gltf;
    gltf.material = R"({"emissiveFactor":[1,0.5,0.25],"emissiveTexture":{"index":0},"extensions":
        {"KHR_materials_emissive_strength":{"emissiveStrength":8}}})";
    const auto surfaces = build({desc(gltf)});
    for (const bool behind : {false, true}) {
        const SurfaceHit white = hit_at(*surfaces, 0.75, 0.75, behind);
        ASSERT_TRUE(white.has_material);
        const SurfaceMaterial material = surfaces->material(white);
        EXPECT_FALSE(material.is_glossy);
        EXPECT_EQ(material.emission[0], 8);
        EXPECT_EQ(material.emission[1], 4);
        EXPECT_EQ(material.emission[2], 2);
        EXPECT_EQ(white.reflectance[0], 1);  // the base colour's default
    }
    const SurfaceMaterial red = surfaces->material(hit_at(*surfaces, 0.25, 0.25));
    EXPECT_EQ(red.emission[0], 8);
    EXPECT_EQ(red.emission[1], 0);
}

TEST_F(GltfMaterials, PbrComesOnRequestOnly) {
    TexturedGltf gltf;
    gltf.material =
        R"({"pbrMetallicRoughness":{"baseColorFactor":[0.8,0.6,0.4,1],"metallicFactor":1,
        "roughnessFactor":0.5,"metallicRoughnessTexture":{"index":0}},
        "extensions":{"KHR_materials_ior":{"ior":2}}})";
    GeometryDesc entry = desc(gltf);
    EXPECT_FALSE(hit_at(*build({entry}), 0.25, 0.25).has_material);
    EXPECT_NEAR(hit_at(*build({entry}), 0.25, 0.25).reflectance[0], 0.8, 1e-12);
    entry.is_pbr = true;
    const auto surfaces = build({entry});
    // Green is roughness, blue metallic: (0, 1) at the top right, (1, 0) at the bottom left.
    const SurfaceHit rough = hit_at(*surfaces, 0.75, 0.25), metal = hit_at(*surfaces, 0.25, 0.75);
    const SurfaceMaterial rough_material = surfaces->material(rough),
                          metal_material = surfaces->material(metal);
    EXPECT_NEAR(rough.reflectance[1], 0.6, 1e-12);
    EXPECT_EQ(rough_material.roughness, 0.5);
    const double root = (2 - 1.334) / (2 + 1.334);
    EXPECT_NEAR(rough_material.f0[1], root * root, 1e-12);
    EXPECT_EQ(metal.reflectance[1], 0);
    EXPECT_EQ(metal_material.roughness, 0);
    EXPECT_NEAR(metal_material.f0[1], 0.6, 1e-12);
}

TEST_F(GltfMaterials, TransmissionIsGlass) {
    const auto glass_of = [&](const std::string& more, std::vector<std::string>* warnings) {
        TexturedGltf gltf;
        gltf.material =
            R"({"pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0.25,1],"roughnessFactor":0},)"
            R"("extensions":{)" +
            more + "}}";
        std::vector<std::string> ignored;
        auto surfaces =
            build_surfaces({desc(gltf)}, {620, 540, 450}, warnings ? *warnings : ignored);
        const auto* const glass = dynamic_cast<const GlassSurfaces*>(surfaces.get());
        EXPECT_EQ(glass != nullptr, hit_at(*surfaces, 0.25, 0.25).glass != 0);
        return glass ? std::optional(glass->materials().at(0)) : std::nullopt;
    };
    const std::string all = R"("KHR_materials_transmission":{"transmissionFactor":1})";
    const auto thin = glass_of(all, nullptr);
    ASSERT_TRUE(thin);
    EXPECT_EQ(thin->n, 1.5);
    EXPECT_TRUE(thin->is_thin);
    // What is left of light on the normal is the base colour.
    EXPECT_NEAR(std::exp(-thin->absorption[0] * thin->thickness), 1, 1e-12);
    EXPECT_NEAR(std::exp(-thin->absorption[1] * thin->thickness), 0.5, 1e-12);
    EXPECT_NEAR(std::exp(-thin->absorption[2] * thin->thickness), 0.25, 1e-12);
    std::vector<std::string> warnings;
    const auto solid = glass_of(
        all + R"(,"KHR_materials_ior":{"ior":1.33},"KHR_materials_volume":{"thicknessFactor":1,)" +
            R"("attenuationColor":[1,0.5,0.1],"attenuationDistance":0.2})",
        &warnings);
    ASSERT_TRUE(solid);
    EXPECT_EQ(solid->n, 1.33);
    EXPECT_FALSE(solid->is_thin);
    EXPECT_NEAR(std::exp(-0.2 * solid->absorption[2]), 0.1, 1e-12);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("the base colour of solid glass"), std::string::npos) << warnings[0];
    warnings.clear();
    EXPECT_FALSE(glass_of(R"("KHR_materials_transmission":{"transmissionFactor":0.3})", &warnings));
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_NE(warnings[0].find("transmission below 0.5"), std::string::npos) << warnings[0];
}

class NormalMaps : public GltfMaterials {
  protected:
    NormalMaps() {
        folder_.write("t.png", test::encoded_image("png", 1, 1, 4, {192, 160, 222, 255}));
        gltf_.material = R"({"normalTexture":{"index":0,"scale":0.5}})";
    }
    // The texel as a vector; x and y halved by the scale.
    const double x_ = 0.5 * (2 * 192 / 255.0 - 1), y_ = 0.5 * (2 * 160 / 255.0 - 1),
                 z_ = 2 * 222 / 255.0 - 1;
    void expect_normal(const GeometryDesc& entry, const Vector3& ray_origin, const Vector3& ahead,
                       const Vector3& expected) {
        SurfaceHit hit;
        ASSERT_TRUE(
            build({entry})->closest_hit({at_origin_plus(ray_origin), ahead}, k_beyond, hit));
        // 8-bit texels as floats.
        EXPECT_NEAR(glm::length(hit.normal - glm::normalize(expected)), 0, 1e-6)
            << hit.normal.x << " " << hit.normal.y << " " << hit.normal.z;
        EXPECT_NEAR(std::abs(glm::dot(hit.geometric_normal, ahead)), 1, 1e-6);
    }
    TexturedGltf gltf_;
};

TEST_F(NormalMaps, RedIsAlongUAndGreenUpTheTexture) {
    // u runs along x, v along y: up the texture is -y. Seen from behind, a bump is a dent. With
    // and without normals in the file.
    const std::vector<float> up{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    for (const std::vector<float>& normals : {std::vector<float>{}, up}) {
        gltf_.normals = normals;
        const GeometryDesc entry = desc(gltf_);
        expect_normal(entry, {0.3, 0.6, 1}, {0, 0, -1}, {x_, -y_, z_});
        expect_normal(entry, {0.3, 0.6, -1}, {0, 0, 1}, {-x_, y_, -z_});
    }
}

TEST_F(NormalMaps, TurnAndMirrorWithTheObject) {
    gltf_.normals = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    GeometryDesc entry = desc(gltf_);
    // Mirrored along x, the bump leans the other way.
    entry.world_from_object = Affine::scale({-1, 1, 1});
    expect_normal(entry, {-0.3, 0.6, 1}, {0, 0, -1}, {-x_, -y_, z_});
    gltf_.node = R"({"mesh":0,"scale":[-1,1,1]})";
    expect_normal(desc(gltf_), {-0.3, 0.6, 1}, {0, 0, -1}, {-x_, -y_, z_});
    gltf_.normals.clear();
    expect_normal(desc(gltf_), {-0.3, 0.6, 1}, {0, 0, -1}, {-x_, -y_, z_});
    // A quarter turn about x: z to -y, y to z.
    entry = desc(gltf_);
    entry.world_from_object = Affine::rotation_xyz_degrees({90, 0, 0}) * Affine::scale({-1, 1, 1});
    expect_normal(entry, {0.3, -1, 0.6}, {0, 1, 0}, {x_, -z_, -y_});
}

TEST_F(NormalMaps, TangentsOfTheFileGoBeforeComputedOnes) {
    gltf_.normals = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
    for (const float side : {1.0F, -1.0F}) {
        gltf_.tangents.clear();
        for (int k = 0; k < 4; ++k) gltf_.tangents.insert(gltf_.tangents.end(), {0, 1, 0, side});
        // Bitangent: cross(z, y) = -x, times the side.
        expect_normal(desc(gltf_), {0.3, 0.6, 1}, {0, 0, -1}, {-side * y_, x_, z_});
    }
}

TEST_F(NormalMaps, TurnWithTheTexturesTransform) {
    gltf_.material = R"({"normalTexture":{"index":0,"scale":0.5,"extensions":
        {"KHR_texture_transform":{"rotation":1.5707963267948966}}}})";
    // u' = v, v' = -u: u' grows along y, and up, where v' shrinks, is x.
    expect_normal(desc(gltf_), {0.3, 0.6, 1}, {0, 0, -1}, {y_, x_, z_});
}

}  // namespace
}  // namespace uw
