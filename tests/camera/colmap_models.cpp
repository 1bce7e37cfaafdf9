// ctest labels: unit
#include "camera/colmap_calibration.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/error.h"
#include "tests/support/calibration_reading.h"
#include "tests/support/message_of.h"

namespace uw {
namespace {

class ColmapModels : public test::CalibrationReading {
  protected:
    /// The camera of a model and its parameters.
    CameraDesc colmap_camera(const std::string& model, const std::string& parameters) const {
        return read(fmt::format("1 {} 640 480 {}\n", model, parameters)).desc;
    }
    /// A pinhole behind a port.
    CameraDesc behind_port(const std::string& port, const std::string& parameters) const {
        return colmap_camera("PINHOLE", fmt::format("500 500 320 240 {} {}", port, parameters));
    }
};

TEST_F(ColmapModels, ParametersGoWhereColmapHasThem) {
    // In the order of COLMAP's sensor/models.h.
    const CameraDesc opencv = colmap_camera("OPENCV", "1 2 3 4 5 6 7 8");
    EXPECT_EQ(opencv.intrinsics.fx, 1);
    EXPECT_EQ(opencv.intrinsics.fy, 2);
    EXPECT_EQ(opencv.intrinsics.cx, 3);
    EXPECT_EQ(opencv.intrinsics.cy, 4);
    EXPECT_EQ(opencv.distortion.k, (std::array<double, 6>{5, 6, 0, 0, 0, 0}));
    EXPECT_EQ(opencv.distortion.p, (std::array<double, 2>{7, 8}));
    const CameraDesc full = colmap_camera("FULL_OPENCV", "1 2 3 4 5 6 7 8 9 10 11 12");
    EXPECT_EQ(full.distortion.k, (std::array<double, 6>{5, 6, 9, 10, 11, 12}));
    EXPECT_EQ(full.distortion.p, (std::array<double, 2>{7, 8}));
    const CameraDesc fisheye = colmap_camera("OPENCV_FISHEYE", "1 2 3 4 5 6 7 8");
    EXPECT_EQ(fisheye.distortion.model, DistortionDesc::Model::fisheye);
    EXPECT_EQ(fisheye.distortion.k, (std::array<double, 6>{5, 6, 7, 8, 0, 0}));
}

TEST_F(ColmapModels, OneFocalLengthIsBoth) {
    for (const auto& [model, parameters] : {std::pair("SIMPLE_PINHOLE", "9 2 3"),
                                            {"SIMPLE_RADIAL", "9 2 3 0.1"},
                                            {"RADIAL", "9 2 3 0.1 0.2"},
                                            {"SIMPLE_RADIAL_FISHEYE", "9 2 3 0.1"},
                                            {"RADIAL_FISHEYE", "9 2 3 0.1 0.2"}}) {
        const CameraDesc camera = colmap_camera(model, parameters);
        EXPECT_EQ(camera.intrinsics.fx, 9) << model;
        EXPECT_EQ(camera.intrinsics.fy, 9) << model;
        EXPECT_EQ(camera.intrinsics.cx, 2) << model;
    }
}

TEST_F(ColmapModels, TheLeastModelThatHoldsTheCamera) {
    CameraDesc camera;
    EXPECT_EQ(colmap_model_of(camera).name, "PINHOLE");
    camera.distortion.p[1] = 0.1;
    EXPECT_EQ(colmap_model_of(camera).name, "OPENCV");
    camera.distortion.k[2] = 0.1;
    EXPECT_EQ(colmap_model_of(camera).name, "FULL_OPENCV");
    camera.distortion.model = DistortionDesc::Model::fisheye;
    EXPECT_EQ(colmap_model_of(camera).name, "OPENCV_FISHEYE");
}

TEST_F(ColmapModels, WrittenParametersAreThoseRead) {
    const CameraDesc camera = colmap_camera("FULL_OPENCV", "1 2 3 4 5 6 7 8 9 10 11 12");
    EXPECT_EQ(colmap_model_of(camera).values,
              (std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}));
    const CameraDesc dome = behind_port("DOMEPORT", "0.1 0.2 0.3 0.5 0.01 1 1.5 1.33");
    const ColmapParameters port = port_model_of(*dome.port);
    EXPECT_EQ(port.name, "DOMEPORT");
    EXPECT_EQ(port.values, (std::vector<double>{0.1, 0.2, 0.3, 0.5, 0.01, 1, 1.5, 1.33}));
}

TEST_F(ColmapModels, NormalsRoundedInTheFileBecomeUnit) {
    const CameraDesc flat = behind_port("FLATPORT", "0.6 0 0.8004 0.1 0.01 1 1.5 1.33");
    EXPECT_NEAR(glm::length(std::get<FlatPortDesc>(*flat.port).normal), 1, 1e-15);
    EXPECT_THROW(behind_port("FLATPORT", "0.6 0 0.9 0.1 0.01 1 1.5 1.33"), InputError);
}

TEST_F(ColmapModels, CountsAreChecked) {
    EXPECT_EQ(test::message_of<InputError>([&] { colmap_camera("RADIAL", "9 2 3 0.1"); }),
              (folder_ / "c.yaml").string() +
                  ":1:3: MODEL: RADIAL has 5 parameters (f cx cy k1 k2), found 4; check the list");
    EXPECT_THROW(behind_port("DOMEPORT", "0 0 0.01 0.05 0.007 1 1.5"), InputError);
}

}  // namespace
}  // namespace uw
