#include "line_array_display.h"

#include <cstddef>
#include <cstdint>

#include <OgreQuaternion.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <pluginlib/class_list_macros.hpp>

#include "../ros/camera_info.h"

namespace tet_line_tracker {
namespace {

using Colouring = LineArrayStyle::Colouring;

constexpr int kMaxTrail = 500;
enum Picture { kUndistorted, kRaw };
constexpr char kCameraInfoStatus[] = "Camera Info";

Eigen::Isometry3d toEigen(const Ogre::Vector3& position, const Ogre::Quaternion& orientation) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << position.x, position.y, position.z;
  pose.linear() =
      Eigen::Quaterniond(orientation.w, orientation.x, orientation.y, orientation.z).toRotationMatrix();
  return pose;
}

}  // namespace

LineArrayDisplay::LineArrayDisplay() {
  depth_ = makeFloat("Depth", 1.0F, "Distance of the plane of the lines from the camera [m].", 0.001F);
  picture_ = new rviz::EnumProperty(
      "Picture", "Undistorted",
      "Undistorted: lines are straight, as they are in space. Raw: as the lens bends them, so that they lie "
      "over the raw picture of a Camera display.",
      this);
  picture_->addOption("Undistorted", kUndistorted);
  picture_->addOption("Raw", kRaw);
  camera_info_topic_ = new rviz::RosTopicProperty(
      "Camera Info Topic", "/camera/camera_info",
      QString::fromStdString(ros::message_traits::datatype<sensor_msgs::CameraInfo>()),
      "Calibration of the raw picture: the camera_info beside its image topic, as for the Camera display.",
      this);
  colouring_ =
      new rviz::EnumProperty("Color By", "Age",
                             "Age: from red (just detected) to blue (100 images and more), as in the debug "
                             "image. Id: a color for each track. Length and Sigma: from blue (long, or "
                             "certain) to red; gray where the sigma is not estimated.",
                             this);
  colouring_->addOption("Id", static_cast<int>(Colouring::kId));
  colouring_->addOption("Age", static_cast<int>(Colouring::kAge));
  colouring_->addOption("Length", static_cast<int>(Colouring::kLength));
  colouring_->addOption("Sigma", static_cast<int>(Colouring::kSigma));
  redrawWith(colouring_);
  const LineArrayStyle defaults;
  longest_ = makeFloat("Longest", static_cast<float>(defaults.longest),
                       "Lines of this length and longer are blue [px].", 1.0F);
  largest_sigma_ =
      makeFloat("Largest Sigma", static_cast<float>(defaults.largest_sigma),
                "Lines with this standard deviation across themselves and more are red [px].", 0.001F);
  min_age_ =
      new rviz::IntProperty("Min Age", 1, "Lines seen in fewer images are not shown; 1 shows all.", this);
  min_age_->setMin(1);
  redrawWith(min_age_);
  trail_images_ =
      new rviz::IntProperty("Trail", 0,
                            "The ends of each line are followed back over so many images. Each image has its "
                            "place in the fixed frame: with the "
                            "frame of the camera as fixed frame, the trail is the movement in the image.",
                            this);
  trail_images_->setMin(0);
  trail_images_->setMax(kMaxTrail);
  redrawWith(trail_images_);
  frustum_ = new rviz::BoolProperty(
      "Frustum", defaults.frustum,
      "Draw what the camera sees, as far as the plane of the lines: the border of the raw picture, or what "
      "the pinhole camera sees which fits the lines best, so roughly for a lens with much distortion.",
      this);
  redrawWith(frustum_);
  makeCommonProperties(0.004F, 0.03F);

  for (rviz::Property* property :
       {static_cast<rviz::Property*>(picture_), static_cast<rviz::Property*>(camera_info_topic_)}) {
    QObject::connect(property, &rviz::Property::changed, this, &LineArrayDisplay::subscribeToCameraInfo);
  }
  camera_info_topic_->hide();
  QObject::connect(colouring_, &rviz::Property::changed, this, &LineArrayDisplay::showScaleOfColouring);
  showScaleOfColouring();
}

void LineArrayDisplay::onInitialize() {
  LineDisplay::onInitialize();
  topic_property_->setString("/line_tracker/lines");
}

void LineArrayDisplay::showScaleOfColouring() {
  longest_->setHidden(colouring_->getOptionInt() != static_cast<int>(Colouring::kLength));
  largest_sigma_->setHidden(colouring_->getOptionInt() != static_cast<int>(Colouring::kSigma));
}

