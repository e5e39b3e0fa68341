#include "line_publisher.h"

#include <visualization_msgs/MarkerArray.h>
#include <boost/make_shared.hpp>

#include "messages.h"

namespace tet_line_tracker {
namespace {

/// Lines matter to estimators, so a slow subscriber gets this many messages of slack.
constexpr std::uint32_t kLinesQueue = 100;
constexpr std::uint32_t kDisplayQueue = 2;

TrackPainter::Style styleOf(const NodeParameters& parameters) {
  TrackPainter::Style style;
  style.ids = parameters.debug_image_ids;
  return style;
}

}  // namespace

LinePublisher::LinePublisher(ros::NodeHandle& node, const NodeParameters& parameters)
    : throttle_(parameters.publish_rate),
      marker_builder_(parameters.marker_ids),
      lines_(node.advertise<LineArray>("lines", kLinesQueue)),
      markers_(node.advertise<visualization_msgs::MarkerArray>("markers", kDisplayQueue)),
      statistics_(node.advertise<TrackingStatistics>("statistics", kLinesQueue)),
      debug_image_(node, styleOf(parameters), parameters.debug_image_rate) {}

void LinePublisher::setParameters(const NodeParameters& parameters) {
  throttle_.setRate(parameters.publish_rate);
  marker_builder_.setIds(parameters.marker_ids);
  debug_image_.setStyle(styleOf(parameters));
  debug_image_.setRate(parameters.debug_image_rate);
}

bool LinePublisher::publish(const LineFrame& frame, const std::string& frame_id, const cv::Mat& gray,
                            std::uint64_t replaced) {
  if (epoch_ != frame.epoch) {
    epoch_ = frame.epoch;
    replaced_before_epoch_ = replaced;
    throttle_.reset();
  }
  if (!throttle_.pass(frame.stamp_ns)) return false;
  lines_.publish(boost::make_shared<const LineArray>(toLineArray(frame, frame_id, lines_sequence_++)));
  if (statistics_.getNumSubscribers() > 0) {
    const auto replaced_in_epoch = static_cast<std::uint32_t>(replaced - replaced_before_epoch_);
    statistics_.publish(boost::make_shared<const TrackingStatistics>(
        toTrackingStatistics(frame, frame_id, statistics_sequence_++, replaced_in_epoch)));
  }
  if (markers_.getNumSubscribers() > 0) {
    markers_.publish(
        boost::make_shared<const visualization_msgs::MarkerArray>(marker_builder_.build(frame, frame_id)));
  }
  debug_image_.publish(frame, frame_id, gray);
  return true;
}

}  // namespace tet_line_tracker
