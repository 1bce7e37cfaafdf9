#include "fit/picture_poses.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "core/base/csv_table.h"
#include "core/base/error.h"
#include "core/base/input_files.h"
#include "core/base/json.h"
#include "core/base/text.h"
#include "core/scene/pose_file.h"

namespace uw {

namespace {

bool is_folder(const std::filesystem::path& file) {
    std::error_code ignored;
    return std::filesystem::is_directory(file, ignored);
}

/// The file of a model's poses: itself, or in the folder of a COLMAP model.
std::filesystem::path pose_file_in(const std::filesystem::path& poses) {
    if (!is_folder(poses)) return poses;
    for (const char* const name : {"images.bin", "images.txt", "transforms.json"})
        if (is_file(poses / name)) return poses / name;
    throw IoError(fmt::format(
        "--poses: {}: this folder has neither images.bin nor images.txt nor transforms.json; give "
        "that of one COLMAP model, such as sparse/0",
        printable(poses.string(), 300)));
}

using PosesByName = std::map<std::string, Pose>;

std::string name_of(const std::filesystem::path& file) {
    return file.lexically_normal().generic_string();
}

PosesByName poses_by_name(const std::filesystem::path& poses) {
    const std::filesystem::path file = pose_file_in(poses);
    const std::optional<PoseFormat> format = pose_format_called(file);
    if (format != PoseFormat::colmap && format != PoseFormat::nerfstudio)
        throw UsageError(fmt::format(
            "--poses {}: names no images; give a COLMAP model or a transforms.json, or set "
            "camera.trajectory.file, which has the poses of frames",
            printable(poses.string(), 300)));
    PosesByName by_name;
    for (const NamedPose& named : read_named_poses(file, *format, "--poses"))
        by_name.emplace(name_of(named.name), named.pose);
    return by_name;
}

/// Looks a picture up by the longest end of its path that is a name.
const Pose* pose_of_picture(const std::filesystem::path& file, const PosesByName& poses) {
    const std::string path = name_of(file);
    for (std::size_t begin = 0; begin != std::string::npos;) {
        const auto found = poses.find(path.substr(begin));
        if (found != poses.end()) return &found->second;
        const std::size_t slash = path.find('/', begin);
        begin = slash == std::string::npos ? slash : slash + 1;
    }
    return nullptr;
}

}  // namespace

std::vector<ObservedPicture> posed_pictures(const std::filesystem::path& images,
                                            const std::filesystem::path& poses,
                                            const std::function<void(const std::string&)>& say) {
    const PosesByName by_name = poses_by_name(poses);
    std::vector<ObservedPicture> posed;
    if (is_folder(images)) {
        for (const auto& [name, pose] : by_name)
            if (is_file(images / name)) posed.push_back({images / name, {}, pose});
        if (const std::size_t others = by_name.size() - posed.size(); others > 0 && !posed.empty())
            say(fmt::format("{}: has none of {} that --poses names; passed over", images.string(),
                            counted(others, "picture")));
    } else {
        for (ObservedPicture& picture : pictures_called(images)) {
            if (const Pose* const pose = pose_of_picture(picture.file, by_name)) {
                picture.world_from_camera = *pose;
                posed.push_back(std::move(picture));
            } else {
                say(fmt::format("{}: --poses has no pose of it; passed over",
                                picture.file.string()));
            }
        }
    }
    if (posed.empty())
        throw InputError(fmt::format(
            "--poses: none of its {} is of a picture of {}; the names must agree, as in '{}'",
            counted(by_name.size(), "pose"), printable(images.string(), 300),
            printable(by_name.begin()->first)));
    return posed;
}

std::string transforms_json(std::span<const std::string> names, std::span<const FoundPose> poses) {
    Json frames = Json::array();
    for (std::size_t i = 0; i < names.size(); ++i) {
        // There y is up and z backward.
        const Vector3 signs{1, -1, -1};
        const Affine& pose = poses[i].world_from_camera;
        Json rows = Json::array();
        for (int row = 0; row < 3; ++row) {
            Json numbers = Json::array();
            for (int column = 0; column < 3; ++column)
                numbers.push_back(number_json(signs[column] * pose.linear()[column][row]));
            numbers.push_back(number_json(pose.offset()[row]));
            rows.push_back(numbers);
        }
        rows.push_back({0, 0, 0, 1});
        frames.push_back({{"file_path", names[i]},
                          {"transform_matrix", rows},
                          {"position_error", vector_json(poses[i].position_error)},
                          {"turn_error", vector_json(poses[i].turn_error)}});
    }
    return json_text({{"frames", frames}});
}

std::string pose_csv(std::span<const std::string> names, std::span<const FoundPose> poses) {
    std::string text =
        "image,x,y,z,x_error,y_error,z_error,turn_x_error,turn_y_error,turn_z_error\n";
    for (std::size_t i = 0; i < names.size(); ++i) {
        text += csv_text(names[i]);
        for (const Vector3& three :
             {poses[i].world_from_camera.offset(), poses[i].position_error, poses[i].turn_error})
            text += fmt::format(",{:.9g},{:.9g},{:.9g}", three.x, three.y, three.z);
        text += "\n";
    }
    return text;
}

}  // namespace uw
