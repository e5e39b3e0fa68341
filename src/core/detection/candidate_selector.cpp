#include "detection/candidate_selector.h"

#include <algorithm>

#include "geometry/clamp.h"

namespace tet_line_tracker {

void CandidateSelector::start(int width, int height, const std::vector<LineSegment>& candidates) {
  cells_per_px_ = {static_cast<float>(kColumns) / static_cast<float>(width),
                   static_cast<float>(kRows) / static_cast<float>(height)};
  cell_px_ = 1.0F / cells_per_px_.maxCoeff();
  filled_.fill(0.0F);
  candidates_ = &candidates;
  heap_.clear();
  for (std::size_t i = 0; i < candidates.size(); ++i) heap_.push_back({scoreOf(candidates[i]), i});
  std::make_heap(heap_.begin(), heap_.end());
}

template <class Visit>
void CandidateSelector::visitCells(const LineSegment& line, const Visit& visit) const {
  const int steps = 2 + static_cast<int>(clampOrLow(2.0F * line.length() / cell_px_, 0.0F, 1e4F));
  const float share = line.length() / (static_cast<float>(steps) * cell_px_);
  for (int i = 0; i < steps; ++i) {
    const Eigen::Vector2f place =
        line.at((static_cast<float>(i) + 0.5F) / static_cast<float>(steps)).cwiseProduct(cells_per_px_);
    const int column = static_cast<int>(clampOrLow(place.x(), 0.0F, kColumns - 1));
    const int row = static_cast<int>(clampOrLow(place.y(), 0.0F, kRows - 1));
    visit(static_cast<std::size_t>(row * kColumns + column), share);
  }
}

void CandidateSelector::add(const LineSegment& line) {
  visitCells(line, [this](std::size_t cell, float length) { filled_[cell] += length; });
}

float CandidateSelector::scoreOf(const LineSegment& line) const {
  float score = 0.0F;
  visitCells(line, [&](std::size_t cell, float length) { score += length / (1.0F + filled_[cell]); });
  return score;
}

const LineSegment* CandidateSelector::next() {
  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end());
    Entry best = heap_.back();
    heap_.pop_back();
    best.score = scoreOf((*candidates_)[best.candidate]);
    if (heap_.empty() || !(best < heap_.front())) {
      return best.score < kMinScore ? nullptr : &(*candidates_)[best.candidate];
    }
    heap_.push_back(best);
    std::push_heap(heap_.begin(), heap_.end());
  }
  return nullptr;
}

}  // namespace tet_line_tracker
