#pragma once

#include <memory>
#include <vector>

#include <opencv2/core.hpp>

#include "pose_track.h"
#include "tet_line_tracker/camera/camera_model.h"
#include "truth.h"

namespace tet_line_tracker {

/// Truth from depth images and poses of a camera in a world that does not move. Depth images need not share
/// the stamps of the images: a point is looked up in the one nearest in time, from where the camera was then.
class DepthTruth : public Truth {
 public:
  /// `depth_mm`: 16UC1, z along the optical axis [mm], 0 unknown; same camera as the images.
  DepthTruth(PoseTrack world_from_camera, std::shared_ptr<const CameraModel> camera);
  void addDepth(std::int64_t stamp_ns, const cv::Mat& depth_mm);

  const CameraModel& camera() const override { return *camera_; }
  std::optional<WorldPoint> lift(std::int64_t stamp_ns, const Eigen::Vector2d& pixel,
                                 const Eigen::Vector2d& normal) const override;
  std::optional<PointView> view(const WorldPoint& point, std::int64_t stamp_ns) const override;

 private:
  struct DepthImage {
    std::int64_t stamp_ns;
    cv::Mat depth_mm;
    Eigen::Isometry3d world_from_camera;
  };
  const DepthImage* nearest(std::int64_t stamp_ns) const;
  /// z of what a pixel of an image shows [m].
  std::optional<double> depthOf(const Eigen::Isometry3d& world_from_image, const DepthImage& depth,
                                const Eigen::Vector2d& pixel) const;
  /// Inverse z that the side of a line at `pixel` has where it meets the line [1/m].
  std::optional<double> inverseDepthOfSide(const Eigen::Isometry3d& world_from_image, const DepthImage& depth,
                                           const Eigen::Vector2d& pixel, const Eigen::Vector2d& normal) const;

  PoseTrack world_from_camera_;
  std::shared_ptr<const CameraModel> camera_;
  std::vector<DepthImage> images_;  ///< by stamp
};

}  // namespace tet_line_tracker
