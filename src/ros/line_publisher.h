#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <ros/ros.h>
#include <opencv2/core.hpp>

#include "debug_image_publisher.h"
#include "markers.h"
#include "node_parameters.h"
#include "publish_throttle.h"
#include "tet_line_tracker/tracking/line_frame.h"

namespace tet_line_tracker {

/// Publishes the lines of an image, and while somebody listens the picture, the markers and the statistics of
/// them. publish(), setCamera() and setParameters() are for one thread at a time; the rest may be called from
/// any.
class LinePublisher {
 public:
  /// Advertises below `node`.
  LinePublisher(ros::NodeHandle& node, const NodeParameters& parameters);

  /// For the images to come. The rate starts anew when it changes.
  void setParameters(const NodeParameters& parameters);

  /// The picture shows lines as this camera bends them; nullptr: straight.
  void setCamera(std::shared_ptr<const CameraModel> camera) { debug_image_.setCamera(std::move(camera)); }

  /// `gray`: the image of `frame`; `replaced`: images that gave way to newer ones since the node began. False
  /// when publish_rate leaves this image out.
  bool publish(const LineFrame& frame, const std::string& frame_id, const cv::Mat& gray,
               std::uint64_t replaced);

  std::string debugImageTopic() const { return debug_image_.topic(); }

 private:
  PublishThrottle throttle_;
  MarkerBuilder marker_builder_;
  std::optional<std::uint32_t> epoch_;
  std::uint64_t replaced_before_epoch_{0};
  std::uint32_t lines_sequence_{0};
  std::uint32_t statistics_sequence_{0};

  ros::Publisher lines_;
  ros::Publisher markers_;
  ros::Publisher statistics_;
  DebugImagePublisher debug_image_;
};

}  // namespace tet_line_tracker
