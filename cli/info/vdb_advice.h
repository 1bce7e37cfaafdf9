#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/info/plume_view.h"
#include "core/base/ray.h"
#include "media/inspection/vdb_inspect.h"

namespace uw {

/// How to use a file's grids, in words and as part of a scene.
struct VdbAdvice {
    std::vector<std::string> lines;  // one sentence or two each
    std::vector<std::string>
        map;  // the grids to map, as scenes address them; empty: none is suitable
    LevelSets level_sets = LevelSets::refused;  // fog where these are level sets
    std::optional<double> voxel_size;  // to give, where the file's is known to be wrong [m]
    double scale = 1;                  // to apply, 1 where the file's size is plausible
    Vector3 mirror{1};  // to apply with it: -1 along the axis in which Blender mirrors the domain
    Vector3 rotate{0};  // to apply: 0, or what the domain was turned by in Blender [degrees]
    /// To apply: 0, or the position of the domain in Blender, or the translation that brings a
    /// distant volume to the origin, or one without a size onto y = 0 [m].
    Vector3 translate{0};
    std::optional<double> fps;            // frames a second of a sequence, where its files tell
    double small_ppm = 0, large_ppm = 0;  // per unit of grid value
    std::vector<double> bands_nm;
    /// How opaque the mapped grids alone are with these concentrations, per band: through their
    /// densest part, along the world axis with the median value of this.
    std::vector<double> optical_depth;
    /// YAML, ready to paste into a scene; empty where nothing can be mapped.
    std::string volumes;
    Bounds bounds;  // of the mapped grids in the world, as placed by the block [m]
    /// Camera, lamps, floor and water that show the volume, and how clearly.
    PlumeView view;
    std::string scene;  // YAML, a whole scene of these and the volume; empty as `volumes` is
};

/// How likely a grid of this name holds a concentration: 0 certainly not, 1 something else from
/// which a concentration can be guessed (heat, flames), 2 unknown, 3 likely, 4 a density.
int concentration_likelihood(const std::string& name);

/// One frame of a sequence, with what is in it.
struct SampledFrame {
    int frame = 0;
    VdbInspection inspection;
};

/// The contents of the frames of a sequence.
struct FrameSurvey {
    std::vector<int> empty;             // frames without anything to map, by their headers
    std::vector<SampledFrame> sampled;  // some of the others, spread evenly from first to last
    std::vector<std::string> faults;    // of frames that cannot be read, one line each
};

/// Reads the headers of all `frames` that exist of the sequence, and all of a few of them. `up`: as
/// for inspect_vdb.
FrameSurvey survey_frames(const std::filesystem::path& pattern, const std::vector<int>& frames,
                          UpAxis up = UpAxis::automatic);

/// The largest value of the grid likeliest to be a concentration, per sampled frame; 1, that of the
/// fog, for a level set.
std::vector<double> max_values(const FrameSurvey& survey);

/// Chooses `small_ppm` and `large_ppm` of the grids in `advice.map`, at `advice.scale`, such that
/// the optical depth is 1.5 at 540 nm, with small and large particles each contributing about half
/// of it. Fills in `optical_depth` and `bounds`. Throws InputError if the grids cannot be loaded.
void start_concentrations(const VdbInspection& inspection, VdbAdvice& advice);

/// Starts with these and searches by drafts for concentrations that make the plume clearly visible;
/// decides `advice.view`, extends `bounds` by those of `others`, which are in the file's size and
/// place, and adds a line about it.
void choose_concentrations(const VdbInspection& inspection, const Bounds& others, VdbAdvice& advice,
                           const InfoProgress& progress = ignore_progress);

/// Advice on one file; reads the grids to map once more and renders drafts of them. `file`: its
/// name to write into the scene.
VdbAdvice advise_on_vdb(const VdbInspection& inspection, const std::filesystem::path& file,
                        const InfoProgress& progress = ignore_progress);

/// Advice on a whole sequence from the frames that were sampled, the same whichever of them is
/// inspected: its bounds and camera enclose all of them, its concentrations suit the fullest frame.
/// `pattern`: the name to write into the scene.
VdbAdvice advise_on_sequence(const FrameSurvey& frames, const std::filesystem::path& pattern,
                             const InfoProgress& progress = ignore_progress);

}  // namespace uw
