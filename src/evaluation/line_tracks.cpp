#include "line_tracks.h"

#include <cstdint>
#include <unordered_map>

namespace tet_line_tracker {

std::vector<LineTrack> collectTracks(const std::vector<LineFrame>& frames) {
  std::vector<LineTrack> tracks;
  std::unordered_map<std::uint64_t, std::size_t> track_of_id;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (k > 0 && frames[k].epoch != frames[k - 1].epoch) track_of_id.clear();
    for (const TrackedLine& line : frames[k].lines) {
      const auto found = track_of_id.find(line.id);
      if (found == track_of_id.end() ||
          tracks[found->second].first_frame + tracks[found->second].lines.size() != k) {
        track_of_id[line.id] = tracks.size();
        tracks.push_back({k, {&line}});
      } else {
        tracks[found->second].lines.push_back(&line);
      }
    }
  }
  return tracks;
}

}  // namespace tet_line_tracker
