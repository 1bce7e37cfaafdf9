#include "core/scene/pose_file.h"
#include "tests/fuzz/fuzzing.h"

// Files of poses, each as one of every format, since none has a mark of its own; and by the names
// of their images.
UWVDB_FUZZ(data, size) {
    using namespace uw;
    static const fuzz::InputFolder folder;
    const std::filesystem::path text = folder.write("poses", fuzz::text_of(data, size));
    const std::filesystem::path binary = folder.write("images.bin", fuzz::text_of(data, size));
    const auto read = [](const std::filesystem::path& file, PoseFormat format) {
        const PoseFile poses = read_pose_file(file, format, "scene.yaml:5: trajectory");
        for (std::size_t k = 1; k < poses.poses.size(); ++k)
            if (!(poses.poses[k - 1].time < poses.poses[k].time)) __builtin_trap();
        if (poses.poses.empty()) __builtin_trap();  // at least one is promised
        if (format != PoseFormat::colmap && format != PoseFormat::nerfstudio) return;
        if (read_named_poses(file, format, "--poses").size() != poses.poses.size())
            __builtin_trap();
    };
    for (const PoseFormat format :
         {PoseFormat::tum, PoseFormat::euroc, PoseFormat::colmap, PoseFormat::nerfstudio})
        fuzz::parse([&] { read(text, format); });
    fuzz::parse([&] { read(binary, PoseFormat::colmap); });
    return 0;
}
