#pragma once

#include <set>
#include <string>
#include <vector>

#include <ros/node_handle.h>

#include "tet_line_tracker/parameters/parameter_table.h"
#include "tet_line_tracker/parameters/parameters.h"

namespace tet_line_tracker {

/// What the node adds to the front end: from ROS images, to ROS messages.
struct NodeParameters {
  double publish_rate{0.0};  ///< messages per second of image stamps, 0..1000 [Hz]; 0: one for every image
  double mono16_scale{1.0 / 256.0};  ///< 8-bit gray per step of a 16-bit image, 1e-6..255
  int queue_size{10};                ///< images that wait for their turn at most, 1..1000
  bool marker_ids{false};            ///< ids beside the lines of ~markers
  bool debug_image_ids{true};        ///< ids on ~debug_image, where there is room
  double debug_image_rate{30.0};     ///< debug images per second of image stamps, 0..1000 [Hz]; 0: all
  double imu_wait{0.05};             ///< an image waits so long for messages of IMU or odometry, 0..10 [s]
  std::string imu_rotation;  ///< "qx qy qz qw": takes directions in the IMU's frame to the camera's; empty:
                             ///< ask tf
  std::string odometry_extrinsic;  ///< "x y z qx qy qz qw": pose of the odometry's child frame in the
                                   ///< camera's [m]; empty: ask tf
  std::string mask;                ///< path of an image: white where lines are tracked; empty: everywhere
};

/// Entries bound to the fields of `parameters`, which must outlive the table.
ParameterTable tableOf(NodeParameters& parameters);

/// One sentence for each broken rule, empty when the parameters can be used.
std::vector<std::string> check(const NodeParameters& parameters);

/// What the nodelet LineMapper adds to the mapper.
struct LineMapperNodeParameters {
  std::string world_frame{"world"};  ///< frame of the map
  std::string camera_frame;          ///< optical frame of the camera; empty: frame_id of the lines
  double tf_timeout{0.5};            ///< lines wait this long for a pose, by the wall clock, 0..60 [s]
  double publish_rate{2.0};          ///< maps per second of the wall clock at most, 0.01..100 [Hz]
};

/// Entries bound to the fields of `parameters`, which must outlive the table.
ParameterTable tableOf(LineMapperNodeParameters& parameters);

/// Names below the private namespace that are not the front end's: image_transport, diagnostic_updater and
/// nodelet keep their own settings there.
const std::set<std::string>& foreignParameterNames();

/// Sets the fields of `table` from the private namespace of `node`. Throws std::invalid_argument with one
/// sentence for each unknown name, wrong type and value out of range.
void loadParameters(const ros::NodeHandle& node, ParameterTable table);

/// The same for the front end and its node, with the rules between their parameters.
void loadParameters(const ros::NodeHandle& node, LineTrackerParameters& tracker, NodeParameters& parameters);

/// Throws std::invalid_argument when the transport that the private parameter image_transport asks for is not
/// there: image_transport itself would find out only after the outputs are advertised.
void checkImageTransport(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

}  // namespace tet_line_tracker
