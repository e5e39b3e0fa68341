#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "tet_line_tracker/parameters/parameters.h"
#include "tet_line_tracker/tracking/line_front_end.h"

namespace tet_line_tracker {

/// The front end of this package; all that a program without ROS needs.
class LineTracker : public LineFrontEnd {
 public:
  /// Throws std::invalid_argument with every broken rule of check(), or when the detector is not available.
  explicit LineTracker(const LineTrackerParameters& parameters);
  ~LineTracker() override;
  LineTracker(LineTracker&&) noexcept;
  LineTracker& operator=(LineTracker&&) noexcept;

  /// As LineFrontEnd::setCamera(). Where pixels cannot be normalised (CameraModel::normalize()) the image
  /// ends: lines are cut there.
  void setCamera(std::shared_ptr<const CameraModel> camera) override;

  /// Lines are detected and tracked where `mask` is not zero; a copy is kept. It applies to images of its
  /// size only; others are used whole. Empty: no mask. Throws std::invalid_argument unless it is 8-bit gray.
  void setMask(const cv::Mat& mask);

  /// Whether angular velocities can make a difference with these parameters.
  bool usesImu() const;
  /// Rotation that takes directions in the IMU's frame to the camera's optical frame; needed for the prior
  /// `imu`.
  void setImuRotation(const Eigen::Matrix3d& camera_from_imu);
  /// Angular velocity in the IMU's frame [rad/s] at a stamp [ns]. Give those up to imuStamp() of an image,
  /// and one after it, before the image.
  void addAngularVelocity(std::int64_t stamp_ns, const Eigen::Vector3d& angular_velocity);

  /// Whether poses of an odometry can make a difference with these parameters.
  bool usesOdometry() const;
  /// Pose of the odometry's body in the camera's optical frame [m]; needed for the prior `odometry`.
  void setOdometryExtrinsic(const Eigen::Isometry3d& camera_from_body);
  /// Pose of the body in the odometry's frame [m] at a stamp [ns]. Give those up to the stamp of an image,
  /// and one after it, before the image.
  void addOdometry(std::int64_t stamp_ns, const Eigen::Isometry3d& odometry_from_body);

  /// The IMU's stamp of what happens at a stamp of the images: later by the parameter imu_time_offset, or by
  /// what is estimated so far [ns]. Up to it, and one after it, an image needs angular velocities.
  std::int64_t imuStamp(std::int64_t image_stamp_ns) const;

  /// Bias of the gyroscope as learned from the images so far, in the camera's optical frame [rad/s].
  Eigen::Vector3d gyroBias() const;

  /// Replaces the parameters between two images. The tracks go on, unless needsNewEpoch(): then they are
  /// dropped, the next image starts a new epoch, and this returns true. Throws as the constructor does; all
  /// stays as it was then.
  bool setParameters(const LineTrackerParameters& parameters);

  FrameResult process(const cv::Mat& gray, std::int64_t stamp_ns) override;
  std::size_t reset() override;

  const LineTrackerParameters& parameters() const;
  /// Detector in use, as in the parameter `detector`.
  std::string detectorName() const;
  /// One sentence for each parameter that cannot be used as it was given, to be shown to the user.
  const std::vector<std::string>& notes() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace tet_line_tracker
