#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace uw {

/// The numbers of frames that `text` lists: "1-10,20-40:2" is 1 to 10, and every second from 20 to
/// 40, both ends included. In the order given, each once. Throws UsageError, which names `option`
/// and what it lists, for other text, and for more than a million frames.
std::vector<int> parse_frame_list(const std::string& text, const char* option = "--frames",
                                  const char* what = "frames");

/// Frames as such a list, in ascending order: "3-5,9". If there are many runs, the first are
/// listed, followed by the number of remaining frames.
std::string format_frame_list(std::vector<int> frames);

}  // namespace uw
