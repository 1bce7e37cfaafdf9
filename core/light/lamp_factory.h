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

/// Appends the emitters of which `lamp`, made from `desc`, consists: the lamp itself; or, if it has
/// an extent, points that fill it evenly, each with the same fraction of its light; or, for a sun
/// with an angle, directions that fill its disc evenly. They are the same in every render. `index`:
/// of the lamp in the scene. `thinning`: the extent's number of samples is divided by this, but is
/// at least one. `world_from_camera` places lamps fixed to the camera.
///
/// The points are a golden-ratio lattice, shifted so that their mean is the centre. On a disk the
/// first coordinate is the area within the radius (Vogel's spiral); in a sphere the third one is
/// the light within the radius (LampFrame). With N points, an integral over the lamp of what varies
/// smoothly has an error of about 1/N^2, and the light in a penumbra one of about 0.7/N of the
/// lamp's light (RMS), 2.4/N at worst, for N = 32.
void append_emitters(const LampDesc& desc, const Lamp& lamp, std::size_t index, int thinning,
                     const Affine& world_from_camera, std::vector<Lamp>& emitters);

/// Builds a lamp at the centre of a volume's light, with all of its intensity.
Lamp make_lamp(const LampDesc& desc, std::span<const EmissivePart> parts);

/// Appends a point for each of the `parts` of `lamp`, an emissive volume.
void append_emitters(const Lamp& lamp, std::size_t index, std::span<const EmissivePart> parts,
                     std::vector<Lamp>& emitters);

/// Appends the luminous surface of `lamp`, made of `desc`, if it has an extent. The other arguments
/// are those of append_emitters.
void append_surface(const LampDesc& desc, const Lamp& lamp, std::size_t index, int thinning,
                    const Affine& world_from_camera, std::vector<LampSurface>& surfaces);

/// Build the light of the sky, `desc.sky`, as the scene's lamp `index`: parallel light from each of
/// the directions that represent it, refracted by the water's surface.
Lamp make_lamp(const LampDesc& desc, const Sky& sky);
void append_emitters(const LampDesc& desc, const Lamp& lamp, std::size_t index, int thinning,
                     const Sky& sky, std::vector<Lamp>& emitters);

/// Appends the mirror image of each emitter from `first` on that lies below the surface, in their
/// order.
void append_mirror_images(const WaterSurface& surface, std::size_t first,
                          std::vector<Lamp>& emitters);

}  // namespace uw
