#pragma once

#include <atomic>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "cli/render/frame_sequence.h"
#include "core/base/error.h"
#include "core/base/output_files.h"
#include "core/image/development.h"
#include "core/image/film.h"
#include "core/image/image_file.h"
#include "core/image/pixel_image.h"
#include "core/passes/pass.h"
#include "render/renderer.h"
#include "render/scene_assembly.h"

namespace uw {

/// Work that is done on a thread of its own, from construction on; by the constructor where the
/// system grants no thread. It is stopped as that of the thread that began it. The destructor waits
/// for it.
class BackgroundTask {
  public:
    explicit BackgroundTask(std::function<void()> work) : work_(std::move(work)) {
        try {
            thread_ = std::thread([this, stop = StopScope::of_this_thread()] {
                const StopScope scope(stop);
                run();
            });
        } catch (const std::system_error&) {
            run();
        }
    }
    ~BackgroundTask() {
        if (thread_.joinable()) thread_.join();
    }
    BackgroundTask(const BackgroundTask&) = delete;
    BackgroundTask& operator=(const BackgroundTask&) = delete;
    BackgroundTask(BackgroundTask&&) = delete;
    BackgroundTask& operator=(BackgroundTask&&) = delete;

    /// Whether finish() would not wait.
    bool is_done() const { return is_done_; }
    /// Waits for the work, and throws what it threw. To be called once.
    void finish() {
        if (thread_.joinable()) thread_.join();
        if (error_) std::rethrow_exception(error_);
    }

  private:
    void run() {
        try {
            work_();
        } catch (...) {
            error_ = std::current_exception();
        }
        is_done_ = true;
    }

    std::function<void()> work_;
    std::exception_ptr error_;
    std::atomic<bool> is_done_{false};
    std::thread thread_;  // last: it uses the others
};

/// What a camera stores of an image, and how.
struct SensorImage {
    DigitalImage image;
    DevelopmentDesc desc;
};

/// Writes all of a PNG or JPEG of it. Throws IoError and Interrupted; what cannot be written is for
/// out.commit() to report.
void write_sensor_image(OutputFile& out, const SensorImage& sensor, const ImageMetadata& metadata);

/// Makes the camera's image of a frame, if it is to have one, of what is rendered for it.
class SensorImager {
  public:
    /// `wanted` of the frame otherwise, with a window. Throws as Development.
    SensorImager(const Frame& frame, const SceneDesc& scene, const RenderOptions& wanted);

    /// What to render: `wanted`, and what the camera's image needs.
    const RenderOptions& rendered() const { return rendered_; }

    /// The camera's image of the film rendered, which then becomes the one wanted: `plan` has its
    /// layers.
    std::optional<SensorImage> take(Film& film, const LayerPlan& plan) const;

  private:
    std::optional<Development> development_;
    DevelopmentDesc desc_;
    PixelWindow window_;  // wanted
    RenderOptions rendered_;
};

/// Prints one line.
using SayCallback = std::function<void(const std::string& line)>;

/// How images are written.
struct ImageStorage {
    ExrOptions exr{};
    std::optional<double> exposure{};  // of the preview; none: its automatic one
    bool is_preview_16_bit = false;
};

/// Writes the EXR, if it has a name, likewise its preview, the camera's image if there is one, and
/// the table of its ids if there is to be one: with what is in `outputs` already all of them whole,
/// or none. Prints where they are and the exposure of the preview, and warns of an image that is
/// black or empty in part, or that half floats cannot hold. Throws IoError and Interrupted.
void write_images(const OutputFiles& files, const Film& film,
                  const std::optional<SensorImage>& sensor, const SurfaceNames& names,
                  ImageMetadata metadata, const ImageStorage& storage, OutputGroup& outputs,
                  const SayCallback& say, const SayCallback& warn);

/// Throws InputError if nothing in `scene` determines where to sample its irradiance.
void check_irradiance_vdb(const AssembledScene& scene);

/// Writes the irradiance of each lamp and band on a surface facing the lamp [W m^-2], with shadows
/// and attenuation, as float grids "irradiance.<lamp>.<band>nm" on a lattice over the bounds of the
/// volumes (of all surfaces and lamps if there are no volumes). Voxels are those of the finest
/// grid, or large enough that the longest side has at most 256 and all grids together at most 2^28
/// values. World space, y up as in the scene's world. All of a VDB file, for `out` to be committed.
/// Throws IoError; Interrupted, also if `progress`, called from any thread, returns false.
void write_irradiance_vdb(OutputFile& out, const AssembledScene& scene,
                          const std::vector<std::shared_ptr<const DeepShadow>>& deep_shadows,
                          const ProgressCallback& progress);

}  // namespace uw
