#include "render/run/job.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <system_error>
#include <utility>

#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/text.h"
#include "media/volumes/load_volumes.h"
#include "media/volumes/vdb_header.h"

namespace uw {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t k_max_runs = 50;  // of frames, named in a message

}  // namespace

const SceneDesc& JobScenes::of(int number) {
    if (!scene_ || number != number_) {
        scene_ = read_(number);
        number_ = number;
    }
    return *scene_;
}

ImageScene JobScenes::made(const JobImage& image) {
    SceneDesc scene = of(image.scene);
    scene.warnings.insert(scene.warnings.end(), warnings_.begin(), warnings_.end());
    return {std::move(scene), image.choice};
}

ImageScene JobScenes::take(const JobImage& image) {
    if (!ahead_ || image != ahead_image_) return made(image);
    return *std::exchange(ahead_, std::nullopt);
}

const ImageScene& JobScenes::look_at(const JobImage& image) {
    if (!ahead_ || image != ahead_image_) {
        ahead_ = made(image);
        ahead_image_ = image;
    }
    return *ahead_;
}

fs::file_time_type InputTimes::last_change(const JobImage& image) {
    // The cameras of one moment use the same files.
    if (image_ && image_->scene == image.scene && image_->choice.frame == image.choice.frame)
        return last_;
    const SceneDesc& scene = scenes_.of(image.scene);
    last_ = fs::file_time_type::min();
    image_ = image;
    for (const InputFile& input : input_files(scene, image.choice, known_)) {
        if (input.is_hashed) continue;
        std::error_code error;
        const auto written = fs::last_write_time(input.file, error);
        if (!error) last_ = std::max(last_, written);
    }
    return last_;
}

namespace {

// Lists the frames that lack a file of a sequence in the scene.
class MissingFrames {
  public:
    void look(const SourceLocation& where, const fs::path& name, std::span<const int> frames) {
        std::vector<int> missing;
        std::error_code ignored;
        for (const int frame : frames)
            if (!fs::is_regular_file(file_of_frame(name, frame), ignored)) missing.push_back(frame);
        if (missing.empty()) return;
        text_ += fmt::format("{}{}.file: '{}' has no file for {} {}", text_.empty() ? "" : "; ",
                             where, printable(name.string(), 300),
                             missing.size() == 1 ? "frame" : "frames", format_frame_list(missing));
    }
    void refuse() const {
        if (!text_.empty())
            throw IoError(text_ + "; choose --frames that exist, or add the missing files");
    }

  private:
    std::string text_;
};

// The files of the numbered frames of one scene.
void check_sequences(std::span<const int> frames, const SceneDesc& scene) {
    MissingFrames missing;
    for (const VolumeDesc& volume : scene.volumes) {
        if (volume.is_sequence) missing.look(volume.where, volume.file, frames);
        if (volume.motion && volume.motion->is_sequence && volume.motion->file != volume.file)
            missing.look(volume.motion->where, volume.motion->file, frames);
    }
    for (const GeometryDesc& mesh : scene.geometry)
        if (mesh.is_sequence) missing.look(mesh.where, mesh.file, frames);
    missing.refuse();
}

// The grids of a frame's files, by their headers: a frame that lacks one is found before the first
// is rendered. `checks`: one per volume.
void check_grids(const SceneDesc& scene, int frame, std::vector<VolumeSequenceCheck>& checks) {
    for (std::size_t v = 0; v < checks.size(); ++v) {
        const VolumeDesc& volume = scene.volumes[v];
        if (volume.is_sequence || (volume.motion && volume.motion->is_sequence))
            checks[v].take(volume_of_frame(volume, frame));
    }
    for (const GeometryDesc& mesh : scene.geometry)
        if (mesh.is_sequence && mesh.level_set)
            select_grid(read_vdb_header(file_of_frame(mesh.file, frame), mesh.where),
                        mesh.level_set->grid, mesh.where, LevelSets::fog);
}

}  // namespace

std::vector<InputFile> check_inputs(const Job& job) {
    std::vector<InputFile> inputs;
    SideFiles known;
    for (std::span<const JobImage> left = job.images; !left.empty();) {
        const auto end = std::ranges::find_if(
            left, [&](const JobImage& image) { return image.scene != left.front().scene; });
        const auto of_scene = left.first(static_cast<std::size_t>(end - left.begin()));
        left = left.subspan(of_scene.size());
        const SceneDesc& scene = job.scenes.of(of_scene.front().scene);
        std::vector<int> frames;
        for (const JobImage& image : of_scene)
            if (image.choice.frame && image.choice.camera == of_scene.front().choice.camera)
                frames.push_back(*image.choice.frame);
        check_sequences(frames, scene);
        std::vector<VolumeSequenceCheck> checks(frames.empty() ? 0 : scene.volumes.size());
        for (const JobImage& image : of_scene) {
            if (image.choice.frame && image.choice.camera == of_scene.front().choice.camera)
                check_grids(scene, *image.choice.frame, checks);
            std::ranges::move(input_files(scene, image.choice, known), std::back_inserter(inputs));
        }
    }
    return inputs;
}

std::string format_frame_list(std::vector<int> frames) {
    std::ranges::sort(frames);
    std::string text;
    std::size_t runs = 0;
    for (std::size_t i = 0; i < frames.size(); ++runs) {
        if (runs == k_max_runs) return text + fmt::format(" and {} more", frames.size() - i);
        std::size_t last = i;
        while (last + 1 < frames.size() && frames[last + 1] == frames[last] + 1) ++last;
        text += fmt::format("{}{}", i == 0 ? "" : ",", frames[i]);
        if (last > i) text += fmt::format("-{}", frames[last]);
        i = last + 1;
    }
    return text;
}

std::string ValueAxis::override_at(std::size_t index) const {
    return fmt::format("{}={}", key, values[index]);
}

std::size_t ValueGrid::count() const {
    std::size_t product = 1;
    for (const ValueAxis& axis : axes) product *= axis.values.size();
    return product;
}

std::vector<std::string> ValueGrid::keys() const {
    std::vector<std::string> keys;
    for (const ValueAxis& axis : axes) keys.push_back(axis.key);
    for (const ValueAxis& axis : companions) keys.push_back(axis.key);
    return keys;
}

namespace {

/// Calls `visit(axis, index)` for every axis, then every companion.
void at_place(const ValueGrid& grid, std::size_t place, const auto& visit) {
    const std::size_t first = place % grid.axes.front().values.size();
    for (const ValueAxis& axis : grid.axes) {
        visit(axis, place % axis.values.size());
        place /= axis.values.size();
    }
    for (const ValueAxis& axis : grid.companions) visit(axis, first);
}

}  // namespace

std::vector<double> ValueGrid::values_at(std::size_t place) const {
    std::vector<double> values;
    at_place(*this, place, [&](const ValueAxis& axis, std::size_t index) {
        values.push_back(axis.values[index]);
    });
    return values;
}

std::vector<std::string> ValueGrid::overrides_at(std::size_t place) const {
    std::vector<std::string> overrides;
    at_place(*this, place, [&](const ValueAxis& axis, std::size_t index) {
        overrides.push_back(axis.override_at(index));
    });
    return overrides;
}

}  // namespace uw
