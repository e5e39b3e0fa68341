#include "line_bag.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <unordered_map>

#include <rosbag/query.h>
#include <rosbag/view.h>

#include "../ros/messages.h"
#include "bag_reader.h"
#include "tet_line_tracker/TrackingStatistics.h"

namespace tet_line_tracker {
namespace {

void takeLosses(const TrackingStatistics& message, LineFrame& frame) {
  FrameStatistics& statistics = frame.statistics;
  statistics.lostFor(LossReason::kFlow) = message.lost_flow;
  statistics.lostFor(LossReason::kResidual) = message.lost_residual;
  statistics.lostFor(LossReason::kLengthRatio) = message.lost_length_ratio;
  statistics.lostFor(LossReason::kAngle) = message.lost_angle;
  statistics.lostFor(LossReason::kSupport) = message.lost_support;
  statistics.lostFor(LossReason::kBorder) = message.lost_border;
  statistics.lostFor(LossReason::kShort) = message.lost_short;
  statistics.lostFor(LossReason::kFieldOfView) = message.lost_field_of_view;
  statistics.lostFor(LossReason::kMask) = message.lost_mask;
  statistics.lostFor(LossReason::kDepth) = message.lost_depth;
  statistics.lostFor(LossReason::kEdgeJump) = message.lost_edge_jump;
  statistics.lostFor(LossReason::kDuplicate) = message.lost_duplicate;
  const std::size_t count = std::min(message.lost_ids.size(), message.lost_reasons.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t reason = message.lost_reasons[i];
    if (reason >= statistics.lost.size()) continue;
    frame.lost.push_back({message.lost_ids[i], static_cast<LossReason>(reason)});
  }
}

void takeTimes(const TrackingStatistics& message, LineFrame& frame) {
  FrameStatistics& times = frame.statistics;
  times.pyramid_ms = message.pyramid_ms;
  times.prior_ms = message.prior_ms;
  times.flow_ms = message.flow_ms;
  times.refine_ms = message.refine_ms;
  times.detect_ms = message.detect_ms;
  times.undistort_ms = message.undistort_ms;
  times.total_ms = message.total_ms;
}

}  // namespace

LineBag readLines(const rosbag::Bag& bag, const std::string& topic) {
  checkDefinition<LineArray>(bag, topic);
  LineBag lines;
  std::unordered_map<std::int64_t, std::size_t> frame_of_stamp;
  rosbag::View line_view(bag, rosbag::TopicQuery(topic));
  for (const rosbag::MessageInstance& instance : line_view) {
    const auto message = instance.instantiate<LineArray>();
    if (!message) {
      throw std::runtime_error(topic + " of " + bag.getFileName() + " holds " + instance.getDataType() +
                               ", not tet_line_tracker/LineArray");
    }
    lines.frames.push_back(toLineFrame(*message));
    frame_of_stamp[lines.frames.back().stamp_ns] = lines.frames.size() - 1;
  }
  if (lines.frames.empty()) throw std::runtime_error("no lines on " + topic + " in " + bag.getFileName());

  std::size_t with_times = 0;
  const std::string statistics_topic = topic.substr(0, topic.rfind('/') + 1) + "statistics";
  checkDefinition<TrackingStatistics>(bag, statistics_topic);
  rosbag::View statistics_view(bag, rosbag::TopicQuery(statistics_topic));
  for (const rosbag::MessageInstance& instance : statistics_view) {
    const auto message = instance.instantiate<TrackingStatistics>();
    if (!message) continue;
    const auto frame = frame_of_stamp.find(static_cast<std::int64_t>(message->header.stamp.toNSec()));
    if (frame == frame_of_stamp.end()) continue;
    takeTimes(*message, lines.frames[frame->second]);
    takeLosses(*message, lines.frames[frame->second]);
    ++with_times;
  }
  lines.has_statistics = with_times == lines.frames.size();
  return lines;
}

}  // namespace tet_line_tracker
