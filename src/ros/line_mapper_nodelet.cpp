#include <deque>
#include <memory>

#include <nodelet/nodelet.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#include <pluginlib/class_list_macros.hpp>

#include "map_messages.h"
#include "messages.h"
#include "node_parameters.h"
#include "throttled_warning.h"

namespace tet_line_tracker {
/// Lines and the poses of their camera in, a map of lines out: see LineMapper. Callbacks run one after the
/// other on the node handle's queue; only the tf2 buffer is filled from another thread, and guards itself.
class LineMapperNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    ros::NodeHandle& node = getPrivateNodeHandle();
    ParameterTable table = tableOf(mapper_parameters_);
    table.append(tableOf(parameters_));
    loadParameters(node, std::move(table));
    mapper_ = std::make_unique<LineMapper>(mapper_parameters_);
    header_.frame_id = parameters_.world_frame;
    listener_ = std::make_unique<tf2_ros::TransformListener>(transforms_);

    map_publisher_ = node.advertise<Line3DArray>("lines", 1, true);
    marker_publisher_ = node.advertise<visualization_msgs::Marker>("markers", 1, true);
    reset_ = node.advertiseService<std_srvs::Trigger::Request, std_srvs::Trigger::Response>(
        "reset", [this](std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
          mapper_ = std::make_unique<LineMapper>(mapper_parameters_);
          changed_ = true;
          response.success = 1;
          response.message = "the map is empty";
          return true;
        });
    publish_timer_ = node.createWallTimer(ros::WallDuration(1.0 / parameters_.publish_rate),
                                          [this](const ros::WallTimerEvent&) { publish(); });
    retry_timer_ = node.createWallTimer(
        ros::WallDuration(0.02), [this](const ros::WallTimerEvent&) { mapWaiting(); }, false, false);
    constexpr int kQueue = 100;
    lines_ = getNodeHandle().subscribe<LineArray>("lines", kQueue, [this](const LineArray::ConstPtr& lines) {
      waiting_.push_back({lines, ros::SteadyTime::now() + ros::WallDuration(parameters_.tf_timeout)});
      mapWaiting();
    });
  }

  /// Maps what has a pose, in order; gives up on what waited too long for one.
  void mapWaiting() {
    while (!waiting_.empty()) {
      const LineArray& lines = *waiting_.front().lines;
      const std::string& camera =
          parameters_.camera_frame.empty() ? lines.header.frame_id : parameters_.camera_frame;
      const CameraPose pose = lookUpPose(transforms_, parameters_.world_frame, camera, lines.header.stamp);
      if (pose.world_from_camera) {
        mapper_->add(toLineFrame(lines), *pose.world_from_camera);
        header_.stamp = lines.header.stamp;
        changed_ = true;
      } else if (ros::SteadyTime::now() < waiting_.front().deadline) {
        break;
      } else {
        ++without_pose_;
        if (pose_warning_.isDue()) {
          NODELET_WARN("%lu images had no pose within %g s and are not in the map; the last one: %s",
                       static_cast<unsigned long>(without_pose_), parameters_.tf_timeout,
                       pose.problem.c_str());
        }
      }
      waiting_.pop_front();
    }
    if (waiting_.empty()) {
      retry_timer_.stop();
    } else {
      retry_timer_.start();
    }
  }

  void publish() {
    if (!changed_ || header_.stamp.isZero()) return;
    changed_ = false;
    const auto map = boost::make_shared<Line3DArray>(toLine3DArray(mapper_->lines(), header_));
    map_publisher_.publish(map);
    marker_publisher_.publish(boost::make_shared<visualization_msgs::Marker>(toMapMarker(*map)));
  }

  struct Waiting {
    LineArray::ConstPtr lines;
    ros::SteadyTime deadline;
  };

  LineMapperParameters mapper_parameters_;
  LineMapperNodeParameters parameters_;
  std::unique_ptr<LineMapper> mapper_;
  std_msgs::Header header_;  ///< of the next map
  bool changed_{false};      ///< since the last map
  std::uint64_t without_pose_{0};
  ThrottledWarning pose_warning_{std::chrono::seconds(5)};
  std::deque<Waiting> waiting_;
  tf2_ros::Buffer transforms_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;
  ros::Publisher map_publisher_;
  ros::Publisher marker_publisher_;
  ros::ServiceServer reset_;
  ros::WallTimer publish_timer_;
  ros::WallTimer retry_timer_;
  ros::Subscriber lines_;
};

}  // namespace tet_line_tracker

PLUGINLIB_EXPORT_CLASS(tet_line_tracker::LineMapperNodelet, nodelet::Nodelet)
