#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "track_measures.h"

namespace tet_line_tracker {

/// The measures of one bag with its name.
struct EvaluatedBag {
  std::string name;
  std::string truth;  ///< "scene", "depth" or "none"
  TrackMeasures measures;
};

/// One row per bag, for people.
void writeText(std::ostream& out, const std::vector<EvaluatedBag>& bags);
/// One row per bag with all measures; unknown ones are empty.
void writeCsv(std::ostream& out, const std::vector<EvaluatedBag>& bags);
/// All measures, survival curves, lines over time and a histogram of errors; unknown values are null.
/// `with_pairs`: also the verdict on every line pair.
void writeJson(std::ostream& out, const std::vector<EvaluatedBag>& bags, bool with_pairs);

}  // namespace tet_line_tracker
