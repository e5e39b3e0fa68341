#pragma once

#include <string>
#include <vector>

#include "tet_line_tracker/parameters/parameter_table.h"

namespace tet_line_tracker {

/// Sets parameters from a YAML file of `name: value` lines (no file when empty) and then from name=value
/// arguments. Throws std::runtime_error or std::invalid_argument with one sentence that names what is wrong;
/// ranges are not checked.
void setParameters(const std::string& file, const std::vector<std::string>& settings, ParameterTable& table);

}  // namespace tet_line_tracker
