#pragma once

#include <string>

#include "tet_line_tracker/parameter_table.h"

namespace tet_line_tracker {

/// README's table: name, default, range, unit and meaning of each entry, one row each.
std::string markdownOf(const ParameterTable& table);

/// The text of a README with the part between its two parameter markers replaced by `markdown`. Throws
/// std::runtime_error when a marker is missing.
std::string withParameters(const std::string& readme, const std::string& markdown);

}  // namespace tet_line_tracker
