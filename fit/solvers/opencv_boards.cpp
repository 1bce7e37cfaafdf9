#include <opencv2/calib3d.hpp>
#include <vector>

#include "fit/board_corners.h"

extern "C" __attribute__((visibility("default"))) void uwvdb_find_board(
    const uw::board_module::GreyPicture& picture, const uw::BoardDesc& board,
    std::vector<uw::ImagePoint>& corners) {
    // OpenCV only reads it.
    const cv::Mat image(picture.height, picture.width, CV_8UC1,
                        const_cast<unsigned char*>(picture.values.data()));
    std::vector<cv::Point2f> found;
    try {
        // As it is, and with its histogram evened out: that finds boards in a veil, and loses those
        // that lamps light before the dark.
        const cv::Size size(board.columns, board.rows);
        constexpr int k_flags = cv::CALIB_CB_EXHAUSTIVE | cv::CALIB_CB_ACCURACY;
        if (!cv::findChessboardCornersSB(image, size, found, k_flags) &&
            !cv::findChessboardCornersSB(image, size, found,
                                         k_flags | cv::CALIB_CB_NORMALIZE_IMAGE))
            return;
    } catch (const cv::Exception&) {
        return;  // pictures too small to hold it
    }
    // Its first pixel's centre is (0, 0).
    for (const cv::Point2f& corner : found)
        corners.push_back({double{corner.x} + 0.5, double{corner.y} + 0.5});
}
