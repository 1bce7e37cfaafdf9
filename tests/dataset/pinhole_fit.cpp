// ctest labels: unit analytic slow
// Cameras with ports as formats without them have them: against Snell's law, against lenses that
// are known, and as COLMAP reads them.
#include "dataset/pinhole_fit.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <sstream>

#include "core/base/error.h"
#include "core/base/json.h"
#include "tests/support/dataset/dataset_scenes.h"

namespace uw {
namespace {

/// Pixels all over the image, each with the point that `point_at` says.
std::vector<SeenPixel> seen_all_over(const CameraDesc& camera,
                                     const std::function<Point3(double x, double y)>& point_at) {
    std::vector<SeenPixel> seen;
    constexpr int k_side = 21;
    for (int row = 0; row < k_side; ++row)
        for (int column = 0; column < k_side; ++column) {
            const ImagePoint pixel{(column + 0.5) / k_side * camera.width,
                                   (row + 0.5) / k_side * camera.height};
            seen.push_back({pixel, point_at(pixel.x, pixel.y)});
        }
    return seen;
}

CameraDesc plain_camera() {
    CameraDesc camera;
    camera.width = 640;
    camera.height = 480;
    camera.intrinsics = {500, 510, 310, 245};
    return camera;
}

/// What a plain camera sees through a flat port across its axis, by Snell's law, in one plane.
Point3 through_flat_port(const CameraDesc& camera, const FlatPortDesc& port, double x, double y,
                         double depth) {
    const IntrinsicsDesc& k = camera.intrinsics;
    const double u = (x - k.cx) / k.fx, v = (y - k.cy) / k.fy, slope = std::hypot(u, v);
    const double sine = std::sin(std::atan(slope));
    const auto tangent_in = [&](double index) { return std::tan(std::asin(sine / index)); };
    const double across = port.distance * slope + port.thickness * tangent_in(port.n_glass) +
                          (depth - port.distance - port.thickness) * tangent_in(port.n_water);
    const double share = slope > 0 ? across / slope : 0;
    return {share * u, share * v, depth};
}

/// Where OpenCV's formula, of 8 or 9 parameters, images a point.
ImagePoint by_opencv(const CameraDesc& camera, const Point3& p) {
    const auto& k = camera.distortion.k;
    const auto& t = camera.distortion.p;
    const double x = p.x / p.z, y = p.y / p.z, r = x * x + y * y;
    const double f = 1 + k[0] * r + k[1] * r * r + k[2] * r * r * r;
    return {camera.intrinsics.cx +
                camera.intrinsics.fx * (f * x + 2 * t[0] * x * y + t[1] * (r + 2 * x * x)),
            camera.intrinsics.cy +
                camera.intrinsics.fy * (f * y + t[0] * (r + 2 * y * y) + 2 * t[1] * x * y)};
}

double squares_of(const CameraDesc& camera, const std::vector<SeenPixel>& seen) {
    double sum = 0;
    for (const SeenPixel& s : seen) {
        const ImagePoint at = by_opencv(camera, s.point);
        sum += (at.x - s.pixel.x) * (at.x - s.pixel.x) + (at.y - s.pixel.y) * (at.y - s.pixel.y);
    }
    return sum;
}

void expect_same_camera(const CameraDesc& a, const CameraDesc& b) {
    EXPECT_NEAR(a.intrinsics.fx, b.intrinsics.fx, 1e-5);
    EXPECT_NEAR(a.intrinsics.fy, b.intrinsics.fy, 1e-5);
    EXPECT_NEAR(a.intrinsics.cx, b.intrinsics.cx, 1e-5);
    EXPECT_NEAR(a.intrinsics.cy, b.intrinsics.cy, 1e-5);
    EXPECT_EQ(a.distortion.model, b.distortion.model);
    for (std::size_t i = 0; i < a.distortion.k.size(); ++i)
        EXPECT_NEAR(a.distortion.k[i], b.distortion.k[i], 1e-7) << i;
    for (std::size_t i = 0; i < a.distortion.p.size(); ++i)
        EXPECT_NEAR(a.distortion.p[i], b.distortion.p[i], 1e-7) << i;
}

// A lens of a model that is fitted is found again from what it sees, wherever the fit begins.
TEST(PinholeFit, FindsALensThatItsModelHas) {
    for (const int terms : {2, 3}) {
        CameraDesc lens = plain_camera();
        lens.distortion.k = {-0.21, 0.06, terms == 3 ? -0.01 : 0.0};
        lens.distortion.p = {0.002, -0.003};
        CameraDesc begun = plain_camera();
        begun.intrinsics = {350, 380, 330, 220};
        if (terms == 3) begun.distortion.k[2] = 0.1;  // so that k3 is fitted
        const Camera camera(lens);
        const auto seen = seen_all_over(lens, [&](double x, double y) {
            return Point3{} + (2 + x / 300) * camera.lens_direction(x, y).value();
        });
        expect_same_camera(fit_pinhole(begun, seen), lens);
        EXPECT_LT(model_error(lens, seen).worst, 1e-6);
    }
}

TEST(PinholeFit, FindsAFisheye) {
    CameraDesc lens = plain_camera();
    lens.intrinsics = {200, 210, 310, 245};  // 180 degrees and more
    lens.distortion.model = DistortionDesc::Model::fisheye;
    lens.distortion.k = {0.02, -0.005, 0.001, -0.0002};
    CameraDesc begun = lens;
    begun.distortion.k = {};
    const Camera camera(lens);
    const auto seen = seen_all_over(lens, [&](double x, double y) {
        return Point3{} + (2 + x / 300) * camera.lens_direction(x, y).value();
    });
    expect_same_camera(fit_pinhole(begun, seen), lens);
}

// At one depth behind a port across the axis what a camera sees is a distortion of radii alone, of
// which a polynomial of fourth order leaves little.
TEST(PinholeFit, OfOneDepthLeavesLittle) {
    CameraDesc camera = plain_camera();
    const FlatPortDesc port{.normal = {0, 0, 1}, .distance = 0.05, .thickness = 0.02};
    const auto seen = seen_all_over(
        camera, [&](double x, double y) { return through_flat_port(camera, port, x, y, 2.5); });
    EXPECT_GT(model_error(camera, seen).median, 50);  // a quarter of the way from the centre
    camera.port = port;
    const CameraDesc fitted = fit_pinhole(camera, seen);
    EXPECT_FALSE(fitted.port);
    EXPECT_LT(model_error(fitted, seen).worst, 0.25);
    EXPECT_LT(model_error(fitted, seen).median, 0.05);
    EXPECT_NEAR(fitted.intrinsics.cx, 310, 0.05);
    // On the axis it is paraxial optics (docs/port.md).
    const double enlarged = 2.5 / (port.distance + port.thickness / port.n_glass +
                                   (2.5 - port.distance - port.thickness) / port.n_water);
    EXPECT_NEAR(fitted.intrinsics.fx / 500, enlarged, 0.004);
}

// No camera of the model nearby is closer, in the mean square, and the errors are those of the
// formula.
TEST(PinholeFit, IsTheLeastOfSquares) {
    CameraDesc camera = plain_camera();
    const FlatPortDesc port{.normal = {0, 0, 1}, .distance = 0.1, .thickness = 0.02};
    const auto seen = seen_all_over(camera, [&](double x, double y) {
        return through_flat_port(camera, port, x, y, 0.8 + 0.5 * std::sin(x / 50) + y / 200);
    });
    const CameraDesc fitted = fit_pinhole(camera, seen);
    const double least = squares_of(fitted, seen);
    const ModelError error = model_error(fitted, seen);
    EXPECT_NEAR(error.rms, std::sqrt(least / static_cast<double>(seen.size())), 1e-9);
    EXPECT_GT(error.worst, error.rms);
    EXPECT_LT(error.median, error.rms);
    const auto expect_more = [&](const std::function<void(CameraDesc&, double)>& change,
                                 double step) {
        for (const double sign : {-1.0, 1.0}) {
            CameraDesc beside = fitted;
            change(beside, sign * step);
            EXPECT_GT(squares_of(beside, seen), least);
        }
    };
    expect_more([](CameraDesc& c, double d) { c.intrinsics.fx += d; }, 1e-3);
    expect_more([](CameraDesc& c, double d) { c.intrinsics.fy += d; }, 1e-3);
    expect_more([](CameraDesc& c, double d) { c.intrinsics.cx += d; }, 1e-3);
    expect_more([](CameraDesc& c, double d) { c.intrinsics.cy += d; }, 1e-3);
    for (std::size_t i = 0; i < 2; ++i) {
        expect_more([i](CameraDesc& c, double d) { c.distortion.k[i] += d; }, 1e-5);
        expect_more([i](CameraDesc& c, double d) { c.distortion.p[i] += d; }, 1e-5);
    }
}

TEST(PinholeFit, NeedsMoreThanOnePoint) {
    const CameraDesc camera = plain_camera();
    const std::vector<SeenPixel> seen(50, {{310, 245}, {0, 0, 2}});
    EXPECT_THROW(fit_pinhole(camera, seen), InputError);
}

// Points behind a perspective camera are off by the diagonal, and do not spoil its fit.
TEST(PinholeFit, CountsWhatTheModelDoesNotImage) {
    const CameraDesc camera = plain_camera();
    auto seen = seen_all_over(
        camera, [&](double x, double y) { return Point3((x - 310) / 500, (y - 245) / 510, 1); });
    seen.push_back({{1, 1}, {0, 0, -1}});
    const CameraDesc fitted = fit_pinhole(camera, seen);
    EXPECT_NEAR(fitted.intrinsics.fx, 500, 1e-6);
    EXPECT_EQ(model_error(fitted, seen).worst, 800);
    EXPECT_LT(model_error(fitted, seen).median, 1e-6);
}

TEST(PinholeFit, IsItselfAfterItsFile) {
    const test::TempDir folder;
    PinholeFit fit{1.25, 2.5, 4, {30.1, 33, 60}, {0.1, 0.2, 1.0 / 3}, {1, 2.0 / 3, 3, 4}, {}};
    fit.distortion.k = {0.1, -0.2, 1.0 / 7};
    fit.distortion.p = {1e-3, -1e-17};
    PinholeFit fisheye = fit;
    fisheye.distortion.model = DistortionDesc::Model::fisheye;
    const PinholeFits fits{fit, std::nullopt, fisheye};
    const auto written = [&](const std::string& text) {
        std::ofstream(folder / "fits.json") << text;
        return folder / "fits.json";
    };
    EXPECT_EQ(read_pinholes(written(pinhole_text(fits)), 3), fits);
    EXPECT_THROW(read_pinholes(folder / "fits.json", 2), InputError);
    EXPECT_THROW(read_pinholes(written("[{}]"), 1), InputError);
    EXPECT_THROW(read_pinholes(folder / "none.json", 3), IoError);
}

constexpr const char* k_flat_port = "camera.port={type: flat, distance: 0.05, thickness: 0.02}";

class PinholeSets : public test::DatasetTest {
  protected:
    /// What a run of these options says, which must succeed.
    std::string said_by(const std::string& folder, const std::vector<std::string>& more) const {
        std::vector<std::string> arguments{"dataset", "moving.yaml", "-o", folder};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const test::ProgramResult result = run(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result.err;
    }

    Json fit_of(const std::string& folder) const {
        return Json::parse(read(folder + "/views/pinholes.json")).at(0);
    }

    /// How far COLMAP's model of the set is off where it observes points, as COLMAP computes it.
    std::vector<double> errors_in(const std::string& folder) const {
        std::istringstream cameras(last_line(read(folder + "/sparse/0/cameras.txt")));
        std::string id, name;
        int width = 0, height = 0;
        CameraDesc model;
        cameras >> id >> name >> width >> height;
        IntrinsicsDesc& i = model.intrinsics;
        cameras >> i.fx >> i.fy >> i.cx >> i.cy;
        if (name != "PINHOLE")
            cameras >> model.distortion.k[0] >> model.distortion.k[1] >> model.distortion.p[0] >>
                model.distortion.p[1];
        std::map<long, Point3> points;
        std::istringstream table(read(folder + "/sparse/0/points3D.txt"));
        for (std::string line; std::getline(table, line);) {
            if (line.starts_with("#")) continue;
            std::istringstream cells(line);
            long point = 0;
            cells >> point;
            Point3& p = points[point];
            cells >> p.x >> p.y >> p.z;
        }
        std::vector<double> errors;
        std::istringstream images(read(folder + "/sparse/0/images.txt"));
        for (std::string line; std::getline(images, line);) {
            if (line.starts_with("#")) continue;
            std::istringstream cells(line);
            std::string ignored;
            Rotation q;
            Vector3 t;
            cells >> ignored >> q.w >> q.x >> q.y >> q.z >> t.x >> t.y >> t.z;
            std::getline(images, line);
            std::istringstream seen(line);
            double x = 0, y = 0;
            for (long point = 0; seen >> x >> y >> point;) {
                if (point < 0) continue;
                const Vector3 p = q.matrix() * from_origin(points.at(point)) + t;
                const ImagePoint at = by_opencv(model, at_origin_plus(p));
                errors.push_back(std::hypot(at.x - x, at.y - y));
            }
        }
        std::ranges::sort(errors);
        return errors;
    }

    static std::string last_line(const std::string& text) {
        return text.substr(text.rfind('\n', text.size() - 2) + 1);
    }
    static std::string poses_in(const std::string& images) {
        std::istringstream lines(images);
        std::string poses, line;
        while (std::getline(lines, line))
            if (line.ends_with(".png")) poses += line + "\n";
        return poses;
    }
};

TEST_F(PinholeSets, SayHowFarTheyAreOff) {
    const std::vector<std::string> options{"--format", "colmap", "--set", k_flat_port, "--quiet"};
    const std::string said = said_by("air", options);
    EXPECT_EQ(test::line_count(said), 1) << said;
    EXPECT_TRUE(said.starts_with("warning: --format colmap has no words for a port")) << said;
    const std::vector<double> errors = errors_in("air");
    ASSERT_GT(errors.size(), 1000U);
    const Json fit = fit_of("air");
    // The points observed are on other pixels than those fitted to.
    const double median = fit.at("in_air").at("median_px").get<double>();
    EXPECT_NEAR(errors[errors.size() / 2] / median, 1, 0.1);
    EXPECT_NE(said.find(fmt::format("off by {:.3g} px in the median", median)), std::string::npos)
        << said;
    EXPECT_NE(said.find("--pinhole-fit"), std::string::npos);
    EXPECT_NE(read("air/README.md").find(fmt::format("off by {:.3g} px in the median", median)),
              std::string::npos);
}

TEST_F(PinholeSets, FittedAreOffByWhatTheySay) {
    const std::vector<std::string> options{"--format", "colmap,nerfstudio,euroc", "--set",
                                           k_flat_port, "--pinhole-fit"};
    const std::string said = said_by("fitted", options);
    EXPECT_NE(said.find("note: --format colmap,nerfstudio,euroc has no words for a port: the "
                        "cameras there are pinholes, fitted to surfaces "),
              std::string::npos)
        << said;
    EXPECT_EQ(said.find("warning"), std::string::npos) << said;
    const Json fit = fit_of("fitted");
    const std::vector<double> errors = errors_in("fitted");
    ASSERT_GT(errors.size(), 1000U);
    const double median = fit.at("fitted").at("median_px").get<double>();
    EXPECT_NEAR(errors[errors.size() / 2] / median, 1, 0.2);
    EXPECT_LT(errors.back(), 1.5 * fit.at("fitted").at("worst_px").get<double>());
    EXPECT_LT(20 * median, fit.at("in_air").at("median_px").get<double>());
    EXPECT_NE(read("fitted/README.md").find(fmt::format("{:.3g} px in the median", median)),
              std::string::npos);
    const Json transforms = Json::parse(read("fitted/transforms.json"));
    EXPECT_EQ(transforms.at("camera_model"), "OPENCV");
    EXPECT_EQ(transforms.at("fl_x"), fit.at("intrinsics").at(0));
    EXPECT_EQ(transforms.at("k2"), fit.at("k").at(1));
    EXPECT_NE(read("fitted/mav0/cam0/sensor.yaml").find("fitted to the rays in water"),
              std::string::npos);
    EXPECT_EQ(
        said_by("quiet", {"--format", "colmap", "--set", k_flat_port, "--pinhole-fit", "--quiet"}),
        "");
}

// KITTI's tables have no distortion that could be fitted, so that its camera is that in air always.
TEST_F(PinholeSets, OfKittiSayHowFarTheyAreOff) {
    const std::string said =
        said_by("kitti", {"--format", "kitti", "--set", k_flat_port, "--quiet"});
    EXPECT_EQ(test::line_count(said), 1) << said;
    EXPECT_TRUE(said.starts_with("warning: --format kitti has no words for a port")) << said;
    EXPECT_NE(said.find("--pinhole-fit fits those of colmap, nerfstudio, euroc and mcap"),
              std::string::npos)
        << said;
    said_by("air", {"--format", "colmap", "--set", k_flat_port, "--quiet"});
    EXPECT_EQ(fit_of("kitti"), fit_of("air"));
    const std::string off = fmt::format("off by {:.3g} px in the median",
                                        fit_of("air").at("in_air").at("median_px").get<double>());
    EXPECT_NE(said.find(off), std::string::npos) << said;
    EXPECT_NE(read("kitti/README.md").find(off), std::string::npos);
    // Beside a format that is fitted it is still warned of.
    const std::string both = said_by(
        "both", {"--format", "colmap,kitti", "--set", k_flat_port, "--pinhole-fit", "--quiet"});
    EXPECT_EQ(test::line_count(both), 1) << both;
    EXPECT_TRUE(both.starts_with("warning: --format kitti has no words for a port")) << both;
    EXPECT_NE(both.find("--pinhole-fit fits those of colmap to"), std::string::npos) << both;
    EXPECT_NE(read("both/README.md").find("fitted, as colmap has it"), std::string::npos);
    EXPECT_EQ(read("both/kitti/sequences/00/calib.txt"),
              read("kitti/kitti/sequences/00/calib.txt"));
}

// The set differs from that of the camera in air in nothing but the models without ports.
TEST_F(PinholeSets, FittedHaveTheTruePoses) {
    said_by("air", {"--format", "colmap", "--set", k_flat_port});
    said_by("fitted", {"--format", "colmap", "--set", k_flat_port, "--pinhole-fit"});
    EXPECT_EQ(poses_in(read("fitted/sparse/0/images.txt")),
              poses_in(read("air/sparse/0/images.txt")));
    for (const char* file : {"sparse/0/images.txt", "sparse/refractive/cameras.txt",
                             "views/points.csv", "images/000003.png"})
        EXPECT_TRUE(read(fmt::format("fitted/{}", file)) == read(fmt::format("air/{}", file)))
            << file;
    EXPECT_NE(read("fitted/sparse/0/cameras.txt"), read("air/sparse/0/cameras.txt"));
    // In the folder of the other set.
    expect_failure({"dataset", "moving.yaml", "-o", "air", "--format", "colmap", "--set",
                    k_flat_port, "--pinhole-fit"},
                   2, "its pinhole_fit is false there, true here");
}

// A dome around the camera's very centre bends no ray.
TEST_F(PinholeSets, BehindACentredDomeAreRightInAir) {
    EXPECT_EQ(said_by("dome", {"--format", "colmap", "--quiet", "--set",
                               "camera.port={type: dome, center: [0, 0, 0], radius: 0.08, "
                               "thickness: 0.007}"}),
              "");
    EXPECT_LT(errors_in("dome").back(), 1e-5);
}

TEST_F(PinholeSets, OfARigFitEachCameraThatHasAPort) {
    const test::ProgramResult result = run(
        {"dataset", "pair.yaml", "-o", "rig", "--format", "nerfstudio", "--pinhole-fit", "--quiet",
         "--set", "cameras.right.port={type: flat, distance: 0.05, thickness: 0.02}"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const Json fits = Json::parse(read("rig/views/pinholes.json"));
    ASSERT_EQ(fits.size(), 2U);
    EXPECT_TRUE(fits.at(0).is_null());
    const Json frames = Json::parse(read("rig/transforms.json")).at("frames");
    EXPECT_EQ(frames.at(0).at("fl_x"), 36);
    EXPECT_EQ(frames.at(1).at("fl_x"), fits.at(1).at("intrinsics").at(0));
    EXPECT_GT(frames.at(1).at("fl_x"), 45);  // 4/3 of 36
}

TEST_F(PinholeSets, AreRefusedWhereTheyMakeNoSense) {
    expect_failure({"dataset", "moving.yaml", "--format", "png", "--pinhole-fit"}, 2,
                   "add one of them to --format");
    expect_failure(
        {"dataset", "moving.yaml", "--format", "kitti", "--pinhole-fit", "--set", k_flat_port}, 2,
        "add one of them to --format");
    expect_failure({"dataset", "moving.yaml", "--format", "colmap", "--pinhole-fit"}, 2,
                   "no camera of the scene has a port");
    expect_failure({"dataset", "moving.yaml", "-o", "open", "--quiet", "--format", "nerfstudio",
                    "--pinhole-fit", "--set", k_flat_port, "--set", "geometry=[]"},
                   3, "there is no surface in view");
}

}  // namespace
}  // namespace uw
