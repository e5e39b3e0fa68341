#pragma once

#include <string>
#include <vector>

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>

#include "tet_line_tracker/parameters/parameter_table.h"

namespace tet_line_tracker {

/// The values of `table` as dynamic_reconfigure sends them.
dynamic_reconfigure::Config toConfig(const ParameterTable& table);

/// Names, types, ranges and meanings for rqt_reconfigure and dynparam. `defaults`: a table whose fields are
/// at their defaults.
dynamic_reconfigure::ConfigDescription toConfigDescription(const ParameterTable& defaults);

/// Sets the fields of `table` that `config` names. One sentence for each value that is refused, and stays as
/// it was: an unknown name, a type or value that is not allowed, a parameter that is set at the start only.
std::vector<std::string> setFrom(const dynamic_reconfigure::Config& config, ParameterTable& table);

}  // namespace tet_line_tracker
