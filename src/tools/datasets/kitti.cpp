#include <stdexcept>

#include "image_files.h"
#include "text_table.h"
#include "trajectory.h"

namespace tet_line_tracker {
namespace {

namespace fs = std::filesystem;

/// A rectified camera: K, and its place beside camera 0, which the poses are of.
struct RectifiedCamera {
  CameraCalibration calibration;
  Eigen::Isometry3d reference_from_camera;
};

RectifiedCamera readCamera(const fs::path& file, const std::string& name) {
  for (const TextRow& row : readTextTable(file, 1)) {
    if (row.text(0) != name + ":") continue;
    if (row.size() != 13) {
      throw std::runtime_error(row.where() + ": " + name + " has " + std::to_string(row.size() - 1) +
                               " numbers, needs 12");
    }
    RectifiedCamera camera;
    camera.calibration.model = "plumb_bob";
    camera.calibration.distortion.assign(5, 0.0);
    camera.calibration.fx = row.number(1);
    camera.calibration.cx = row.number(3);
    camera.calibration.fy = row.number(6);
    camera.calibration.cy = row.number(7);
    if (camera.calibration.fx == 0.0 || camera.calibration.fy == 0.0) {
      throw std::runtime_error(row.where() + ": " + name + " has a focal length of 0");
    }
    // P = K [I t]: a point of camera 0 moves by t into this camera.
    Eigen::Vector3d t;
    t.z() = row.number(12);
    t.x() = (row.number(4) - camera.calibration.cx * t.z()) / camera.calibration.fx;
    t.y() = (row.number(8) - camera.calibration.cy * t.z()) / camera.calibration.fy;
    camera.reference_from_camera = Eigen::Translation3d(-t) * Eigen::Quaterniond::Identity();
    return camera;
  }
  throw std::runtime_error(file.string() + " holds no line " + name + ":");
}

Eigen::Isometry3d readPose(const TextRow& row) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  std::size_t field = 0;
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 4; ++c) pose.matrix()(r, c) = row.number(field++);
  }
  constexpr double kRounding = 1e-3;
  if (!(pose.linear() * pose.linear().transpose()).isIdentity(kRounding) ||
      pose.linear().determinant() < 0.0) {
    throw std::runtime_error(row.where() + ": the left 3x3 part is not a rotation");
  }
  return pose;
}

/// Beside the images, or where the download of all sequences keeps it: poses/00.txt for sequences/00.
std::optional<fs::path> findPoses(const fs::path& root) {
  if (fs::exists(root / "poses.txt")) return root / "poses.txt";
  const fs::path whole = fs::canonical(root);
  const fs::path beside = whole.parent_path().parent_path() / "poses" / (whole.filename().string() + ".txt");
  return fs::exists(beside) ? std::optional<fs::path>(beside) : std::nullopt;
}

}  // namespace

Dataset openKitti(const fs::path& path, const DatasetOptions& options) {
  // Gray is what the tracker works on; the colour download has image_2 alone.
  const bool colour = !fs::exists(path / "image_0") && fs::exists(path / "image_2");
  const std::vector<fs::path> images = listImages(path / (colour ? "image_2" : "image_0"));
  const std::vector<TextRow> times = readTextTable(path / "times.txt", 1);
  if (times.size() != images.size()) {
    throw std::runtime_error((path / "times.txt").string() + " has " + std::to_string(times.size()) +
                             " stamps for " + std::to_string(images.size()) + " images");
  }
  std::vector<StampedFile> files;
  for (std::size_t i = 0; i < images.size(); ++i) {
    files.push_back({times[i].seconds(0) + ros::Duration(kFirstStampS), images[i]});
  }
  const RectifiedCamera camera = readCamera(path / "calib.txt", colour ? "P2" : "P0");

  Dataset dataset;
  dataset.camera = options.camera ? *options.camera : camera.calibration;
  if (const std::optional<fs::path> poses_file = findPoses(path)) {
    const std::vector<TextRow> poses = readTextTable(*poses_file, 12);
    if (poses.size() != files.size()) {
      throw std::runtime_error(poses_file->string() + " has " + std::to_string(poses.size()) + " poses for " +
                               std::to_string(files.size()) + " images");
    }
    for (std::size_t i = 0; i < poses.size(); ++i) {
      dataset.ground_truth.push_back({files[i].stamp, readPose(poses[i]) * camera.reference_from_camera});
    }
  }
  dataset.images = std::make_unique<ImageFileSequence>((path / "times.txt").string(), std::move(files));
  return dataset;
}

}  // namespace tet_line_tracker
