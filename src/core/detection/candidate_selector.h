#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "tet_line_tracker/geometry/line_segment.h"

namespace tet_line_tracker {

/// Chooses among detected segments: the longest and best spread ones first. The score of a candidate is its
/// length, each part of it divided by one plus the length of the lines that its cell of an 8x6 grid over the
/// image already holds. Equal scores go to the candidate that came first. Buffers are kept between images.
class CandidateSelector {
 public:
  /// Begins with an empty image of this size [px]. `candidates` must stay unchanged until the next start().
  void start(int width, int height, const std::vector<LineSegment>& candidates);

  /// Fills the cells of a line that is tracked or was chosen.
  void add(const LineSegment& line);

  /// A candidate with a lower score adds nothing: its cells are full of lines [cell sides].
  static constexpr float kMinScore = 0.15F;

  /// The candidate with the highest score that next() has not returned yet; nullptr when none is left with
  /// kMinScore.
  const LineSegment* next();

 private:
  static constexpr int kColumns = 8;
  static constexpr int kRows = 6;

  struct Entry {
    float score;
    std::size_t candidate;
    bool operator<(const Entry& other) const {
      return score < other.score || (score == other.score && candidate > other.candidate);
    }
  };

  /// Calls `visit` with each cell of the line, and the length in it [cell sides].
  template <class Visit>
  void visitCells(const LineSegment& line, const Visit& visit) const;
  float scoreOf(const LineSegment& line) const;

  Eigen::Vector2f cells_per_px_{0.0F, 0.0F};
  float cell_px_{1.0F};
  std::array<float, static_cast<std::size_t>(kColumns* kRows)> filled_{};  ///< with lines [cell sides]
  const std::vector<LineSegment>* candidates_{nullptr};
  std::vector<Entry> heap_;  ///< scores are upper bounds: cells only fill up
};

}  // namespace tet_line_tracker
