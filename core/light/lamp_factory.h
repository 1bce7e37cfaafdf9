#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/base/vector_math.h"
#include "core/light/emission.h"
#include "core/light/lamp.h"
#include "core/light/lamps_in_view.h"
#include "core/light/sky.h"
#include "core/scene/lamp_desc.h"

namespace uw {

/// Builds the lamp that `desc` describes for these bands: reads the files of its profile and its
/// spectrum, and converts lumens and candelas into watts. `world_from_camera` places lamps fixed to
/// the camera. Adds a one-line warning for an IES file whose candelas are inconsistent with its
/// lumens. Throws InputError, also for a spectrum if there is a single band, whose width is
/// undefined, and for a spectrum without light in any band; IoError for a file that cannot be read.
Lamp make_lamp(const LampDesc& desc, const Affine& world_from_camera,
               std::span<const double> bands_nm, std::vector<std::string>& warnings);

/// Appends the points that `lamp`, made of `desc`, consists of: itself, or, if it has an extent,
/// points that fill that evenly and share its light equally, or of a sun with an angle directions
/// that fill its disc evenly. They are the same ones in every render: shadows become as many steps.
/// `index`: of the lamp in the scene. `thinning`: of the extent's samples only every so many-th is
/// made, at least one. `world_from_camera` places lamps fixed to the camera.
///
/// The points are a golden-ratio lattice, on a disk with area in the place of its first coordinate
/// (Vogel's spiral), in a sphere with the distance from the centre as a third coordinate
/// (LampFrame), moved so that their mean is the centre. With N of them, what varies smoothly over
/// the lamp is off by about 1/N^2, and the light in a penumbra by about 0.7/N of the lamp's
/// (RMS), 2.4/N at worst, for N = 32.
void append_emitters(const LampDesc& desc, const Lamp& lamp, std::size_t index, int thinning,
                     const Affine& world_from_camera, std::vector<Lamp>& emitters);

/// The light of a volume as a lamp at the middle of it, with all of its intensity.
Lamp make_lamp(const LampDesc& desc, std::span<const EmissivePart> parts);

/// Appends a point for each of the `parts` of `lamp`, the light of a volume.
void append_emitters(const Lamp& lamp, std::size_t index, std::span<const EmissivePart> parts,
                     std::vector<Lamp>& emitters);

/// Appends the luminous surface of `lamp`, made of `desc`, if it has an extent. The other arguments
/// are those of append_emitters.
void append_surface(const LampDesc& desc, const Lamp& lamp, std::size_t index, int thinning,
                    const Affine& world_from_camera, std::vector<LampSurface>& surfaces);

/// The light of the sky, `desc.sky`, as the scene's lamp `index`: parallel light from each of the
/// directions that stand for it, refracted by the water's surface.
Lamp make_lamp(const LampDesc& desc, const Sky& sky);
void append_emitters(const LampDesc& desc, const Lamp& lamp, std::size_t index, int thinning,
                     const Sky& sky, std::vector<Lamp>& emitters);

/// Appends the mirror image of each emitter from `first` on that stands below the surface, in
/// their order.
void append_mirror_images(const WaterSurface& surface, std::size_t first,
                          std::vector<Lamp>& emitters);

}  // namespace uw
