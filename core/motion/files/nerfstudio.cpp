#include "core/motion/files/nerfstudio.h"

#include <fmt/format.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/json/json.h"
#include "core/motion/files/pose_lines.h"

namespace uw {

namespace {

// Files have six digits and more, some after a scale was taken out.
constexpr double k_rigid_tolerance = 1e-3;

/// One of the file's frames, for messages.
class NerfstudioFrame {
  public:
    NerfstudioFrame(const Json& frame, std::size_t index, const std::string& origin)
        : frame_(frame), index_(index), origin_(origin) {}

    NamedPose read() const {
        if (!frame_.is_object() || !frame_.contains("transform_matrix"))
            fail("has no transform_matrix");
        const Json& rows = frame_["transform_matrix"];
        if (!rows.is_array() || (rows.size() != 4 && rows.size() != 3))
            fail("its transform_matrix has not four rows of four numbers");
        Matrix3 linear(0.0);
        Vector3 offset(0.0);
        for (std::size_t i = 0; i < rows.size(); ++i)
            for (std::size_t j = 0; j < 4; ++j) {
                const double x = number(rows[i], j);
                if (i == 3) {
                    if (std::abs(x - (j == 3 ? 1 : 0)) > k_rigid_tolerance)
                        fail("its transform_matrix does not end in 0, 0, 0, 1");
                } else if (j == 3) {
                    offset[static_cast<int>(i)] = x;
                } else {
                    linear[static_cast<int>(j)][static_cast<int>(i)] = x;
                }
            }
        check_rotation(linear);
        // y up and -z forward become y down and z forward.
        linear[1] = -linear[1];
        linear[2] = -linear[2];
        return {name(), {at_origin_plus(offset), rotation_of(linear)}, index_};
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw InputError(fmt::format("{}: frames[{}]: {}", origin_, index_, what));
    }

    double number(const Json& row, std::size_t j) const {
        if (!row.is_array() || row.size() != 4 || !row[j].is_number())
            fail("its transform_matrix has not four rows of four numbers");
        const double x = row[j].get<double>();
        if (!(std::abs(x) <= k_largest_pose_number))
            fail("its transform_matrix has a number above 1e12");
        return x;
    }

    void check_rotation(const Matrix3& linear) const {
        const Matrix3 product = glm::transpose(linear) * linear;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                if (!(std::abs(product[i][j] - (i == j ? 1 : 0)) <= k_rigid_tolerance))
                    fail("its transform_matrix is not rigid to within 1e-3; take out its scale");
        if (glm::determinant(linear) < 0) fail("its transform_matrix mirrors the world");
    }

    /// The image's; a frame without one is called by its place.
    std::string name() const {
        const auto found = frame_.find("file_path");
        if (found == frame_.end()) return fmt::format("{:09}", index_);
        if (!found->is_string()) fail("its file_path is no text");
        return found->get<std::string>();
    }

    const Json& frame_;
    std::size_t index_;
    const std::string& origin_;
};

}  // namespace

PoseFile read_nerfstudio(std::string_view text, const std::string& origin) {
    Json json;
    try {
        json = Json::parse(text);
    } catch (const Json::exception& error) {
        throw InputError(fmt::format("{}: is not JSON: {}", origin, printable(error.what(), 200)));
    }
    const auto frames = json.is_object() ? json.find("frames") : json.end();
    if (!json.is_object() || frames == json.end() || !frames->is_array())
        throw InputError(
            fmt::format("{}: has no list 'frames', as nerfstudio's transforms.json has", origin));
    if (frames->size() > k_most_poses)
        throw InputError(
            fmt::format("{}: has more than a million poses; give those that are needed", origin));
    std::vector<NamedPose> named;
    for (std::size_t i = 0; i < frames->size(); ++i)
        named.push_back(NerfstudioFrame((*frames)[i], i, origin).read());
    PoseFile file;
    file.counts_frames = true;
    file.poses = by_frame(std::move(named), origin);
    return file;
}

}  // namespace uw
