#include <nodelet/loader.h>
#include <ros/ros.h>

/// The nodelet tet_line_tracker/LineTracker in a process of its own.
int main(int argc, char** argv) {
  ros::init(argc, argv, "line_tracker");
  // No services of a nodelet manager: they would stand beside those of the tracker.
  nodelet::Loader loader(false);
  const nodelet::M_string& remappings = ros::names::getRemappings();
  const nodelet::V_string arguments;
  if (!loader.load(ros::this_node::getName(), "tet_line_tracker/LineTracker", remappings, arguments))
    return 1;
  ros::spin();
  return 0;
}
