// ctest labels: unit
#include "core/scene/scene_desc.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/scene_folder.h"

namespace uw {
namespace {

using test::SceneFolder;

// The example of the reference (docs/scene-file.md), every section in use.
constexpr std::string_view k_full = R"(uwvdb: 1
camera:
  resolution: [1920, 1080]
  intrinsics: {fx: 1400, fy: 1401, cx: 961, cy: 541}      # pixels
  distortion: {model: brown-conrady, k: [0.1, 0.2, 0.3, 0.4, 0.5, 0.6], p: [0.01, 0.02]}
  port: {type: flat, normal: [0, 0, 2], distance: 0.02, thickness: 0.04, n_air: 1.01, n_glass: 1.5, n_water: 1.34, fresnel: true, radiance_in: air}
  pose: {position: [1, 2, 3], look_at: [1, 2, 9], up: [0, -1, 0]}
  lens: {f_number: 2.8, focal_length: 0.0085, transmission: 0.95}
water:
  bands: [620, 540, 450, 410]
  preset: jerlov-II
  salinity: 33
  temperature: 12
  absorption: [0.30, 0.07, 0.03, 0.02]
  particles: {small: 0.03, large: 0.05, absorption: mineral}
  forward_scatter: {K: 0, G: 0.1, B: 0.1, shape: gaussian}
volumes:
  - file: data/plume.vdb
    grids:
      density: {small: 2.0, large: 10.0}
      "smoke[1]": {absorption: 0.5, scattering: [1, 2, 3, 4], phase: {type: fournier-forand, n: 1.12, mu: 3.6}}
    centering: cell
    up: z
    voxel_size: 0.05
    transform: {scale: 2, rotate: [0, 90, 0], translate: [0, 0, 3]}
geometry:
  - {file: seabed.glb, transform: {translate: [0, -1, 0]}, reflectance: [0.4, 0.35, 0.3, 0.2]}
  - {type: plane, point: [0, 0, 4], normal: [0, 0, -3], reflectance: 0.5}
  - {type: box, min: [-0.1, -0.2, 1.9], max: [0.1, 0.2, 2.1]}
  - {type: sphere, center: [0, 1, 2], radius: 0.2, reflectance: [0.5, 0.5, 0.5, 1]}
lamps:
  - name: left
    position: [-1, -0.5, 0]
    direction: [0, 0, 2]
    profile: {type: spot, beam: 60, edge: 5}
    intensity: [50, 51, 52, 53]
    frame: world
  - {position: [1, 0, 0], profile: {type: cosine, fwhm: 120}, power: 20}
render:
  integrator: reference
  planes: {count: 64, near: 0.1, far: 12}
  output: sensor_irradiance
  samples: 9
)";

class SceneReader : public ::testing::Test {
  protected:
    SceneDesc read(std::string_view text, const std::vector<std::string>& overrides = {}) {
        return read_scene(folder_.write("scene.yaml", text), overrides);
    }
    SceneDesc read_full() {
        folder_.write("data/plume.vdb", "x");
        folder_.write("seabed.glb", "x");
        return read(k_full);
    }
    SceneFolder folder_;
};

void expect_vector(const Vector3& found, const Vector3& expected, double tolerance = 0) {
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(found[axis], expected[axis], tolerance) << "axis " << axis;
    }
}

constexpr std::string_view k_minimal =
    "uwvdb: 1\ncamera: {resolution: [400, 300], intrinsics: {fov_x: 90}}\n";

TEST_F(SceneReader, takesAllLightOfVersion2UnlessItIsSingle) {
    using Scattering = RenderDesc::Scattering;
    constexpr std::string_view k_camera =
        "camera: {resolution: [4, 4], intrinsics: {fx: 4}}\nrender: {samples: 1}\n";
    const auto render_of = [&](const std::string& version, const std::string& scattering) {
        std::vector<std::string> overrides;
        if (!scattering.empty()) overrides.push_back("render.scattering=" + scattering);
        return read_scene_text("uwvdb: " + version + "\n" + std::string(k_camera), "scene.yaml",
                               overrides)
            .render;
    };
    EXPECT_EQ(render_of("1", "").default_scattering, Scattering::single);
    EXPECT_EQ(render_of("2", "").default_scattering, Scattering::multiple);
    EXPECT_FALSE(render_of("2", "").scattering);
    for (const char* version : {"1", "2"})
        EXPECT_EQ(render_of(version, "single").scattering, Scattering::single) << version;
}

