#include "bag_calibration.h"

#include <rosbag/query.h>
#include <sensor_msgs/CameraInfo.h>

namespace tet_line_tracker {

BagCalibration::BagCalibration(const rosbag::Bag& bag, const std::string& topic)
    : where_(topic + " of " + bag.getFileName()) {
  if (topic.empty()) {
    complain("no camera_info in " + bag.getFileName() +
             "; lines are written in pixels, their normalised endpoints are NaN");
  } else {
    view_.addQuery(bag, rosbag::TopicQuery(topic));
  }
  for (const rosbag::MessageInstance& instance : view_) {
    const auto info = instance.instantiate<sensor_msgs::CameraInfo>();
    if (!info) continue;
    // Some drivers leave the stamp out.
    infos_.emplace(info->header.stamp.isZero() ? instance.getTime() : info->header.stamp, instance);
  }
  next_ = infos_.cbegin();
  if (next_ != infos_.cend()) take((next_++)->second);
}

void BagCalibration::take(const rosbag::MessageInstance& instance) {
  if (const auto complaint = input_.update(*instance.instantiate<sensor_msgs::CameraInfo>()))
    complain(where_ + ": " + *complaint);
}

void BagCalibration::complain(const std::string& sentence) {
  complaint_ += (complaint_.empty() ? "" : "; ") + sentence;
}

std::shared_ptr<const CameraModel> BagCalibration::modelFor(const ros::Time& stamp, int width, int height) {
  for (; next_ != infos_.cend() && next_->first <= stamp; ++next_) take(next_->second);
  if (infos_.empty()) return nullptr;
  const CalibrationInput::Model model = input_.modelFor(width, height);
  if (model.warning) complain(where_ + ": " + *model.warning);
  return model.camera;
}

std::string BagCalibration::takeComplaint() {
  std::string complaint;
  complaint.swap(complaint_);
  return complaint;
}

}  // namespace tet_line_tracker
