#include "cli/image_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <unordered_set>

#include "core/base/error.h"
#include "core/base/text.h"

namespace uw {

namespace {

std::string names_of(const std::vector<RigCameraDesc>& cameras) {
    std::string names;
    for (const RigCameraDesc& camera : cameras) names += (names.empty() ? "" : ", ") + camera.name;
    return names;
}

}  // namespace

std::size_t camera_called(const std::string& name, const std::vector<RigCameraDesc>& cameras) {
    if (cameras.empty())
        throw UsageError(fmt::format(
            "--camera {}: the scene has one camera, which has no name; leave the option out",
            printable(name)));
    const auto found = std::ranges::find(cameras, name, &RigCameraDesc::name);
    if (found == cameras.end())
        throw UsageError(fmt::format("--camera: the scene has no camera '{}'; it has {}",
                                     printable(name), names_of(cameras)));
    return static_cast<std::size_t>(found - cameras.begin());
}

std::size_t chosen_camera(const std::string& name, const std::vector<RigCameraDesc>& cameras) {
    if (!name.empty()) return camera_called(name, cameras);
    if (cameras.size() > 1)
        throw UsageError(
            fmt::format("--camera: the scene has several; choose one of {}", names_of(cameras)));
    return 0;
}

namespace {

constexpr int k_last_frame = 999'999'999;
constexpr std::size_t k_max_frames = 1'000'000;

// The option being read, for messages.
struct ListOption {
    const char* name;
    const char* what;

    [[noreturn]] void refuse(std::string_view part, const std::string& why) const {
        throw UsageError(fmt::format("{}: '{}': {}", name, printable(part), why));
    }
    [[noreturn]] void refuse_form(std::string_view part) const {
        refuse(part,
               fmt::format("expected {} such as 7, 1-10 or 20-40:2, separated by commas", what));
    }
};

// Removes a number from the beginning of `text`.
int take_number(std::string_view& text, std::string_view part, const ListOption& option) {
    int number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error == std::errc::result_out_of_range || number > k_last_frame)
        option.refuse(part, fmt::format("{} are numbers from 0 to {}", option.what, k_last_frame));
    if (error != std::errc() || number < 0) option.refuse_form(part);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return number;
}

struct ListedRange {
    int first = 0, last = 0, step = 1;
};

ListedRange parse_range(std::string_view part, const ListOption& option) {
    std::string_view text = part;
    ListedRange range;
    range.first = range.last = take_number(text, part, option);
    if (take_beginning(text, "-")) {
        range.last = take_number(text, part, option);
        if (take_beginning(text, ":")) range.step = take_number(text, part, option);
    }
    if (!text.empty()) option.refuse_form(part);
    if (range.last < range.first)
        option.refuse(part,
                      fmt::format("begins after its end; write {}-{}", range.last, range.first));
    if (range.step == 0)
        option.refuse(part, "a step of 0 leads nowhere; write 1 or more after the colon");
    return range;
}

}  // namespace

std::vector<int> parse_frame_list(const std::string& text, const char* name, const char* what) {
    const ListOption option{name, what};
    std::vector<int> frames;
    std::unordered_set<int> known;
    std::size_t at = 0;
    while (at <= text.size()) {
        const std::size_t comma = std::min(text.find(',', at), text.size());
        const ListedRange range =
            parse_range(std::string_view(text).substr(at, comma - at), option);
        for (long frame = range.first; frame <= range.last; frame += range.step) {
            const int number = static_cast<int>(frame);
            if (known.insert(number).second) frames.push_back(number);
            if (frames.size() > k_max_frames)
                option.refuse(text,
                              fmt::format("more than a million {}; render them in parts", what));
        }
        at = comma + 1;
    }
    return frames;
}

}  // namespace uw
