#include <stdexcept>

#include "image_files.h"
#include "rgbd_files.h"
#include "text_table.h"

namespace tet_line_tracker {
namespace {

namespace fs = std::filesystem;

/// The camera of the renderer. Its y axis points up, against the rows of the image, and so does that of the
/// published trajectories: fy is negative. Numbers and poses are passed on as published; they only fit
/// together. Flipping the sign of fy alone would mirror the scene against its trajectory.
CameraCalibration iclNuimCamera() {
  return {"plumb_bob", 640, 480, 481.2, -480.0, 319.5, 239.5, {0.0, 0.0, 0.0, 0.0, 0.0}};
}

/// `groundtruth.txt`, or the name under which the trajectories are published.
std::optional<fs::path> findTrajectory(const fs::path& root) {
  if (fs::exists(root / "groundtruth.txt")) return root / "groundtruth.txt";
  for (const auto& entry : fs::directory_iterator(root)) {
    const std::string name = entry.path().filename().string();
    static const std::string kEnding = ".gt.freiburg";
    if (name.size() > kEnding.size() &&
        name.compare(name.size() - kEnding.size(), kEnding.size(), kEnding) == 0) {
      return entry.path();
    }
  }
  return std::nullopt;
}

bool isDepth(const std::string& name) {
  return name.rfind("depth", 0) == 0 || name.rfind("./depth", 0) == 0;
}

}  // namespace

Dataset openIclNuim(const fs::path& path, const DatasetOptions& options) {
  const double rate_hz = options.rate_hz.value_or(kIclNuimRateHz);
  const fs::path list = path / "associations.txt";
  std::vector<StampedFile> images;
  std::vector<StampedFile> depth;
  for (const TextRow& row : readTextTable(list, 4)) {
    const bool depth_first = isDepth(row.text(1));
    if (depth_first == isDepth(row.text(3))) {
      throw std::runtime_error(row.where() + ": needs one image below depth/ and one of colour");
    }
    const std::size_t depth_field = depth_first ? 0 : 2;
    const std::size_t image_field = 2 - depth_field;
    depth.push_back({frameStamp(row.frameNumber(depth_field), rate_hz), path / row.text(depth_field + 1)});
    images.push_back({frameStamp(row.frameNumber(image_field), rate_hz), path / row.text(image_field + 1)});
  }
  Dataset dataset;
  dataset.camera = options.camera ? *options.camera : iclNuimCamera();
  dataset.images = std::make_unique<ImageFileSequence>(list.string(), std::move(images));
  dataset.depth = std::make_unique<DepthFileSequence>(list.string(), std::move(depth), kRgbdDepthUnitsPerM);
  if (const std::optional<fs::path> file = findTrajectory(path)) {
    dataset.ground_truth = readRgbdTrajectory(*file, TrajectoryStamps::kFrameNumbers, rate_hz);
  }
  return dataset;
}

}  // namespace tet_line_tracker
