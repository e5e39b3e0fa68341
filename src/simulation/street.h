#pragma once

#include "world.h"

namespace tet_line_tracker {

/// A winding street of `options.street_length` from x = -30 on: houses, lamp posts, signs, parked cars,
/// fences, trees, kerbs and lane marks under a bright sky. The free box is that of a camera in the right
/// lane, relative to the centre line of RoadCurve(options.seed).
World makeStreet(const WorldOptions& options);

}  // namespace tet_line_tracker