TEST_F(SceneReader, readsTheCamera) {
    const CameraDesc camera = read_full().camera;
    EXPECT_EQ(camera.width, 1920);
    EXPECT_EQ(camera.height, 1080);
    EXPECT_EQ(camera.intrinsics.fx, 1400);
    EXPECT_EQ(camera.intrinsics.fy, 1401);
    EXPECT_EQ(camera.intrinsics.cx, 961);
    EXPECT_EQ(camera.intrinsics.cy, 541);
    EXPECT_EQ(camera.distortion.k, (std::array<double, 6>{0.1, 0.2, 0.3, 0.4, 0.5, 0.6}));
    EXPECT_EQ(camera.distortion.p, (std::array<double, 2>{0.01, 0.02}));
    ASSERT_TRUE(camera.port);
    expect_vector(std::get<FlatPortDesc>(*camera.port).normal, {0, 0, 1});
    EXPECT_EQ(std::get<FlatPortDesc>(*camera.port).distance, 0.02);
    EXPECT_EQ(std::get<FlatPortDesc>(*camera.port).thickness, 0.04);
    EXPECT_EQ(std::get<FlatPortDesc>(*camera.port).n_air, 1.01);
    EXPECT_EQ(std::get<FlatPortDesc>(*camera.port).n_glass, 1.5);
    EXPECT_EQ(std::get<FlatPortDesc>(*camera.port).n_water, 1.34);
    EXPECT_TRUE(std::get<FlatPortDesc>(*camera.port).fresnel);
    EXPECT_TRUE(std::get<FlatPortDesc>(*camera.port).radiance_in_air);
    ASSERT_TRUE(camera.lens);
    EXPECT_EQ(camera.lens->f_number, 2.8);
    EXPECT_EQ(camera.lens->focal_length, 0.0085);
    EXPECT_EQ(camera.lens->transmission, 0.95);
    // looking along +z with -y up is the camera's own frame, moved
    expect_vector(camera.world_from_camera.apply_to_vector({1, 0, 0}), {1, 0, 0});
    expect_vector(camera.world_from_camera.apply_to_vector({0, 1, 0}), {0, 1, 0});
    expect_vector(camera.world_from_camera.offset(), {1, 2, 3});
}

TEST_F(SceneReader, readsTheWater) {
    const WaterDesc water = read_full().water;
    EXPECT_EQ(water.bands_nm, (std::vector<double>{620, 540, 450, 410}));
    EXPECT_EQ(water.preset, "jerlov-II");
    EXPECT_EQ(water.salinity, 33);
    EXPECT_EQ(water.temperature, 12);
    EXPECT_EQ(water.absorption, (PerBand{0.30, 0.07, 0.03, 0.02}));
    EXPECT_EQ(water.small_ppm, 0.03);
    EXPECT_EQ(water.large_ppm, 0.05);
    EXPECT_TRUE(water.mineral_absorption);
    EXPECT_FALSE(water.scattering);
}

TEST_F(SceneReader, readsExplicitScatteringAndDissolvedMatter) {
    const SceneDesc scene = read(std::string(k_minimal) +
                                 "water:\n"
                                 "  cdom: 0.2\n"
                                 "  chlorophyll: 3\n"
                                 "  scattering: {b: 0.25, phase: {type: hg, g: -0.5}}\n");
    EXPECT_EQ(scene.water.cdom, 0.2);
    EXPECT_EQ(scene.water.chlorophyll, 3);
    ASSERT_TRUE(scene.water.scattering);
    EXPECT_EQ(scene.water.scattering->b, (PerBand{0.25, 0.25, 0.25}));
    EXPECT_EQ(scene.water.scattering->phase.function,
              PhaseFunctionDesc(HenyeyGreensteinDesc{-0.5}));
    EXPECT_FALSE(scene.water.small_ppm);
    EXPECT_FALSE(scene.water.absorption);
}

TEST_F(SceneReader, readsVolumes) {
    const SceneDesc scene = read_full();
    ASSERT_EQ(scene.volumes.size(), 1U);
    const VolumeDesc& volume = scene.volumes[0];
    EXPECT_EQ(volume.file, folder_.path() / "data/plume.vdb");
    EXPECT_EQ(volume.centering, Centering::cell);
    EXPECT_EQ(volume.up, UpAxis::z);
    EXPECT_EQ(volume.voxel_size, 0.05);
    EXPECT_NE(volume.where.find("scene.yaml:18:5: volumes[0]"), std::string::npos) << volume.where;
    ASSERT_EQ(volume.grids.size(), 2U);
    EXPECT_EQ(volume.grids[0].grid, "density");
    EXPECT_EQ(volume.grids[0].small_ppm, 2);
    EXPECT_EQ(volume.grids[0].large_ppm, 10);
    EXPECT_FALSE(volume.grids[0].optics);
    EXPECT_EQ(volume.grids[1].grid, "smoke[1]");
    ASSERT_TRUE(volume.grids[1].optics);
    EXPECT_EQ(volume.grids[1].optics->absorption, (PerBand{0.5, 0.5, 0.5, 0.5}));
    EXPECT_EQ(volume.grids[1].optics->scattering, (PerBand{1, 2, 3, 4}));
    ASSERT_TRUE(volume.grids[1].optics->phase);
    EXPECT_EQ(volume.grids[1].optics->phase->function,
              PhaseFunctionDesc(FournierForandDesc{1.12, 3.6}));
    // scale 2, then a quarter turn about y (x goes to -z), then 3 along z; cos 90 deg rounds
    const Point3 moved = volume.world_from_upright * Point3{1, 0, 0};
    expect_vector(from_origin(moved), {0, 0, 1}, 1e-15);
}

