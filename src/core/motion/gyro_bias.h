#pragma once

#include <Eigen/Core>

namespace tet_line_tracker {

/// Learns the bias of a gyroscope from what it measures beyond the rotation that the images show: a mean over
/// all images at first, which an exponential one of kTimeConstant follows. Parallax, blur and moving objects
/// disturb single images, so once the mean has settled large innovations count less, and absurd ones never
/// count; the bias itself may have any size.
class GyroBias {
 public:
  /// `measured`, `seen`: rotation vectors of the same interval [rad] by the gyroscope and by the images, in
  /// one frame. Ignored when not finite.
  void learn(const Eigen::Vector3f& measured, const Eigen::Vector3f& seen, float interval_s);

  /// [rad/s]
  const Eigen::Vector3f& value() const { return value_; }
  /// Forgets all: for another gyroscope, or another pose of it.
  void reset() { *this = GyroBias(); }

  static constexpr float kTimeConstant = 5.0F;       ///< [s]
  static constexpr float kSettlingTime = 1.0F;       ///< [s]
  static constexpr float kClippedInnovation = 0.1F;  ///< after it a larger one counts as this [rad/s]
  static constexpr float kMaxInnovation = 1.0F;      ///< a larger one is a wrong rotation [rad/s]

 private:
  Eigen::Vector3f value_{Eigen::Vector3f::Zero()};
  float learned_s_{0.0F};  ///< time that the mean is of, at most kTimeConstant
};

}  // namespace tet_line_tracker
