#include <stdexcept>

#include "image_files.h"
#include "rgbd_files.h"
#include "text_table.h"

namespace tet_line_tracker {
namespace {

namespace fs = std::filesystem;

/// Colour camera of one of the three sensors, as the dataset's page gives them, 640x480.
CameraCalibration freiburgCamera(int sensor) {
  switch (sensor) {
    case 1:
      return {"plumb_bob", 640, 480, 517.3, 516.5, 318.6, 255.3, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}};
    case 2:
      return {"plumb_bob", 640, 480, 520.9, 521.0, 325.1, 249.7, {0.2312, -0.7849, -0.0033, -0.0001, 0.9172}};
    default:  // images of the third one are already undistorted
      return {"plumb_bob", 640, 480, 535.4, 539.2, 320.1, 247.6, {0.0, 0.0, 0.0, 0.0, 0.0}};
  }
}

/// The dataset does not store its intrinsics: the folder's name says which sensor it was.
CameraCalibration cameraFromFolderName(const fs::path& folder) {
  const fs::path whole = fs::canonical(folder);
  const std::string name = whole.filename().string();
  for (int sensor = 1; sensor <= 3; ++sensor) {
    const std::string number = std::to_string(sensor);
    if (name.find("freiburg" + number) != std::string::npos ||
        name.find("fr" + number) != std::string::npos) {
      return freiburgCamera(sensor);
    }
  }
  throw std::runtime_error(
      "the folder name \"" + name +
      "\" holds none of freiburg1, freiburg2, freiburg3 (fr1, fr2, fr3), which would say "
      "the intrinsics: --camera-info is needed");
}

std::vector<StampedFile> readImageList(const fs::path& root, const char* name) {
  std::vector<StampedFile> files;
  for (const TextRow& row : readTextTable(root / name, 2)) {
    files.push_back({row.seconds(0), root / row.text(1)});
  }
  return files;
}

}  // namespace

Dataset openTum(const fs::path& path, const DatasetOptions& options) {
  Dataset dataset;
  dataset.images =
      std::make_unique<ImageFileSequence>((path / "rgb.txt").string(), readImageList(path, "rgb.txt"));
  dataset.camera = options.camera ? *options.camera : cameraFromFolderName(path);
  if (fs::exists(path / "depth.txt")) {
    dataset.depth = std::make_unique<DepthFileSequence>(
        (path / "depth.txt").string(), readImageList(path, "depth.txt"), kRgbdDepthUnitsPerM);
  }
  if (fs::exists(path / "groundtruth.txt")) {
    dataset.ground_truth = readRgbdTrajectory(path / "groundtruth.txt", TrajectoryStamps::kSeconds);
  }
  return dataset;
}

}  // namespace tet_line_tracker