TEST_F(SceneReader, readsGeometry) {
    const SceneDesc scene = read_full();
    ASSERT_EQ(scene.geometry.size(), 4U);
    EXPECT_EQ(scene.geometry[0].type, GeometryDesc::Type::file);
    EXPECT_EQ(scene.geometry[0].file, folder_.path() / "seabed.glb");
    EXPECT_EQ(scene.geometry[0].reflectance, (PerBand{0.4, 0.35, 0.3, 0.2}));
    expect_vector(scene.geometry[0].world_from_object.offset(), {0, -1, 0});
    EXPECT_EQ(scene.geometry[1].type, GeometryDesc::Type::plane);
    EXPECT_EQ(scene.geometry[1].point, (Point3{0, 0, 4}));
    expect_vector(scene.geometry[1].normal, {0, 0, -1});
    EXPECT_EQ(scene.geometry[1].reflectance, (PerBand{0.5, 0.5, 0.5, 0.5}));
    EXPECT_EQ(scene.geometry[2].type, GeometryDesc::Type::box);
    EXPECT_EQ(scene.geometry[2].min, (Point3{-0.1, -0.2, 1.9}));
    EXPECT_EQ(scene.geometry[2].max, (Point3{0.1, 0.2, 2.1}));
    EXPECT_FALSE(scene.geometry[2].reflectance);
    EXPECT_EQ(scene.geometry[3].type, GeometryDesc::Type::sphere);
    EXPECT_EQ(scene.geometry[3].center, (Point3{0, 1, 2}));
    EXPECT_EQ(scene.geometry[3].radius, 0.2);
}

