#include "trajectory.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "counter_random.h"

namespace tet_line_tracker {
namespace {

/// Of a camera in a hand, along each axis: together 0.6 m/s^2 rms.
struct Sway {
  double amplitude, frequency_hz;
};
constexpr Sway kSwaySlow{0.035, 0.7};
constexpr Sway kSwayFast{0.006, 1.4};

/// From 0 to 1 with continuous second derivative.
double smoothStep(double t) {
  t = std::min(1.0, std::max(0.0, t));
  return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

}  // namespace

double Trajectory::Signal::at(double time_s) const {
  double value = offset + slope * time_s;
  for (const Wave& wave : waves) {
    value += wave.amplitude * std::sin(2.0 * M_PI * wave.frequency_hz * time_s + wave.phase);
  }
  return value;
}

Trajectory::Trajectory(const TrajectoryOptions& options)
    : bare_wall_view_(options.bare_wall_view), middle_s_(0.5 * options.seconds) {
  RandomSequence random(options.seed, 3);
  const auto add = [&](Channel channel, double amplitude, double frequency_hz) {
    signals_[channel].waves.push_back({amplitude, frequency_hz, random.uniform(0.0, 2.0 * M_PI)});
  };
  const Eigen::Vector3d& centre = options.free_centre;
  const double room_to_sway = options.hand_sway ? kSwaySlow.amplitude + kSwayFast.amplitude : 0.0;
  const Eigen::Vector3d extent = (options.free_half_extent.array() - room_to_sway).max(0.0);
  signals_[kX].offset = centre.x();
  signals_[kY].offset = centre.y();
  signals_[kZ].offset = centre.z();
  /// Wanders within `share` of the free box, at most at about `speed` [m/s] per axis.
  const auto wander = [&](double share, double speed) {
    for (const Channel axis : {kX, kY, kZ}) {
      const double amplitude = share * extent(axis);
      const double frequency_hz = std::min(0.8, speed / (2.0 * M_PI * amplitude));
      add(axis, 0.75 * amplitude, frequency_hz);
      add(axis, 0.25 * amplitude, 1.7 * frequency_hz);
    }
  };

  if (options.motion == "slow") {
    wander(1.0, 0.3);
    add(kYaw, 1.4, 0.025);
    add(kYaw, 0.15, 0.11);
    add(kPitch, 0.12, 0.07);
    add(kRoll, 0.05, 0.09);
  } else if (options.motion == "fast") {
    // Yaw swings at up to 1.5 rad/s: 34 px per image at 20 Hz in the middle of a EuRoC image.
    wander(0.8, 0.6);
    add(kYaw, 1.5 / (2.0 * M_PI * 0.21), 0.21);
    add(kPitch, 0.30 / (2.0 * M_PI * 0.33), 0.33);
    add(kRoll, 0.20 / (2.0 * M_PI * 0.27), 0.27);
  } else if (options.motion == "corridor") {
    signals_[kX].offset = kFlightStart;
    signals_[kX].slope = kFlightSpeed;
    add(kX, 0.15, 0.13);
    add(kY, extent.y(), 0.12);
    add(kZ, extent.z(), 0.17);
    add(kYaw, 0.25, 0.10);
    add(kPitch, 0.06, 0.23);
    add(kRoll, 0.05, 0.19);
  } else if (options.motion == "shake") {
    wander(0.5, 0.15);
    add(kYaw, 0.9, 0.03);
    for (const Channel angle : {kYaw, kPitch, kRoll}) {
      add(angle, 0.030, 2.1);
      add(angle, 0.012, 4.3);
      add(angle, 0.004, 7.3);
    }
    for (const Channel axis : {kX, kY, kZ}) {
      add(axis, 0.008, 1.9);
      add(axis, 0.002, 4.7);
    }
  } else if (options.motion == "rotation") {
    add(kYaw, 1.6, 0.05);
    add(kPitch, 0.25, 0.13);
    add(kRoll, 0.20, 0.09);
  } else if (options.motion == "drive") {
    // 5 to 15 m/s along the street.
    road_.emplace(options.seed);
    signals_[kX].slope = kDriveSpeed;
    add(kX, 3.6 / (2.0 * M_PI * 0.06), 0.06);
    add(kY, extent.y(), 0.07);
    add(kZ, extent.z(), 1.1);
    add(kYaw, 0.010, 0.4);
    add(kPitch, 0.006, 1.3);
    add(kRoll, 0.008, 0.8);
  } else if (options.motion == "still") {
    signals_[kYaw].offset = 0.4;
  } else {
    throw std::invalid_argument(
        "motion \"" + options.motion +
        "\" is not known; known: slow, fast, corridor, shake, rotation, still, drive");
  }
  if (options.hand_sway) {
    for (const Channel axis : {kX, kY, kZ}) {
      for (const Sway& sway : {kSwaySlow, kSwayFast}) add(axis, sway.amplitude, sway.frequency_hz);
    }
  }
}

double Trajectory::bareWallWeight(double time_s) const {
  const double from_middle = std::abs(time_s - middle_s_) - 0.5 * kBareWallHold;
  // Some of the motion stays: shaken hands shake in front of a bare wall too.
  return 0.95 * (1.0 - smoothStep(from_middle / kBareWallTurn));
}

Eigen::Isometry3d Trajectory::worldFromCamera(double time_s) const {
  std::array<double, kChannels> value{};
  for (std::size_t i = 0; i < value.size(); ++i) value[i] = signals_[i].at(time_s);
  if (bare_wall_view_) {
    const Eigen::Vector3d& p = bare_wall_view_->position;
    const std::array<double, kChannels> there{p.x(), p.y(), p.z(), bare_wall_view_->yaw, 0.0, 0.0};
    const double weight = bareWallWeight(time_s);
    for (std::size_t i = 0; i < value.size(); ++i) value[i] += weight * (there[i] - value[i]);
  }
  if (road_) {
    const double x = value[kX];
    const Eigen::Vector2d place = road_->beside(x, value[kY]);
    value[kX] = place.x();
    value[kY] = place.y();
    value[kYaw] += road_->heading(x);
  }
  Eigen::Matrix3d level;  // optical axes of a camera that looks along x, in the world
  level << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << value[kX], value[kY], value[kZ];
  pose.linear() = (Eigen::AngleAxisd(value[kYaw], Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(-value[kPitch], Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(value[kRoll], Eigen::Vector3d::UnitX()))
                      .toRotationMatrix() *
                  level;
  return pose;
}

}  // namespace tet_line_tracker
