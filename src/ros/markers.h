#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include <visualization_msgs/MarkerArray.h>

#include "tet_line_tracker/tracking/line_frame.h"

namespace tet_line_tracker {

/// Lines as rviz markers on the plane z = 1 of the camera's optical frame, coloured by age: namespace
/// "lines", and "ids" for the texts. There a line is straight whatever the lens, so the straight marker lies
/// on the edge all along. Lines without normalised endpoints have no marker.
class MarkerBuilder {
 public:
  explicit MarkerBuilder(bool ids) : ids_(ids) {}

  /// For the images to come.
  void setIds(bool ids) { ids_ = ids; }

  /// Markers of an image whose frame is `frame_id`. They replace those of the image before; a new epoch
  /// begins with DELETEALL.
  visualization_msgs::MarkerArray build(const LineFrame& frame, const std::string& frame_id);

 private:
  bool ids_;
  std::optional<std::uint32_t> epoch_;
  std::size_t shown_ids_{0};  ///< texts of the image before
};

}  // namespace tet_line_tracker
