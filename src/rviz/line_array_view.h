#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>

#include "line_trail.h"
#include "raw_picture.h"
#include "shown_lines.h"

namespace tet_line_tracker {

/// How the lines of images are shown.
struct LineArrayStyle {
  enum class Colouring { kId, kAge, kLength, kSigma };

  Colouring colouring{Colouring::kAge};
  double depth{1.0};          ///< of the plane on which the lines are drawn, from the camera [m]
  std::uint32_t min_age{1};   ///< younger lines are not shown [images]
  double longest{300.0};      ///< length from which on a line has the last colour [px]
  double largest_sigma{0.5};  ///< sigma from which on a line has the last colour [px]
  std::size_t trail{0};       ///< images over which endpoints are followed back
  float alpha{1.0F};          ///< of the lines; the trail fades from there to transparent
  bool ids{false};
  bool frustum{false};  ///< draw the view of the camera as far as the plane of the lines
  /// Lines are drawn where they lie over this picture, bent as the lens bends them; nullptr: undistorted.
  std::shared_ptr<const RawPicture> raw;
};

/// The lines of the newest image of `images` with the paths on which their endpoints came; each path has the
/// colour of its line. Over a raw picture, lines without normalised ends are straight between their pixels,
/// as the tracker has them. The message does not hold the calibration: without a raw picture, the frustum is
/// that of the pinhole camera which fits the ends of the lines best, and is not drawn when there are fewer
/// than three lines.
ShownLines showLines(const std::deque<PosedLines>& images, const LineArrayStyle& style);

}  // namespace tet_line_tracker
