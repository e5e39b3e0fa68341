#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "camera_effects.h"
#include "distractors.h"
#include "inertial.h"
#include "light.h"
#include "renderer.h"
#include "sensor.h"
#include "tet_line_tracker/camera/camera_model.h"
#include "trajectory.h"
#include "world.h"

namespace tet_line_tracker {

struct SimulationOptions {
  std::string motion{"slow"};   ///< slow, fast, corridor, shake, rotation, still, drive
  std::string scene;            ///< room, corridor, empty, street; empty string: what suits the motion
  std::string light{"normal"};  ///< normal, or a list of low, gain_jumps, drift
  double seconds{20.0};         ///< from the first image to the last, above 0 [s]
  double rate_hz{20.0};         ///< images per second, above 0, at most 1 / exposure [Hz]
  std::uint64_t seed{1};
  bool moving_object{false};      ///< a crate swings through the view
  bool hand_sway{false};          ///< the camera sways with about 1 m/s^2, as in a hand
  bool textureless_phase{false};  ///< a bare wall alone in view for 1.5 s in the middle
  CameraEffects camera_effects;
  Distractors distractors;  ///< in scene room
  int threads{1};           ///< for rendering
  std::int64_t first_stamp_ns{1000000000000};
};

/// Camera of EuRoC's cam0.
CameraCalibration defaultSimulatedCamera();
/// Left gray camera of KITTI's first odometry sequences, rectified: that of the street.
CameraCalibration streetCamera();
/// Pose of the IMU in the camera, as in EuRoC.
Eigen::Isometry3d defaultCameraFromImu();

/// A camera and an IMU on their way through a world: everything that a simulated sequence holds.
class Simulation {
 public:
  /// Throws std::invalid_argument that names the option at fault.
  Simulation(const SimulationOptions& options, std::shared_ptr<const CameraModel> camera);

  /// Geometry, with the arguments that made it.
  const SceneGeometry& geometry() const { return world_.geometry; }
  const World& world() const { return world_; }
  const Trajectory& trajectory() const { return trajectory_; }

  int imageCount() const;
  /// Middle of the exposure of an image, 0 .. imageCount() - 1.
  std::int64_t imageStamp(int number) const;
  double timeOf(std::int64_t stamp_ns) const;
  std::int64_t stampAt(double time_s) const;

  /// The next image (CV_8UC1), in order from number 0.
  cv::Mat nextImage();
  /// Without lens blur, noise and motion blur (CV_32FC1, 8-bit gray levels), at any stamp.
  cv::Mat idealImage(std::int64_t stamp_ns);

 private:
  double meanRadiance() const;
  /// What falls on the sensor in an exposure whose middle, for the middle row, is `time_s`.
  cv::Mat radiance(double time_s);
  cv::Mat radianceByRows(double time_s);
  std::vector<View> exposureViews(double time_s) const;

  SimulationOptions options_;
  std::shared_ptr<const CameraModel> camera_;
  World world_;
  Trajectory trajectory_;
  Renderer renderer_;
  Sensor sensor_;
  LightSchedule light_;
  double brightness_;
  int next_image_{0};
};

}  // namespace tet_line_tracker
