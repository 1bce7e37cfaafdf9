#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/image/film.h"
#include "core/image/layers.h"
#include "edit/session/edited_scene.h"
#include "render/measures/picture_numbers.h"

namespace uw {

/// The steps in which a picture is refined. The first exists only for a scene that is rendered with
/// all light, before any other picture of it: single scattering, which takes a tenth of the time.
enum class PictureQuality { first, small, draft, full_draft, final };
inline constexpr std::size_t k_picture_qualities = 5;

/// "first", "small", "draft", "full-draft", "final".
std::string_view name_of(PictureQuality quality);

/// The size of a step's picture [pixels] of a scene of `width` x `height`.
std::pair<int, int> picture_size(PictureQuality quality, int width, int height);

/// The contribution of one lamp, or of light that comes from no lamp, to a picture.
struct LightLayers {
    std::string key;  // EditedLamp::key
    Film film;
    LayerPlan plan;
    Spectrum brightness;  // with which it was rendered, EditedLamp::brightness
};

/// A picture of a scene, taken apart by lamps.
struct Picture {
    std::int64_t number = 0;  // in the order made: its identity
    PictureQuality quality = PictureQuality::small;
    int width = 0, height = 0;
    std::shared_ptr<const EditedScene> scene;               // the one that it was made for
    std::vector<std::shared_ptr<const LightLayers>> lamps;  // in the order of the scene's
    std::shared_ptr<const LightLayers> unlit;               // emission, depth and albedo
};

/// How values are sent: as IEEE 754 halves, times a power of two for each plane, or singles.
enum class SampleType { f16, f32 };

/// The planes of a picture as bytes for the page, docs/edit-api.md.
std::string picture_bytes(const Picture& picture, SampleType type);

/// Whether a picture of one scene is valid for the other: they differ at most in names and
/// brightness.
bool is_same_picture(const EditedScene& a, const EditedScene& b);

/// The layers of a picture with its lamps as bright as they are in `now`, off where they are off.
/// Refers to the picture. Precondition: is_same_picture(*picture.scene, now).
PictureLayers mixed_layers(const Picture& picture, const EditedScene& now);

}  // namespace uw
