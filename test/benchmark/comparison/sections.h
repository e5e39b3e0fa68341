#pragma once

#include "sequence.h"

namespace tet_line_tracker {

// The sections of the report, each printed as Markdown.

/// Whole front ends on the same stream.
void compareFrontEnds(const Sequence& sequence, std::size_t images);
/// Pyramid, and flow of endpoints on given pyramids, beside OpenCV's; with the errors on known shifts.
void compareFlow(const Sequence& sequence, std::size_t images);
/// Line detectors: times, lines found again after the true motion, false lines in noise.
void compareDetectors(const Sequence& sequence, std::size_t images);
/// Cost of our stages over image size and number of lines, with fitted exponents.
void showScaling(const Sequence& sequence, std::size_t images);

}  // namespace tet_line_tracker
