#include "mask_file.h"

#include <stdexcept>

#include <opencv2/imgcodecs.hpp>

namespace tet_line_tracker {

cv::Mat readMask(const std::string& path) {
  if (path.empty()) return {};
  const cv::Mat picture = cv::imread(path, cv::IMREAD_GRAYSCALE);
  if (picture.empty()) {
    throw std::invalid_argument("parameter mask is " + path + ", needs an image file that can be read");
  }
  return picture >= 128;
}

std::string maskComplaint(const cv::Mat& mask, int width, int height) {
  if (mask.empty() || (mask.cols == width && mask.rows == height)) return {};
  return "the mask is " + std::to_string(mask.cols) + "x" + std::to_string(mask.rows) + ", the images have " +
         std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace tet_line_tracker
