#include "parameter_arguments.h"

#include <set>
#include <stdexcept>

#include <yaml-cpp/yaml.h>

namespace tet_line_tracker {

void setParameters(const std::string& file, const std::vector<std::string>& settings, ParameterTable& table) {
  if (!file.empty()) {
    YAML::Node yaml;
    try {
      yaml = YAML::LoadFile(file);
    } catch (const YAML::Exception& error) {
      throw std::runtime_error("cannot read " + file + ": " + error.what());
    }
    if (!yaml.IsMap()) throw std::runtime_error(file + " is no list of `name: value` lines");
    std::set<std::string> names;
    for (const auto& entry : yaml) {
      // YAML forbids it, yaml-cpp takes it.
      if (!names.insert(entry.first.Scalar()).second) {
        throw std::runtime_error(file + ":" + std::to_string(entry.first.Mark().line + 1) + ": " +
                                 entry.first.Scalar() + " is set twice");
      }
      if (!entry.second.IsScalar()) {
        throw std::runtime_error(file + ": " + entry.first.Scalar() + " is not a single value");
      }
      table.set(entry.first.Scalar(), entry.second.Scalar());
    }
  }
  for (const std::string& setting : settings) {
    const std::size_t equals = setting.find('=');
    if (equals == std::string::npos)
      throw std::runtime_error("--set " + setting + " needs the form name=value");
    table.set(setting.substr(0, equals), setting.substr(equals + 1));
  }
}

}  // namespace tet_line_tracker
