#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include <yaml-cpp/yaml.h>

namespace tet_line_tracker {

/// Top level of a YAML file, which must be a map. Throws std::runtime_error with the file's name (and line).
YAML::Node loadYaml(const std::filesystem::path& path);

/// A positive whole number. Throws std::runtime_error that names file and key.
int yamlSize(const YAML::Node& node, const std::string& where);
std::string yamlText(const YAML::Node& node, const std::string& where);
/// Finite numbers of a list; `count` 0: any number of them. Throws std::runtime_error that names file and
/// key.
std::vector<double> yamlNumbers(const YAML::Node& node, std::size_t count, const std::string& where);

}  // namespace tet_line_tracker
