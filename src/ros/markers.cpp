#include "markers.h"

#include "tet_line_tracker/display/track_painter.h"

namespace tet_line_tracker {
namespace {

/// On z = 1: about 2 px of a camera with a focal length of 450 px.
constexpr double kLineWidth = 0.004;
constexpr double kTextHeight = 0.03;

geometry_msgs::Point onPlane(const Eigen::Vector2d& normalized) {
  geometry_msgs::Point point;
  point.x = normalized.x();
  point.y = normalized.y();
  point.z = 1.0;
  return point;
}

std_msgs::ColorRGBA markerColour(std::uint32_t age) {
  const std::array<float, 3> rgb = colourOfAge(age);
  std_msgs::ColorRGBA colour;
  colour.r = rgb[0];
  colour.g = rgb[1];
  colour.b = rgb[2];
  colour.a = 1.0F;
  return colour;
}

visualization_msgs::Marker markerOf(const std_msgs::Header& header, const std::string& name,
                                    std::int32_t type) {
  visualization_msgs::Marker marker;
  marker.header = header;
  marker.ns = name;
  marker.type = type;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1.0;
  return marker;
}

}  // namespace

visualization_msgs::MarkerArray MarkerBuilder::build(const LineFrame& frame, const std::string& frame_id) {
  std_msgs::Header header;
  header.stamp.fromNSec(static_cast<std::uint64_t>(frame.stamp_ns));
  header.frame_id = frame_id;

  visualization_msgs::MarkerArray array;
  if (epoch_ != frame.epoch) {
    array.markers.push_back(markerOf(header, "", visualization_msgs::Marker::LINE_LIST));
    array.markers.back().action = visualization_msgs::Marker::DELETEALL;
    shown_ids_ = 0;
    epoch_ = frame.epoch;
  }

  visualization_msgs::Marker lines = markerOf(header, "lines", visualization_msgs::Marker::LINE_LIST);
  lines.scale.x = kLineWidth;
  std::size_t texts = 0;
  for (const TrackedLine& line : frame.lines) {
    if (!line.start_normalized.allFinite() || !line.end_normalized.allFinite()) continue;
    lines.points.push_back(onPlane(line.start_normalized));
    lines.points.push_back(onPlane(line.end_normalized));
    lines.colors.insert(lines.colors.end(), 2, markerColour(line.age));
    if (!ids_) continue;
    visualization_msgs::Marker text = markerOf(header, "ids", visualization_msgs::Marker::TEXT_VIEW_FACING);
    text.id = static_cast<std::int32_t>(texts++);
    text.pose.position = onPlane(0.5 * (line.start_normalized + line.end_normalized));
    text.scale.z = kTextHeight;
    text.color = markerColour(line.age);
    text.text = std::to_string(line.id);
    array.markers.push_back(text);
  }
  // A list without points is an error in rviz.
  if (lines.points.empty()) lines.action = visualization_msgs::Marker::DELETE;
  array.markers.push_back(lines);
  for (std::size_t i = texts; i < shown_ids_; ++i) {
    visualization_msgs::Marker gone = markerOf(header, "ids", visualization_msgs::Marker::TEXT_VIEW_FACING);
    gone.id = static_cast<std::int32_t>(i);
    gone.action = visualization_msgs::Marker::DELETE;
    array.markers.push_back(gone);
  }
  shown_ids_ = texts;
  return array;
}

}  // namespace tet_line_tracker
