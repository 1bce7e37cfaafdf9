#include "cli/dataset/missing_views.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>

#include "cli/dataset/set_definition.h"
#include "core/base/parallel.h"
#include "dataset/set/point_seeds.h"
#include "dataset/set/view_writer.h"
#include "dataset/view_record.h"
#include "render/input_files.h"
#include "render/resolved_scene.h"

namespace uw {

namespace {

namespace fs = std::filesystem;

/// When the inputs of views were written last.
class InputTimes {
  public:
    InputTimes(const DatasetArguments& arguments, const DatasetDefinition& definition)
        : arguments_(arguments), definition_(definition) {}

    fs::file_time_type last_change(const View& view) {
        if (!view_ || view_->draw != view.draw)
            scene_ = scene_of_draw(arguments_, definition_.draws[view.draw]);
        const bool is_known = view_ && view_->draw == view.draw && view_->frame == view.frame;
        view_ = view;
        if (is_known) return last_;
        last_ = fs::file_time_type::min();
        const SceneDesc image = scene_of_image(scene_, choice_of(definition_, scene_, view));
        for (const InputFile& input : input_files(image, known_)) {
            std::error_code error;
            const auto written = fs::last_write_time(input.file, error);
            if (!error && !input.is_hashed) last_ = std::max(last_, written);
        }
        return last_;
    }

  private:
    const DatasetArguments& arguments_;
    const DatasetDefinition& definition_;
    SceneDesc scene_;
    std::optional<View> view_;  // the last asked for
    fs::file_time_type last_;
    MeshSideFiles known_;
};

}  // namespace

std::vector<std::size_t> missing_views(const DatasetArguments& arguments,
                                       const DatasetDefinition& definition, ViewRange range) {
    const fs::path& folder = arguments.image.output;
    const std::string sum = sum_of(definition);
    std::vector<char> is_there(range.end - range.begin);
    parallel_for(is_there.size(), [&](std::size_t i) {
        const View view = definition.view(range.begin + i);
        is_there[i] = is_view_complete(folder, definition, sum, view) ? 1 : 0;
    });
    InputTimes inputs(arguments, definition);
    std::vector<std::size_t> missing;
    for (std::size_t i = 0; i < is_there.size(); ++i) {
        const View view = definition.view(range.begin + i);
        std::error_code error;
        if (is_there[i] == 0 || fs::last_write_time(folder / record_file(definition, view), error) <
                                    inputs.last_change(view))
            missing.push_back(range.begin + i);
    }
    return missing;
}

}  // namespace uw
