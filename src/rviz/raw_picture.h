#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <sensor_msgs/CameraInfo.h>
#include <Eigen/Core>

#include "tet_line_tracker/camera/camera_model.h"

namespace tet_line_tracker {

/// The raw picture as the Camera display of rviz shows it: that projects the scene with P of camera_info, and
/// lays the picture under it as it is, with the bends of the lens. What is to lie over the picture has to be
/// bent in the scene.
class RawPicture {
 public:
  /// `camera`: the model of `info`, whose P can be inverted.
  RawPicture(const sensor_msgs::CameraInfo& info, std::shared_ptr<const CameraModel> camera);

  /// The point at z = `depth` of the optical frame that lies over a pixel of the raw image [m]. At depth 0
  /// all pixels have the place from which rviz looks.
  Eigen::Vector3d pointOver(const Eigen::Vector2d& pixel, double depth) const;

  /// Pixels between two ends through which the image of a straight line of space passes: so many that it
  /// leaves their connections by less than 0.05 px. None where the line is straight in the image, or the
  /// model has no ray for one of the ends.
  std::vector<Eigen::Vector2d> between(const Eigen::Vector2d& start, const Eigen::Vector2d& end) const;

 private:
  std::shared_ptr<const CameraModel> camera_;
  Eigen::Array2d focal_;   ///< of P [px of the full image]
  Eigen::Array2d centre_;  ///< of P [px of the full image]
  Eigen::Array2d shift_;   ///< of the place from which rviz looks, in the optical frame [m]
  Eigen::Array2d scale_;   ///< pixels of the full image per pixel
  Eigen::Array2d offset_;  ///< where the image begins in the full one [px]
};

struct RawPictureChoice {
  std::shared_ptr<const RawPicture> picture;  ///< nullptr: lines cannot be laid over it
  std::string problem;                        ///< why; empty when they can
};

/// What the Camera display shows with a camera_info for images of this size [px].
RawPictureChoice chooseRawPicture(const sensor_msgs::CameraInfo& info, std::uint32_t width,
                                  std::uint32_t height);

}  // namespace tet_line_tracker
