// ctest labels: unit slow
//
// Files of other programs through the whole program, with automatic settings. The environment
// variable UWVDB_SAMPLES names their folder; where it is set, a file that is missing is a failure.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <set>

#include "tests/support/cli_test.h"

namespace uw {
namespace {

using test::ImageFile;

// A wall behind the origin, and a lamp above the camera, which looks along -z.
constexpr const char* k_before_a_wall = R"(uwvdb: 1
camera: {resolution: [48, 27], intrinsics: {fov_x: 50}, pose: {position: [0, 0, 4], look_at: [0, 0, 0]}}
water: {bands: [620, 540, 450]}
geometry: [{type: plane, point: [0, 0, -2], normal: [0, 0, 1]}]
lamps: [{position: [1.5, 1.5, 3], frame: world, intensity: 50}]
render: {samples: 1}
)";

constexpr const char* k_over_the_seabed = R"(uwvdb: 1
camera: {resolution: [96, 54], intrinsics: {fov_x: 69}, pose: {position: [0.3, 1.3, 2.6], look_at: [-0.05, 0.35, -0.4]}}
lamps: [{position: [0.6, -0.3, 0], intensity: 50}]
render: {samples: 1}
)";

struct VolumeSample {
    const char* file;
    const char* grid;
    double large_ppm;       // per unit
    const char* transform;  // brings it to the origin, some 2 m large
    const char* voxel;      // of what is said about it: its voxels, in the scene's size,
    const char* placement;  // and what the file decided
};

std::ostream& operator<<(std::ostream& out, const VolumeSample& sample) {
    return out << sample.file << " " << sample.grid;
}

constexpr const char* k_blender = "centering cell (automatic), up z (automatic)";
constexpr const char* k_others = "centering node (automatic), up y (automatic)";
// Moves to the third of the domain (6 x 3 x 2.4 m) that is nearest its inlet.
constexpr const char* k_in_domain = "{translate: [-2, -0.5, 1.5]}";

const std::vector<VolumeSample> k_volumes{
    {"plume128_blosc_half_0020.vdb", "density", 10, k_in_domain, "0.04688", k_blender},
    {"plume128_blosc_half_0030.vdb", "density", 10, k_in_domain, "0.04688", k_blender},
    {"plume128_blosc_half_0040.vdb", "density", 10, k_in_domain, "0.04688", k_blender},
    {"plume128long_blosc_half_0100.vdb", "density", 10, k_in_domain, "0.04688", k_blender},
    {"plume96_noise2_data_0030.vdb", "density", 10, k_in_domain, "0.0625", k_blender},
    {"plume96_noise2_noise_0030.vdb", "density_noise", 10, k_in_domain, "0.03125", k_blender},
    {"plume96_none32_0024.vdb", "density", 10, k_in_domain, "0.0625", k_blender},
    {"plume96_zip32_0024.vdb", "density", 10, k_in_domain, "0.0625", k_blender},
    {"fire64_blosc_half_0020.vdb", "density", 10, k_in_domain, "0.09375", k_blender},
    {"openvdb_smoke_houdini.vdb", "density", 10, "{scale: 0.02, translate: [0.15, -0.8, 0]}",
     "0.009524", k_others},
    {"oiio_sphere.vdb", "density", 10, "{scale: 0.5}", "0.05", k_others},
    {"gaffer_sphere.vdb", "density", 10, "{scale: 0.5, translate: [0, -1, 0]}", "0.1", k_others},
    {"arnold_torus01.vdb", "voxel_fog_density", 0.3, "{scale: 0.1, translate: [0.585, 0, -0.46]}",
     "0.04032", k_others},
    {"arnold_grids.vdb", "density[0]", 1, "{scale: 0.5, translate: [-2, 0, 0]}", "0.05", k_others},
    {"arnold_grids.vdb", "density[1]", 1, "{scale: 0.5, translate: [-1, 0, 0]}", "0.05", k_others},
    {"arnold_grids.vdb", "density[2]", 1, "{scale: 0.5}", "0.05", k_others}};

