#include <opencv2/calib3d.hpp>
#include <vector>

#include "fit/least_squares.h"

extern "C" __attribute__((visibility("default"))) void uwvdb_poses_from_points(
    const uw::SeenPoints& seen, std::vector<uw::RigidMatrix>& poses) {
    std::vector<cv::Point3d> points;
    std::vector<cv::Point2d> images;
    for (const auto& [x, y, z] : seen.points) points.emplace_back(x, y, z);
    for (const auto& [x, y] : seen.images) images.emplace_back(x, y);
    std::vector<cv::Mat> rotations, translations;
    try {
        cv::solvePnPGeneric(points, images, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), rotations,
                            translations, false, cv::SOLVEPNP_SQPNP);
    } catch (const cv::Exception&) {
        return;  // points on a line, and the like
    }
    for (std::size_t i = 0; i < rotations.size(); ++i) {
        cv::Mat rotation;
        cv::Rodrigues(rotations[i], rotation);
        uw::RigidMatrix pose{};
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column)
                pose[static_cast<std::size_t>(3 * row + column)] = rotation.at<double>(row, column);
            pose[static_cast<std::size_t>(9 + row)] = translations[i].at<double>(row);
        }
        poses.push_back(pose);
    }
}
