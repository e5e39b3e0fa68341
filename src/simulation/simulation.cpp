#include "simulation.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace tet_line_tracker {
namespace {

LightOptions lightOptions(const SimulationOptions& options) {
  LightOptions light = parseLight(options.light);
  light.daylight = options.scene == "street";
  return light;
}

SimulationOptions completed(SimulationOptions options) {
  if (!(options.seconds > 0.0 && options.seconds <= 600.0)) {
    throw std::invalid_argument("seconds is " + std::to_string(options.seconds) + ", needs 0..600");
  }
  if (options.scene.empty()) {
    options.scene = options.motion == "corridor" ? "corridor" : options.motion == "drive" ? "street" : "room";
  }
  if (options.motion == "corridor" && options.scene != "corridor") {
    throw std::invalid_argument("motion corridor needs scene corridor, not \"" + options.scene + "\"");
  }
  if ((options.motion == "drive") != (options.scene == "street")) {
    throw std::invalid_argument("motion drive and scene street go together, motion is \"" + options.motion +
                                "\", scene \"" + options.scene + "\"");
  }
  const double highest_rate = 1.0 / LightSchedule(lightOptions(options), 0).exposureSeconds();
  if (!(options.rate_hz > 0.0 && options.rate_hz <= highest_rate)) {
    throw std::invalid_argument("rate is " + std::to_string(options.rate_hz) + " Hz, needs 0.." +
                                std::to_string(static_cast<int>(highest_rate)) +
                                " with this light's exposure");
  }
  return options;
}

WorldOptions worldOptions(const SimulationOptions& options) {
  WorldOptions world;
  world.scene = options.scene;
  world.seed = options.seed;
  constexpr double kFreeWayAhead = 9.0;  // left at the end of the flight [m]
  world.corridor_length =
      Trajectory::kFlightStart + Trajectory::kFlightSpeed * options.seconds + kFreeWayAhead;
  constexpr double kStreetBeyond = 150.0;  // before the start and beyond the end of the drive [m]
  world.street_length = Trajectory::kDriveSpeed * options.seconds + kStreetBeyond;
  world.bare_wall = options.textureless_phase;
  world.moving_object = options.moving_object;
  world.distractors = options.distractors;
  world.motion_origin_ns = options.first_stamp_ns;
  return world;
}

TrajectoryOptions trajectoryOptions(const SimulationOptions& options, const World& world) {
  TrajectoryOptions trajectory;
  trajectory.motion = options.motion;
  trajectory.seconds = options.seconds;
  trajectory.seed = options.seed;
  trajectory.hand_sway = options.hand_sway;
  trajectory.free_centre = world.free_centre;
  trajectory.free_half_extent = world.free_half_extent;
  if (options.textureless_phase) {
    trajectory.bare_wall_view = TrajectoryOptions::BareWallView{world.bare_wall_view, world.bare_wall_yaw};
  }
  return trajectory;
}

std::string text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

}  // namespace

CameraCalibration defaultSimulatedCamera() {
  CameraCalibration camera;
  camera.model = "plumb_bob";
  camera.width = 752;
  camera.height = 480;
  camera.fx = 458.654;
  camera.fy = 457.296;
  camera.cx = 367.215;
  camera.cy = 248.375;
  camera.distortion = {-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05};
  return camera;
}

CameraCalibration streetCamera() {
  CameraCalibration camera;
  camera.model = "plumb_bob";
  camera.width = 1241;
  camera.height = 376;
  camera.fx = 718.856;
  camera.fy = 718.856;
  camera.cx = 607.1928;
  camera.cy = 185.2157;
  return camera;
}

Eigen::Isometry3d defaultCameraFromImu() {
  Eigen::Matrix3d imu_from_camera;
  imu_from_camera << 0.0148655429818, -0.999880929698, 0.00414029679422,  //
      0.999557249008, 0.0149672133247, 0.025715529948,                    //
      -0.0257744366974, 0.00375618835797, 0.999660727178;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translate(Eigen::Vector3d(-0.0216401454975, -0.064676986768, 0.00981073058949));
  pose.rotate(Eigen::Quaterniond(imu_from_camera).normalized());
  return pose.inverse();
}

Simulation::Simulation(const SimulationOptions& options, std::shared_ptr<const CameraModel> camera)
    : options_(completed(options)),
      camera_(std::move(camera)),
      world_(makeWorld(worldOptions(options_))),
      trajectory_(trajectoryOptions(options_, world_)),
      renderer_(camera_, world_, options_.threads),
      sensor_(makeSensor(options_.camera_effects, options_.seed)),
      light_(lightOptions(options_), options_.seed),
      brightness_(light_.meanGray() / meanRadiance()) {
  const auto onOff = [](bool on) { return on ? "yes" : "no"; };
  SceneGeometry& geometry = world_.geometry;
  geometry.addArgument("scene", options_.scene);
  geometry.addArgument("motion", options_.motion);
  geometry.addArgument("light", options_.light);
  geometry.addArgument("seconds", text(options_.seconds));
  geometry.addArgument("rate_hz", text(options_.rate_hz));
  geometry.addArgument("seed", std::to_string(options_.seed));
  geometry.addArgument("moving_object", onOff(options_.moving_object));
  if (options.hand_sway) geometry.addArgument("hand_sway", "yes");
  geometry.addArgument("textureless_phase", onOff(options_.textureless_phase));
  const std::string effects = options_.camera_effects.text();
  if (effects != "none") geometry.addArgument("camera_effects", effects);
  const std::string distractors = options_.distractors.text();
  if (distractors != "none") geometry.addArgument("distractors", distractors);
}

