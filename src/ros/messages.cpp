#include "messages.h"

#include <ros/time.h>

#include <algorithm>

namespace tet_line_tracker {
namespace {

template <class Vector, class Array>
void assign(const Vector& from, Array& to) {
  to[0] = from.x();
  to[1] = from.y();
}

std_msgs::Header headerOf(const LineFrame& frame, const std::string& frame_id, std::uint32_t sequence) {
  std_msgs::Header header;
  header.seq = sequence;
  header.stamp.fromNSec(static_cast<std::uint64_t>(frame.stamp_ns));
  header.frame_id = frame_id;
  return header;
}

}  // namespace

LineArray toLineArray(const LineFrame& frame, const std::string& frame_id, std::uint32_t sequence) {
  LineArray message;
  message.header = headerOf(frame, frame_id, sequence);
  message.epoch = frame.epoch;
  message.image_count = frame.image_count;
  message.width = static_cast<std::uint32_t>(frame.width);
  message.height = static_cast<std::uint32_t>(frame.height);
  message.detected = static_cast<std::uint8_t>(frame.detected);
  message.lines.reserve(frame.lines.size());
  for (const TrackedLine& line : frame.lines) {
    Line& out = message.lines.emplace_back();
    out.id = line.id;
    out.age = line.age;
    assign(line.segment.start, out.start_px);
    assign(line.segment.end, out.end_px);
    assign(line.start_normalized, out.start_normalized);
    assign(line.end_normalized, out.end_normalized);
    out.sigma_px = line.sigma_px;
    std::copy(line.covariance_px.begin(), line.covariance_px.end(), out.covariance_px.begin());
    out.cut = line.cut;
    out.residual = line.residual;
  }
  return message;
}

LineFrame toLineFrame(const LineArray& message) {
  LineFrame frame;
  frame.stamp_ns = static_cast<std::int64_t>(message.header.stamp.toNSec());
  frame.epoch = message.epoch;
  frame.image_count = message.image_count;
  frame.width = static_cast<int>(message.width);
  frame.height = static_cast<int>(message.height);
  frame.detected = message.detected != 0;
  frame.lines.reserve(message.lines.size());
  for (const Line& line : message.lines) {
    TrackedLine& out = frame.lines.emplace_back();
    out.id = line.id;
    out.age = line.age;
    out.segment = {{line.start_px[0], line.start_px[1]}, {line.end_px[0], line.end_px[1]}};
    out.start_normalized = {line.start_normalized[0], line.start_normalized[1]};
    out.end_normalized = {line.end_normalized[0], line.end_normalized[1]};
    out.sigma_px = line.sigma_px;
    std::copy(line.covariance_px.begin(), line.covariance_px.end(), out.covariance_px.begin());
    out.cut = line.cut;
    out.residual = line.residual;
  }
  return frame;
}

TrackingStatistics toTrackingStatistics(const LineFrame& frame, const std::string& frame_id,
                                        std::uint32_t sequence, std::uint32_t dropped_queue) {
  const FrameStatistics& from = frame.statistics;
  TrackingStatistics message;
  message.header = headerOf(frame, frame_id, sequence);
  message.epoch = frame.epoch;
  message.image_count = frame.image_count;
  message.tracks_before = from.tracks_before;
  message.tracks_kept = from.tracks_kept;
  message.lines_detected = from.lines_detected;
  message.lines_added = from.lines_added;
  message.coverage = from.coverage;
  message.lines_cut = from.lines_cut;
  message.lines_left_out = from.lines_left_out;
  message.lost_flow = from.lostFor(LossReason::kFlow);
  message.lost_residual = from.lostFor(LossReason::kResidual);
  message.lost_length_ratio = from.lostFor(LossReason::kLengthRatio);
  message.lost_angle = from.lostFor(LossReason::kAngle);
  message.lost_support = from.lostFor(LossReason::kSupport);
  message.lost_border = from.lostFor(LossReason::kBorder);
  message.lost_short = from.lostFor(LossReason::kShort);
  message.lost_field_of_view = from.lostFor(LossReason::kFieldOfView);
  message.lost_mask = from.lostFor(LossReason::kMask);
  message.lost_depth = from.lostFor(LossReason::kDepth);
  message.lost_edge_jump = from.lostFor(LossReason::kEdgeJump);
  message.lost_duplicate = from.lostFor(LossReason::kDuplicate);
  message.lost_ids.reserve(frame.lost.size());
  message.lost_reasons.reserve(frame.lost.size());
  for (const LostLine& line : frame.lost) {
    message.lost_ids.push_back(line.id);
    message.lost_reasons.push_back(static_cast<std::uint8_t>(line.reason));
  }
  message.prior = from.prior;
  message.prior_rotation = from.prior_rotation;
  message.imu_time_offset = static_cast<float>(from.imu_time_offset);
  std::copy(from.translation.begin(), from.translation.end(), message.translation.begin());
  message.translation_inliers = from.translation_inliers;
  message.dropped_late = from.dropped_late;
  message.dropped_duplicate = from.dropped_duplicate;
  message.dropped_zero = from.dropped_zero;
  message.dropped_queue = dropped_queue;
  message.pyramid_ms = static_cast<float>(from.pyramid_ms);
  message.prior_ms = static_cast<float>(from.prior_ms);
  message.flow_ms = static_cast<float>(from.flow_ms);
  message.refine_ms = static_cast<float>(from.refine_ms);
  message.detect_ms = static_cast<float>(from.detect_ms);
  message.undistort_ms = static_cast<float>(from.undistort_ms);
  message.total_ms = static_cast<float>(from.total_ms);
  return message;
}

}  // namespace tet_line_tracker
