#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "core/passes/pass.h"
#include "core/passes/pixel_renderer.h"
#include "core/paths/path_walk.h"

namespace uw {

/// A round of light paths for every pixel; an image may take several rounds.
struct PathRound {
    /// Paths are traced in up to this many batches. Their means are independent; the standard error
    /// is estimated from the spread of these (batch means).
    static constexpr int k_batches = 16;

    int number = 0;   // index of the round, from 0; each has its own random numbers
    int samples = 1;  // paths per pixel, >= 1

    int batches() const { return samples < k_batches ? samples : k_batches; }
};

/// Statistics of a few trial paths at places all over an image: sums over the places, of means over
/// the bands.
struct PathTrial {
    struct OfKind {
        double mean = 0, variance = 0;  // of a path's estimate of the radiance [W m^-2 sr^-1]
        double work = 0;                // mean work of a path (PathTracer)
    };
    double single = 0;              // emitted light, and that reflected or scattered only once
    std::array<OfKind, 3> kinds{};  // of all other light: the kinds of PathCounts
};

/// Renders pixels by path tracing: the light of a pixel is the mean over random paths from the
/// camera (PathTracer), which is unbiased and has a standard error.
class PathPixels {
  public:
    /// Receives the number of paths traced since it was last called.
    using TracedCallback = std::function<void(int paths)>;

    /// `pixels` renders everything that is not a mean over paths. Its light transport must have
    /// paths, and it must outlive this object. `order_count`: the size of PixelResult::orders and
    /// reflections.
    PathPixels(const PixelRenderer& pixels, std::size_t order_count)
        : pixels_(pixels), order_count_(order_count) {}

    /// Traces `paths` paths of each kind at a few places all over the image.
    PathTrial run_trial(int paths) const;
    /// The same at the image position (x, y) alone. `place` selects the random numbers.
    PathTrial run_trial(double x, double y, std::uint64_t place, int paths) const;
    /// Allocates the work of the following paths among the kinds, by such a trial, so that the
    /// error is least for the time. `samples`: the approximate number of paths per pixel.
    void allocate_paths(int samples);

    /// Renders pixel (x, y). The result depends neither on the number of threads nor on the part of
    /// the image that is rendered. Rounds after the first set only what is a mean over paths.
    /// `observer` receives every path vertex and contribution as well, including the lamps in view
    /// and their direct light on surfaces; null for none. Thread safe. Throws Interrupted.
    void render(int x, int y, const PathRound& round, const TracedCallback& traced,
                PixelResult& result, ContributionSink* observer = nullptr) const;

  private:
    class Sum;
    struct Batch;
    struct Scratch;

    void begin(const SurfaceSample* surface, const Ray& ray, const SurfaceLight& light,
               std::size_t light_index, CameraSegment& segment, Sum& sum) const;
    void render_without_paths(int x, int y, const PathRound& round, PixelView& view,
                              PixelResult& result) const;
    void trace(int x, int y, const Batch& batch, Scratch& scratch, Sum& sum,
               const TracedCallback& traced) const;
    void add_lamps_in_view(const Ray& ray, double max_distance, std::vector<SeenLamp>& lamps,
                           Sum& sum) const;
    void trace_behind_glass(const SurfaceSample& glass, const Batch& batch, int index,
                            Scratch& scratch, Sum& sum) const;
    void trace_path(const SurfaceSample* surface, const Ray& ray, const SurfaceLight& light,
                    std::size_t light_index, const Batch& batch, int index, Scratch& scratch,
                    Sum& sum) const;

    const PixelRenderer& pixels_;
    std::size_t order_count_;
    PathCounts path_counts_;
};

/// Options of the light paths of an image.
struct PathRequest {
    /// The number of paths that MultipleScatteringPass traces, relative to that for the image's
    /// quality.
    double path_factor = 1;
    // The following are for images that are path traced (IntegratorKind::traces_paths).
    /// The target of PathAccuracy::error, which replaces the scene's number of samples. No more
    /// than k_max_paths paths per pixel are traced for it.
    std::optional<double> error{};
    int orders = 0;  // LayerSupply::orders

    friend bool operator==(const PathRequest&, const PathRequest&) = default;
};

/// When a path-traced image is done: after a number of samples, or at a target error.
struct PathGoal {
    int samples = 16;               // paths per pixel, in the mean
    std::optional<double> error{};  // if set, replaces `samples`: PathRequest::error
};

/// Returns the mean number of paths per pixel to trace next for an image that has reached `so_far`,
/// or 0 if it is done. For a target error, the number follows from the error so far, and is at most
/// twice the number of paths so far.
int samples_of_next_round(const PathGoal& goal, const PathAccuracy& so_far);

/// Renders every pixel of the film's window by path tracing, round after round, on all permitted
/// threads. The result does not depend on the number of threads. Pixels do not depend on the window
/// either, except for a target error: then sampling is adaptive, and pixels in noisier surroundings
/// get more paths. After each round, while no pixel is being rendered, sets ImageProgress::paths.
class PathPass final : public Pass {
  public:
    PathPass(const RenderDesc& render, const PathRequest& request);

    PassNeeds needs(const LayerPlan& plan) const override;
    void provide(LayerSupply& supply) const override;
    void run(Rendering& rendering) override;

  private:
    PathRequest request_;
    bool has_error_;  // whether a standard error can be estimated, which takes two samples
    bool needs_slabs_;
};

}  // namespace uw