int Simulation::imageCount() const {
  return static_cast<int>(std::floor(options_.seconds * options_.rate_hz + 1e-9)) + 1;
}

std::int64_t Simulation::imageStamp(int number) const {
  return stampAt(number / options_.rate_hz);
}

std::int64_t Simulation::stampAt(double time_s) const {
  return options_.first_stamp_ns + std::llround(time_s * 1e9);
}

double Simulation::timeOf(std::int64_t stamp_ns) const {
  return 1e-9 * static_cast<double>(stamp_ns - options_.first_stamp_ns);
}

double Simulation::meanRadiance() const {
  constexpr int kViews = 24;
  constexpr int kPixelStep = 24;
  const cv::Size size(camera_->calibration().width, camera_->calibration().height);
  double sum = 0.0;
  int count = 0;
  for (int i = 0; i < kViews; ++i) {
    const double time_s = options_.seconds * (i + 0.5) / kViews;
    const Eigen::Isometry3d pose = trajectory_.worldFromCamera(time_s);
    for (int y = kPixelStep / 2; y < size.height; y += kPixelStep) {
      for (int x = kPixelStep / 2; x < size.width; x += kPixelStep) {
        const auto ray = camera_->unproject({x, y});
        if (!ray) continue;
        const auto hit = world_.geometry.raycast(pose.translation(), pose.linear() * *ray, stampAt(time_s));
        if (!hit) continue;
        constexpr float kSide = 0.04F;  // [m]
        sum += static_cast<double>(world_.gray(hit->point, kSide) *
                                   vignettingAt(sensor_, size, static_cast<float>(x), static_cast<float>(y)));
        ++count;
      }
    }
  }
  if (count == 0) throw std::invalid_argument("the camera sees nothing of the scene");
  return sum / count;
}

std::vector<View> Simulation::exposureViews(double time_s) const {
  const double exposure_s = light_.exposureSeconds();
  const Eigen::Isometry3d opened = trajectory_.worldFromCamera(time_s - 0.5 * exposure_s);
  const Eigen::Isometry3d closed = trajectory_.worldFromCamera(time_s + 0.5 * exposure_s);
  const CameraCalibration& calibration = camera_->calibration();
  double longest = 0.0;  // way of a point over the image during the exposure [px]
  constexpr int kGrid = 6;
  for (int j = 0; j <= kGrid; ++j) {
    for (int i = 0; i <= kGrid; ++i) {
      const Eigen::Vector2d pixel((calibration.width - 1) * i / static_cast<double>(kGrid),
                                  (calibration.height - 1) * j / static_cast<double>(kGrid));
      const auto ray = camera_->unproject(pixel);
      if (!ray) continue;
      const std::int64_t opening = stampAt(time_s - 0.5 * exposure_s);
      const auto hit = world_.geometry.raycast(opened.translation(), opened.linear() * *ray, opening);
      if (!hit) continue;
      const Eigen::Vector3d point = world_.geometry.pointAt(hit->point, stampAt(time_s + 0.5 * exposure_s));
      const auto moved = camera_->project(closed.inverse() * point);
      if (moved) longest = std::max(longest, (*moved - pixel).norm());
    }
  }
  constexpr double kStepPx = 1.2;  // finer steps vanish in the width of a pixel and the lens's blur
  constexpr int kMostViews = 24;
  const int count = std::min(kMostViews, std::max(1, static_cast<int>(std::ceil(longest / kStepPx))));
  std::vector<View> views;
  for (int i = 0; i < count; ++i) {
    const double t = time_s + exposure_s * ((i + 0.5) / count - 0.5);
    views.push_back({trajectory_.worldFromCamera(t), stampAt(t)});
  }
  return views;
}

cv::Mat Simulation::radiance(double time_s) {
  return sensor_.effects.rolling_shutter ? radianceByRows(time_s) : renderer_.render(exposureViews(time_s));
}

cv::Mat Simulation::radianceByRows(double time_s) {
  // Some moments of the readout; rows between two of them are a mixture, which moves an edge by parts of a
  // pixel as the camera does.
  constexpr int kBands = 16;
  const int height = camera_->calibration().height;
  const double rows_per_band = static_cast<double>(height - 1) / kBands;
  cv::Mat sum = cv::Mat::zeros(height, camera_->calibration().width, CV_32FC1);
  for (int k = 0; k <= kBands; ++k) {
    const double moment = time_s + CameraEffects::kReadoutSeconds * (static_cast<double>(k) / kBands - 0.5);
    const cv::Range rows(std::max(0, static_cast<int>(std::floor((k - 1) * rows_per_band))),
                         std::min(height, static_cast<int>(std::ceil((k + 1) * rows_per_band)) + 1));
    const cv::Mat seen = renderer_.render(exposureViews(moment), rows);
    for (int y = rows.start; y < rows.end; ++y) {
      const double weight = 1.0 - std::abs(y / rows_per_band - k);
      if (weight > 0.0) cv::scaleAdd(seen.row(y), weight, sum.row(y), sum.row(y));
    }
  }
  return sum;
}

cv::Mat Simulation::nextImage() {
  const int number = next_image_++;
  const double time_s = timeOf(imageStamp(number));
  const double gain = light_.nextGain(time_s);
  const std::uint64_t noise_seed = hash64(hash64(options_.seed, 6), static_cast<std::uint64_t>(number));
  return expose(sensor_, radiance(time_s), brightness_, gain, noise_seed);
}

cv::Mat Simulation::idealImage(std::int64_t stamp_ns) {
  return renderer_.render({{trajectory_.worldFromCamera(timeOf(stamp_ns)), stamp_ns}});
}

}  // namespace tet_line_tracker
