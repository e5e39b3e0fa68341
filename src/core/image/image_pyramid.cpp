#include "tet_line_tracker/image/image_pyramid.h"

#include <algorithm>

#include "kernels/kernels.h"

namespace tet_line_tracker {

void ImagePyramid::build(const cv::Mat& gray, int levels) {
  int count = 1;
  for (cv::Size size = gray.size(); count < levels && (std::min(size.width, size.height) + 1) / 2 >= kMinSide;
       ++count) {
    size = cv::Size((size.width + 1) / 2, (size.height + 1) / 2);
  }
  images_.resize(static_cast<std::size_t>(count));
  buffers_.resize(static_cast<std::size_t>(std::max(count, levels)));
  row_.resize(static_cast<std::size_t>(gray.cols) + kernels::kRowPadding);
  images_[0] = gray;
  for (std::size_t j = 1; j < images_.size(); ++j) {
    const cv::Mat& source = images_[j - 1];
    cv::Mat& target = buffers_[j];
    target.create((source.rows + 1) / 2, (source.cols + 1) / 2, CV_8UC1);
    for (int y = 0; y < target.rows; ++y) {
      const std::uint8_t* middle = source.ptr<std::uint8_t>(2 * y);
      const std::uint8_t* above = source.ptr<std::uint8_t>(std::max(0, 2 * y - 1));
      const std::uint8_t* below = source.ptr<std::uint8_t>(std::min(source.rows - 1, 2 * y + 1));
      kernels::active().halveRow(above, middle, below, source.cols, row_.data(), target.ptr<std::uint8_t>(y));
    }
    images_[j] = target;
  }
}

}  // namespace tet_line_tracker
