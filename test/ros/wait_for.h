#pragma once

#include <functional>

#include <ros/ros.h>

namespace tet_line_tracker {

inline constexpr double kPatience = 30.0;  // [s] a slow machine only makes the test slow

/// Takes messages until `condition` holds; false when it does not within `seconds`.
inline bool waitFor(const std::function<bool()>& condition, double seconds = kPatience) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
  while (ros::ok() && !condition()) {
    if (ros::WallTime::now() > end) return false;
    ros::spinOnce();
    ros::WallDuration(0.005).sleep();
  }
  return condition();
}

}  // namespace tet_line_tracker
