#pragma once

#include <string>

#include "tet_line_tracker/parameters/parameter_table.h"

namespace tet_line_tracker {

/// The parameters of a table as a YAML file of `name: value` lines with their meaning and range as comments:
/// the text of config/line_tracker.yaml.
std::string yamlOf(const ParameterTable& table);

}  // namespace tet_line_tracker
