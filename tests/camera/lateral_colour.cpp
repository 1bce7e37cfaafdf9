// ctest labels: unit analytic
#include "camera/lateral_colour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "core/scene/dispersion.h"

namespace uw {
namespace {

using Material = DispersionDesc::Material;

DispersionDesc sea() {
    DispersionDesc water{.material = Material::water};
    water.salinity = 35;
    water.temperature = 10;
    return water;
}

/// 12 megapixels, 80 degrees wide.
CameraDesc large_camera(const PortDesc& port) {
    CameraDesc camera;
    camera.width = 4000;
    camera.height = 3000;
    camera.intrinsics = {2383.5, 2383.5, 2000, 1500};
    camera.port = port;
    set_wavelength(camera, 540);
    return camera;
}

FlatPortDesc bk7_window() {
    FlatPortDesc port;
    port.normal = glm::normalize(Vector3(0.05, -0.02, 1));
    port.distance = 0.021;
    port.thickness = 0.018;
    port.dispersion.glass = DispersionDesc{.material = Material::bk7};
    port.dispersion.water = sea();
    return port;
}

DomePortDesc pmma_dome() {
    DomePortDesc port;
    port.center = {0.002, -0.001, -0.012};
    port.radius = 0.05;
    port.thickness = 0.006;
    port.dispersion.glass = DispersionDesc{.material = Material::pmma};
    port.dispersion.water = sea();
    return port;
}

/// Where a ray of one wavelength ends, traced with angles instead of vectors: on the outer glass
/// surface, and on the plane z = 3 m.
struct Traced {
    Vector3 glass, plane;
};

Vector3 on_plane(const Vector3& from, const Vector3& direction) {
    return from + (3 - from.z) / direction.z * direction;
}

double bk7_index(double nm) {
    const double w = nm * nm / 1e6;
    return std::sqrt(1 + 1.03961212 * w / (w - 0.00600069867) +
                     0.231792344 * w / (w - 0.0200179144) + 1.01046945 * w / (w - 103.560653));
}
double pmma_index(double nm) {
    const double w = nm * nm / 1e6;
    return std::sqrt(1 + 1.1819 * w / (w - 0.011313));
}
/// Quan and Fry's equation with S = 35 and T = 10 put in.
double sea_index(double nm) {
    return 1.31405 + (1.779e-4 - 1.05e-5 + 1.6e-6) * 35 - 2.02e-4 +
           (15.868 + 0.40425 - 0.0423) / nm - 4382 / nm / nm + 1.1455e6 / nm / nm / nm;
}

/// In the plane of the normal and the ray: angles to the normal, and distances from it.
Traced through_window(const Vector3& d, double nm) {
    const FlatPortDesc port = bk7_window();
    const Vector3 n = port.normal;
    const double air = std::acos(glm::dot(d, n));
    const Vector3 u = glm::normalize(d - glm::dot(d, n) * n);
    const double glass = std::asin(std::sin(air) / bk7_index(nm));
    const double water = std::asin(std::sin(air) / sea_index(nm));
    const Vector3 out = (port.distance + port.thickness) * n +
                        (port.distance * std::tan(air) + port.thickness * std::tan(glass)) * u;
    return {out, on_plane(out, std::cos(water) * n + std::sin(water) * u)};
}

/// In the plane of the centre and the ray, by the polar angle about the centre: n r sin i stays the
/// same, and the angles of the triangles sum to 180 degrees.
Traced through_dome(const Vector3& d, double nm) {
    const DomePortDesc port = pmma_dome();
    const Vector3 centre = from_origin(port.center);
    const Vector3 e1 = glm::normalize(-centre);  // from the centre to the camera
    const Vector3 e2 = glm::normalize(d - glm::dot(d, e1) * e1);
    const double offset = glm::length(centre), alpha = std::acos(glm::dot(d, e1));
    const double invariant = offset * std::sin(alpha);
    const double inner = port.radius, outer = inner + port.thickness;
    const double air = std::asin(invariant / inner);
    const double into_glass = std::asin(invariant / (pmma_index(nm) * inner));
    const double out_glass = std::asin(invariant / (pmma_index(nm) * outer));
    const double water = std::asin(invariant / (sea_index(nm) * outer));
    const double at = (alpha - air) + (into_glass - out_glass);
    const Vector3 out = centre + outer * (std::cos(at) * e1 + std::sin(at) * e2);
    const double way = at + water;  // the ray's direction, from e1
    return {out, on_plane(out, std::cos(way) * e1 + std::sin(way) * e2)};
}

void expect_traced(const PortDesc& port, Traced (*trace)(const Vector3&, double)) {
    for (const double nm : {420.0, 450.0, 540.0, 620.0, 690.0}) {
        CameraDesc desc = large_camera(port);
        set_wavelength(desc, nm);
        const Camera camera(desc);
        for (double y = 10; y < 3000; y += 745)
            for (double x = 10; x < 4000; x += 663) {
                const auto ray = camera.refracted_ray(x, y);
                ASSERT_TRUE(ray);
                const Traced truth = trace(*camera.lens_direction(x, y), nm);
                const Vector3 origin = from_origin(ray->origin);
                EXPECT_LT(glm::length(origin - truth.glass), 1e-7);
                EXPECT_LT(glm::length(on_plane(origin, ray->direction) - truth.plane), 1e-7);
            }
    }
}

TEST(LateralColour, RaysOfEachBandAreThoseOfAnIndependentTrace) {
    expect_traced(bk7_window(), through_window);
    expect_traced(pmma_dome(), through_dome);
}

// Without depth of air and glass the window's rays all pass through the camera's centre, and a
// pixel at the slope u shows the sine u / sqrt(1 + u^2) / n in the water.
TEST(LateralColour, OfAThinWindowIsTheClosedForm) {
    FlatPortDesc port;
    port.dispersion.water = sea();
    const CameraDesc camera = large_camera(port);
    const double u = std::hypot(2000, 1500) / camera.intrinsics.fx;
    const double sine = u / std::sqrt(1 + u * u) / sea_index(540);
    for (const double nm : {450.0, 620.0}) {
        const double in_air = sine * sea_index(nm);
        const double shift = camera.intrinsics.fx * (in_air / std::sqrt(1 - in_air * in_air) - u);
        const LateralColour found = lateral_colour(camera, 540, nm);
        EXPECT_NEAR(found.pixels, std::abs(shift), 1e-6) << nm;
        EXPECT_NEAR(std::hypot(found.at.x - 2000, found.at.y - 1500), 2500, 1e-9);
    }
    EXPECT_LT(lateral_colour(camera, 540, 540).pixels, 1e-9);
}

TEST(LateralColour, OfNumbersIsNone) {
    const CameraDesc camera = large_camera(FlatPortDesc{});
    EXPECT_EQ(lateral_colour(camera, 450, 620).pixels, 0);
    EXPECT_TRUE(band_shifts(camera, std::vector<double>{620, 540, 450}).empty());
    const auto groups = colour_groups(camera, std::vector<double>{620, 540, 450});
    ASSERT_EQ(groups.size(), 1U);
    EXPECT_EQ(groups[0].bands, (std::vector<std::size_t>{0, 1, 2}));
    EXPECT_EQ(groups[0].wavelength_nm, 540);
}

TEST(LateralColour, GroupsAreAsWideAsTheyMayBe) {
    std::vector<double> bands;
    for (int nm = 700; nm >= 400; nm -= 10) bands.push_back(nm);
    CameraDesc camera = large_camera(bk7_window());
    set_wavelength(camera, 550);
    const auto groups = colour_groups(camera, bands);
    EXPECT_GT(groups.size(), 5U);
    EXPECT_EQ(groups.front().wavelength_nm, 550);
    std::vector<int> counts(bands.size());
    for (const ColourGroup& group : groups)
        for (const std::size_t band : group.bands) {
            ++counts[band];
            EXPECT_LE(lateral_colour(camera, group.wavelength_nm, bands[band]).pixels,
                      k_shared_rays);
        }
    EXPECT_EQ(counts, std::vector<int>(bands.size(), 1));
    EXPECT_LT(colour_groups(camera, bands, 1.0).size(), groups.size());
    EXPECT_EQ(colour_groups(camera, bands, 100.0).size(), 1U);
    // A small picture has nothing to tell apart.
    resize_image(camera, 16, 12);
    EXPECT_EQ(colour_groups(camera, std::vector<double>{620, 550, 450}).size(), 1U);
}

TEST(LateralColour, OfADomeAroundItsCameraIsNone) {
    DomePortDesc port = pmma_dome();
    port.center = {0, 0, 0};
    EXPECT_LT(lateral_colour(large_camera(port), 450, 620).pixels, 1e-9);
}

TEST(LateralColour, IsSaidBandByBand) {
    EXPECT_EQ(text_of(std::vector<BandShift>{{620, 1.934}, {540, 0}, {450, 3.006}}),
              "up to 1.93 pixels at 620 nm, 3.01 at 450 nm");
}

}  // namespace
}  // namespace uw
