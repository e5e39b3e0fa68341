#include "map_messages.h"

#include <geometry_msgs/TransformStamped.h>
#include <tf2/exceptions.h>

namespace tet_line_tracker {
namespace {

std_msgs::ColorRGBA colour(float r, float g, float b) {
  std_msgs::ColorRGBA rgba;
  rgba.r = r;
  rgba.g = g;
  rgba.b = b;
  rgba.a = 1.0F;
  return rgba;
}

}  // namespace

geometry_msgs::Point toPoint(const Eigen::Vector3d& p) {
  geometry_msgs::Point point;
  point.x = p.x();
  point.y = p.y();
  point.z = p.z();
  return point;
}

Line3DArray toLine3DArray(const std::vector<MappedLine>& lines, const std_msgs::Header& header) {
  Line3DArray map;
  map.header = header;
  map.lines.reserve(lines.size());
  for (const MappedLine& line : lines) {
    Line3D& out = map.lines.emplace_back();
    out.id = line.id;
    out.epoch = line.epoch;
    out.track_id = line.track;
    out.start = toPoint(line.start);
    out.end = toPoint(line.end);
    out.sigma_start = static_cast<float>(line.sigma_start);
    out.sigma_end = static_cast<float>(line.sigma_end);
    out.views = static_cast<std::uint32_t>(line.views);
    out.reprojection_error = static_cast<float>(line.reprojection_px);
    out.parallax = static_cast<float>(line.parallax);
    out.distance = static_cast<float>(line.distance);
    out.finished = line.finished;
  }
  return map;
}

visualization_msgs::Marker toMapMarker(const Line3DArray& map) {
  static const std_msgs::ColorRGBA kFinished = colour(0.2F, 0.8F, 0.3F);
  static const std_msgs::ColorRGBA kTracked = colour(1.0F, 0.7F, 0.1F);
  visualization_msgs::Marker marker;
  marker.header = map.header;
  marker.ns = "line_map";
  marker.type = visualization_msgs::Marker::LINE_LIST;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = 0.015;  // width [m]
  marker.color = kFinished;
  for (const Line3D& line : map.lines) {
    const std_msgs::ColorRGBA& rgba = line.finished ? kFinished : kTracked;
    marker.points.push_back(line.start);
    marker.points.push_back(line.end);
    marker.colors.insert(marker.colors.end(), 2, rgba);
  }
  return marker;
}

CameraPose lookUpPose(const tf2::BufferCore& transforms, const std::string& world, const std::string& camera,
                      const ros::Time& stamp) {
  try {
    const geometry_msgs::Transform t = transforms.lookupTransform(world, camera, stamp).transform;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() =
        Eigen::Quaterniond(t.rotation.w, t.rotation.x, t.rotation.y, t.rotation.z).toRotationMatrix();
    pose.translation() = Eigen::Vector3d(t.translation.x, t.translation.y, t.translation.z);
    return {pose, ""};
  } catch (const tf2::TransformException& error) {
    return {std::nullopt, "no pose of " + camera + " in " + world + ": " + error.what()};
  }
}

}  // namespace tet_line_tracker
