#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tf2/buffer_core.h>
#include <visualization_msgs/Marker.h>

#include "tet_line_tracker/Line3DArray.h"
#include "tet_line_tracker/mapping/line_mapper.h"

namespace tet_line_tracker {

geometry_msgs::Point toPoint(const Eigen::Vector3d& p);

/// The map as published. `header`: newest image in the map, frame of the poses.
Line3DArray toLine3DArray(const std::vector<MappedLine>& lines, const std_msgs::Header& header);

/// One marker with all lines: finished ones in one colour, those still tracked in another.
visualization_msgs::Marker toMapMarker(const Line3DArray& map);

/// Pose of a camera, or why there is none.
struct CameraPose {
  std::optional<Eigen::Isometry3d> world_from_camera;
  std::string problem;  ///< one sentence that names the frame or the time that is missing
};

/// Pose of frame `camera` in frame `world` at `stamp`, between the transforms before and after it.
CameraPose lookUpPose(const tf2::BufferCore& transforms, const std::string& world, const std::string& camera,
                      const ros::Time& stamp);

}  // namespace tet_line_tracker
