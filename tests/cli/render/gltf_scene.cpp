// ctest labels: analytic
//
// The example mesh with the camera and lamps of its own file, in water as clear as a vacuum,
// against rays and light computed here from the bytes of the file.
#include <numbers>

#include "tests/support/cli_test.h"
#include "tests/support/meshes/gltf_truth.h"

namespace uw {
namespace {

constexpr int k_width = 160, k_height = 120, k_step = 8;

const std::filesystem::path k_seabed =
    std::filesystem::path(UWVDB_SOURCE_DIR) / "assets/meshes/seabed.glb";

/// Blender's watts, and how it shades spots.
struct GltfLamp {
    const char* name;
    double watts;
    double color[3];
    bool is_spot;
};
// As set in Blender; colours are floats in the file. The spots are 70 degrees wide, blend 0.2.
const GltfLamp k_lamps[] = {{"SpotLeft", 120, {1, 0.96, 0.9}, true},
                            {"SpotRight", 80, {1, 1, 1}, true},
                            {"PointFill", 30, {0.8, 0.9, 1}, false}};

// As Cycles shades it in Blender 3.4, which wrote the file (kernel/light/common.h).
double spot_falloff(double cosine) {
    const double outer = std::cos(35 * std::numbers::pi / 180);
    const double t = std::min(1.0, std::max(0.0, (cosine - outer) / ((1 - outer) * 0.2)));
    return cosine * t * t * (3 - 2 * t);
}

class GltfScene : public test::CliTest {
  protected:
    GltfScene() : truth_(k_seabed) {
        write("scene.yaml",
              "uwvdb: 1\n"
              "camera: {resolution: [160, 120]}\n"
              "water: {absorption: 0, scattering: {b: 0, phase: {type: water}}}\n"
              "geometry: [{file: '" +
                  k_seabed.string() +
                  "', camera: Camera, lamps: all}]\n"
                  "render: {samples: 1}\n");
    }

    /// The ray of a pixel's centre by the file's camera: -z ahead, +y up.
    Ray ray_of(int x, int y) const {
        const test::GltfTruth::Node& camera = truth_.node("Camera");
        const double top = std::tan(truth_.yfov / 2);
        const Vector3 local((x + 0.5 - k_width / 2.0) / (k_height / 2.0) * top,
                            -(y + 0.5 - k_height / 2.0) / (k_height / 2.0) * top, -1);
        return {camera.world * Point3{}, glm::normalize(camera.world.apply_to_vector(local))};
    }
    Vector3 forward() const {
        return glm::normalize(truth_.node("Camera").world.apply_to_vector({0, 0, -1}));
    }

