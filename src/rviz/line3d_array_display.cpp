#include "line3d_array_display.h"

#include <cstdint>
#include <limits>

#include <OgreQuaternion.h>
#include <ros/time.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/properties/ros_topic_property.h>
#include <pluginlib/class_list_macros.hpp>

namespace tet_line_tracker {
namespace {

using Colouring = Line3DArrayStyle::Colouring;

}  // namespace

Line3DArrayDisplay::Line3DArrayDisplay() {
  const Line3DArrayStyle defaults;
  colouring_ = new rviz::EnumProperty(
      "Color By", "Sigma",
      "Sigma: from blue (certain) to red. Height: from blue (low) to red (high), along z of "
      "the map. State: green while the line is tracked, blue when it is finished.",
      this);
  colouring_->addOption("Sigma", static_cast<int>(Colouring::kSigma));
  colouring_->addOption("Height", static_cast<int>(Colouring::kHeight));
  colouring_->addOption("State", static_cast<int>(Colouring::kState));
  redrawWith(colouring_);
  largest_sigma_ = makeFloat("Largest Sigma", static_cast<float>(defaults.largest_sigma),
                             "Lines with this standard deviation and more are red [m].", 0.0001F);
  height_bounds_of_map_ =
      new rviz::BoolProperty("Height Bounds of Map", defaults.height_bounds_of_map,
                             "The colors go from the lowest to the highest line that is shown.", this);
  redrawWith(height_bounds_of_map_);
  constexpr float kAnyHeight = -std::numeric_limits<float>::max();
  lowest_ = makeFloat("Lowest", static_cast<float>(defaults.lowest),
                      "Lines at this height and below are blue [m].", kAnyHeight);
  highest_ = makeFloat("Highest", static_cast<float>(defaults.highest),
                       "Lines at this height and above are red [m].", kAnyHeight);
  live_ = new rviz::BoolProperty("Live Lines", defaults.live, "Show lines that are still tracked.", this);
  redrawWith(live_);
  finished_ = new rviz::BoolProperty("Finished Lines", defaults.finished,
                                     "Show lines whose track has ended: they do not change any more.", this);
  redrawWith(finished_);
  max_sigma_ = makeFloat("Max Sigma", 0.0F,
                         "Lines with a larger standard deviation are not shown [m]; 0 shows all.", 0.0F);
  min_views_ = new rviz::IntProperty("Min Views", 0, "Lines that fewer images saw are not shown.", this);
  min_views_->setMin(0);
  redrawWith(min_views_);
  makeCommonProperties(0.015F, 0.1F);

  QObject::connect(colouring_, &rviz::Property::changed, this, &Line3DArrayDisplay::showScaleOfColouring);
  QObject::connect(height_bounds_of_map_, &rviz::Property::changed, this,
                   &Line3DArrayDisplay::showScaleOfColouring);
  showScaleOfColouring();
}

void Line3DArrayDisplay::onInitialize() {
  LineDisplay::onInitialize();
  topic_property_->setString("/line_mapper/lines");
}

void Line3DArrayDisplay::showScaleOfColouring() {
  const bool by_height = colouring_->getOptionInt() == static_cast<int>(Colouring::kHeight);
  largest_sigma_->setHidden(colouring_->getOptionInt() != static_cast<int>(Colouring::kSigma));
  height_bounds_of_map_->setHidden(!by_height);
  lowest_->setHidden(!by_height || height_bounds_of_map_->getBool());
  highest_->setHidden(!by_height || height_bounds_of_map_->getBool());
}

Line3DArrayStyle Line3DArrayDisplay::style() const {
  Line3DArrayStyle style;
  style.colouring = static_cast<Colouring>(colouring_->getOptionInt());
  style.largest_sigma = largest_sigma_->getFloat();
  style.height_bounds_of_map = height_bounds_of_map_->getBool();
  style.lowest = lowest_->getFloat();
  style.highest = highest_->getFloat();
  style.live = live_->getBool();
  style.finished = finished_->getBool();
  if (max_sigma_->getFloat() > 0.0F) style.max_sigma = max_sigma_->getFloat();
  style.min_views = static_cast<std::uint32_t>(min_views_->getInt());
  style.alpha = alpha_->getFloat();
  style.ids = ids_->getBool();
  return style;
}

void Line3DArrayDisplay::update(float /*wall_dt*/, float /*ros_dt*/) {
  if (!map_) return;
  Ogre::Vector3 position;
  Ogre::Quaternion orientation;
  // The map is at rest in its frame: where that frame is now counts, not where it was at the stamp.
  const bool known =
      context_->getFrameManager()->getTransform(map_->header.frame_id, ros::Time(), position, orientation);
  tellTransform(known, map_->header.frame_id);
  if (known) visual_->setPose(position, orientation);
}

void Line3DArrayDisplay::fixedFrameChanged() {
  // The publisher of a map that is complete is silent: what it sent last stays.
  const Line3DArray::ConstPtr map = map_;
  LineDisplay::fixedFrameChanged();
  if (map) processMessage(map);
}

void Line3DArrayDisplay::processMessage(const Line3DArray::ConstPtr& message) {
  map_ = message;
  redraw();
}

ShownLines Line3DArrayDisplay::show() {
  if (!map_) return {};
  ShownLines shown = showMap(*map_, style());
  tellCounts(shown);
  if (shown.without_place > 0) {
    setStatus(StatusProperty::Error, "Points",
              QString("%1 lines have ends that are not finite numbers").arg(shown.without_place));
  } else {
    deleteStatus("Points");
  }
  return shown;
}

}  // namespace tet_line_tracker

PLUGINLIB_EXPORT_CLASS(tet_line_tracker::Line3DArrayDisplay, rviz::Display)