struct Refusal {
    const char* file;
    const char* grid;
    const char* message;
};

std::ostream& operator<<(std::ostream& out, const Refusal& refusal) {
    return out << refusal.file << " " << refusal.grid;
}

const std::vector<Refusal> k_refusals{
    {"openvdb_sphere_houdini.vdb", "ls_sphere", "is a level set"},
    {"arnold_pointgrid.vdb", "points", "holds points"},
    {"oiio_sphereCd.vdb", "Cd", "holds vectors (vec3s)"},
    {"arnold_grids.vdb", "density",
     "3 grids are called 'density'; write 'density[0]' for the first"},
    {"openvdb_smoke_houdini.vdb", "vel", "no grid 'vel'"},
    {"fire64_blosc_half_0020.vdb", "heat", "no grid 'heat'"}};

const std::vector<const char*> k_meshes{"seabed.glb",        "seabed_sep.gltf", "seabed_only.ply",
                                        "cube_quads.ply",    "lights_raw.gltf", "lights_spec.gltf",
                                        "lights_compat.gltf"};
const std::set<std::string> k_parts_of_meshes{"seabed_sep.bin", "sand.png", "checker.png"};

class Samples : public test::CliTest {
  protected:
    static std::string path(const std::string& file) {
        const auto sample = std::filesystem::path(std::getenv("UWVDB_SAMPLES")) / file;
        EXPECT_TRUE(std::filesystem::exists(sample)) << sample << " is missing";
        return "'" + sample.string() + "'";
    }
    void write_volume_scene(const std::string& file, const std::string& grid, double large_ppm,
                            const std::string& transform) const {
        write("scene.yaml", std::string(k_before_a_wall) + "volumes: [{file: " + path(file) +
                                ", grids: {'" + grid + "': {small: 0.2, large: " +
                                std::to_string(large_ppm) + "}}, transform: " + transform + "}]\n");
    }
    ImageFile render_mesh(const std::string& file) const {
        // Blender turns its z-up to y-up for glTF, not for PLY.
        const std::string transform =
            file.ends_with(".ply") ? ", transform: {rotate: [-90, 0, 0]}" : "";
        write("scene.yaml", std::string(k_over_the_seabed) + "geometry: [{file: " + path(file) +
                                transform + "}]\n");
        return render();
    }
};

class VolumeSamples : public Samples, public testing::WithParamInterface<VolumeSample> {};

