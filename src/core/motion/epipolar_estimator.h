#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace tet_line_tracker {

/// A point of the scene in two images, as rays of the optical frame with z = 1.
struct PointPair {
  Eigen::Vector3d before;  ///< rotated to the camera of the second image by the predicted rotation
  Eigen::Vector3d now;
  bool inlier{false};         ///< agrees with the motion
  double inverse_depth{0.0};  ///< in the image before, in units of 1 / the camera's step: now ~ before +
                              ///< inverse_depth * translation
};

/// Motion of the camera between two images, beyond the predicted rotation.
struct EgoMotion {
  Eigen::Vector3d rotation{Eigen::Vector3d::Zero()};  ///< correction of the rotation, rotation vector [rad]
  Eigen::Vector3d translation{Eigen::Vector3d::Zero()};  ///< unit vector: how points move in the optical
                                                         ///< frame; zero: not known
  std::size_t inliers{0};
  std::size_t agreeing{0};  ///< the same, and also counted where the rotation alone explains the points
  bool rotates{false};      ///< the rotation is known, also where the translation is too small to be seen
  bool known() const { return !translation.isZero(); }
};

/// Direction of translation from points in two images whose rotation is nearly known: translation . (before x
/// now) = 0 for every static point. RANSAC over pairs of points, then a robust fit of direction and rotation.
/// The same input gives the same result.
class EpipolarEstimator {
 public:
  /// What is known before the points are looked at.
  struct Prior {
    Eigen::Vector3d rotation{Eigen::Vector3d::Zero()};  ///< correction that is likely [rad]
    double rotation_sigma{0.02};                        ///< its deviation [rad]
    Eigen::Vector3d steady{Eigen::Vector3d::Zero()};    ///< correction if the camera goes on turning [rad]
    Eigen::Vector3d translation{
        Eigen::Vector3d::Zero()};  ///< direction if it goes on moving; zero: not known
  };

  /// `focal`: [px]. Sets inlier and inverse_depth of the pairs.
  EgoMotion estimate(std::vector<PointPair>& pairs, double focal, const Prior& prior);

 private:
  /// Median movement of the pairs that `rotation` does not explain [px].
  double parallaxOf(const std::vector<PointPair>& pairs, double focal, const Eigen::Vector3d& rotation);

  struct Candidate {
    Eigen::Vector3d rotation, translation;
    double cost;
  };
  double costOf(const Eigen::Vector3d& translation) const;
  double behindCost(const std::vector<PointPair>& pairs, const Candidate& candidate) const;
  Candidate fit(const std::vector<PointPair>& pairs, const Prior& prior, const Eigen::Vector3d& rotation,
                const Eigen::Vector3d& translation) const;

  struct Constraint {
    Eigen::Vector3d cross;  ///< before x now
    double per_px;          ///< turns translation . cross into px, but for the sine towards the epipole
    Eigen::Vector3d before;
  };
  std::vector<Constraint> constraints_;
  std::vector<double> parallax_;
};

}  // namespace tet_line_tracker
