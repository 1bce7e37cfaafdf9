#pragma once

#include "core/json/json.h"
#include "edit/session/picture.h"
#include "render/measures/picture_numbers.h"
#include "render/measures/target_probe.h"

namespace uw {

/// Whether a picture of one scene serves the other: they differ in names and brightness at most.
bool is_same_picture(const EditedScene& a, const EditedScene& b);

/// The layers of a picture with its lamps as bright as they are in `now`, off where they are off.
/// Refers to the picture. Precondition: is_same_picture(*picture.scene, now).
PictureLayers mixed_layers(const Picture& picture, const EditedScene& now);

/// {"signal", "backscatter", ...}, docs/edit-api.md.
Json numbers_json(const PictureNumbers& numbers);
Json target_numbers_json(const TargetNumbers& numbers);

}  // namespace uw