TEST_P(VolumeSamples, AreSeenWhereTheyAre) {
    const VolumeSample& sample = GetParam();
    write_volume_scene(sample.file, sample.grid, sample.large_ppm, sample.transform);
    const test::ProgramResult result =
        run({"render", "scene.yaml", "-o", "out.exr", "--layers", "all"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    for (const std::string& part :
         {std::string(": ") + sample.voxel + " x " + sample.voxel + " x " + sample.voxel +
              " m per voxel, ",
          std::string(sample.placement), std::string("  bounds x "), std::string("  large: min "),
          std::string("  optical depth through the middle along z: ")})
        EXPECT_NE(result.err.find(part), std::string::npos) << part << "\n" << result.err;
    EXPECT_EQ(result.err.find("warning"), std::string::npos) << result.err;

    const ImageFile image = test::read_exr(folder_ / "out.exr");
    test::expect_finite_and_lit(image);
    // It dims the wall behind it in the middle of the picture, and not in its corners.
    const float in_corners =
        std::min({image.at("transmittance.G", 0, 0), image.at("transmittance.G", 47, 0),
                  image.at("transmittance.G", 0, 26), image.at("transmittance.G", 47, 26)});
    float in_middle = 1;
    for (int y = 9; y < 18; ++y)
        for (int x = 16; x < 32; ++x)
            in_middle = std::min(in_middle, image.at("transmittance.G", x, y));
    EXPECT_LT(in_middle, 0.8F * in_corners);
}

class RefusedSamples : public Samples, public testing::WithParamInterface<Refusal> {};

TEST_P(RefusedSamples, SayWhyInOneLine) {
    const Refusal& refusal = GetParam();
    write_volume_scene(refusal.file, refusal.grid, 1, "{scale: 1}");
    expect_failure({"render", "scene.yaml"}, 3, refusal.message);
    EXPECT_FALSE(exists("scene.exr"));
}

class MeshSamples : public Samples, public testing::WithParamInterface<const char*> {};

TEST_P(MeshSamples, AreSeenAndLit) {
    const ImageFile image = render_mesh(GetParam());
    test::expect_finite_and_lit(image);
    const std::vector<float>& ids = image.channels.at("id.V");
    EXPECT_GT(std::count(ids.begin(), ids.end(), 1.0F), 100);
    // What is seen is lit: the lamp is beside the camera.
    const std::vector<float>& lit = image.channels.at("lit.V");
    EXPECT_GT(std::accumulate(lit.begin(), lit.end(), 0.0F), 80.0F);
}

class AlignedSamples : public Samples {};

TEST_F(AlignedSamples, TexturesInsideAndBesideAFileAreTheSame) {
    if (std::getenv("UWVDB_SAMPLES") == nullptr) return;  // nothing to look at
    EXPECT_EQ(render_mesh("seabed.glb").channels, render_mesh("seabed_sep.gltf").channels);
}

TEST_F(AlignedSamples, ThePlyCubeIsTheGltfCube) {
    if (std::getenv("UWVDB_SAMPLES") == nullptr) return;
    const ImageFile ply = render_mesh("cube_quads.ply"), gltf = render_mesh("lights_raw.gltf");
    const std::vector<float>&a = ply.channels.at("depth.Z"), &b = gltf.channels.at("depth.Z");
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-5F * b[i]);
}

TEST_F(AlignedSamples, ThePlySeabedIsThatOfTheGlb) {
    if (std::getenv("UWVDB_SAMPLES") == nullptr) return;
    const ImageFile ply = render_mesh("seabed_only.ply"), glb = render_mesh("seabed.glb");
    const std::vector<float>&a = ply.channels.at("depth.Z"), &b = glb.channels.at("depth.Z");
    int same = 0, nearer = 0, seen = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (a[i] == 0) continue;
        ++seen;
        same += std::abs(a[i] - b[i]) < 1e-5F * a[i] ? 1 : 0;
        nearer += b[i] < (1 - 1e-5F) * a[i] ? 1 : 0;  // a rock, the cube or the pipe
    }
    EXPECT_GT(seen, 2000);
    EXPECT_GT(same, 0.7 * seen);
    EXPECT_GT(nearer, 100);
    EXPECT_EQ(same + nearer, seen);
}

TEST_F(AlignedSamples, EveryFileOfTheFolderIsTried) {
    const char* folder = std::getenv("UWVDB_SAMPLES");
    if (folder == nullptr) return;
    std::set<std::string> tried = k_parts_of_meshes;
    for (const VolumeSample& sample : k_volumes) tried.insert(sample.file);
    for (const Refusal& refusal : k_refusals) tried.insert(refusal.file);
    tried.insert(k_meshes.begin(), k_meshes.end());
    // Folders in it hold scenes and sequences, which are no samples by themselves.
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (!entry.is_directory()) {
            EXPECT_TRUE(tried.contains(entry.path().filename().string())) << entry.path();
        }
}

template <class Sample>
std::vector<Sample> where_available(const std::vector<Sample>& samples) {
    return std::getenv("UWVDB_SAMPLES") != nullptr ? samples : std::vector<Sample>{};
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(VolumeSamples);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(RefusedSamples);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(MeshSamples);
INSTANTIATE_TEST_SUITE_P(Folder, VolumeSamples, testing::ValuesIn(where_available(k_volumes)));
INSTANTIATE_TEST_SUITE_P(Folder, RefusedSamples, testing::ValuesIn(where_available(k_refusals)));
INSTANTIATE_TEST_SUITE_P(Folder, MeshSamples, testing::ValuesIn(where_available(k_meshes)));

}  // namespace
}  // namespace uw