LineArrayStyle LineArrayDisplay::style() const {
  LineArrayStyle style;
  style.colouring = static_cast<Colouring>(colouring_->getOptionInt());
  style.depth = depth_->getFloat();
  style.min_age = static_cast<std::uint32_t>(min_age_->getInt());
  style.longest = longest_->getFloat();
  style.largest_sigma = largest_sigma_->getFloat();
  style.trail = static_cast<std::size_t>(trail_images_->getInt());
  style.alpha = alpha_->getFloat();
  style.ids = ids_->getBool();
  style.frustum = frustum_->getBool();
  return style;
}

void LineArrayDisplay::processMessage(const LineArray::ConstPtr& message) {
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  const bool known = context_->getFrameManager()->getTransform(message->header, position, orientation);
  tellTransform(known, message->header.frame_id);
  if (!known) return;
  trail_.add(message, toEigen(position, orientation), static_cast<std::size_t>(trail_images_->getInt()));
  redraw();
}

void LineArrayDisplay::subscribe() {
  LineDisplay::subscribe();
  subscribeToCameraInfo();
}

void LineArrayDisplay::unsubscribe() {
  camera_info_subscriber_.shutdown();
  LineDisplay::unsubscribe();
}

bool LineArrayDisplay::isRaw() const {
  return picture_->getOptionInt() == kRaw;
}

void LineArrayDisplay::subscribeToCameraInfo() {
  camera_info_topic_->setHidden(!isRaw());
  camera_info_subscriber_.shutdown();
  camera_info_.reset();
  raw_.reset();
  deleteStatus(kCameraInfoStatus);
  if (isRaw() && isEnabled() && !camera_info_topic_->getTopicStd().empty()) {
    try {
      camera_info_subscriber_ = update_nh_.subscribe(camera_info_topic_->getTopicStd(), 1,
                                                     &LineArrayDisplay::processCameraInfo, this);
    } catch (const ros::Exception& error) {
      setStatus(StatusProperty::Error, kCameraInfoStatus, QString("Error subscribing: ") + error.what());
    }
  }
  redraw();
}

void LineArrayDisplay::processCameraInfo(const sensor_msgs::CameraInfo::ConstPtr& info) {
  if (camera_info_ && sameCalibration(*info, *camera_info_) && info->P == camera_info_->P) return;
  camera_info_ = info;
  raw_.reset();
  redraw();
}

std::shared_ptr<const RawPicture> LineArrayDisplay::rawPicture() {
  if (!camera_info_subscriber_) {
    if (camera_info_topic_->getTopicStd().empty()) {
      setStatus(StatusProperty::Error, kCameraInfoStatus, "The topic of the calibration is missing");
    }
    return nullptr;
  }
  if (!camera_info_) {
    setStatus(StatusProperty::Warn, kCameraInfoStatus,
              QString("No message has come on [%1]: lines cannot be laid over the raw picture without it")
                  .arg(camera_info_topic_->getTopic()));
    return nullptr;
  }
  if (trail_.images().empty()) return nullptr;
  const LineArray& image = *trail_.images().back().message;
  if (!raw_ || raw_width_ != image.width || raw_height_ != image.height) {
    raw_ = chooseRawPicture(*camera_info_, image.width, image.height);
    raw_width_ = image.width;
    raw_height_ = image.height;
  }
  if (raw_->picture) {
    setStatus(StatusProperty::Ok, kCameraInfoStatus, QString::fromStdString(imageText(*camera_info_)));
  } else {
    setStatus(StatusProperty::Error, kCameraInfoStatus, QString::fromStdString(raw_->problem));
  }
  return raw_->picture;
}

ShownLines LineArrayDisplay::show() {
  LineArrayStyle style_of_now = style();
  if (isRaw()) {
    style_of_now.raw = rawPicture();
    if (!style_of_now.raw) return {};
  }
  ShownLines shown = showLines(trail_.images(), style_of_now);
  if (trail_.images().empty()) return shown;
  tellCounts(shown);
  tellWithoutPlace(shown);
  return shown;
}

void LineArrayDisplay::tellWithoutPlace(const ShownLines& shown) {
  if (shown.without_place > 0) {
    const std::size_t all = trail_.images().back().message->lines.size();
    setStatus(
        shown.without_place == all ? StatusProperty::Error : StatusProperty::Warn, "Calibration",
        QString("%1 of %2 lines have no normalized endpoints: the tracker has no calibration of the camera "
                "(camera_info)")
            .arg(shown.without_place)
            .arg(all));
  } else {
    deleteStatus("Calibration");
  }
}

}  // namespace tet_line_tracker

PLUGINLIB_EXPORT_CLASS(tet_line_tracker::LineArrayDisplay, rviz::Display)
