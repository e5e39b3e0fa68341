#include "yaml_file.h"

#include <cmath>
#include <stdexcept>

namespace tet_line_tracker {
namespace {

template <class T>
T yamlValue(const YAML::Node& node, const std::string& where, const char* needed) {
  if (!node) throw std::runtime_error(where + " is missing");
  try {
    return node.as<T>();
  } catch (const YAML::Exception&) {
    throw std::runtime_error(where + " is not " + needed);
  }
}

}  // namespace

YAML::Node loadYaml(const std::filesystem::path& path) {
  // A fifo would wait for a writer.
  if (!std::filesystem::is_regular_file(path)) throw std::runtime_error("cannot read " + path.string());
  YAML::Node node;
  try {
    node = YAML::LoadFile(path.string());
  } catch (const YAML::BadFile&) {
    throw std::runtime_error("cannot read " + path.string());
  } catch (const YAML::Exception& error) {
    throw std::runtime_error(path.string() + ":" + std::to_string(error.mark.line + 1) +
                             ": not YAML: " + error.msg);
  }
  if (!node.IsMap()) throw std::runtime_error(path.string() + " is not a YAML map");
  return node;
}

int yamlSize(const YAML::Node& node, const std::string& where) {
  const int value = yamlValue<int>(node, where, "a whole number");
  if (value <= 0) throw std::runtime_error(where + " is " + std::to_string(value) + ", needs more than 0");
  return value;
}

std::string yamlText(const YAML::Node& node, const std::string& where) {
  return yamlValue<std::string>(node, where, "a word");
}

std::vector<double> yamlNumbers(const YAML::Node& node, std::size_t count, const std::string& where) {
  std::vector<double> numbers = yamlValue<std::vector<double>>(node, where, "a list of numbers");
  if (count != 0 && numbers.size() != count) {
    throw std::runtime_error(where + " has " + std::to_string(numbers.size()) + " numbers, needs " +
                             std::to_string(count));
  }
  for (const double number : numbers) {
    if (!std::isfinite(number)) throw std::runtime_error(where + " holds a number that is not finite");
  }
  return numbers;
}

}  // namespace tet_line_tracker
