#pragma once

#include <algorithm>
#include <string>
#include <vector>

/// Scenes in many layouts, for editing their text.
namespace uw::test {

inline std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
        lines.push_back(text.substr(begin, end - begin));
        begin = end;
    }
    return lines;
}

/// The lines that differ, as diff prints them (longest common subsequence), each with '-' or '+'.
inline std::string diff(const std::string& before, const std::string& after) {
    const std::vector<std::string> a = lines_of(before), b = lines_of(after);
    std::vector<std::vector<int>> common(a.size() + 1, std::vector<int>(b.size() + 1, 0));
    for (std::size_t i = a.size(); i-- > 0;)
        for (std::size_t j = b.size(); j-- > 0;)
            common[i][j] = a[i] == b[j] ? common[i + 1][j + 1] + 1
                                        : std::max(common[i + 1][j], common[i][j + 1]);
    std::string result;
    std::size_t i = 0, j = 0;
    while (i < a.size() || j < b.size()) {
        if (i < a.size() && j < b.size() && a[i] == b[j]) {
            ++i, ++j;
        } else if (i < a.size() && (j == b.size() || common[i + 1][j] >= common[i][j + 1])) {
            result += "-" + a[i++];
        } else {
            result += "+" + b[j++];
        }
    }
    return result;
}

inline const std::string k_camera =
    "uwvdb: 1\n"
    "camera: {resolution: [64, 48], intrinsics: {fov_x: 60}}\n";

inline const std::string k_commented = "# The rig of the boat\n" + k_camera +
                                       "lamps:  # both of them\n"
                                       "  # the good one\n"
                                       "  - name: left   # port side\n"
                                       "    position: [-1.0,  -0.5, 0]\t# x\ty z\n"
                                       "    profile:\n"
                                       "      type: spot  # not isotropic\n"
                                       "      beam: 60    # degrees\n"
                                       "    intensity: 50\n"
                                       "    # spare: none\n"
                                       "  - name: right\n"
                                       "    position: [1.0, -0.5, 0]\n"
                                       "    intensity: [50, 50, 50]\n"
                                       "# the end\n";

inline const std::string k_anchored =
    k_camera +
    "lamps:\n"
    "  - name: left\n"
    "    position: [-1, 0, 0]\n"
    "    profile: &spot {type: spot, beam: 60, edge: 5}  # shared\n"
    "    intensity: &bright [50, 50, 50]\n"
    "  - name: right\n"
    "    position: [1, 0, 0]\n"
    "    profile: *spot\n"
    "    intensity: *bright\n"
    "  - {name: far, position: [3, 0, 0], profile: *spot, intensity: 9}\n";

inline const std::string k_flow =
    k_camera +
    "lamps: [{name: left, position: [-1, 0, 0], intensity: 1},  # one\n"
    "        {name: right, position: [1, 0, 0],\n"
    "         intensity: 2, profile: {type: spot, # narrow\n"
    "                                 beam: 20}}]  # two\n"
    "water: {preset: jerlov-II}\n";

inline const std::string k_json =
    "{\n"
    "  \"uwvdb\": 1,\n"
    "  \"camera\": {\"resolution\": [64, 48], \"intrinsics\": {\"fov_x\": 60}},\n"
    "  \"lamps\": [\n"
    "    {\"name\": \"left\", \"position\": [0, 1, 2], \"intensity\": 5}\n"
    "  ]\n"
    "}\n";

inline std::string with_windows_lines(const std::string& text) {
    std::string result;
    for (const char c : text) result += c == '\n' ? std::string("\r\n") : std::string(1, c);
    return result;
}

inline std::string without_last_break(std::string text) {
    text.pop_back();
    return text;
}

}  // namespace uw::test
