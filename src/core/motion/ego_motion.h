#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "motion/corner_tracker.h"
#include "motion/epipolar_estimator.h"
#include "tet_line_tracker/camera/camera_model.h"
#include "tet_line_tracker/image/image_pyramid.h"
#include "tet_line_tracker/motion/motion_prior.h"

namespace tet_line_tracker {

/// How the camera moves, turning and translation, from corners followed from image to image. Each corner
/// keeps its inverse depth in units of 1 / the camera's last step, which tells where it goes next, and by how
/// much one step is longer than the last.
class EgoMotionTracker {
 public:
  /// How the gyroscope says that the camera turned, and the deviation of that [rad].
  struct MeasuredRotation {
    Eigen::Matrix3d rotation;
    double deviation;
    bool trusted;  ///< it has agreed with the images before
  };

  /// nullptr: no motion is estimated.
  void setCamera(std::shared_ptr<const CameraModel> camera);
  /// Forgets the corners and the motion.
  void reset();

  /// Completes `prediction`, which says how the camera turned from the image of the call before to this one,
  /// by its translation, and corrects the rotation. `interval_s`: between both images [s]. `measured`: how it
  /// turned by the gyroscope, which no parallax deceives. `step`: how points move by an odometry while the
  /// camera takes its step, which turned as `prediction` says [m].
  void update(const ImagePyramid& pyramid, double interval_s, const std::optional<MeasuredRotation>& measured,
              const std::optional<Eigen::Vector3d>& step, MotionPrediction& prediction);

  /// Inverse depth of what is near `pixel` in the image before the last update(), in units of 1 / the step of
  /// that update; nothing when no corner has one.
  std::optional<DepthGuess> depthNear(const Eigen::Vector2f& pixel) const;

 private:
  struct Known {
    bool followed{false};                      ///< into this image, whether it was found or not
    Eigen::Vector3d ray{0.0, 0.0, 1.0};        ///< in the last image, z = 1
    double inverse_depth{0.0};                 ///< there; 0: not known yet
    Eigen::Vector2f pixel_before{0.0F, 0.0F};  ///< in the image before that [px]
    double inverse_before{0.0};                ///< there
  };

  void rememberPlaces();
  /// How much longer the `step` of an odometry is than its last; nothing when either is unknown.
  std::optional<double> odometryRatio(const std::optional<Eigen::Vector3d>& step) const;
  /// How much longer this step is than the last, and how the camera turned, if it went on as before.
  double steadyRatio(double interval_s) const;
  Eigen::Matrix3d steadyRotation(double interval_s) const;
  /// Follows the corners from where `rotation` puts them, and takes the motion from them; not known when
  /// fewer than `min_inliers` agree.
  EgoMotion follow(const ImagePyramid& pyramid, double interval_s, const Eigen::Matrix3d& rotation,
                   const std::optional<MeasuredRotation>& measured, std::size_t min_inliers);
  /// Takes the motion that the corners alone show instead of `motion`, which is bound to the gyroscope, where
  /// more of them agree with it: a gyroscope is wrong whose stamps are late, for one.
  void askCornersAlone(const MeasuredRotation& measured, EpipolarEstimator::Prior prior, EgoMotion& motion);
  /// Where the prediction led the corners astray: from the gyroscope's rotation, or without it from going on
  /// as before and from a few turns. Corrects the prediction when it finds them again.
  EgoMotion followFromElsewhere(const ImagePyramid& pyramid, double interval_s,
                                const std::optional<MeasuredRotation>& measured,
                                MotionPrediction& prediction);
  void expect(const Eigen::Matrix3d& rotation, double interval_s);
  void collectPairs(const Eigen::Matrix3d& rotation);
  double stepRatio(const EgoMotion& motion, double fallback);
  void learnDepths(const EgoMotion& motion, double ratio);

  std::shared_ptr<const CameraModel> camera_;
  double focal_{0.0};
  CornerTracker corners_;
  EpipolarEstimator estimator_;
  std::vector<Known> known_;
  std::vector<PointPair> pairs_;
  std::vector<PointPair> free_pairs_;  ///< the same, where no gyroscope is asked
  std::vector<std::size_t> slots_;     ///< of the pairs
  std::vector<double> ratios_;
  Eigen::Vector3d translation_{Eigen::Vector3d::Zero()};  ///< of the last step
  Eigen::Vector3d rotation_{Eigen::Vector3d::Zero()};     ///< of the last step, rotation vector [rad]
  double last_interval_s_{0.0};
  double last_step_m_{0.0};  ///< length of the odometry's last step; 0: not known
};

}  // namespace tet_line_tracker
