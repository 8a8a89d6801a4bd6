#include "tests/bench/opencv_mergers.h"

#include <opencv2/core.hpp>
#include <opencv2/photo.hpp>

namespace gonio::bench {
namespace {

/// MergeDebevec wants three channels: all the same.
cv::Mat eightBit(const Frame& frame) {
    cv::Mat picture(frame.pixels.height(), frame.pixels.width(), CV_8UC3);
    const double scale = 255 / (4095.0 - frame.blackLevel);
    for (int y = 0; y < picture.rows; ++y) {
        for (int x = 0; x < picture.cols; ++x) {
            const double dn = frame.pixels.at(x, y) - static_cast<double>(frame.blackLevel);
            picture.at<cv::Vec3b>(y, x) =
                cv::Vec3b::all(cv::saturate_cast<std::uint8_t>(dn * scale));
        }
    }
    return picture;
}

std::vector<float> listed(const cv::Mat& picture) {
    std::vector<float> list;
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x) list.push_back(picture.at<cv::Vec3f>(y, x)[0]);
    return list;
}

}  // namespace

std::vector<OpenCvResult> openCvMerged(const std::vector<Frame>& bracket) {
    std::vector<cv::Mat> pictures;
    std::vector<float> seconds;
    for (const Frame& frame : bracket) {
        pictures.push_back(eightBit(frame));
        seconds.push_back(static_cast<float>(frame.exposure.seconds()));
    }
    cv::Mat response(256, 1, CV_32FC3);
    for (int i = 0; i < 256; ++i) {
        const float linear = i == 0 ? 0.5F : static_cast<float>(i);  // 0 has no logarithm
        response.at<cv::Vec3f>(i) = cv::Vec3f::all(linear / 255);
    }
    cv::Mat debevec, robertson;
    cv::createMergeDebevec()->process(pictures, debevec, seconds, response);
    cv::createMergeRobertson()->process(pictures, robertson, seconds, response);
    return {{"OpenCV MergeDebevec, 8 bit", listed(debevec)},
            {"OpenCV MergeRobertson, 8 bit", listed(robertson)}};
}

}  // namespace gonio::bench
