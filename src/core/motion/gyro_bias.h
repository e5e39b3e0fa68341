#pragma once

#include <algorithm>

#include <Eigen/Core>

namespace tet_line_tracker {

/// Learns the bias of a gyroscope from what it measures beyond the rotation that the images show: a mean over
/// all images at first, which an exponential one of kTimeConstant follows. Parallax, blur and moving objects
/// disturb single images, so once the mean has settled large innovations count less, and absurd ones never
/// count; the bias itself may have any size.
class GyroBias {
 public:
  /// The gyroscope has agreed with the images for a while.
  bool isTrusted() const { return learned_s_ >= kTrustTime && mean_innovation_ < kTrustedInnovation; }
  /// Of value(), as far as it has been learned [rad/s].
  float deviation() const { return std::max(0.01F, 0.1F / (1.0F + 10.0F * learned_s_)); }
  /// `measured`, `seen`: rotation vectors of the same interval [rad] by the gyroscope and by the images, in
  /// one frame. Ignored when not finite.
  void learn(const Eigen::Vector3f& measured, const Eigen::Vector3f& seen, float interval_s);

  /// The images did not show how the camera turned.
  void doubt() { notice(kDoubt); }

  /// [rad/s]
  const Eigen::Vector3f& value() const { return value_; }
  /// Forgets all: for another gyroscope, or another pose of it.
  void reset() { *this = GyroBias(); }

  static constexpr float kTimeConstant = 5.0F;        ///< [s]
  static constexpr float kSettlingTime = 1.0F;        ///< [s]
  static constexpr float kClippedInnovation = 0.1F;   ///< after it a larger one counts as this [rad/s]
  static constexpr float kTrustTime = 0.5F;           ///< [s]
  static constexpr float kDoubt = 0.05F;              ///< 8 in a row end the trust [rad/s]
  static constexpr float kTrustedInnovation = 0.04F;  ///< [rad/s]
  static constexpr float kMaxInnovation = 1.0F;       ///< a larger one is a wrong rotation [rad/s]

 private:
  void notice(float innovation);

  Eigen::Vector3f value_{Eigen::Vector3f::Zero()};
  float mean_innovation_{0.0F};  ///< of the last images [rad/s]
  float learned_s_{0.0F};        ///< time that the mean is of, at most kTimeConstant
};

}  // namespace tet_line_tracker
