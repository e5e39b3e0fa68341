#include <stdexcept>

#include "../yaml_file.h"
#include "image_files.h"
#include "text_table.h"
#include "trajectory.h"

namespace tet_line_tracker {
namespace {

namespace fs = std::filesystem;

/// Pose of a sensor in the body's frame (T_BS) from its sensor.yaml.
Eigen::Isometry3d readBodyFromSensor(const fs::path& file) {
  const YAML::Node matrix = loadYaml(file)["T_BS"];
  const std::string where = file.string() + ": T_BS";
  if (!matrix || !matrix.IsMap()) throw std::runtime_error(where + " is missing or not a matrix");
  const std::vector<double> data = yamlNumbers(matrix["data"], 16, where + "/data");
  Eigen::Isometry3d pose;
  pose.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(data.data());
  constexpr double kRounding = 1e-3;
  if (!(pose.linear() * pose.linear().transpose()).isIdentity(kRounding) ||
      pose.linear().determinant() < 0.0 || !pose.matrix().row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1))) {
    throw std::runtime_error(where + " is not a rotation and a translation");
  }
  return pose;
}

/// The same where a dataset may leave the file out, since the sensor's frame is the body's.
Eigen::Isometry3d readBodyFromSensorIfThere(const fs::path& file) {
  return fs::exists(file) ? readBodyFromSensor(file) : Eigen::Isometry3d::Identity();
}

CameraCalibration readCamera(const fs::path& file) {
  const YAML::Node root = loadYaml(file);
  const std::string where = file.string() + ": ";
  const std::string projection = yamlText(root["camera_model"], where + "camera_model");
  if (projection != "pinhole") {
    throw std::runtime_error(where + "camera_model \"" + projection + "\" is not known; known: pinhole");
  }
  yamlNumbers(root["resolution"], 2, where + "resolution");
  const std::vector<double> k = yamlNumbers(root["intrinsics"], 4, where + "intrinsics");
  CameraCalibration camera;
  camera.width = yamlSize(root["resolution"][0], where + "resolution[0]");
  camera.height = yamlSize(root["resolution"][1], where + "resolution[1]");
  camera.fx = k[0];
  camera.fy = k[1];
  camera.cx = k[2];
  camera.cy = k[3];
  camera.distortion = yamlNumbers(root["distortion_coefficients"], 4, where + "distortion_coefficients");
  const std::string model = yamlText(root["distortion_model"], where + "distortion_model");
  if (model == "radial-tangential" || model == "radtan") {
    camera.model = "plumb_bob";
    camera.distortion.push_back(0.0);  // ROS writes k1 k2 p1 p2 k3
  } else if (model == "equidistant") {
    camera.model = "equidistant";
  } else {
    throw std::runtime_error(where + "distortion_model \"" + model +
                             "\" is not known; known: radial-tangential, radtan, equidistant");
  }
  const std::vector<std::string> broken = check(camera);
  if (!broken.empty()) throw std::runtime_error(where + broken.front());
  return camera;
}

std::vector<StampedFile> readImageList(const fs::path& folder) {
  std::vector<StampedFile> files;
  for (const TextRow& row : readTextTable(folder / "data.csv", 2)) {
    files.push_back({row.nanoseconds(0), folder / "data" / row.text(1)});
  }
  return files;
}

std::vector<ImuSample> readImu(const fs::path& file) {
  std::vector<ImuSample> samples;
  for (const TextRow& row : readTextTable(file, 7)) {
    samples.push_back({row.nanoseconds(0), row.vector(1), row.vector(4)});
    if (samples.size() > 1 && samples.back().stamp <= samples[samples.size() - 2].stamp) {
      throw std::runtime_error(row.where() + ": the stamp is not after that of the line before");
    }
  }
  return samples;
}

}  // namespace

Dataset openEuroc(const fs::path& path, const DatasetOptions& options) {
  const fs::path root = fs::exists(path / "mav0") ? path / "mav0" : path;
  const fs::path cam0 = root / "cam0";
  if (!fs::is_directory(cam0))
    throw std::runtime_error("neither " + (path / "mav0" / "cam0").string() + " nor " +
                             (path / "cam0").string() + " is a folder");
  const Eigen::Isometry3d body_from_camera = readBodyFromSensor(cam0 / "sensor.yaml");

  Dataset dataset;
  dataset.camera = options.camera ? *options.camera : readCamera(cam0 / "sensor.yaml");
  dataset.images = std::make_unique<ImageFileSequence>((cam0 / "data.csv").string(), readImageList(cam0));
  if (fs::exists(root / "imu0")) {
    dataset.imu = readImu(root / "imu0" / "data.csv");
    dataset.camera_from_imu =
        body_from_camera.inverse() * readBodyFromSensorIfThere(root / "imu0" / "sensor.yaml");
  }
  for (const char* name : {"state_groundtruth_estimate0", "mocap0"}) {
    if (!fs::exists(root / name)) continue;
    const Eigen::Isometry3d body_from_truth = readBodyFromSensorIfThere(root / name / "sensor.yaml");
    for (const TextRow& row : readTextTable(root / name / "data.csv", 8)) {
      dataset.ground_truth.push_back(
          {row.nanoseconds(0), row.poseScalarFirst(1) * body_from_truth.inverse() * body_from_camera});
    }
    sortTrajectory(dataset.ground_truth);
    break;
  }
  return dataset;
}

}  // namespace tet_line_tracker
