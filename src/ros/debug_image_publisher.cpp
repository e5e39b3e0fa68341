#include "debug_image_publisher.h"

#include <sensor_msgs/image_encodings.h>
#include <sys/resource.h>
#include <boost/make_shared.hpp>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <utility>

namespace tet_line_tracker {
namespace {

constexpr std::uint32_t kDisplayQueue = 2;
constexpr std::size_t kWaiting = 2;  ///< images that wait for the painter
constexpr int kNice = 10;            ///< of the painter; the tracker has 0

sensor_msgs::ImageConstPtr toDebugImage(const LineFrame& frame, const std::string& frame_id,
                                        const cv::Mat& gray, TrackPainter& painter) {
  const auto image = boost::make_shared<sensor_msgs::Image>();
  image->header.stamp.fromNSec(static_cast<std::uint64_t>(frame.stamp_ns));
  image->header.frame_id = frame_id;
  image->encoding = sensor_msgs::image_encodings::BGR8;
  image->width = static_cast<std::uint32_t>(gray.cols);
  image->height = static_cast<std::uint32_t>(gray.rows);
  image->step = 3 * image->width;
  image->data.resize(static_cast<std::size_t>(image->step) * image->height);
  cv::Mat bgr(gray.rows, gray.cols, CV_8UC3, image->data.data(), image->step);
  painter.paint(gray, frame, bgr);
  return image;
}

}  // namespace

DebugImagePublisher::DebugImagePublisher(ros::NodeHandle& node, const TrackPainter::Style& style,
                                         double rate_hz)
    : style_(style),
      throttle_(rate_hz),
      publisher_(image_transport::ImageTransport(node).advertise("debug_image", kDisplayQueue)),
      queue_(kWaiting),
      thread_(&DebugImagePublisher::paintAll, this) {}

DebugImagePublisher::~DebugImagePublisher() {
  queue_.close();
  thread_.join();
}

void DebugImagePublisher::publish(const LineFrame& frame, const std::string& frame_id, const cv::Mat& gray) {
  if (publisher_.getNumSubscribers() == 0 || !throttle_.pass(frame.stamp_ns)) return;
  // The pixels may be those of a message that goes when the tracker is done with it.
  queue_.push({frame, frame_id, gray.clone(), style_, camera_});
}

void DebugImagePublisher::paintAll() {
  // Linux sets the nice value of the calling thread alone. Without it the picture is only less polite.
  setpriority(PRIO_PROCESS, 0, kNice);
  TrackPainter painter;
  while (const auto painting = queue_.pop()) {
    try {
      painter.setStyle(painting->style);
      painter.setCamera(painting->camera);
      publisher_.publish(toDebugImage(painting->frame, painting->frame_id, painting->gray, painter));
    } catch (const std::exception& error) {
      ROS_ERROR_THROTTLE(10.0, "%s leaves an image out: %s", topic().c_str(), error.what());
    }
  }
}

}  // namespace tet_line_tracker
