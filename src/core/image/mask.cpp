#include "image/mask.h"

#include <algorithm>
#include <cmath>

namespace tet_line_tracker {

bool mostlyInMask(const LineCurve& line, const cv::Mat& mask) {
  const int points = std::max(2, static_cast<int>(line.chord.length() / 2.0F));
  int inside = 0;
  for (int i = 0; i < points; ++i) {
    const Eigen::Vector2f p = line.at((static_cast<float>(i) + 0.5F) / static_cast<float>(points));
    const int x = std::clamp(static_cast<int>(std::lround(p.x())), 0, mask.cols - 1);
    const int y = std::clamp(static_cast<int>(std::lround(p.y())), 0, mask.rows - 1);
    inside += mask.at<uchar>(y, x) != 0 ? 1 : 0;
  }
  return 2 * inside >= points;
}

}  // namespace tet_line_tracker
