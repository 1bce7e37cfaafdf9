// ctest labels: unit metamorphic
#include "camera/calibration.h"

#include <gtest/gtest.h>

#include "camera/camera.h"
#include "core/scene/scene_desc.h"
#include "tests/support/calibration_reading.h"
#include "tests/support/calibration_texts.h"

namespace uw {
namespace {

class Calibrations : public test::CalibrationReading {
  protected:
    /// What was written, read again; a scene's camera by the scene's reader.
    CameraDesc read_again(CalibrationFormat format, const std::string& text) const {
        if (format != CalibrationFormat::scene) return read(text).desc;
        return read_scene(write("scene.yaml", "uwvdb: 1\n" + text), {}).camera;
    }
};

/// The largest difference of rays, origin or direction, over the image and beyond its edges;
/// infinite where one camera has a ray and the other has none.
double worst_difference(const CameraDesc& a, const CameraDesc& b) {
    const Camera first(a), second(b);
    double worst = 0;
    for (int j = -2; j <= 22; ++j) {
        for (int i = -2; i <= 22; ++i) {
            const double x = a.width * i / 20.0, y = a.height * j / 20.0;
            const auto p = first.refracted_ray(x, y), q = second.refracted_ray(x, y);
            if (p.has_value() != q.has_value()) return INFINITY;
            if (!p) continue;
            worst = std::max({worst, glm::length(p->origin - q->origin),
                              glm::length(p->direction - q->direction)});
        }
    }
    return worst;
}

TEST_F(Calibrations, EveryFormatReadWrittenAndReadAgainHasTheSameRays) {
    int written = 0;
    for (const auto& [name, camera, text] : test::calibration_texts()) {
        const CameraDesc desc = read(text, camera).desc;
        for (const CalibrationFormat format : calibration_formats()) {
            if (!calibration_obstacle(format, desc).empty()) continue;
            const CameraDesc again = read_again(format, write_calibration(format, desc));
            EXPECT_EQ(again.width, desc.width) << name << " " << word_of(format);
            EXPECT_EQ(again.height, desc.height) << name << " " << word_of(format);
            EXPECT_EQ(again.port.has_value(), desc.port.has_value());
            EXPECT_LT(worst_difference(desc, again), 1e-9) << name << " as " << word_of(format);
            ++written;
        }
    }
    // Four files have ports and go into three formats each, two more are more than radtan.
    EXPECT_EQ(written, 7 * 6 - 2 + 4 * 3);
}

TEST_F(Calibrations, PixelCentresAreAtZeroInOpenCvRosAndKalibr) {
    // cv::projectPoints shows (0, 0, 1) at (cx, cy), where the first pixel's centre is (0, 0).
    for (const auto& [text, camera, cx, cy] :
         {std::tuple(test::k_ros_plumb_bob, "", 312.3333507245396, 246.2279496394374),
          std::tuple(test::k_opencv_rational, "", 639.5, 359.5),
          std::tuple(test::k_kalibr, "cam0", 362.680, 246.049),
          std::tuple(test::k_kalibr, "cam1", 254.93170605935475, 256.8974428996504)}) {
        const auto ray = Camera(read(text, camera).desc).refracted_ray(cx + 0.5, cy + 0.5);
        ASSERT_TRUE(ray);
        EXPECT_LT(glm::length(ray->direction - Vector3(0, 0, 1)), 1e-12);
    }
}

TEST_F(Calibrations, ImageCornerIsZeroInColmapAndCalibmar) {
    const auto colmap = Camera(read(test::k_colmap, "2").desc).refracted_ray(960, 540);
    ASSERT_TRUE(colmap);
    EXPECT_EQ(colmap->direction, Vector3(0, 0, 1));
    CameraDesc calibmar = read(test::k_calibmar_flat).desc;
    EXPECT_EQ(calibmar.intrinsics.cx, 963.440447);
    calibmar.port.reset();
    const auto ray = Camera(calibmar).refracted_ray(963.440447, 604.968632);
    ASSERT_TRUE(ray);
    EXPECT_LT(glm::length(ray->direction - Vector3(0, 0, 1)), 1e-12);
}

TEST_F(Calibrations, CoefficientsGoWhereTheyBelong) {
    const CameraDesc rational = read(test::k_opencv_rational).desc;
    EXPECT_EQ(rational.distortion.k, (std::array<double, 6>{5.2, 3.1, 0.15, 5.5, 4.9, 0.9}));
    EXPECT_EQ(rational.distortion.p, (std::array<double, 2>{1e-4, -2e-4}));
    EXPECT_EQ(rational.intrinsics.fy, 912);
    const CameraDesc full = read(test::k_colmap, "12").desc;
    EXPECT_EQ(full.distortion.k, (std::array<double, 6>{-0.1, 0.05, 0.01, 0.02, -0.003, 0.0004}));
    EXPECT_EQ(full.distortion.p, (std::array<double, 2>{0.001, -0.002}));
    const CameraDesc simple = read(test::k_colmap, "1").desc;
    EXPECT_EQ(simple.intrinsics.fy, 2559.81);
    EXPECT_EQ(simple.distortion.k[0], -0.0204997);
    const CameraDesc fisheye = read(test::k_kalibr, "cam1").desc;
    EXPECT_EQ(fisheye.distortion.model, DistortionDesc::Model::fisheye);
    EXPECT_EQ(fisheye.distortion.k[3], 0.00020293673591811182);
}

TEST_F(Calibrations, Ports) {
    const CameraDesc flat = read(test::k_calibmar_flat).desc;
    ASSERT_TRUE(flat.port);
    const auto& port = std::get<FlatPortDesc>(*flat.port);
    EXPECT_NEAR(port.normal.x, 0.01311427226, 1e-11);
    EXPECT_NEAR(glm::length(port.normal), 1, 1e-15);
    EXPECT_EQ(port.distance, 0.02531637365);
    EXPECT_EQ(port.thickness, 0.01);
    EXPECT_EQ(port.n_water, 1.333);
    const CameraDesc domed = read(test::k_colmap, "21").desc;
    const auto& dome = std::get<DomePortDesc>(domed.port.value());
    EXPECT_EQ(dome.center, (Point3{0.001, 0.002, 0.01}));
    EXPECT_EQ(dome.radius, 0.05);
    EXPECT_EQ(dome.thickness, 0.007);
    EXPECT_EQ(dome.n_glass, 1.52);
    EXPECT_FALSE(read(test::k_colmap, "2").desc.port);
}

TEST_F(Calibrations, WhatAFormatCannotExpressIsSaid) {
    const CameraDesc flat = read(test::k_calibmar_flat).desc;
    EXPECT_NE(calibration_obstacle(CalibrationFormat::opencv, flat).find("have no ports"),
              std::string::npos);
    EXPECT_NE(calibration_obstacle(CalibrationFormat::kalibr, flat).find("have no ports"),
              std::string::npos);
    EXPECT_EQ(calibration_obstacle(CalibrationFormat::colmap, flat), "");
    const CameraDesc rational = read(test::k_opencv_rational).desc;
    EXPECT_NE(calibration_obstacle(CalibrationFormat::kalibr, rational).find("radtan"),
              std::string::npos);
    CameraDesc lossy = flat;
    std::get<FlatPortDesc>(*lossy.port).fresnel = true;
    EXPECT_EQ(calibration_omissions(CalibrationFormat::colmap, lossy).size(), 1U);
    EXPECT_TRUE(calibration_omissions(CalibrationFormat::scene, lossy).empty());
}

TEST_F(Calibrations, CameraOfASceneTakesItsCalibration) {
    write("rig.yaml", test::k_calibmar_dome);
    const auto file = write("scene.yaml", "uwvdb: 1\ncamera: {calibration: rig.yaml}\n");
    CameraDesc camera = read_scene(file, {}).camera;
    ASSERT_TRUE(camera.calibration);
    const auto calibration = apply_calibration(camera);
    ASSERT_TRUE(calibration);
    EXPECT_EQ(calibration->format, CalibrationFormat::calibmar);
    EXPECT_EQ(camera.width, 1280);
    EXPECT_TRUE(camera.port);
    EXPECT_EQ(worst_difference(camera, calibration->desc), 0);
    CameraDesc none;
    EXPECT_FALSE(apply_calibration(none));
}

TEST_F(Calibrations, UnknownFilesListWhatIsKnown) {
    for (const char* text : {"", " \n", "a: 1\n", "[1, 2]\n", "hello\n", "a: {b: c}\n"})
        expect_refused(text, "known formats are OpenCV and ROS YAML");
    expect_refused("uwvdb: 1\ncamera: {}\n", "is a scene, not a calibration");
    expect_refused(std::string("\0\1\2", 3), "not UTF-8 text");
    expect_refused("a: [1\n", "correct the YAML");
    expect_refused("model: !!python/object x\nparameters: []\n", "has no meaning in a calibration");
}

TEST_F(Calibrations, WhatIsNoFile) {
    EXPECT_THROW(read_calibration(folder_ / "none.yaml"), IoError);
    EXPECT_THROW(read_calibration(folder_.path()), IoError);
}

}  // namespace
}  // namespace uw
