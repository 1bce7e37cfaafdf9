#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/scene/scene_desc.h"
#include "render/image_scene.h"
#include "render/scene_loading.h"

namespace uw {

/// One image of a job.
struct JobImage {
    int scene = 0;       ///< the number of its scene among JobScenes
    ImageChoice choice;  ///< its frame and its camera

    friend bool operator==(const JobImage&, const JobImage&) = default;
};

/// The scenes of a job by their numbers: one scene, its variations, the draws of a data set, or the
/// places of a grid of values. Each is read when its images are due, and kept until another is.
class JobScenes {
  public:
    /// Reads the scene of a number; throws as load_scene does.
    using Reader = std::function<SceneDesc(int number)>;

    explicit JobScenes(Reader read) : read_(std::move(read)) {}

    /// The scene of a number; the reference is valid until another is asked for. Throws as the
    /// reader does.
    const SceneDesc& of(int number);

    /// The scene of an image, ready to be rendered. Throws as ImageScene does.
    ImageScene take(const JobImage& image);

    /// The same ahead of the image's turn: it is kept until it is taken, so that its glTF files
    /// are imported once.
    const ImageScene& look_at(const JobImage& image);

    /// Adds a warning about the whole job to those of each image's scene.
    void warn(std::string line) { warnings_.push_back(std::move(line)); }

  private:
    ImageScene made(const JobImage& image);

    Reader read_;
    std::vector<std::string> warnings_;
    int number_ = 0;
    std::optional<SceneDesc> scene_;  // of that number
    JobImage ahead_image_;
    std::optional<ImageScene> ahead_;
};

/// The images that are rendered, one after the other, and the scenes that they show.
struct Job {
    JobScenes& scenes;
    std::vector<JobImage> images;
};

/// When the files of images' scenes were changed last, to tell which images are to be rendered
/// again. Files that are part of a scene's hash do not count: the hash tells of them.
class InputTimes {
  public:
    explicit InputTimes(JobScenes& scenes) : scenes_(scenes) {}

    /// Throws as input_files does.
    std::filesystem::file_time_type last_change(const JobImage& image);

  private:
    JobScenes& scenes_;
    std::optional<JobImage> image_;  // the last asked for
    std::filesystem::file_time_type last_;
    SideFiles known_;
};

/// Checks before the first image that the files of all sequences are there, and returns every file
/// that the images' scenes are read from. Throws IoError that names all frames whose files are
/// missing; InputError for a frame that does not match the others (VolumeSequenceCheck) or that a
/// trajectory does not have.
std::vector<InputFile> check_inputs(const Job& job);

/// Numbers of frames as --frames takes them, in ascending order: "3-5,9". If there are many runs,
/// the first are listed, followed by the number of remaining frames.
std::string format_frame_list(std::vector<int> frames);

/// A value of a scene that differs from image to image.
struct ValueAxis {
    std::string key;  ///< as `--set` takes it
    std::vector<double> values;

    /// The value at `index` as an override of the scene.
    std::string override_at(std::size_t index) const;
};

/// A grid of values, place by place: the first axis changes fastest.
struct ValueGrid {
    std::vector<ValueAxis> axes;        ///< at least one
    std::vector<ValueAxis> companions;  ///< change along with the first axis, and are as long

    /// The number of places.
    std::size_t count() const;
    /// The keys of the axes, then of the companions.
    std::vector<std::string> keys() const;
    /// The values of these keys at a place, as numbers and as overrides of the scene.
    std::vector<double> values_at(std::size_t place) const;
    std::vector<std::string> overrides_at(std::size_t place) const;
};

}  // namespace uw
