#include "line_trail.h"

namespace tet_line_tracker {
namespace {

bool follows(const LineArray& next, const LineArray& last) {
  return next.header.stamp > last.header.stamp && next.header.frame_id == last.header.frame_id &&
         next.epoch == last.epoch && next.image_count > last.image_count;
}

}  // namespace

void LineTrail::add(const LineArray::ConstPtr& message, const Eigen::Isometry3d& pose, std::size_t earlier) {
  if (!images_.empty() && !follows(*message, *images_.back().message)) images_.clear();
  images_.push_back({message, pose});
  while (images_.size() > earlier + 1) images_.pop_front();
}

}  // namespace tet_line_tracker
