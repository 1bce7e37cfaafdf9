#include "core/motion/files/pose_file_reader.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/files/text_file.h"
#include "core/motion/files/nerfstudio.h"
#include "core/motion/files/pose_tables.h"
#include "core/scene/yaml/config_node.h"

namespace uw {

namespace {

// Of COLMAP's images.txt nearly all is points.
constexpr std::size_t k_most_bytes = std::size_t{1} << 30;

PoseFile read_text(std::string_view text, PoseFormat format, const std::string& origin) {
    constexpr std::string_view k_byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(k_byte_order_mark)) text.remove_prefix(k_byte_order_mark.size());
    switch (format) {
        case PoseFormat::tum:
            return read_tum(text, origin);
        case PoseFormat::euroc:
            return read_euroc(text, origin);
        case PoseFormat::colmap:
            return read_colmap_images(text, origin);
        case PoseFormat::nerfstudio:
            break;
    }
    return read_nerfstudio(text, origin);
}

}  // namespace

PoseFile read_pose_file(const std::filesystem::path& file, PoseFormat format,
                        const std::string& subject) {
    const std::string origin = fmt::format("{}: {}", subject, printable(file.string(), 300));
    const std::string text = read_text_file(file, origin, k_most_bytes, "file of poses");
    PoseFile poses = read_text(text, format, origin);
    if (poses.poses.empty()) throw InputError(origin + ": has no pose");
    poses.hash = text_hash(text);
    return poses;
}

}  // namespace uw
