#pragma once

#include <cstdint>
#include <string>

#include "tet_line_tracker/LineArray.h"
#include "tet_line_tracker/TrackingStatistics.h"
#include "tet_line_tracker/tracking/line_frame.h"

namespace tet_line_tracker {

/// The lines of an image as published. `frame_id` is that of the image. `sequence` counts the messages of one
/// topic from 0: roscpp writes this number into header.seq when it serializes, so the same images give the
/// same bytes whether they are published or written to a bag.
LineArray toLineArray(const LineFrame& frame, const std::string& frame_id, std::uint32_t sequence);

/// The lines of a message, without statistics.
LineFrame toLineFrame(const LineArray& message);

/// What happened to the lines of an image. `dropped_queue`: images of this epoch that were replaced by a
/// newer one before their turn.
TrackingStatistics toTrackingStatistics(const LineFrame& frame, const std::string& frame_id,
                                        std::uint32_t sequence, std::uint32_t dropped_queue);

}  // namespace tet_line_tracker
