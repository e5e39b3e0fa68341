#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "tet_line_tracker/geometry/line_segment.h"

namespace tet_line_tracker {

/// Gives the longest and best spread of new lines first: what a line brings is its length, and in each cell
/// of an 8x6 grid over the image the less, the more length of lines already lies there. Equal bids go to the
/// line that came first among the candidates. Buffers are kept from start to start.
class SpreadChooser {
 public:
  /// Begins anew with an empty image of this size [px]. `candidates` must stay as they are until the next
  /// start.
  void start(int width, int height, const std::vector<LineSegment>& candidates);

  /// From now on `line` fills its cells.
  void add(const LineSegment& line);

  /// The best of the candidates that were not given yet; nullptr: none is left.
  const LineSegment* next();

 private:
  static constexpr int kColumns = 8;
  static constexpr int kRows = 6;

  struct Bid {
    float worth;
    std::size_t candidate;
    bool operator<(const Bid& other) const {
      return worth < other.worth || (worth == other.worth && candidate > other.candidate);
    }
  };

  /// Calls `visit` with each cell of the line, and the length in it [cell sides].
  template <class Visit>
  void visitCells(const LineSegment& line, const Visit& visit) const;
  float worthOf(const LineSegment& line) const;

  Eigen::Vector2f cells_per_px_{0.0F, 0.0F};
  float cell_px_{1.0F};
  std::array<float, static_cast<std::size_t>(kColumns* kRows)> filled_{};  ///< with lines [cell sides]
  const std::vector<LineSegment>* candidates_{nullptr};
  std::vector<Bid> bids_;  ///< heap; no candidate is worth more than it bids, as cells only fill up
};

}  // namespace tet_line_tracker
