// ctest labels: unit
// Images of numbers, read back by their definitions, against the layers of the EXR beside them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/image/image_file.h"
#include "tests/support/dataset/dataset_scenes.h"

namespace uw {
namespace {

/// A PNG's numbers of 8 or 16 bits.
std::vector<int> numbers_of(const std::filesystem::path& file, int bits) {
    const PixelImage image = read_image(file);
    std::vector<int> numbers;
    for (const float value : image.pixels)
        numbers.push_back(
            static_cast<int>(std::lround(static_cast<double>(value) * ((1 << bits) - 1))));
    return numbers;
}

template <class T>
T bytes_as(const std::string& bytes, std::size_t at) {
    T value;
    std::memcpy(&value, bytes.data() + at, sizeof(value));
    return value;
}

class DatasetImages : public test::DatasetTest {};

TEST_F(DatasetImages, DepthIsRoundedAndOfTheScaleWanted) {
    make("moving.yaml", "exr,depth,mask,ids", {"--frames", "2", "--depth-scale", "777"});
    const test::ImageFile exr = truth("000002");
    const std::vector<int> depth = numbers_of(folder_ / "set/depth/000002.png", 16);
    const std::vector<int> mask = numbers_of(folder_ / "set/masks/000002.png", 8);
    const std::vector<int> ids = numbers_of(folder_ / "set/ids/000002.png", 16);
    ASSERT_EQ(depth.size(), 40U * 30U);
    for (std::size_t i = 0; i < depth.size(); ++i) {
        EXPECT_EQ(depth[i], std::lround(777.0 * exr.channels.at("depth.Z")[i]));
        EXPECT_EQ(ids[i], exr.channels.at("id.V")[i]);
        EXPECT_EQ(mask[i], exr.channels.at("id.V")[i] > 0 ? 255 : 0);
    }
    EXPECT_EQ(read("set/ids/names.csv"), "layer,number,name,geometry\nid,1,plane,0\nid,2,box,1\n");
}

TEST_F(DatasetImages, DepthBeyondTheLimitIsLeftOut) {
    make("scene.yaml", "exr,depth", {"--depth-far", "3"});
    const test::ImageFile exr = truth("000000");
    const std::vector<int> depth = numbers_of(folder_ / "set/depth/000000.png", 16);
    int near = 0, far = 0;
    for (std::size_t i = 0; i < depth.size(); ++i) {
        const float z = exr.channels.at("depth.Z")[i];
        EXPECT_EQ(depth[i], z > 3 ? 0 : std::lround(1000.0 * z));
        (z > 3 ? far : near) += 1;
    }
    EXPECT_GT(near, 0);
    EXPECT_GT(far, 0);
}

// By equation: sRGB of radiance times one exposure, with and without water.
TEST_F(DatasetImages, PairsForRestorationHaveOneExposure) {
    make("moving.yaml", "exr,clean",
         {"--frames", "0,3", "--exposure", "2.5", "--image-bits", "16"});
    const auto srgb = [](double linear) {
        const double v = std::clamp(linear, 0.0, 1.0);
        return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    };
    for (const char* frame : {"000000", "000003"}) {
        const test::ImageFile exr = truth(frame);
        for (const auto& [folder, layer] :
             {std::pair("images", ""), std::pair("clean", "clean.")}) {
            const std::vector<int> image =
                numbers_of(folder_ / ("set/" + std::string(folder) + "/" + frame + ".png"), 16);
            ASSERT_EQ(image.size(), 3U * 40U * 30U);
            for (std::size_t i = 0; i < image.size(); ++i) {
                const std::string channel = layer + std::string(1, "RGB"[i % 3]);
                EXPECT_NEAR(image[i], 65535 * srgb(2.5 * exr.channels.at(channel)[i / 3]), 0.5001)
                    << folder;
            }
        }
    }
}

TEST_F(DatasetImages, AutomaticExposureIsOneForAll) {
    make("moving.yaml", "png");
    const double first = read_preview_header(folder_ / "set/images/000000.png")->exposure;
    EXPECT_NE(first, 1);
    for (int frame = 1; frame < 7; ++frame)
        EXPECT_EQ(
            read_preview_header(folder_ / fmt::format("set/images/{:06}.png", frame))->exposure,
            first);
}

TEST_F(DatasetImages, NumpyArraysAreTheLayers) {
    make("moving.yaml", "exr,npy", {"--frames", "1", "--layers", "normal,flow"});
    const test::ImageFile exr = truth("000001");
    const auto check = [&](const std::string& layer, const std::string& shape,
                           const std::vector<std::string>& channels) {
        const std::string bytes = read("set/npy/" + layer + "/000001.npy");
        ASSERT_TRUE(bytes.starts_with(std::string("\x93NUMPY\x01\x00", 8))) << layer;
        const auto length = bytes_as<std::uint16_t>(bytes, 8);
        EXPECT_EQ((10U + length) % 64, 0U);
        const std::string header = bytes.substr(10, length);
        EXPECT_NE(header.find("'descr': '<f4', 'fortran_order': False, 'shape': " + shape + ","),
                  std::string::npos)
            << header;
        EXPECT_EQ(header.back(), '\n');
        ASSERT_EQ(bytes.size(), 10U + length + 4 * 1200 * channels.size());
        for (std::size_t i = 0; i < 1200; ++i)
            for (std::size_t c = 0; c < channels.size(); ++c) {
                const auto value =
                    bytes_as<float>(bytes, 10U + length + 4 * (i * channels.size() + c));
                const float expected = exr.channels.at(channels[c])[i];
                // Light in an EXR may be stored as half floats, within 2^-11 of each value.
                EXPECT_NEAR(value, expected, layer == "rgb" ? expected / 2000 : 0) << layer;
            }
    };
    check("depth", "(30, 40)", {"depth.Z"});
    check("normal", "(30, 40, 3)", {"normal.X", "normal.Y", "normal.Z"});
    check("flow", "(30, 40, 2)", {"flow.X", "flow.Y"});
    check("rgb", "(30, 40, 3)", {"R", "G", "B"});
}

TEST_F(DatasetImages, FlowIsMiddleburys) {
    make("moving.yaml", "exr,flow", {"--frames", "4-6"});
    EXPECT_FALSE(exists("set/flow/000006.flo"));  // there is no frame 7
    const test::ImageFile exr = truth("000004");
    const std::string flo = read("set/flow/000004.flo");
    ASSERT_EQ(flo.size(), 12U + 8 * 1200);
    EXPECT_EQ(flo.substr(0, 4), "PIEH");  // 202021.25
    EXPECT_EQ(bytes_as<std::int32_t>(flo, 4), 40);
    EXPECT_EQ(bytes_as<std::int32_t>(flo, 8), 30);
    const std::vector<int> occluded = numbers_of(folder_ / "set/flow_occluded/000004.png", 8);
    for (std::size_t i = 0; i < 1200; ++i) {
        EXPECT_EQ(bytes_as<float>(flo, 12 + 8 * i), exr.channels.at("flow.X")[i]);
        EXPECT_EQ(bytes_as<float>(flo, 16 + 8 * i), exr.channels.at("flow.Y")[i]);
        EXPECT_EQ(occluded[i], exr.channels.at("flow_occluded.V")[i] == 0 ? 0 : 255);
    }
}

TEST_F(DatasetImages, FlowIsUnknownWhereNothingIsSeen) {
    make(
        "moving.yaml", "exr,flow,kitti",
        {"--frames", "0-1", "--set", "geometry=[{type: box, min: [0, 0, 2], max: [0.5, 0.5, 3]}]"});
    const test::ImageFile exr = truth("000000");
    const std::string flo = read("set/flow/000000.flo");
    const std::vector<int> kitti =
        numbers_of(folder_ / "set/kitti/training/flow_occ/000000_10.png", 16);
    int unknown = 0;
    for (std::size_t i = 0; i < 1200; ++i) {
        const bool is_known = std::isfinite(exr.channels.at("flow.X")[i]);
        EXPECT_EQ(std::abs(bytes_as<float>(flo, 12 + 8 * i)) < 1e9F, is_known);
        EXPECT_EQ(kitti[3 * i + 2], is_known ? 1 : 0);
        unknown += is_known ? 0 : 1;
    }
    EXPECT_GT(unknown, 0);
    EXPECT_LT(unknown, 1200);
}

// The geometry of a wall at 4 m: fx * 0.1 m / 4 m, and the principal points one pixel apart.
TEST_F(DatasetImages, DisparityIsMiddleburysAndKittis) {
    make("pair.yaml", "png,exr,disparity,kitti");
    const test::ImageFile exr = truth("left/000000");
    const std::string pfm = read("set/disparity/left/000000.pfm");
    const std::string header = "Pf\n40 30\n-1.0\n";
    ASSERT_TRUE(pfm.starts_with(header));
    ASSERT_EQ(pfm.size(), header.size() + 4 * 1200);
    const std::vector<int> occ =
        numbers_of(folder_ / "set/kitti/training/disp_occ_0/000000_10.png", 16);
    const std::vector<int> noc =
        numbers_of(folder_ / "set/kitti/training/disp_noc_0/000000_10.png", 16);
    int hidden = 0;
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
            const float d = exr.at("disparity.X", x, y);
            const auto at = static_cast<std::size_t>((29 - y) * 40 + x);
            EXPECT_EQ(bytes_as<float>(pfm, header.size() + 4 * at), d);
            const double z = exr.at("depth.Z", x, y);
            EXPECT_NEAR(d, 36 * 0.1 / z + 1, 1e-5);
            const auto i = static_cast<std::size_t>(y * 40 + x);
            const long code = std::lround(256.0 * d);
            EXPECT_EQ(occ[i], code < 1 ? 0 : code);
            const bool is_hidden = exr.at("disparity_occluded.V", x, y) != 0;
            EXPECT_EQ(noc[i], is_hidden || code < 1 ? 0 : code);
            hidden += is_hidden && code >= 1 ? 1 : 0;
        }
    EXPECT_GT(hidden, 0);
    EXPECT_TRUE(read("set/kitti/training/image_2/000000_10.png") ==
                read("set/images/left/000000.png"));
    EXPECT_TRUE(read("set/kitti/training/image_3/000000_10.png") ==
                read("set/images/right/000000.png"));
    const std::string calibration = read("set/kitti/training/calib_cam_to_cam/000000.txt");
    // fx 36, its centre one half less, as the first pixel's centre is (0, 0) there; -fx times 0.1
    // m.
    EXPECT_NE(calibration.find("P_rect_02: 3.600000000000e+01 0.000000000000e+00 "
                               "1.850000000000e+01 0.000000000000e+00 "),
              std::string::npos)
        << calibration;
    EXPECT_NE(calibration.find("P_rect_03: 3.600000000000e+01 0.000000000000e+00 "
                               "1.750000000000e+01 -3.600000000000e+00 "),
              std::string::npos)
        << calibration;
}

TEST_F(DatasetImages, KittisFlowAndPairs) {
    make("moving.yaml", "exr,kitti", {"--frames", "0-2,5,6"});
    const std::string training = "set/kitti/training/";
    for (const char* pair : {"000000", "000001", "000005"}) {
        for (const char* file : {"image_2/{}_10.png", "image_2/{}_11.png", "flow_occ/{}_10.png",
                                 "flow_noc/{}_10.png", "calib_cam_to_cam/{}.txt"})
            EXPECT_TRUE(exists(training + fmt::format(fmt::runtime(file), pair))) << pair << file;
    }
    EXPECT_FALSE(exists(training + "image_2/000002_10.png"));
    EXPECT_FALSE(exists(training + "image_2/000004_11.png"));
    EXPECT_TRUE(read(training + "image_2/000000_11.png") ==
                read(training + "image_2/000001_10.png"));
    const test::ImageFile exr = truth("000001");
    const std::vector<int> occ = numbers_of(folder_ / (training + "flow_occ/000001_10.png"), 16);
    const std::vector<int> noc = numbers_of(folder_ / (training + "flow_noc/000001_10.png"), 16);
    int hidden = 0;
    for (std::size_t i = 0; i < 1200; ++i) {
        ASSERT_EQ(occ[3 * i + 2], 1);
        // The development kit's decoding, exact to half a step of 1/64 px.
        EXPECT_NEAR((occ[3 * i] - 32768) / 64.0, exr.channels.at("flow.X")[i], 1 / 128.0);
        EXPECT_NEAR((occ[3 * i + 1] - 32768) / 64.0, exr.channels.at("flow.Y")[i], 1 / 128.0);
        const bool is_hidden = exr.channels.at("flow_occluded.V")[i] != 0;
        EXPECT_EQ(noc[3 * i + 2], is_hidden ? 0 : 1);
        hidden += is_hidden ? 1 : 0;
    }
    EXPECT_GT(hidden, 0);
}

TEST_F(DatasetImages, DisparityOfOtherPairsIsRefused) {
    expect_failure({"dataset", "pair.yaml", "-o", "set", "--format", "disparity", "--set",
                    "cameras[1].pose.look_at=[0.2, 0, 1]"},
                   2, "are no rectified pair");
    EXPECT_FALSE(exists("set"));
}

// A camera with a sensor: what `uwvdb render` stores of it.
TEST_F(DatasetImages, AreTheSensorsWhereThereIsOne) {
    const std::vector<std::string> sensor{
        "--set", "camera.lens={f_number: 2.8, focal_length: 0.006}", "--set",
        "camera.sensor={exposure: 0.00001, mosaic: rggb, "
        "quantum_efficiency: {r: [0.5, 0.1, 0], g: [0.1, 0.5, 0.1], b: [0, 0.1, 0.5]}, full_well: "
        "20000, "
        "bit_depth: 12}"};
    expect_failure({"dataset", "moving.yaml", "-o", "set", "--frames", "3", sensor[0], sensor[1],
                    sensor[2], sensor[3], "--set", "camera.sensor.image={format: jpeg}"},
                   2, "the images of data sets are PNG");
    make("moving.yaml", "png", {"--frames", "3", sensor[0], sensor[1], sensor[2], sensor[3]});
    const auto result = run({"render", "moving.yaml", "--frames", "3", "-o", "r.####.sensor.png",
                             sensor[0], sensor[1], sensor[2], sensor[3], "--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(numbers_of(folder_ / "set/images/000003.png", 16),
              numbers_of(folder_ / "r.0003.sensor.png", 16));
}

}  // namespace
}  // namespace uw
