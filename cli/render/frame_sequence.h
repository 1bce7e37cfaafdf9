#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "cli/render/render_arguments.h"
#include "core/image/film.h"
#include "core/scene/scene_desc.h"
#include "core/scene/sensor_desc.h"
#include "render/run/job.h"
#include "render/scene_loading.h"

namespace uw {

/// The files that one render writes.
struct OutputFiles {
    std::filesystem::path image;            // of light, mostly an EXR; empty: the preview alone
    std::filesystem::path preview;          // PNG beside it, or what is written instead
    std::filesystem::path sensor{};         // the camera's image, PNG or JPEG; empty: none
    std::filesystem::path stats;            // JSON; empty: none
    std::filesystem::path irradiance_vdb;   // empty: none
    std::filesystem::path numbers{};        // CSV about all images; empty: none
    std::filesystem::path deep{};           // deep EXR; empty: none
    std::filesystem::path ids{};            // CSV of names; empty: no layer of numbers
    std::filesystem::path contact_sheet{};  // PNG of all images; empty: none
    std::filesystem::path manifest_csv{}, manifest_json{};  // of all variations; empty: none

    /// The light, or the preview or the camera's image where that is all.
    const std::filesystem::path& main() const {
        return !image.empty() ? image : preview.empty() ? sensor : preview;
    }
    /// What is to be looked at: the preview, or the camera's image where that is all.
    const std::filesystem::path& picture() const { return preview.empty() ? sensor : preview; }
};

/// What the names of cameras' images have before their ending.
inline constexpr std::string_view k_sensor_ending = ".sensor";

/// The camera's image beside others: "out.sensor.png" beside "out.exr".
std::filesystem::path sensor_image_beside(const std::filesystem::path& image,
                                          DevelopmentDesc::Format format);

/// The deep image of another: "out.deep.exr" beside "out.exr".
std::filesystem::path deep_image_beside(const std::filesystem::path& image);

/// Whether a file of this name is written as OpenEXR.
bool is_exr(const std::filesystem::path& file);

/// The files that the arguments request; names keep their placeholders for the frame number, and so
/// does the default name of a sequence's images. Throws UsageError for a name whose ending is not
/// that of its format, and for a format whose writer is not installed.
OutputFiles output_files(const RenderArguments& arguments);

/// Checks before the work, rather than after it, that all files can be written.
class OutputCheck {
  public:
    /// Registers files that are read.
    void take_inputs(const std::vector<InputFile>& inputs);
    /// Removes what killed runs left where they are to be, too. Throws UsageError if two files are
    /// the same, or one has been registered before; IoError if one cannot be created.
    void take_outputs(const OutputFiles& files);

  private:
    std::map<std::filesystem::path, std::string> taken_;
    std::set<std::filesystem::path> tidied_;  // folders
};

/// One image of a run.
struct Frame {
    std::optional<int> number;  // none: the run renders the scene as it is, without --frames
    OutputFiles files;
    std::size_t camera = 0;          // of a rig's, by its index
    std::string camera_name;         // empty: the scene has one camera
    std::optional<int> variation{};  // of the scene; none: the scene itself
    PixelWindow window{};            // the pixels that are written

    JobImage image() const { return {variation.value_or(0), {number, camera}}; }
};

/// The frames as the images of a job: the scene itself has the number 0.
std::vector<JobImage> images_of(const std::vector<Frame>& frames);

/// Where an image belongs, to begin a message with: "variation 17: frame 3: camera left: ". Empty
/// for the only one.
std::string place_in_run(const Frame& frame);

/// The images of a run, in the order they are rendered.
struct FrameSequence {
    std::vector<Frame> frames;
    std::filesystem::path stats;            // one file about all of them; empty: none, or one each
    std::filesystem::path numbers{};        // one file about all of them; empty: none
    std::filesystem::path contact_sheet{};  // likewise
    std::filesystem::path manifest_csv{}, manifest_json{};  // of variations; empty: none
};

/// The frames of `--frames all`. Throws UsageError if nothing in the scene moves.
std::vector<int> all_frames(const SceneDesc& scene);

/// The images that the arguments request. Throws UsageError for several frames with one name, and
/// for a name whose ending is not that of its format.
FrameSequence frames_of(const RenderArguments& arguments);

/// Makes all frames those of one variation of the scene: its number, of four digits, replaces
/// {variation} in the names of files, or goes before their ending as v0017.
void set_variation(FrameSequence& sequence, int variation);

/// Turns every frame into one for each camera of a rig, whose name replaces {camera} in the names
/// of files, or goes before their ending. `only`: this camera alone; empty: all. What is the same
/// for all cameras, the irradiance, is written with the first. Throws UsageError for a camera that
/// does not exist, and for {camera} or {variation} in names without a rig or variations.
void add_cameras(FrameSequence& sequence, const SceneDesc& scene, const std::string& only);

/// Whether a camera of the scene has a sensor.
bool has_sensor(const SceneDesc& scene);

/// Adds the images of the cameras that have a sensor (`camera.sensor`), beside the others or, where
/// that is all there is, under the name requested. Throws UsageError for a camera without sensor
/// where there would be nothing else, and for a name whose ending is not that of its format.
void add_sensor_images(FrameSequence& sequence, const SceneDesc& scene);

/// When `frame`, one of a sequence, was rendered: all its files but the statistics exist. None: not
/// all of them do.
std::optional<std::filesystem::file_time_type> time_rendered(const Frame& frame);

/// A one-line warning if names and frames do not match although they can be rendered: frames that
/// are all alike, or names with a placeholder for the number but no frames.
std::optional<std::string> frame_warning(const RenderArguments& arguments, const SceneDesc& scene);

/// Checks what all frames read and write before the first is rendered: throws as check_inputs and
/// OutputCheck do.
void check_frames(const FrameSequence& sequence, JobScenes& scenes);

}  // namespace uw
