#include "remapped_lbd_knn.h"

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

#include "tracking/stopwatch.h"

namespace tet_line_tracker {

void RemappedLbdKnn::track(const cv::Mat& gray) {
  if (!camera()) return LbdKnn::track(gray);
  Stopwatch stage;
  if (prepared_for_ != camera() || map_.size() != gray.size()) prepare(gray.size());
  cv::remap(gray, remapped_, map_, cv::noArray(), cv::INTER_LINEAR);
  const double remap_ms = stage.lap();
  LbdKnn::track(remapped_);
  frame().statistics.undistort_ms = remap_ms;
  for (TrackedLine& line : frame().lines) line.segment = *toRaw(line.segment);
}

bool RemappedLbdKnn::isWanted(const LineSegment& segment) const {
  if (!camera()) return true;
  const std::optional<LineSegment> raw = toRaw(segment);
  if (!raw || raw->length() < static_cast<float>(detection().min_length)) return false;
  // Beyond the raw image the pinhole is black; along its border lie edges of nothing.
  constexpr float kBesideBlack = 3.0F;
  const ImageBounds bounds = ImageBounds::ofImage(map_.cols, map_.rows, kBesideBlack);
  return bounds.contains(raw->start) && bounds.contains(raw->end);
}

void RemappedLbdKnn::prepare(const cv::Size& size) {
  prepared_for_ = camera();
  constexpr double kStep = 1e-3;
  const auto project = [this](double x, double y) { return prepared_for_->project({x, y, 1.0}); };
  centre_ = project(0.0, 0.0).value_or(Eigen::Vector2d(0.5 * size.width, 0.5 * size.height));
  focal_ = {(project(kStep, 0.0).value_or(centre_).x() - centre_.x()) / kStep,
            (project(0.0, kStep).value_or(centre_).y() - centre_.y()) / kStep};
  map_.create(size, CV_32FC2);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto raw = project((x - centre_.x()) / focal_.x(), (y - centre_.y()) / focal_.y());
      map_.at<cv::Vec2f>(y, x) = raw ? cv::Vec2f(static_cast<float>(raw->x()), static_cast<float>(raw->y()))
                                     : cv::Vec2f(-1e4F, -1e4F);
    }
  }
}

std::optional<LineSegment> RemappedLbdKnn::toRaw(const LineSegment& segment) const {
  const auto raw = [this](const Eigen::Vector2f& pixel) {
    const Eigen::Vector2d point = (pixel.cast<double>() - centre_).cwiseQuotient(focal_);
    return prepared_for_->project(point.homogeneous());
  };
  const auto start = raw(segment.start);
  const auto end = raw(segment.end);
  if (!start || !end) return std::nullopt;
  return LineSegment{start->cast<float>(), end->cast<float>()};
}

}  // namespace tet_line_tracker
