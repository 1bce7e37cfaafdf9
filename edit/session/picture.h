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

/// The steps in which a picture is refined: `small` has some 160 x 90 pixels, `draft` lies within
/// 480 x 270, `full_draft` and `final` have the scene's size, at most 2.3 million pixels. A newer
/// change ends them within 30 ms, except the small one; a change of brightness or name, or of which
/// lamps are on, renders nothing. With all light there is no draft. The first exists only for a
/// scene that is rendered with all light, before any other picture of it: single scattering, which
/// takes a tenth of the time.
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

/// The planes of a picture as bytes for the page: 4 bytes, the length of the header, little endian;
/// the header, JSON, padded with blanks such that the planes begin at a multiple of 16 bytes; the
/// planes in the header's order, each height x width x channels values, little endian, to be
/// multiplied by its `factor`:
///
///     {"key": 7,                          // grows; the same key, the same pixels
///      "revision": 12, "width": 480, "height": 270,
///      "scale": 2.0,                      // full width / this width
///      "quality": "draft", "bands": 3, "lamps": ["left", "far"],
///      "lamp_brightness": [[40, 40, 40], ...],   // with which they were rendered
///      "planes": [{"lamp": "left", "layer": "direct", "channels": 3, "factor": 1}, ...],
///      "type": "f16"}                     // or "f32"
///
/// Three channels are linear R G B; one is a value. Each lamp has `direct`, `backscatter`, `clean`,
/// `irradiance` and, where the scene has them, `forward` and `multiple`; with "lamp": null come the
/// same for surfaces that shine by themselves, and `depth` [m]. The planes of a lamp are to be
/// multiplied, channel by channel, by the `rgb_scale` of the state over its `lamp_brightness`, and
/// by 0 if it is off. The total is the sum of `direct`, `forward`, `backscatter` and `multiple`.
std::string picture_bytes(const Picture& picture, SampleType type);

/// Whether a picture of one scene is valid for the other: they differ at most in names and
/// brightness.
bool is_same_picture(const EditedScene& a, const EditedScene& b);

/// The layers of a picture with its lamps as bright as they are in `now`, off where they are off.
/// Refers to the picture. Precondition: is_same_picture(*picture.scene, now).
PictureLayers mixed_layers(const Picture& picture, const EditedScene& now);

}  // namespace uw
