#pragma once

#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "cli/dataset/dataset_arguments.h"
#include "cli/progress.h"
#include "cli/render/background_task.h"
#include "dataset/set/dataset_file.h"
#include "dataset/view_images.h"
#include "render/renderer.h"

namespace uw {

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

}  // namespace uw
