#include "dataset/frame_stamps.h"

#include <fmt/format.h>

#include <cstdlib>

#include "core/base/error.h"

namespace uw {

FrameStamps::FrameStamps(const SceneDesc& scene)
    : are_poses_(scene.render.times == RenderDesc::Times::trajectory) {
    const std::optional<TrajectoryDesc>& moves =
        scene.rig_trajectory ? scene.rig_trajectory : scene.camera.trajectory;
    if (moves) clock_ = read_pose_clock(*moves).value_or(PoseClock());
}

std::int64_t FrameStamps::at(std::optional<int> frame, double time) const {
    if (are_poses_ && frame && static_cast<std::size_t>(*frame) < clock_.stamps.size())
        return clock_.stamps[static_cast<std::size_t>(*frame)];
    const auto since_zero = nanoseconds(time);
    if (!since_zero)
        throw InputError(fmt::format(
            "the time of {:g} s is after the year 2116, beyond nanoseconds of 64 bits", time));
    return clock_.zero + *since_zero;
}

std::string seconds_text(std::int64_t stamp) {
    constexpr std::int64_t k_second = 1'000'000'000;
    return fmt::format("{}{}.{:09}", stamp < 0 ? "-" : "", std::abs(stamp / k_second),
                       std::abs(stamp % k_second));
}

std::int64_t euroc_stamp(std::int64_t stamp) {
    // Readers cut the names of images into seconds and nine digits of nanoseconds, and sort them as
    // text. So all have 19 digits, as the benchmark's, whose clock began in 1970, have; those of
    // other clocks are counted from May 2014.
    constexpr std::int64_t k_min_of_19_digits = 1'000'000'000'000'000'000;
    constexpr std::int64_t k_start_of_others = 1'400'000'000'000'000'000;
    return stamp >= k_min_of_19_digits ? stamp : k_start_of_others + stamp;
}

}  // namespace uw
