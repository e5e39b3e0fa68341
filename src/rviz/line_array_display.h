#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include <ros/subscriber.h>
#include <rviz/properties/enum_property.h>
#include <rviz/properties/int_property.h>
#include <rviz/properties/ros_topic_property.h>
#include <sensor_msgs/CameraInfo.h>

#include "line_array_view.h"
#include "line_display.h"
#include "line_trail.h"
#include "raw_picture.h"
#include "tet_line_tracker/LineArray.h"

namespace tet_line_tracker {

/// Shows the lines of the newest image on a plane in front of its camera, where tf says that the camera was:
/// straight as they are in space, or so that they lie over the raw picture of a Camera display.
class LineArrayDisplay : public LineDisplay<LineArray> {
 public:
  LineArrayDisplay();

 protected:
  void onInitialize() override;
  void processMessage(const LineArray::ConstPtr& message) override;
  void subscribe() override;
  void unsubscribe() override;
  ShownLines show() override;
  void forget() override { trail_.clear(); }

 private:
  LineArrayStyle style() const;
  void showScaleOfColouring();
  bool isRaw() const;
  /// Takes the camera_info of the topic of now, when the raw picture is chosen.
  void subscribeToCameraInfo();
  void processCameraInfo(const sensor_msgs::CameraInfo::ConstPtr& info);
  /// What the newest lines are laid over; nullptr where there is none, and the status says why.
  std::shared_ptr<const RawPicture> rawPicture();
  void tellWithoutPlace(const ShownLines& shown);

  rviz::FloatProperty* depth_;
  rviz::EnumProperty* picture_;
  rviz::RosTopicProperty* camera_info_topic_;
  rviz::EnumProperty* colouring_;
  rviz::FloatProperty* longest_;
  rviz::FloatProperty* largest_sigma_;
  rviz::IntProperty* min_age_;
  rviz::IntProperty* trail_images_;
  rviz::BoolProperty* frustum_;
  LineTrail trail_;

  sensor_msgs::CameraInfo::ConstPtr camera_info_;  ///< nullptr: none has come
  std::optional<RawPictureChoice> raw_;            ///< of camera_info_, for images of the size below
  std::uint32_t raw_width_{0}, raw_height_{0};     ///< [px]
  ros::Subscriber camera_info_subscriber_;         ///< the last member: its messages need the others
};

}  // namespace tet_line_tracker
