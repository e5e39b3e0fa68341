#include "contiguous_ids.h"

#include <unordered_set>
#include <utility>

namespace tet_line_tracker {

std::vector<std::uint32_t> ContiguousIds::assign(const LineArray& array,
                                                 const std::vector<const Line*>& lines) {
  // 0 marks a new line: kFirst is larger.
  std::vector<std::uint32_t> ids(lines.size(), 0);
  std::unordered_set<std::uint32_t> in_use;
  if (array.epoch == epoch_ && array.image_count >= image_count_) {
    const std::uint64_t images = array.image_count - image_count_;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const auto before = sent_.find(lines[i]->id);
      // A track is one image older in each image. Where that does not add up, another tracker (a node that
      // was restarted) uses the same numbers for other lines.
      if (before == sent_.end() || before->second.age + images != lines[i]->age) continue;
      ids[i] = before->second.id;
      in_use.insert(ids[i]);
    }
  }

  std::unordered_map<std::uint64_t, Sent> now;
  now.reserve(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    while (ids[i] == 0) {
      if (in_use.count(next_) == 0) ids[i] = next_;
      next_ = next_ == kLast ? kFirst : next_ + 1;
    }
    now[lines[i]->id] = {ids[i], lines[i]->age};
  }
  sent_ = std::move(now);
  epoch_ = array.epoch;
  image_count_ = array.image_count;
  return ids;
}

}  // namespace tet_line_tracker
