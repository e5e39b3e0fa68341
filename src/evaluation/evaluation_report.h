#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "absolute_error.h"
#include "surface_measures.h"
#include "three_view_error.h"
#include "track_measures.h"

namespace tet_line_tracker {

/// The measures of one bag with its name.
struct EvaluatedBag {
  std::string name;
  std::string truth;  ///< "scene", "depth", "poses" or "none"
  TrackMeasures measures;
  std::optional<AbsoluteMeasures> absolute{};  ///< when asked for, and the truth is a scene
  ThreeViewMeasures three_view{};              ///< where poses are known
  std::vector<SurfaceMeasures> surfaces{};     ///< when asked for, and the truth is a scene
};

/// One row per bag, for people.
void writeText(std::ostream& out, const std::vector<EvaluatedBag>& bags);
/// The absolute errors, one row per bag and class of length, for people. A bag without has one row of "-".
void writeAbsoluteText(std::ostream& out, const std::vector<EvaluatedBag>& bags);
/// What the lines are on, one row per bag and kind of surface that has lines, for people.
void writeSurfaceText(std::ostream& out, const std::vector<EvaluatedBag>& bags);
/// One row per bag with all measures; unknown ones are empty. Columns of absolute errors and of surfaces when
/// a bag has them.
void writeCsv(std::ostream& out, const std::vector<EvaluatedBag>& bags);
/// All measures, survival curves, lines over time and a histogram of errors; unknown values are null.
/// `with_pairs`: also the verdict on every line pair.
void writeJson(std::ostream& out, const std::vector<EvaluatedBag>& bags, bool with_pairs);

}  // namespace tet_line_tracker
