#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <ros/time.h>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "tet_line_tracker/camera/camera_model.h"

namespace tet_line_tracker {

/// Seconds that are added to the stamps of formats that count from 0, since a zero stamp means "not set" in
/// ROS.
constexpr double kFirstStampS = 1.0;

/// What the command line says of a dataset.
struct DatasetOptions {
  std::optional<double> rate_hz;            ///< images per second, for formats without stamps
  std::optional<CameraCalibration> camera;  ///< replaces what the dataset says of its lens
};

struct StampedImage {
  ros::Time stamp;
  cv::Mat image;
};

/// Images in the order of their stamps, read one by one.
class ImageSequence {
 public:
  virtual ~ImageSequence() = default;

  /// Number of images; an estimate for video files.
  virtual std::size_t size() const = 0;
  /// The next image; nothing after the last one. Throws std::runtime_error that names the file at fault.
  virtual std::optional<StampedImage> next() = 0;
};

struct ImuSample {
  ros::Time stamp;
  Eigen::Vector3d angular_velocity;  ///< [rad/s]
  Eigen::Vector3d acceleration;      ///< specific force [m/s^2]
};

struct StampedPose {
  ros::Time stamp;
  Eigen::Isometry3d pose;
};

/// A recorded sequence of one camera, whatever its format on disk.
struct Dataset {
  std::optional<CameraCalibration> camera;
  std::optional<Eigen::Isometry3d> camera_from_imu;
  std::unique_ptr<ImageSequence> images;  ///< 8UC1, 8UC3 (BGR) or 16UC1
  std::unique_ptr<ImageSequence> depth;   ///< 16UC1 [mm], 0: unknown; null: the dataset has none
  std::vector<ImuSample> imu;             ///< stamps increase
  std::vector<StampedPose> ground_truth;  ///< camera in the world at the stamps of the truth, which increase
};

/// Names of the formats that openDataset() knows.
const std::vector<std::string>& datasetFormats();

/// Opens a dataset. Throws std::runtime_error with one sentence that names the file (and line) at fault.
Dataset openDataset(const std::string& format, const std::filesystem::path& path,
                    const DatasetOptions& options);

/// EuRoC MAV in ASL folders: `mav0` or its parent; cam0, imu0, state_groundtruth_estimate0 (or mocap0).
Dataset openEuroc(const std::filesystem::path& path, const DatasetOptions& options);
/// A folder of images in natural order of their names, kDefaultImageRateHz unless told otherwise.
Dataset openImages(const std::filesystem::path& path, const DatasetOptions& options);
constexpr double kDefaultImageRateHz = 20.0;
/// TUM RGB-D: rgb.txt, depth.txt, groundtruth.txt; the folder's name (freiburg1..3) says the intrinsics.
Dataset openTum(const std::filesystem::path& path, const DatasetOptions& options);
/// ICL-NUIM in its TUM-compatible form: associations.txt and groundtruth.txt or *.gt.freiburg, in frame
/// numbers.
Dataset openIclNuim(const std::filesystem::path& path, const DatasetOptions& options);
constexpr double kIclNuimRateHz = 30.0;
/// KITTI odometry: image_0 (or image_2), times.txt, calib.txt, poses.txt.
Dataset openKitti(const std::filesystem::path& path, const DatasetOptions& options);
/// A video file at the rate that it tells, or that of the command line.
Dataset openVideo(const std::filesystem::path& path, const DatasetOptions& options);

}  // namespace tet_line_tracker