    test::GltfTruth truth_;
};

TEST_F(GltfScene, DepthPositionAndNormalAreThoseOfItsTriangles) {
    const test::ImageFile image = render({"--layers", "depth,range,position,normal,id"});
    int compared = 0, seen = 0, missed = 0;
    for (int y = k_step / 2; y < k_height; y += k_step) {
        for (int x = k_step / 2; x < k_width; x += k_step) {
            const Ray ray = ray_of(x, y);
            const test::TruthHit hit = first_hit(truth_, ray);
            ++seen;
            if (!hit.found()) {
                ++missed;
                EXPECT_EQ(image.at("id.V", x, y), 0) << x << " " << y;
                continue;
            }
            // Vertices of up to 6 m are rounded to floats once placed: some 3e-7 m across the
            // surface, more along a grazing ray.
            const double slack = 2e-6 / std::max(0.02, -glm::dot(hit.flat, ray.direction));
            if (hit.rim < 1e-3) continue;  // rounding may choose the neighbour
            ++compared;
            EXPECT_NEAR(image.at("range.V", x, y), hit.t, slack) << x << " " << y;
            EXPECT_NEAR(image.at("depth.Z", x, y), hit.t * glm::dot(ray.direction, forward()),
                        slack);
            const Point3 position = ray.at(hit.t);
            EXPECT_NEAR(image.at("position.X", x, y), position.x, slack);
            EXPECT_NEAR(image.at("position.Y", x, y), position.y, slack);
            EXPECT_NEAR(image.at("position.Z", x, y), position.z, slack);
            // Normals of floats, bent by 0.1 rad per mm at most on the smallest parts.
            EXPECT_NEAR(image.at("normal.X", x, y), hit.normal.x, 1e-5 + 100 * slack);
            EXPECT_NEAR(image.at("normal.Y", x, y), hit.normal.y, 1e-5 + 100 * slack);
            EXPECT_NEAR(image.at("normal.Z", x, y), hit.normal.z, 1e-5 + 100 * slack);
        }
    }
    EXPECT_EQ(seen, 300);
    EXPECT_GT(compared, 150);
    EXPECT_GT(missed, 20);
}

TEST_F(GltfScene, LampsShineWithBlendersWattsOverFourPi) {
    // Without its textures: light is of their mean over a pixel, `albedo` of their value at its
    // centre.
    const test::ImageFile image =
        render({"--layers", "direct,irradiance,albedo,position,normal,lit", "--set",
                "geometry[0].reflectance=[0.6, 0.5, 0.4]"});
    const char* const channels[] = {"R", "G", "B"};
    int compared = 0;
    for (int y = 0; y < k_height; ++y) {
        for (int x = 0; x < k_width; ++x) {
            if (image.at("lit.V", x, y) != 1) continue;  // all lamps see it: no shadow to know of
            const Point3 at{image.at("position.X", x, y), image.at("position.Y", x, y),
                            image.at("position.Z", x, y)};
            const Vector3 normal(image.at("normal.X", x, y), image.at("normal.Y", x, y),
                                 image.at("normal.Z", x, y));
            double expected[3] = {};
            bool beside_edge = false;
            for (const GltfLamp& lamp : k_lamps) {
                const Affine& world = truth_.node(lamp.name).world;
                const Vector3 to_lamp = world * Point3{} - at;
                const double r = glm::length(to_lamp);
                const Vector3 axis = world.apply_to_vector({0, 0, -1});
                const double falloff =
                    lamp.is_spot ? spot_falloff(glm::dot(-to_lamp, axis) / r) : 1;
                beside_edge |= falloff < 0.05;  // steep there, and positions are floats
                const double cosine = glm::dot(normal, to_lamp) / r;
                for (int c = 0; c < 3; ++c)
                    expected[c] += lamp.watts / (4 * std::numbers::pi) * lamp.color[c] * falloff *
                                   cosine / (r * r);
            }
            if (beside_edge) continue;
            ++compared;
            for (int c = 0; c < 3; ++c) {
                const std::string channel = channels[c];
                // Floats in the file and the image; what is claimed is 1e-4.
                EXPECT_NEAR(image.at("irradiance." + channel, x, y), expected[c],
                            1e-4 * expected[c])
                    << x << " " << y;
                EXPECT_NEAR(image.at("direct." + channel, x, y),
                            expected[c] * image.at("albedo." + channel, x, y) / std::numbers::pi,
                            1e-4 * expected[c]);
            }
        }
    }
    EXPECT_GT(compared, 1000);
}

TEST_F(GltfScene, ItsLampsHaveLayersOfTheirOwnAndShareTheEntrysTransform) {
    const test::ImageFile image = render({"--layers", "lamps,direct"});
    for (const GltfLamp& lamp : k_lamps)
        EXPECT_TRUE(image.channels.contains(std::string("lamp.") + lamp.name + ".R"));
    // Turned and moved as a whole, camera and lamps with it, everything looks the same.
    const test::ImageFile moved =
        render({"--layers", "lamps,direct", "--set",
                "geometry[0].transform={rotate: [10, -70, 25], translate: [3, -2, 1]}"});
    int differing = 0;
    const std::vector<float>&a = image.channels.at("direct.G"), &b = moved.channels.at("direct.G");
    // Floats of other places: edges of textures and shadows fall on other sides of a few centres.
    for (std::size_t i = 0; i < a.size(); ++i)
        differing += std::abs(a[i] - b[i]) > 1e-3F * std::abs(a[i]) ? 1 : 0;
    EXPECT_LT(differing, 0.01 * k_width * k_height);
}

TEST_F(GltfScene, FramesOfASequenceBringTheirCamerasAndTheSameLamps) {
    std::ifstream in(std::filesystem::path(UWVDB_SOURCE_DIR) / "tests/data/lights_compat.gltf");
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const auto replaced = [&](const std::string& from, const std::string& to) {
        std::string result = text;
        const std::size_t at = result.find("\"nodes\" : [\n        {");
        result.replace(result.find(from, at), from.size(), to);
        return result;
    };
    write("s_1.gltf", text);
    write("s_2.gltf", replaced("3.200000047683716", "3.9"));  // the robot, farther back
    write("s_3.gltf", replaced("SpotLeft", "SpotLift"));
    write("scene.yaml",
          "uwvdb: 1\ncamera: {resolution: [96, 72]}\ngeometry: [{file: 's_#.gltf', camera: true, "
          "lamps: all, light_units: compat}]\nrender: {samples: 1}\n");
    const test::ProgramResult two = run(
        {"render", "scene.yaml", "-o", "o_#.exr", "--frames", "1-2", "--layers", "depth,lamps"});
    ASSERT_EQ(two.exit_code, 0) << two.err;
    const test::ImageFile near = test::read_exr(folder_ / "o_1.exr");
    const test::ImageFile far = test::read_exr(folder_ / "o_2.exr");
    EXPECT_TRUE(near.channels.contains("lamp.PointFill.G"));
    const auto nearest = [](const test::ImageFile& image) {
        float least = 1e9F;
        for (const float z : image.channels.at("depth.Z"))
            least = z > 0 ? std::min(z, least) : least;
        return least;
    };
    // Along an axis 15 degrees off, to a cube's corner as pixels meet it.
    EXPECT_NEAR(nearest(far) - nearest(near), 0.68, 0.03);
    const test::ProgramResult three =
        run({"render", "scene.yaml", "-o", "p_#.exr", "--frames", "1-3", "--quiet"});
    EXPECT_EQ(three.exit_code, 3);
    EXPECT_NE(three.err.find("frame 3: its lamps are SpotLift, SpotRight, PointFill"),
              std::string::npos)
        << three.err;
    EXPECT_EQ(run({"render", "scene.yaml", "-o", "q.exr"}).exit_code, 3);  // an open sequence
}

}  // namespace
}  // namespace uw
