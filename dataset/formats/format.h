#pragma once

#include <string_view>

#include "core/scene/scene_desc.h"
#include "dataset/complete_sequence.h"
#include "dataset/definition.h"
#include "dataset/set_files.h"
#include "dataset/view_images.h"

namespace uw {

/// A format of data sets: what is rendered for it, and which files it has.
struct DatasetFormat {
    std::string_view name;     // as --format takes it
    std::string_view summary;  // one line, for --help
    /// Its paragraph in a set's data card, in Markdown: folders, units, conventions.
    std::string_view card;
    /// The layers that it is made of, as LayerPlan takes them; empty: the image alone.
    std::string_view layers = {};
    bool needs_points = false;  // ViewImages::points
    bool needs_images = false;  // those of png, which is then written as well
    /// Throws UsageError of one line for a set that it cannot express. `scene`: of the first view,
    /// with its rig. May be null.
    void (*check)(const DatasetDefinition& definition, const SceneDesc& scene) = nullptr;
    /// Writes the files of one view; called from several threads for different views. May be null.
    void (*write_view)(const ViewImages& images, SetFiles& files) = nullptr;
    /// Writes what needs all views of a draw. May be null.
    void (*complete)(const CompleteSequence& sequence, SetFiles& files) = nullptr;
};

}  // namespace uw
