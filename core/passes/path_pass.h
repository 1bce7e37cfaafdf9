#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "core/passes/pass.h"
#include "core/passes/pixel_renderer.h"
#include "core/paths/path_segment.h"

namespace uw {

/// Light paths of each pixel: a round of an image, which may have several.
struct PathRound {
    /// Paths are traced in as many batches, whose means are independent; their spread tells the
    /// standard error.
    static constexpr int k_batches = 16;

    int number = 0;   // of the round, from 0: each has random numbers of its own
    int samples = 1;  // paths per pixel, >= 1

    int batches() const { return samples < k_batches ? samples : k_batches; }
};

/// What a few light paths bring all over an image: sums over places, of means over the bands.
struct PathTrial {
    struct OfKind {
        double mean = 0, variance = 0;  // of the radiance that a path brings [W m^-2 sr^-1]
        double work = 0;                // of a path (PathTracer)
    };
    double once = 0;                // emitted, or reflected or scattered no more than once
    std::array<OfKind, 3> kinds{};  // of all other light, as PathCounts has them
};

/// Pixels whose light is the mean over random paths from the camera (PathTracer): no bias, and a
/// standard error.
class PathPixels {
  public:
    /// Receives the number of paths traced since it was last called.
    using TracedCallback = std::function<void(int paths)>;

    /// `pixels` renders everything that is not a mean over paths, and its light transport has
    /// paths; it must outlive this object. `order_count`: of PixelResult::orders and reflections.
    PathPixels(const PixelRenderer& pixels, std::size_t order_count)
        : pixels_(pixels), order_count_(order_count) {}

    /// Tries `paths` of each kind at a few places all over the image.
    PathTrial try_out(int paths) const;
    /// The same at the image position (x, y) alone; another `place` has other random numbers.
    PathTrial try_out(double x, double y, std::uint64_t place, int paths) const;
    /// By such a trial, shares out the time of the paths that follow among the kinds as leaves the
    /// least error. `samples`: paths per pixel, about.
    void share_out(int samples);

    /// Renders pixel (x, y). The same for any number of threads, and for any part of the image. In
    /// rounds after the first, only what is a mean over paths. Thread safe. Throws Interrupted.
    /// `follower`: is told of every turn and term as well, of lamps in view and of what surfaces
    /// reflect of them, too; null: nobody is.
    void render(int x, int y, const PathRound& round, const TracedCallback& traced,
                PixelResult& result, ContributionSink* follower = nullptr) const;

  private:
    class Sum;
    struct Batch;

    void begin(const SurfaceSample* surface, const Ray& ray, const SurfaceLight& light,
               std::size_t in_light, CameraSegment& segment, Sum& sum) const;
    void render_the_rest(int x, int y, const PathRound& round, PixelView& view,
                         PixelResult& result) const;
    void trace(int x, int y, const Batch& batch, PixelView& view, Sum& sum,
               const TracedCallback& traced) const;
    void add_lamps_in_view(const Ray& ray, double reach, Sum& sum) const;
    void trace_path(const SurfaceSample* surface, const Ray& ray, const SurfaceLight& light,
                    std::size_t in_light, const Batch& batch, int index, Sum& sum) const;

    const PixelRenderer& pixels_;
    std::size_t order_count_;
    PathCounts times_;
};

/// What is requested of the light paths of an image.
struct PathRequest {
    /// How many paths the fast form of all light takes (MultipleScatteringPass), as a multiple of
    /// those that the image's quality does.
    double share = 1;
    // Of images that are rendered by light paths (IntegratorKind::traces_paths):
    /// The greatest PathAccuracy::error, instead of the scene's samples. No more than k_max_paths
    /// are traced for it.
    std::optional<double> error{};
    int orders = 0;  // LayerSupply::orders

    friend bool operator==(const PathRequest&, const PathRequest&) = default;
};

/// When an image of light paths is done.
struct PathGoal {
    int samples = 16;               // paths per pixel, in the mean
    std::optional<double> error{};  // instead: PathRequest::error
};

/// The mean number of paths per pixel to trace next for an image that has reached `so_far`; 0: it
/// is done. For an error that must not be exceeded, the number follows from the error so far, and
/// is at most twice that of the paths so far.
int samples_of_next_round(const PathGoal& goal, const PathAccuracy& so_far);

/// Renders every pixel of the film's window by light paths, round after round, on all permitted
/// threads. The result does not depend on their number, and pixels do not depend on the window
/// unless it is an error that is to be reached: then pixels with more noise around them get more of
/// the paths. After each round, while no pixel is being rendered,
/// it sets ImageProgress::paths.
class PathPass final : public Pass {
  public:
    PathPass(const RenderDesc& render, const PathRequest& request);

    PassNeeds needs(const LayerPlan& plan) const override;
    void provide(LayerSupply& supply) const override;
    void run(Rendering& rendering) override;

  private:
    PathRequest request_;
    bool has_error_;  // which takes two samples
    bool needs_slabs_;
};

}  // namespace uw
