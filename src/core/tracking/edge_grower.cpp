#include "tracking/edge_grower.h"

#include <algorithm>
#include <cmath>

namespace tet_line_tracker {
namespace {

constexpr int kRounds = 4;                // of a new line
constexpr std::uint64_t kImages = 4;      // from one try at both ends of a tracked line to the next
constexpr float kStep = 0.5F;             // of a round, in lengths of the line
constexpr float kMinStep = 16.0F;         // [px]
constexpr float kMaxStep = 96.0F;         // [px]
constexpr float kMaxGap = 0.05F;          // that is bridged, in lengths of the line
constexpr float kMinMaxGap = 4.0F;        // such a gap is bridged by any line [px]
constexpr float kLook = 16.0F;            // the first look beyond the end of a tracked line [px]
constexpr float kLookShare = 0.5F;        // of the contrast of the line: the edge goes on
constexpr float kMinGrowth = 4.0F;        // less is noise [px]
constexpr float kMinSupport = 0.8F;       // of the whole line, before and after
constexpr float kMaxDisagreement = 0.5F;  // of the old ends with the new line [px]

}  // namespace

bool EdgeGrower::grow(const cv::Mat& gray, const VisibleArea& area, float margin, EdgeFit& edge,
                      LineBend& bend) const {
  int round = 0;
  while (round < kRounds && growOnce(gray, area, margin, kStartCut | kEndCut, edge, bend)) ++round;
  return round > 0;
}

bool EdgeGrower::growTracked(const cv::Mat& gray, const VisibleArea& area, std::uint64_t image,
                             const TrackedLine& line, EdgeFit& edge, LineBend& bend) const {
  // Not all tracks in the same image: ids follow each other.
  unsigned ends = (image + line.id) % kImages == 0 ? kStartCut | kEndCut : line.cut;
  const LineCurve curve(edge.segment, bend);
  for (const unsigned end : {kStartCut, kEndCut}) {
    if ((ends & end) != 0 && !mayGoOn(gray, curve, end == kEndCut, edge.contrast)) ends &= ~end;
  }
  return ends != 0 && growOnce(gray, area, 0.0F, ends, edge, bend);
}

bool EdgeGrower::mayGoOn(const cv::Mat& gray, const LineCurve& line, bool at_end, float contrast) const {
  const Eigen::Vector2f chord = line.chord.end - line.chord.start;
  const float slope = line.bend.slope(at_end ? 1.0F : 0.0F);
  const Eigen::Vector2f way = kLook * (chord + slope * line.chord.normal()).normalized();
  const LineSegment ahead = at_end ? LineSegment{line.chord.end, line.chord.end + way}
                                   : LineSegment{line.chord.start - way, line.chord.start};
  return refiner_.contrastOf(gray, ahead) >= kLookShare * contrast;
}

bool EdgeGrower::growOnce(const cv::Mat& gray, const VisibleArea& area, float margin, unsigned ends,
                          EdgeFit& edge, LineBend& bend) const {
  if (edge.support < kMinSupport) return false;
  const LineSegment& line = edge.segment;
  LineCurve whole(line);
  if ((ends & kEndCut) != 0) whole.chord.end = endOfEdge(gray, area, margin, line, edge.contrast);
  if ((ends & kStartCut) != 0) {
    // Seen the other way round the other side is brighter.
    whole.chord.start = endOfEdge(gray, area, margin, {line.end, line.start}, -edge.contrast);
  }
  if (whole.chord.start == line.start && whole.chord.end == line.end) return false;
  whole.bend = area.lens().between(whole.chord);
  const EdgeFit fit = refiner_.fit(gray, whole, edge.contrast);
  if (fit.support < kMinSupport) return false;
  const LineCurve fitted(fit.segment, whole.bend);
  if (std::abs(fitted.distance(line.start)) > kMaxDisagreement ||
      std::abs(fitted.distance(line.end)) > kMaxDisagreement) {
    return false;
  }
  edge = fit;
  bend = whole.bend;
  return true;
}

Eigen::Vector2f EdgeGrower::endOfEdge(const cv::Mat& gray, const VisibleArea& area, float margin,
                                      const LineSegment& line, float contrast) const {
  const float length = line.length();
  const float step = std::clamp(kStep * length, kMinStep, kMaxStep);
  LineCurve ahead = area.lens().curve({line.end, area.lens().beyond(line, step)});
  if (!area.cutToBounds(margin, ahead) || ahead.chord.start != line.end) return line.end;
  const float reach = refiner_.reachOf(gray, ahead, contrast, std::max(kMinMaxGap, kMaxGap * length));
  if (reach < kMinGrowth) return line.end;
  const Eigen::Vector2f end = ahead.at(reach / ahead.chord.length());
  return area.sees(end) ? end : line.end;
}

}  // namespace tet_line_tracker
