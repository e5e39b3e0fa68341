#pragma once

#include <string>

#include "tet_line_tracker/parameters/parameter_table.h"

namespace tet_line_tracker {

/// README's table: name, default, range, unit and meaning of each entry, one row each; of the tracker also
/// whether it may change while images come. `node`: whose table it is.
std::string markdownOf(const ParameterTable& table, const std::string& node);

/// `text` with the part between the two parameter markers of a node replaced by `markdown`. The first marker
/// names the command that does this: list_parameters --update, with --node for nodes other than the tracker.
/// Throws std::runtime_error when a marker is missing.
std::string withParameters(const std::string& text, const std::string& node, const std::string& markdown);

/// Name of the tracker for withParameters().
extern const char* const kTrackerNode;

}  // namespace tet_line_tracker
