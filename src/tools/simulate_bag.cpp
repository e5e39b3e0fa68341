#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>

#include <std_msgs/String.h>
#include <boost/algorithm/string/join.hpp>

#include "../simulation/odometry.h"
#include "../simulation/simulation.h"
#include "output_file.h"
#include "program.h"
#include "sequence_bag.h"
#include "tet_line_tracker/camera/calibration_file.h"

namespace po = boost::program_options;
using namespace tet_line_tracker;

namespace {

struct Arguments {
  std::string out;
  std::string camera_info;
  SimulationOptions simulation;
  bool no_imu{false};
  bool noise_free_imu{false};
  bool odometry{false};
  double imu_time_offset_s{0.0};
  double imu_bias_rad_s{0.0};
  double imu_misalignment_deg{0.0};
};

void checkRange(const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  std::ostringstream sentence;
  sentence << name << " is " << value << ", needs " << low << ".." << high;
  throw std::invalid_argument(sentence.str());
}

ros::Time toRosTime(std::int64_t stamp_ns) {
  ros::Time stamp;
  return stamp.fromNSec(static_cast<std::uint64_t>(stamp_ns));
}

/// Gives their number.
int writeImuSamples(SequenceBag& bag, const Simulation& simulation, const Arguments& arguments) {
  constexpr double kRate = 200.0;   // [Hz]
  constexpr double kMargin = 0.05;  // before the first image and after the last [s]
  InertialErrors errors(arguments.simulation.seed, kRate);
  const double end_s = simulation.timeOf(simulation.imageStamp(simulation.imageCount() - 1)) + kMargin;
  const int count = static_cast<int>(std::ceil((end_s + kMargin) * kRate)) + 1;
  // About an axis that is none of the camera's.
  const Eigen::AngleAxisd misalignment(arguments.imu_misalignment_deg * M_PI / 180.0,
                                       Eigen::Vector3d(2.0, -1.0, 1.0).normalized());
  const Eigen::Isometry3d camera_from_imu = defaultCameraFromImu() * misalignment;
  for (int i = 0; i < count; ++i) {
    const double time_s = i / kRate - kMargin;
    const InertialSample ideal = idealInertialSample(simulation.trajectory(), camera_from_imu, time_s);
    InertialSample sample = arguments.noise_free_imu ? ideal : errors.apply(ideal);
    sample.angular_velocity.array() += arguments.imu_bias_rad_s;
    bag.writeImu(toRosTime(simulation.stampAt(time_s + arguments.imu_time_offset_s)), sample.angular_velocity,
                 sample.acceleration);
  }
  return count;
}

void writeOdometry(SequenceBag& bag, const Simulation& simulation, const Arguments& arguments) {
  constexpr double kRate = 50.0;   // [Hz]
  constexpr double kMargin = 0.1;  // before the first image and after the last [s]
  SimulatedOdometry odometry(simulation.trajectory(), arguments.simulation.motion == "drive",
                             arguments.simulation.seed, -kMargin);
  const double end_s = simulation.timeOf(simulation.imageStamp(simulation.imageCount() - 1)) + kMargin;
  const int count = static_cast<int>(std::ceil((end_s + kMargin) * kRate)) + 1;
  for (int i = 0; i < count; ++i) {
    const double time_s = i / kRate - kMargin;
    bag.writeOdometry(toRosTime(simulation.stampAt(time_s)), odometry.advance(time_s));
  }
}

int simulate(const Arguments& arguments) {
  checkOutput(arguments.out, {arguments.camera_info});
  const bool street = arguments.simulation.motion == "drive";
  const CameraCalibration camera = !arguments.camera_info.empty()
                                       ? readCalibrationFile(arguments.camera_info).camera
                                   : street ? streetCamera()
                                            : defaultSimulatedCamera();
  Simulation simulation(arguments.simulation, makeCameraModel(camera));
  const ros::Time first_stamp = toRosTime(simulation.imageStamp(0));
  // The IMU begins a little earlier, and transforms come before all that needs them.
  const ros::Time transform_stamp = first_stamp - SequenceBag::kCameraInfoLead;
  SequenceBag bag(
      arguments.out, camera, arguments.no_imu ? std::nullopt : std::make_optional(defaultCameraFromImu()),
      transform_stamp, arguments.odometry ? std::make_optional(defaultCameraFromBody(street)) : std::nullopt);
  std_msgs::String scene;
  scene.data = simulation.geometry().toText();
  bag.write(kSceneTopic, transform_stamp, scene);
  const int imu_samples = arguments.no_imu ? 0 : writeImuSamples(bag, simulation, arguments);
  if (arguments.odometry) writeOdometry(bag, simulation, arguments);

  const int count = simulation.imageCount();
  ProgressBar progress(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    throwIfInterrupted();
    const std::int64_t stamp_ns = simulation.imageStamp(i);
    const ros::Time stamp = toRosTime(stamp_ns);
    bag.writePose(stamp, simulation.trajectory().worldFromCamera(simulation.timeOf(stamp_ns)));
    bag.writeImage(stamp, simulation.nextImage());
    progress.advance();
  }
  bag.close();
  std::printf("%s: %d images, %d IMU samples, %g s\n", arguments.out.c_str(), count, imu_samples,
              arguments.simulation.seconds);
  return 0;
}

int run(int argc, char** argv) {
  Arguments arguments;
  SimulationOptions& simulation = arguments.simulation;
  std::string effects = "none";
  std::string distractors = "none";
  po::options_description options;
  options.add_options()("out", po::value(&arguments.out)->required(), "bag to write");
  options.add_options()("scene", po::value(&simulation.scene),
                        "room, corridor, empty or street (default: what suits the motion)");
  options.add_options()(
      "motion", po::value(&simulation.motion)->default_value(simulation.motion),
      "slow, fast, corridor, shake, rotation, still, or drive (5 to 15 m/s along the street)");
  options.add_options()("light", po::value(&simulation.light)->default_value(simulation.light),
                        "normal, or a list of low, gain_jumps, drift (low,drift)");
  options.add_options()("seconds", po::value(&simulation.seconds)->default_value(simulation.seconds),
                        "from the first image to the last [s]");
  options.add_options()(
      "rate", po::value(&simulation.rate_hz),
      "images per second, whose exposure does not depend on it (default: 20, for drive 10) [Hz]");
  options.add_options()("seed", po::value(&simulation.seed)->default_value(simulation.seed),
                        "of all that is random");
  options.add_options()("moving-object", po::bool_switch(&simulation.moving_object),
                        "a crate swings to and fro in view");
  options.add_options()(
      "hand-sway", po::bool_switch(&simulation.hand_sway),
      "the camera sways as in a hand, with about 1 m/s^2: an estimator needs it for the scale");
  options.add_options()("textureless-phase", po::bool_switch(&simulation.textureless_phase),
                        "the camera looks at a bare wall for 1.5 s in the middle");
  options.add_options()("camera-effects", po::value(&effects)->default_value(effects)->value_name("LIST"),
                        ("all or a list of what the camera does to its pictures: " +
                         boost::algorithm::join(cameraEffectNames(), ", "))
                            .c_str());
  options.add_options()("distractors",
                        po::value(&distractors)->default_value(distractors)->value_name("LIST"),
                        ("all or a list of things in the room whose lines are no straight edges: " +
                         boost::algorithm::join(distractorNames(), ", "))
                            .c_str());
  options.add_options()("camera-info", po::value(&arguments.camera_info)->value_name("FILE"),
                        "calibration of the camera (default: EuRoC's cam0, for drive KITTI's)");
  options.add_options()("no-imu", po::bool_switch(&arguments.no_imu), "write no IMU and no extrinsics");
  options.add_options()("noise-free-imu", po::bool_switch(&arguments.noise_free_imu),
                        "IMU without noise and bias");
  options.add_options()(
      "odometry", po::bool_switch(&arguments.odometry),
      "also write /odom (nav_msgs/Odometry) with errors; for drive that of wheels: no pitch, "
      "no roll, no slip");
  options.add_options()("imu-time-offset", po::value(&arguments.imu_time_offset_s)->value_name("S"),
                        "stamps of the IMU are later by this than those of images, -0.5 to 0.5 [s]");
  options.add_options()("imu-bias", po::value(&arguments.imu_bias_rad_s)->value_name("RAD_S"),
                        "added to each axis of the gyroscope, -1 to 1 [rad/s]");
  options.add_options()("imu-misalignment", po::value(&arguments.imu_misalignment_deg)->value_name("DEG"),
                        "the IMU is turned by this from where its transform says, 0 to 180 [deg]");
  const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  options.add_options()("threads", po::value(&simulation.threads)->default_value(cores),
                        "for rendering; the bag does not depend on it");
  po::positional_options_description positional;
  positional.add("out", 1);
  po::variables_map values;
  if (!parseCommandLine(argc, argv, "simulate_bag OUT.bag [options]", options, positional, values)) return 0;
  checkRange("imu-time-offset", arguments.imu_time_offset_s, -0.5, 0.5);
  checkRange("imu-bias", arguments.imu_bias_rad_s, -1.0, 1.0);
  checkRange("imu-misalignment", arguments.imu_misalignment_deg, 0.0, 180.0);
  simulation.camera_effects = parseCameraEffects(effects);
  simulation.distractors = parseDistractors(distractors);
  if (values.count("rate") == 0 && simulation.motion == "drive") simulation.rate_hz = 10.0;
  return simulate(arguments);
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram("simulate_bag", [&] { return run(argc, argv); });
}
