#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "tet_line_tracker/camera/camera_model.h"
#include "tet_line_tracker/geometry/line_segment.h"
#include "tet_line_tracker/parameters/parameters.h"

namespace tet_line_tracker {

/// One line of one image.
struct TrackedLine {
  std::uint64_t id{0};   ///< the same over the life of the track; never used again by this tracker
  std::uint32_t age{1};  ///< images the track was seen in, this one included
  LineSegment segment;   ///< in the raw image [px]
  Eigen::Vector2d start_normalized{
      Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN())};  ///< z = 1
  Eigen::Vector2d end_normalized{
      Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN())};  ///< z = 1
  float sigma_px{
      std::numeric_limits<float>::quiet_NaN()};  ///< of the position along the normal; NaN: not estimated
  float residual{
      std::numeric_limits<float>::quiet_NaN()};  ///< mean absolute gray difference, 0..1; NaN: detected here
};

/// Why a line was lost, in the order of the checks.
enum class LossReason {
  kFlow,
  kResidual,
  kForwardBackward,
  kLength,
  kAngle,
  kSupport,
  kBorder,
  kMask,
  kDuplicate,
  kGeometry,
  kCount
};

/// What happened to the lines of one image, and how long it took. Mirrors TrackingStatistics.msg.
struct FrameStatistics {
  std::uint32_t tracks_before{0};   ///< lines of the image before
  std::uint32_t tracks_kept{0};     ///< of these, lines that are still there
  std::uint32_t lines_detected{0};  ///< found by the detector on this image
  std::uint32_t lines_added{0};     ///< of these, new tracks
  float coverage{0.0F};             ///< share of the 8x6 grid of the image that a line crosses, 0..1
  std::uint32_t lines_cut{0};  ///< tracked or detected, cut to the part of the image that can be normalised
  std::uint32_t lines_left_out{0};  ///< the same, but less than min_length was left: lost, or not added
  std::array<std::uint32_t, static_cast<std::size_t>(LossReason::kCount)> lost{};  ///< by LossReason

  std::string prior{"none"};   ///< motion prior that was used
  float prior_rotation{0.0F};  ///< angle of the predicted rotation [rad]

  std::uint32_t dropped_late{0}, dropped_duplicate{0}, dropped_zero{0};  ///< images of this epoch

  double pyramid_ms{0}, prior_ms{0}, flow_ms{0}, refine_ms{0}, detect_ms{0}, undistort_ms{0}, total_ms{0};
};

/// All lines of one image, oldest id first.
struct LineFrame {
  std::int64_t stamp_ns{0};
  std::uint32_t epoch{0};        ///< +1 at every reset
  std::uint64_t image_count{0};  ///< images accepted in this epoch, this one included
  int width{0}, height{0};       ///< of the image [px]
  bool detected{false};          ///< the detector ran on this image
  std::vector<TrackedLine> lines;
  FrameStatistics statistics;
};

/// The front end: images in, lines with ids out. All that a program without ROS needs. Not thread-safe; two
/// trackers share nothing. The same images and parameters give the same lines.
class LineTracker {
 public:
  /// Throws std::invalid_argument with every broken rule of check(), or when the detector is not available.
  explicit LineTracker(const LineTrackerParameters& parameters);
  ~LineTracker();
  LineTracker(LineTracker&&) noexcept;
  LineTracker& operator=(LineTracker&&) noexcept;

  /// Calibration for the normalised endpoints; nullptr: they are NaN. May change between images. Where pixels
  /// cannot be normalised (CameraModel::normalize()) the image ends: lines are cut there.
  void setCamera(std::shared_ptr<const CameraModel> camera);

  /// Where lines are looked for and may go on: where `mask` is not zero; a copy is kept. Counts for images of
  /// its size alone, others are used whole; empty: all are. Throws std::invalid_argument unless it is 8-bit
  /// gray.
  void setMask(const cv::Mat& mask);

  /// Takes directions in the IMU's frame to the camera's optical frame; needed for the prior `imu`.
  void setImuRotation(const Eigen::Matrix3d& camera_from_imu);
  /// Angular velocity in the IMU's frame [rad/s] at a stamp [ns]. Give those up to the stamp of an image, and
  /// one after it, before the image.
  void addAngularVelocity(std::int64_t stamp_ns, const Eigen::Vector3d& angular_velocity);

  /// Tracks the lines of the image before into `gray` (8-bit, one channel; not copied, not kept) with its
  /// stamp [ns]. Gives the lines of this image, valid until the next call, or nullptr when the image is
  /// dropped because of its stamp (see StreamGate). Throws std::invalid_argument for an image that is empty
  /// or not 8-bit gray.
  const LineFrame* process(const cv::Mat& gray, std::int64_t stamp_ns);

  /// Forgets all tracks; the next image starts a new epoch. Gives the number of tracks that were dropped.
  std::size_t reset();

  const LineTrackerParameters& parameters() const;
  /// Detector in use, as in the parameter `detector`.
  std::string detectorName() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace tet_line_tracker
