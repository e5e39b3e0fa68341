#pragma once

#include <rviz/properties/enum_property.h>
#include <rviz/properties/int_property.h>

#include "line3d_array_view.h"
#include "line_display.h"
#include "tet_line_tracker/Line3DArray.h"

namespace tet_line_tracker {

/// Shows a map of lines, in its frame, which may move in the fixed frame.
class Line3DArrayDisplay : public LineDisplay<Line3DArray> {
 public:
  Line3DArrayDisplay();

  void update(float wall_dt, float ros_dt) override;

 protected:
  void onInitialize() override;
  void fixedFrameChanged() override;
  void processMessage(const Line3DArray::ConstPtr& message) override;
  ShownLines show() override;
  void forget() override { map_.reset(); }

 private:
  Line3DArrayStyle style() const;
  void showScaleOfColouring();

  rviz::EnumProperty* colouring_;
  rviz::FloatProperty* largest_sigma_;
  rviz::BoolProperty* height_bounds_of_map_;
  rviz::FloatProperty* lowest_;
  rviz::FloatProperty* highest_;
  rviz::BoolProperty* live_;
  rviz::BoolProperty* finished_;
  rviz::FloatProperty* max_sigma_;
  rviz::IntProperty* min_views_;
  Line3DArray::ConstPtr map_;  ///< the newest
};

}  // namespace tet_line_tracker
