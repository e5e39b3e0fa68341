#pragma once

#include <cstdint>
#include <optional>

#include "tet_line_tracker/parameters/parameters.h"

namespace tet_line_tracker {

/// What to do with the next image of a stream.
enum class StreamVerdict {
  kTrack,          ///< follows the image before
  kNewEpoch,       ///< first image, or the stream jumped: forget the tracks, then use the image
  kDropLate,       ///< its stamp is before the last one
  kDropDuplicate,  ///< its stamp is the last one's
  kDropZero        ///< it has no stamp
};

inline bool isDropped(StreamVerdict verdict) {
  return verdict != StreamVerdict::kTrack && verdict != StreamVerdict::kNewEpoch;
}

/// Decides by stamps and sizes alone whether an image continues a stream (open bags, live cameras, bag
/// loops). A single late image is dropped; when kLateImagesForNewEpoch images in a row, each later than the
/// one before, are all behind the last accepted one, the stream has jumped back for good and a new epoch
/// begins.
class StreamGate {
 public:
  static constexpr int kLateImagesForNewEpoch = 3;

  struct Dropped {
    std::uint32_t late{0}, duplicate{0}, zero{0};
  };

  explicit StreamGate(const StreamParameters& parameters);

  /// For the images to come.
  void setParameters(const StreamParameters& parameters);

  /// Verdict for an image with this stamp [ns] and size [px]; remembers it when it is to be used.
  StreamVerdict admit(std::int64_t stamp_ns, int width, int height);
  /// The next image starts a new epoch.
  void reset();
  /// Images dropped since construction.
  const Dropped& dropped() const { return dropped_; }
  /// Stamp of the last accepted image [ns], if any in this epoch.
  std::optional<std::int64_t> lastStamp() const { return last_stamp_ns_; }

 private:
  std::int64_t max_gap_ns_{0};
  std::optional<std::int64_t> last_stamp_ns_;
  int width_{0}, height_{0};
  std::int64_t late_stamp_ns_{0};
  int late_in_a_row_{0};
  Dropped dropped_;
};

}  // namespace tet_line_tracker
