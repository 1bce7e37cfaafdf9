#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "camera/camera.h"
#include "core/base/input_files.h"
#include "core/scene/yaml_document.h"
#include "edit/session/picture.h"
#include "render/renderer.h"
#include "tests/support/edit_picture.h"

namespace uw::test {

/// What `uwvdb render` and the lamp editor show of one scene, as values R G B of each pixel.
struct TwoPictures {
    std::vector<double> rendered, edited;
    double stated_error = 0;  ///< of `rendered`: RMS of its pixels' standard errors; 0: it has none

    double mean() const {
        double sum = 0;
        for (const double value : rendered) sum += value;
        return sum / static_cast<double>(rendered.size());
    }
    double mean_difference() const {
        double sum = 0;
        for (std::size_t i = 0; i < rendered.size(); ++i) sum += edited[i] - rendered[i];
        return sum / static_cast<double>(rendered.size());
    }
    double rms_difference() const {
        double sum = 0;
        for (std::size_t i = 0; i < rendered.size(); ++i)
            sum += (edited[i] - rendered[i]) * (edited[i] - rendered[i]);
        return std::sqrt(sum / static_cast<double>(rendered.size()));
    }
};

/// The project's scene of this name, `width` x `height` pixels and with this light, in the editor's
/// session.
inline std::shared_ptr<const EditedScene> edited_example(const std::string& name, int width,
                                                         int height,
                                                         RenderDesc::Scattering scattering) {
    const std::filesystem::path file =
        std::filesystem::path(UWVDB_SOURCE_DIR) / "assets/scenes" / name;
    const std::string text = read_text_file(file, name, YamlLimits{}.bytes, "scene");
    auto scene = std::make_shared<EditedScene>(
        *make_edited_scene(text, parse_yaml(text, name), file, {}, 1));
    scene->scene = scene->scene.with([&](SceneDesc& desc) {
        resize_image(desc.camera, width, height);
        desc.render.scattering = scattering;
    });
    scene->camera = std::make_shared<Camera>(scene->scene.desc().camera);
    return scene;
}

/// The total that the page mixes of the bytes of the session's final picture
/// (edit/session/picture.h), and the image that the renderer makes of the whole scene at once.
inline TwoPictures both_pictures_of(const std::string& name, int width, int height,
                                    RenderDesc::Scattering scattering) {
    const std::shared_ptr<const EditedScene> scene =
        edited_example(name, width, height, scattering);
    PictureRenderer renderer(quiet_callbacks());
    const ReadPicture served =
        read_picture(picture_bytes(*final_picture(renderer, scene), SampleType::f32));
    TwoPictures pictures;
    pictures.edited.resize(static_cast<std::size_t>(3 * width * height));
    constexpr std::array<std::string_view, 5> k_total{"direct", "backscatter", "forward",
                                                      "multiple", "snow"};
    for (std::size_t p = 0; p < served.planes.size(); ++p) {
        const Json& plane = served.header["planes"][p];
        if (std::ranges::find(k_total, plane["layer"].get<std::string>()) == k_total.end())
            continue;
        std::array<double, 3> gain{1, 1, 1};
        if (!plane["lamp"].is_null()) {
            const std::size_t lamp = *scene->find_lamp(plane["lamp"].get<std::string>());
            const std::array<double, 3> now = scene->colour_scale(scene->lamps[lamp].brightness);
            for (std::size_t c = 0; c < 3; ++c) {
                const double then = served.header["lamp_brightness"][lamp][c].get<double>();
                gain[c] = then > 0 ? now[c] / then : 0;
            }
        }
        EXPECT_EQ(served.planes[p].size(), pictures.edited.size());
        for (std::size_t i = 0; i < pictures.edited.size(); ++i)
            pictures.edited[i] += gain[i % 3] * static_cast<double>(served.planes[p][i]);
    }

    Renderer whole;
    whole.set_scene(scene->scene);
    const Film& film = whole.render();
    const std::size_t channels = film.channel_names().size();
    EXPECT_EQ(film.channel_names()[0], "R");
    for (std::size_t at = 0; at < film.values().size(); at += channels)
        for (std::size_t c = 0; c < 3; ++c)
            pictures.rendered.push_back(static_cast<double>(film.values()[at + c]));
    const std::vector<double>& of_bands = whole.report().multiple_error_of_bands;
    if (!of_bands.empty()) {
        EXPECT_EQ(of_bands.size(), 3U);
        double squares = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            double mean = 0;
            for (std::size_t i = c; i < pictures.rendered.size(); i += 3)
                mean += 3 * pictures.rendered[i] / static_cast<double>(pictures.rendered.size());
            squares += std::pow(of_bands[c] * mean, 2) / 3;
        }
        pictures.stated_error = std::sqrt(squares);
    }
    return pictures;
}

}  // namespace uw::test
