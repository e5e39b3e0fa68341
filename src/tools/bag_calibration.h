#pragma once

#include <map>
#include <memory>
#include <string>

#include <ros/time.h>
#include <rosbag/view.h>

#include "../ros/calibration_input.h"

namespace tet_line_tracker {

/// The camera_info messages of a bag, taken as the node takes them: the newest one up to the stamp of an
/// image (the first one for images before it), and none that does not fit the image. Each trouble is told
/// once.
class BagCalibration {
 public:
  /// `topic` empty: there is none, which is told too.
  BagCalibration(const rosbag::Bag& bag, const std::string& topic);

  /// Model for the image with this stamp and size [px]; nullptr: none that can be used.
  std::shared_ptr<const CameraModel> modelFor(const ros::Time& stamp, int width, int height);
  /// What is to be told since the last call, one sentence per trouble; empty: nothing.
  std::string takeComplaint();

 private:
  void take(const rosbag::MessageInstance& instance);
  void complain(const std::string& sentence);

  std::string where_;  ///< topic and bag, for people
  rosbag::View view_;
  std::multimap<ros::Time, rosbag::MessageInstance> infos_;
  std::multimap<ros::Time, rosbag::MessageInstance>::const_iterator next_;
  CalibrationInput input_;
  std::string complaint_;
};

}  // namespace tet_line_tracker
