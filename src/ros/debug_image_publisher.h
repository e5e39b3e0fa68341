#pragma once

#include <memory>
#include <string>
#include <thread>
#include <utility>

#include <image_transport/image_transport.h>
#include <ros/ros.h>
#include <opencv2/core.hpp>

#include "newest_queue.h"
#include "publish_throttle.h"
#include "tet_line_tracker/display/track_painter.h"
#include "tet_line_tracker/tracking/line_frame.h"

namespace tet_line_tracker {

/// Paints and publishes the lines over their images while somebody looks, in a thread of its own that gives
/// way to the tracker: painting takes longer than tracking. When images come faster than they are painted,
/// the older ones are left out. publish() and the setters are for one thread at a time.
class DebugImagePublisher {
 public:
  /// Advertises `debug_image` below `node`. `rate_hz`: of setRate().
  DebugImagePublisher(ros::NodeHandle& node, const TrackPainter::Style& style, double rate_hz);
  ~DebugImagePublisher();
  DebugImagePublisher(const DebugImagePublisher&) = delete;
  DebugImagePublisher& operator=(const DebugImagePublisher&) = delete;

  /// For the images to come.
  void setStyle(const TrackPainter::Style& style) { style_ = style; }
  /// At most so many images per second of their stamps; 0: all.
  void setRate(double rate_hz) { throttle_.setRate(rate_hz); }
  /// Lines of the images to come are painted as this camera bends them; nullptr: straight.
  void setCamera(std::shared_ptr<const CameraModel> camera) { camera_ = std::move(camera); }

  /// `gray`: the image of `frame`; it is copied.
  void publish(const LineFrame& frame, const std::string& frame_id, const cv::Mat& gray);

  std::string topic() const { return publisher_.getTopic(); }

 private:
  /// All that a painting needs.
  struct Painting {
    LineFrame frame;
    std::string frame_id;
    cv::Mat gray;
    TrackPainter::Style style;
    std::shared_ptr<const CameraModel> camera;
  };

  void paintAll();

  TrackPainter::Style style_;
  std::shared_ptr<const CameraModel> camera_;
  PublishThrottle throttle_;
  image_transport::Publisher publisher_;
  NewestQueue<Painting> queue_;
  std::thread thread_;
};

}  // namespace tet_line_tracker
