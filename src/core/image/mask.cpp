#include "image/mask.h"

#include <cmath>

#include "geometry/clamp.h"

namespace tet_line_tracker {

bool mostlyInMask(const LineCurve& line, const cv::Mat& mask) {
  constexpr float kMaxPoints = 1e4F;
  const int points = static_cast<int>(clampOrLow(line.chord.length() / 2.0F, 2.0F, kMaxPoints));
  int inside = 0;
  for (int i = 0; i < points; ++i) {
    const Eigen::Vector2f p = line.at((static_cast<float>(i) + 0.5F) / static_cast<float>(points));
    const int x = static_cast<int>(std::lround(clampOrLow(p.x(), 0.0F, static_cast<float>(mask.cols - 1))));
    const int y = static_cast<int>(std::lround(clampOrLow(p.y(), 0.0F, static_cast<float>(mask.rows - 1))));
    inside += mask.at<uchar>(y, x) != 0 ? 1 : 0;
  }
  return 2 * inside >= points;
}

}  // namespace tet_line_tracker