TEST_F(SceneReader, readsLampsAndRender) {
    const SceneDesc scene = read_full();
    ASSERT_EQ(scene.lamps.size(), 2U);
    const LampDesc& left = scene.lamps[0];
    EXPECT_EQ(left.name, "left");
    EXPECT_EQ(left.position, (Point3{-1, -0.5, 0}));
    expect_vector(left.direction, {0, 0, 1});
    EXPECT_EQ(std::get<SpotProfileDesc>(left.profile).beam, 60);
    EXPECT_EQ(std::get<SpotProfileDesc>(left.profile).edge, 5);
    EXPECT_EQ(left.intensity, (PerBand{50, 51, 52, 53}));
    EXPECT_FALSE(left.power);
    EXPECT_FALSE(left.fixed_to_camera);
    const LampDesc& second = scene.lamps[1];
    EXPECT_EQ(second.name, "lamp2");
    EXPECT_EQ(std::get<CosineProfileDesc>(second.profile).fwhm, 120);
    EXPECT_EQ(second.power, (PerBand{20, 20, 20, 20}));
    EXPECT_FALSE(second.intensity);
    EXPECT_TRUE(second.fixed_to_camera);
    EXPECT_EQ(scene.render.integrator, RenderDesc::Integrator::reference);
    EXPECT_EQ(scene.render.output, RenderDesc::Output::sensor_irradiance);
    EXPECT_EQ(scene.render.samples, 9);
    EXPECT_EQ(scene.render.planes.count, 64);
    EXPECT_EQ(scene.render.planes.near, 0.1);
    EXPECT_EQ(scene.render.planes.far, 12);
    EXPECT_NE(scene.render.planes.where.find("scene.yaml:41:11: render.planes"), std::string::npos)
        << scene.render.planes.where;
    EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(SceneReader, fillsInDefaults) {
    const SceneDesc scene = read(k_minimal);
    // 400 px over 90 degrees: the half width is one focal length, tan 45 deg rounds
    EXPECT_NEAR(scene.camera.intrinsics.fx, 200, 1e-12);
    EXPECT_EQ(scene.camera.intrinsics.fx, scene.camera.intrinsics.fy);
    EXPECT_EQ(scene.camera.intrinsics.cx, 200);
    EXPECT_EQ(scene.camera.intrinsics.cy, 150);
    EXPECT_FALSE(scene.camera.port);
    EXPECT_FALSE(scene.camera.lens);
    EXPECT_EQ(scene.camera.world_from_camera.linear(), Matrix3(1.0));
    EXPECT_EQ(scene.water.bands_nm, (std::vector<double>{620, 540, 450}));
    EXPECT_EQ(scene.water.salinity, 35);
    EXPECT_EQ(scene.water.temperature, 20);
    EXPECT_TRUE(scene.volumes.empty());
    EXPECT_EQ(scene.render.output, RenderDesc::Output::radiance);
    EXPECT_FALSE(scene.render.samples);
    EXPECT_FALSE(scene.render.scattering);
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_NE(scene.warnings[0].find("no lamps, so all that does not emit light will be black"),
              std::string::npos);
}

TEST_F(SceneReader, warnsOfFieldsOfViewInRadians) {
    const auto warned = [this](const char* fov) {
        const SceneDesc scene =
            read(k_minimal, {std::string("camera.intrinsics.fov_x=") + fov, "lamps=[]"});
        return scene.warnings.size() > 1 ? scene.warnings[0] : "";
    };
    EXPECT_NE(warned("1.2").find("camera.intrinsics.fov_x: 1.2 degrees is a very narrow view; "
                                 "degrees, not radians (1.2 radians are 68.8 degrees)?"),
              std::string::npos)
        << warned("1.2");
    EXPECT_NE(warned("3.14"), "");
    EXPECT_EQ(warned("3.2"), "");
}

TEST_F(SceneReader, takesLightPaths) {
    const SceneDesc scene = read(std::string(k_minimal) +
                                 "render: {integrator: path, scattering: multiple, samples: "
                                 "65536}\n");
    EXPECT_EQ(scene.render.integrator, RenderDesc::Integrator::path);
    EXPECT_EQ(scene.render.scattering, RenderDesc::Scattering::multiple);
    EXPECT_NE(scene.render.scattering_where.find(": render.scattering"), std::string::npos);
    EXPECT_EQ(scene.render.samples, 65536);
}

TEST_F(SceneReader, fyFollowsFx) {
    const SceneDesc scene =
        read("uwvdb: 1\ncamera: {resolution: [400, 300], intrinsics: {fx: 321}}\n");
    EXPECT_EQ(scene.camera.intrinsics.fy, 321);
    EXPECT_EQ(scene.camera.intrinsics.cy, 150);
}

TEST_F(SceneReader, volumesAreAutomaticWhereNothingIsSaid) {
    folder_.write("a.vdb", "x");
    const SceneDesc scene =
        read(std::string(k_minimal) + "volumes:\n- {file: a.vdb, grids: {density: {small: 1}}}\n");
    EXPECT_EQ(scene.volumes.at(0).centering, Centering::automatic);
    EXPECT_EQ(scene.volumes.at(0).up, UpAxis::automatic);
    EXPECT_EQ(scene.volumes.at(0).grids.at(0).large_ppm, 0);
}

TEST_F(SceneReader, readsJson) {
    const SceneDesc scene = read(R"({"uwvdb": 1, "camera": {"resolution": [4, 3],
        "intrinsics": {"fov_x": 60}}, "lamps": [{"name": "a", "position": [0, 0, 0],
        "intensity": [1e0, +2, 3.0]}]})");
    EXPECT_EQ(scene.lamps.at(0).intensity, (PerBand{1, 2, 3}));
}

TEST_F(SceneReader, sharesValuesByAliases) {
    const SceneDesc scene = read(std::string(k_minimal) +
                                 "lamps:\n"
                                 "- {name: a, position: &p [1, 2, 3], intensity: &i 5}\n"
                                 "- {name: b, position: *p, intensity: *i}\n");
    EXPECT_EQ(scene.lamps.at(1).position, (Point3{1, 2, 3}));
    EXPECT_EQ(scene.lamps.at(1).intensity, (PerBand{5, 5, 5}));
}

TEST_F(SceneReader, hashFollowsMeaningNotLayout) {
    const std::string hash = read(k_minimal).hash;
    EXPECT_EQ(hash.size(), 16U);
    EXPECT_EQ(hash, read("# comment\ncamera:\n  intrinsics: {fov_x: 9.0e1}\n"
                         "  resolution: [400, 300]\nuwvdb: 1\n")
                        .hash);
    EXPECT_NE(hash, read(k_minimal, {"camera.intrinsics.fov_x=91"}).hash);
    EXPECT_EQ(hash, read(k_minimal, {"camera.intrinsics.fov_x=90"}).hash);
}

TEST_F(SceneReader, unreadableFilesAreIoErrors) {
    EXPECT_THROW(read_scene(folder_.path() / "none.yaml", {}), IoError);
    EXPECT_THROW(read_scene(folder_.path(), {}), IoError);
}

}  // namespace
}  // namespace uw
