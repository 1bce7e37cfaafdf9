// ctest labels: analytic
#include "render/measures/irradiance_vdb.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/vector_math.h"
#include "tests/support/cli_test.h"
#include "tests/support/vdb/vdb_fixtures.h"
#include "tests/support/vdb/vdb_values.h"

namespace uw {
namespace {

using test::VdbValues;

// Two boxes on the axis, so that the first shades the second, and a second lamp beside them.
constexpr const char* k_scene = R"(uwvdb: 1
camera: {resolution: [8, 4], intrinsics: {fov_x: 60}}
water:
  bands: [620, 450]
  absorption: [0.35, 0.05]
  scattering: {b: [0.20, 0.25], phase: {type: hg, g: 0.8}}
geometry:
  - {type: box, min: [-0.2, -0.2, 1], max: [0.2, 0.2, 1.2]}
  - {type: box, min: [-0.6, -0.6, 2], max: [0.6, 0.6, 2.2]}
volumes:
  - {file: thin.vdb, grids: {density: {absorption: 1.0e-9}}}
lamps:
  - {name: front, position: [0, 0, 0], intensity: [50, 30], frame: world}
  - {name: side, position: [2, 0.5, 1], power: 100, frame: world}
)";

struct Box {
    Vector3 min, max;
};
constexpr Box k_near{{-0.2, -0.2, 1}, {0.2, 0.2, 1.2}}, k_far_box{{-0.6, -0.6, 2}, {0.6, 0.6, 2.2}};

// Whether the open segment from a to b meets the box grown by `margin` (slab test).
bool meets(const Point3& a, const Point3& b, const Box& box, double margin) {
    double enter = 0, leave = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double d = b[axis] - a[axis];
        double low = box.min[axis] - margin - a[axis], high = box.max[axis] + margin - a[axis];
        if (d == 0) {
            if (low > 0 || high < 0) return false;
            continue;
        }
        low /= d, high /= d;
        enter = std::max(enter, std::min(low, high));
        leave = std::min(leave, std::max(low, high));
    }
    return enter < leave;
}

class IrradianceVdb : public test::CliTest {
  protected:
    IrradianceVdb() {
        // Next to nothing, everywhere: it says where to sample and how finely.
        test::VdbFixture thin;
        thin.boxes = {{{-20, -20, 0}, {20, 20, 60}, 1.0}};
        thin.file_from_index = Affine::scale(Vector3(0.05));
        test::write_fixture(folder_ / "thin.vdb", {thin});
        write("scene.yaml", k_scene);
    }
};

TEST_F(IrradianceVdb, FollowsTheInverseSquareAndTheWaterWithShadows) {
    render({"--irradiance-vdb", "light.vdb"});
    const std::map<std::string, VdbValues> grids = test::read_vdb_values(folder_ / "light.vdb");
    EXPECT_EQ(grids.size(), 4U);  // one for each lamp and band
    struct Case {
        const char* grid;
        Point3 lamp;
        double intensity, attenuation;
    };
    for (const Case& c :
         {Case{"irradiance.front.620nm", {0, 0, 0}, 50, 0.55},
          Case{"irradiance.front.450nm", {0, 0, 0}, 30, 0.30},
          Case{"irradiance.side.620nm", {2, 0.5, 1}, 100 / (4 * std::numbers::pi), 0.55},
          Case{"irradiance.side.450nm", {2, 0.5, 1}, 100 / (4 * std::numbers::pi), 0.30}}) {
        int lit = 0, shaded = 0;
        const VdbValues& grid = grids.at(c.grid);
        EXPECT_EQ(grid.metadata.at("unit"), "W m^-2");
        EXPECT_NE(std::string(c.grid).find("." + grid.metadata.at("lamp") + "."),
                  std::string::npos);
        for (const VdbValues::Voxel& voxel : grid.voxels) {
            const double r = distance(voxel.position, c.lamp);
            if (r < 0.05) continue;  // a voxel that holds the lamp has no one value
            const auto met = [&](double margin) {
                return meets(c.lamp, voxel.position, k_near, margin) ||
                       meets(c.lamp, voxel.position, k_far_box, margin);
            };
            if (met(-1e-3)) {  // a millimetre within the shadow
                ASSERT_EQ(voxel.value, 0) << c.grid;
                ASSERT_FALSE(voxel.active);
                ++shaded;
            } else if (!met(1e-3)) {
                // A 32-bit float of a product of doubles: far within the thousandth asked for.
                const double expected = c.intensity * std::exp(-c.attenuation * r) / (r * r);
                ASSERT_NEAR(voxel.value, expected, 1e-5 * expected) << c.grid;
                ++lit;
            }
        }
        EXPECT_GT(lit, 20000) << c.grid;
        EXPECT_GT(shaded, 1000) << c.grid;
    }
}

TEST_F(IrradianceVdb, WithoutAVolumeCoversSurfacesAndLamps) {
    expect_failure(
        {"render", "scene.yaml", "-o", "out2.exr", "--irradiance-vdb", "no.vdb", "--set",
         "geometry=[]", "--set", "volumes=[]", "--set", "lamps=[{position: [1, 0, 0], power: 1}]"},
        3, "--irradiance-vdb: the scene has no volume");
    EXPECT_FALSE(exists("no.vdb"));
    EXPECT_FALSE(exists("out2.exr"));
    // Without a volume: over all surfaces and lamps, here a flat box.
    render({"--irradiance-vdb", "flat.vdb", "--set", "volumes=[]", "--set",
            "geometry=[{type: box, min: [-1, -0.05, 1], max: [1, 0.05, 1.05]}]", "--set",
            "lamps=[{position: [0, 0.04, 1.04], power: 1, frame: world}]"});
    const auto flat = test::read_vdb_values(folder_ / "flat.vdb");
    ASSERT_EQ(flat.size(), 2U);
    EXPECT_TRUE(flat.contains("irradiance.lamp1.450nm"));
}

}  // namespace
}  // namespace uw
