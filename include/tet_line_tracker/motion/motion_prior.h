#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "tet_line_tracker/camera/camera_model.h"
#include "tet_line_tracker/geometry/line_segment.h"
#include "tet_line_tracker/image/image_pyramid.h"
#include "tet_line_tracker/parameters/parameters.h"

namespace tet_line_tracker {

/// An inverse depth (1 / z of the optical frame), in units of 1 / the length of the camera's last step.
struct DepthGuess {
  double inverse{0.0};
  double variance{0.0};
};

/// How the camera is expected to have moved from the image before to this one.
struct MotionPrediction {
  enum class Source { kNone, kImu, kImage, kOdometry };
  Source source{Source::kNone};
  /// Takes directions in the camera's optical frame at the image before to the same directions at this one.
  Eigen::Matrix3d rotation{Eigen::Matrix3d::Identity()};
  /// How points move in the optical frame while the camera takes its step: a unit vector, zero where it is
  /// not known. A point of the image before on the ray h (z = 1) with the inverse depth d appears on rotation
  /// * h + d * translation.
  Eigen::Vector3d translation{Eigen::Vector3d::Zero()};
  double step_ratio{0.0};          ///< length of this step over that of the step before; 0: not known
  bool confirmed{false};           ///< the rotation is that of corners too
  std::size_t inliers{0};          ///< corners that agree with the translation
  double angle() const;            ///< of the rotation [rad]
  const char* sourceName() const;  ///< none, imu, image or odometry
  bool used() const { return source != Source::kNone || translates(); }
  bool translates() const { return !translation.isZero(); }
};

/// Predicts where lines are in the next image from the rotation of the camera, which moves far and near
/// points alike and makes up most of the image motion of a fast camera. The rotation comes from a direct
/// alignment of the coarsest pyramid levels, from a gyroscope, or from an alignment that begins at the
/// gyroscope's, whichever fits the images best, and is used only if they agree that it is better than none;
/// or from an odometry, which tells the translation as well. Corners that are followed from there correct it.
/// Not thread-safe.
class MotionPrior {
 public:
  explicit MotionPrior(const MotionPriorParameters& parameters);
  ~MotionPrior();
  MotionPrior(MotionPrior&&) noexcept;
  MotionPrior& operator=(MotionPrior&&) noexcept;

  /// For the images to come. What is known of camera, IMU and odometry stays.
  void setParameters(const MotionPriorParameters& parameters);
  /// Calibration; nullptr: a pinhole with a focal length of the image's width is assumed.
  void setCamera(std::shared_ptr<const CameraModel> camera);
  /// Takes directions in the IMU's frame to the camera's optical frame. Without it angular velocities are not
  /// used.
  void setImuRotation(const Eigen::Matrix3d& camera_from_imu);
  /// Angular velocity in the IMU's frame [rad/s], in the order of stamps [ns]; late ones are ignored.
  void addAngularVelocity(std::int64_t stamp_ns, const Eigen::Vector3d& angular_velocity);

  /// Pose of the odometry's body in the camera's optical frame [m]. Without it the odometry is not used.
  void setOdometryExtrinsic(const Eigen::Isometry3d& camera_from_body);
  /// Pose of the body in the odometry's frame [m], in the order of stamps [ns]; late ones are ignored. Used
  /// by the prior `odometry` where a camera is set.
  void addOdometry(std::int64_t stamp_ns, const Eigen::Isometry3d& odometry_from_body);

  /// Bias of the gyroscope as learned from the images so far, in the camera's optical frame [rad/s].
  Eigen::Vector3d gyroBias() const;

  /// By how much the IMU's stamps are ahead of the images' [s]: what happens at stamp t of an image has the
  /// IMU stamp t + imuTimeOffset(). As the parameter says, or as estimated so far.
  double imuTimeOffset() const;

  /// Forgets the image before; the next predict() gives no motion.
  void reset();

  /// Motion from the image of the call before to this one, and makes this one the image before.
  MotionPrediction predict(const ImagePyramid& pyramid, std::int64_t stamp_ns);

  /// Where `segment` of the image before is expected after `prediction`; itself where the camera cannot see
  /// it. `start_normalized`, `end_normalized`: its endpoints on z = 1, NaN where not known.
  LineSegment apply(const MotionPrediction& prediction, const LineSegment& segment,
                    const Eigen::Vector2d& start_normalized, const Eigen::Vector2d& end_normalized) const;

  /// The same with the movement by the translation, where that is known: `inverse_depths` of start and end in
  /// the image before, in units of 1 / this step.
  LineSegment apply(const MotionPrediction& prediction, const LineSegment& segment,
                    const Eigen::Vector2d& start_normalized, const Eigen::Vector2d& end_normalized,
                    const Eigen::Vector2d& inverse_depths) const;

  /// Of the camera, or of the pinhole assumed [px]; 1 before the first image.
  double focal() const;

  /// Inverse depth near a pixel of the image before, by what moved with it there, in units of 1 / this step.
  std::optional<DepthGuess> depthNear(const Eigen::Vector2f& pixel) const;

  /// Pyramid levels that predict() wants to see.
  static constexpr int kPyramidLevels = 5;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace tet_line_tracker
