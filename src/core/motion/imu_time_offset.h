#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include <Eigen/Core>

namespace tet_line_tracker {

/// Estimates by how much the clock of an IMU is ahead of that of a camera: what happens at stamp t of an
/// image has the IMU stamp t + value(), as Kalibr's timeshift_cam_imu and VINS's td. For each of many offsets
/// the rotations that the images show are compared with those that the gyroscope measured in the shifted
/// intervals; the offset whose differences have the smallest variance (so a bias does not matter) wins, by a
/// parabola through its neighbours. Single bad images weigh little, and old ones fade with kTimeConstant. The
/// value moves only when turns observe it well.
class ImuTimeOffset {
 public:
  /// Angular velocity in the IMU's frame [rad/s], in the order of stamps [ns]. The same samples are ignored
  /// as by GyroIntegrator.
  void addAngularVelocity(std::int64_t stamp_ns, const Eigen::Vector3d& angular_velocity);

  /// Rotation vector [rad] that takes directions in the camera at `from_ns` to the same directions at
  /// `to_ns`, as the images alone show it, and the rotation from the IMU's frame to the camera's. It counts
  /// once the samples reach far enough beyond the image.
  void addImageRotation(std::int64_t from_ns, std::int64_t to_ns, const Eigen::Vector3d& seen,
                        const Eigen::Matrix3d& camera_from_imu);

  /// t_imu - t_camera [s], within +-kMaxOffset; 0 until it is known.
  double value() const { return value_s_; }
  /// Standard deviation of the estimate [s]; nothing while it is not observed.
  std::optional<double> sigma() const { return sigma_s_; }

  /// Forgets all: for another IMU.
  void reset() { *this = ImuTimeOffset(); }

  static constexpr double kMaxOffset = 0.1;       ///< [s]
  static constexpr double kTimeConstant = 30.0;   ///< of the fading of old images [s]
  static constexpr double kMaxSigma = 1e-3;       ///< a worse estimate moves nothing [s]
  static constexpr double kDeadBand = 5e-4;       ///< nor does one that differs by less [s]
  static constexpr double kResidualScale = 0.05;  ///< at which an image weighs half [rad/s]

 private:
  struct Sample {
    std::int64_t stamp_ns;
    Eigen::Vector3d angular_velocity;
    Eigen::Vector3d angle;  ///< integral of the angular velocity since the first sample [rad]
  };
  struct Interval {
    std::int64_t from_ns, to_ns;
    Eigen::Vector3d seen;
    Eigen::Matrix3d camera_from_imu;
  };
  /// Of the differences between gyroscope and images at one offset, weighted [rad/s].
  struct Moments {
    Eigen::Vector3d sum{Eigen::Vector3d::Zero()};
    double square_sum{0.0};
  };

  static constexpr std::size_t kCandidates = 57;
  static constexpr std::int64_t kStepNs = 4000000;
  static constexpr std::int64_t kReachNs = kStepNs * static_cast<std::int64_t>(kCandidates / 2);
  static std::int64_t offsetOf(std::size_t candidate) {
    return kStepNs * static_cast<std::int64_t>(candidate) - kReachNs;
  }

  Eigen::Vector3d angleAt(std::int64_t stamp_ns) const;
  bool hasGap(std::int64_t from_ns, std::int64_t to_ns) const;
  void learn(const Interval& interval);
  void estimate();
  double variance(std::size_t candidate) const;

  std::deque<Sample> samples_;
  std::deque<Interval> waiting_;
  std::array<Moments, kCandidates> moments_;
  double weight_{0.0};  ///< of all images that count, faded
  double images_{0.0};  ///< their number, faded
  double value_s_{0.0};
  std::optional<double> sigma_s_;
};

}  // namespace tet_line_tracker
