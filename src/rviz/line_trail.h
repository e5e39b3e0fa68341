#pragma once

#include <cstddef>
#include <deque>

#include <Eigen/Geometry>

#include "tet_line_tracker/LineArray.h"

namespace tet_line_tracker {

/// The lines of an image and where its camera was.
struct PosedLines {
  LineArray::ConstPtr message;
  Eigen::Isometry3d pose;  ///< takes points of the camera's frame to the fixed frame
};

/// The newest images with their lines. Forgets all of them when what comes next does not follow them: a stamp
/// or a count of images that does not grow (a bag that starts again, a restarted tracker), a new epoch, or
/// another camera.
class LineTrail {
 public:
  /// Adds an image and keeps `earlier` images before it.
  void add(const LineArray::ConstPtr& message, const Eigen::Isometry3d& pose, std::size_t earlier);

  void clear() { images_.clear(); }

  /// The oldest first.
  const std::deque<PosedLines>& images() const { return images_; }

 private:
  std::deque<PosedLines> images_;
};

}  // namespace tet_line_tracker
