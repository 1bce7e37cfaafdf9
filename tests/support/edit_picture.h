#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "edit/session/picture_renderer.h"
#include "tests/support/edit_scene.h"

namespace uw::test {

/// A picture's bytes, read as edit/session/picture.h says.
struct ReadPicture {
    Json header;
    std::vector<std::vector<float>> planes;
};

inline float float_of_half(std::uint16_t half) {
    const int exponent = (half >> 10) & 31, mantissa = half & 1023;
    const float magnitude = exponent == 0
                                ? std::ldexp(static_cast<float>(mantissa), -24)
                                : std::ldexp(static_cast<float>(1024 + mantissa), exponent - 25);
    return (half & 0x8000) != 0 ? -magnitude : magnitude;
}

inline ReadPicture read_picture(const std::string& bytes) {
    ReadPicture picture;
    std::uint32_t length = 0;
    for (std::size_t i = 0; i < 4; ++i)
        length |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
    picture.header = Json::parse(bytes.substr(4, length));
    std::size_t at = 4 + length;
    EXPECT_EQ(at % 16, 0U);
    const std::size_t pixels =
        picture.header["width"].get<std::size_t>() * picture.header["height"].get<std::size_t>();
    const bool is_half = picture.header["type"] == "f16";
    for (const Json& plane : picture.header["planes"]) {
        std::vector<float>& values = picture.planes.emplace_back();
        for (std::size_t i = 0; i < pixels * plane["channels"].get<std::size_t>(); ++i) {
            if (is_half) {
                std::uint16_t half = 0;
                std::memcpy(&half, bytes.data() + at, 2);
                values.push_back(float_of_half(half) * plane["factor"].get<float>());
                at += 2;
            } else {
                values.emplace_back();
                std::memcpy(&values.back(), bytes.data() + at, 4);
                at += 4;
            }
        }
    }
    EXPECT_EQ(at, bytes.size());
    return picture;
}

/// For a PictureRenderer whose pictures are all that a test asks of it.
inline PictureCallbacks quiet_callbacks() {
    return {[](const Picture&) {},
            {},
            [](const std::string& message) { ADD_FAILURE() << message; },
            [](const Renderer&) {},
            [](const EditedScene&, const std::string&) {}};
}

/// The picture of a scene once it does not get any better.
inline std::shared_ptr<const Picture> final_picture(
    PictureRenderer& renderer, const std::shared_ptr<const EditedScene>& scene) {
    renderer.show(scene);
    const bool is_done = eventually([&] {
        const auto picture = renderer.picture();
        return picture && picture->scene == scene && picture->quality == PictureQuality::final;
    });
    EXPECT_TRUE(is_done);
    return renderer.picture();
}

}  // namespace uw::test
