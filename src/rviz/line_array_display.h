#pragma once

#include <rviz/properties/enum_property.h>
#include <rviz/properties/int_property.h>

#include "line_array_view.h"
#include "line_display.h"
#include "line_trail.h"
#include "tet_line_tracker/LineArray.h"

namespace tet_line_tracker {

/// Shows the lines of the newest image on a plane in front of its camera, where tf says that the camera was.
/// There a line is straight whatever the lens.
class LineArrayDisplay : public LineDisplay<LineArray> {
 public:
  LineArrayDisplay();

 protected:
  void onInitialize() override;
  void processMessage(const LineArray::ConstPtr& message) override;
  ShownLines show() override;
  void forget() override { trail_.clear(); }

 private:
  LineArrayStyle style() const;
  void showScaleOfColouring();

  rviz::FloatProperty* depth_;
  rviz::EnumProperty* colouring_;
  rviz::FloatProperty* longest_;
  rviz::FloatProperty* largest_sigma_;
  rviz::IntProperty* min_age_;
  rviz::IntProperty* trail_images_;
  rviz::BoolProperty* frustum_;
  LineTrail trail_;
};

}  // namespace tet_line_tracker
