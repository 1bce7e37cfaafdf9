#pragma once

#include <vector>

#include "core/image/film.h"
#include "render/scene_assembly.h"

namespace uw {

/// How clearly the volumes of a scene are seen, from two pictures of it. Light is that of the
/// picture's R, G and B as luminance, so water and backscatter before the volumes count.
struct DraftContrast {
    /// Of a pixel: |with - without| / max(without, mean of the picture without). Here the 99th
    /// percentile of the pixels that see the volumes.
    double contrast = 0;
    /// Fraction of the image whose rays pass through the volumes before any surface.
    double seen = 0;
    /// Median luminance of these pixels, relative to the 99th percentile of the whole picture,
    /// which previews show as 0.8.
    double brightness = 0;
    /// 90th percentile of the optical depth of the volumes along these rays, in the middle band.
    double depth = 0;
};

/// Compares a picture of `scene` with one of the same scene without its volumes: same camera, same
/// size.
DraftContrast compare_drafts(const AssembledScene& scene, const Film& with, const Film& without);

/// Makes `desc` that of a small, quickly rendered picture of the same view: light scattered once,
/// draft quality, at most `width` pixels wide.
void make_draft(SceneDesc& desc, int width);

/// The width of drafts, and of those of volumes too small to be seen in these.
inline constexpr int k_draft_width = 128, k_fine_draft_width = 512;
/// Of the image: volumes that cover less need the finer draft.
inline constexpr double k_least_seen = 0.002;

/// A plume that changes the picture by less than this will hardly be noticed; at the second it is
/// plain to see.
inline constexpr double k_hardly_seen = 0.05, k_plain_to_see = 0.3;

}  // namespace uw
