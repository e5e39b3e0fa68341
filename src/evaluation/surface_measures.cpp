#include "surface_measures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "undistorted_line.h"

namespace tet_line_tracker {
namespace {

using Votes = std::array<std::size_t, kSurfaceKinds>;

void vote(Votes& votes, SurfaceKind kind) {
  ++votes[static_cast<std::size_t>(kind)];
}

/// Nothing without votes.
std::optional<SurfaceKind> winnerOf(const Votes& votes) {
  const auto most = std::max_element(votes.begin(), votes.end());
  if (*most == 0) return std::nullopt;
  return static_cast<SurfaceKind>(most - votes.begin());
}

std::optional<SurfaceKind> kindOf(const TrackedLine& line, std::int64_t stamp_ns, const SceneTruth& truth) {
  constexpr int kPoints = 9;
  const UndistortedLine undistorted(truth.camera(), line);
  Votes votes{};
  for (int i = 0; i < kPoints; ++i) {
    const auto sample = undistorted.at((i + 0.5) / kPoints);
    const auto kind = sample ? truth.kindAt(stamp_ns, sample->pixel, sample->normal) : std::nullopt;
    if (kind) vote(votes, *kind);
  }
  return winnerOf(votes);
}

double ratio(std::size_t part, std::size_t whole) {
  return whole == 0 ? SurfaceMeasures::kUnknown : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

std::vector<SurfaceMeasures> measureSurfaces(const std::vector<LineFrame>& frames, const SceneTruth& truth,
                                             const std::vector<PairError>& pairs, double inlier_px) {
  struct Track {
    std::size_t lines{0};
    Votes votes{};
  };
  std::map<std::uint64_t, Track> tracks;
  for (const LineFrame& frame : frames) {
    for (const TrackedLine& line : frame.lines) {
      Track& track = tracks[line.id];
      ++track.lines;
      const auto kind = kindOf(line, frame.stamp_ns, truth);
      if (kind) vote(track.votes, *kind);
    }
  }

  Votes tracks_on{};
  Votes lines_on{};
  std::size_t all_lines = 0;
  std::map<std::uint64_t, SurfaceKind> kind_of;
  for (const auto& [id, track] : tracks) {
    all_lines += track.lines;
    const auto kind = winnerOf(track.votes);
    if (!kind) continue;
    kind_of.emplace(id, *kind);
    vote(tracks_on, *kind);
    lines_on[static_cast<std::size_t>(*kind)] += track.lines;
  }
  Votes judged{};
  Votes right{};
  for (const PairError& pair : pairs) {
    const auto kind = kind_of.find(pair.id);
    if (kind == kind_of.end() || std::isnan(pair.error)) continue;
    vote(judged, kind->second);
    if (pair.error < inlier_px) vote(right, kind->second);
  }

  std::vector<SurfaceMeasures> result;
  for (std::size_t i = 0; i < tracks_on.size(); ++i) {
    result.push_back({static_cast<SurfaceKind>(i), tracks_on[i], ratio(lines_on[i], all_lines),
                      ratio(lines_on[i], tracks_on[i]), ratio(right[i], judged[i])});
  }
  return result;
}

}  // namespace tet_line_tracker
