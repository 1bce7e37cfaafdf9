#pragma once

#include "cli/info/draft_contrast.h"
#include "cli/info/scene_proposal.h"
#include "core/scene/volume_desc.h"

namespace uw {

/// A proposed scene and how well it shows its volume.
struct PlumeView {
    SceneProposal proposal;
    double factor = 1;  // by which the volume's concentrations are to be multiplied
    DraftContrast draft;
};

/// Proposes a scene around `bounds`, which hold what `volume` holds, and searches by drafts for
/// concentrations, and only then for clearer water, that make the volume plain to see without being
/// opaque. `volume` names a file, not a sequence. Throws InputError if it cannot be loaded.
PlumeView view_plume(const VolumeDesc& volume, const Bounds& bounds);

}  // namespace uw
