#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "tet_line_tracker/tracking/line_frame.h"

namespace tet_line_tracker {

/// Holds a stream of line messages against the rules that every consumer relies on (README, "Messages"): ids
/// are contiguous, unique in a message and never come back; ages and counts go up by one; values are finite
/// where they must be; lines lie inside the image and are long enough; images and messages pair up.
class LineRules {
 public:
  /// `min_length`: of every line [px].
  explicit LineRules(double min_length);

  /// The next message, in the order of publication.
  void add(const LineFrame& frame);
  /// An image of the stream that was tracked, in any order relative to add().
  void addImage(std::int64_t stamp_ns, int width, int height);
  /// After the last message: pairs images with messages. Without images this checks nothing.
  void finish();

  /// Broken rules with how often each was broken, and its first occasion in words.
  struct Violation {
    std::size_t count{0};
    std::string first;
  };
  const std::map<std::string, Violation>& violations() const { return violations_; }
  std::size_t messages() const { return messages_; }
  std::size_t lines() const { return lines_; }
  /// Lines without normalised endpoints: the image had no calibration.
  std::size_t linesNotNormalized() const { return lines_not_normalized_; }

 private:
  void require(bool holds, const char* rule, const LineFrame& frame, std::optional<std::uint64_t> id = {});
  void checkStream(const LineFrame& frame);
  void checkLine(const LineFrame& frame, const TrackedLine& line);

  struct Size {
    int width, height;
  };
  struct Seen {
    std::uint64_t message;  ///< the last one that held the id
    std::uint32_t age;      ///< in that message
  };
  double min_length_;
  std::size_t messages_{0}, lines_{0}, lines_not_normalized_{0};
  std::uint32_t epoch_{0};
  std::uint64_t image_count_{0};
  std::int64_t stamp_ns_{0};
  bool joined_late_{false};  ///< the stream began before the first message: ages are only known from then on
  std::unordered_map<std::uint64_t, Seen> ids_;  ///< of this epoch
  std::map<std::int64_t, Size> images_;
  std::map<std::int64_t, Size> message_sizes_;
  std::map<std::string, Violation> violations_;
};

}  // namespace tet_line_tracker
