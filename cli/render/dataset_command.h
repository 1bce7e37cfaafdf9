#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/render/dataset_arguments.h"
#include "cli/render/image_output.h"
#include "dataset/definition.h"
#include "dataset/view.h"
#include "render/renderer.h"
#include "run/background_task.h"

namespace uw {

/// The views of `range` that are to be rendered, by their indices: those that are not there whole,
/// and those that an input file has changed since. Inputs that are part of the scene's hash are
/// part of the definition. Throws as load_scene.
std::vector<std::size_t> missing_views(const DatasetArguments& arguments,
                                       const DatasetDefinition& definition, ViewRange range);

/// Renders and writes views of a data set one after the other, each written while the next is
/// rendered, and reports progress to the user.
class ViewRenderer {
  public:
    /// `count`: of the views to come. `arguments` outlive the renderer.
    ViewRenderer(const DatasetArguments& arguments, std::size_t count);
    ~ViewRenderer();
    ViewRenderer(const ViewRenderer&) = delete;
    ViewRenderer& operator=(const ViewRenderer&) = delete;
    ViewRenderer(ViewRenderer&&) = delete;
    ViewRenderer& operator=(ViewRenderer&&) = delete;

    /// The exposures that bring the brightest of a few views of the first draw to a good
    /// brightness, by small drafts of them. `scene`: of that draw.
    Exposures exposures_of(const DatasetDefinition& definition, const SceneDesc& scene);

    /// Renders a view in `scene`, that of its draw, and has it written. Throws InputError; IoError,
    /// of this view or the one before; Interrupted, and then nothing of this view is written.
    void render(const DatasetFile& set, const View& view, const SceneDesc& scene);

    /// Waits until the last view rendered has been written. Throws as its writing does.
    void finish();

    /// How many views have been written.
    std::size_t done() const { return done_; }

  private:
    bool proceed(const std::string& stage, double fraction);
    void warn(const std::vector<std::string>& warnings);
    /// Reads a draw's surface points, or finds and writes them.
    void load_points(const DatasetFile& set, std::size_t draw, const SceneDesc& scene);

    const DatasetArguments& arguments_;
    std::size_t count_, rendered_ = 0;
    Progress progress_;
    Renderer renderer_;
    std::set<std::string> warned_;
    std::shared_ptr<const std::vector<SurfacePoint>> points_;  // null: none are needed
    std::size_t draw_of_points_ = 0;
    std::size_t done_ = 0;
    std::unique_ptr<BackgroundTask> writing_;
};

/// `uwvdb dataset`: throws as load_scene, Renderer and complete_dataset do; UsageError for a folder
/// that holds something else; Interrupted.
void run_dataset(const DatasetArguments& arguments);

Command dataset_command();

}  // namespace uw
