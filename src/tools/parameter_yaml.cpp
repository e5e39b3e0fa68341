#include "parameter_yaml.h"

#include <algorithm>
#include <sstream>

namespace tet_line_tracker {
namespace {

/// An empty text in quotes: without them YAML reads nothing at all, which is no text.
std::string yamlValue(const ParameterTable::Entry& entry) {
  const std::string text = ParameterTable::valueText(entry);
  return text.empty() ? "\"\"" : text;
}

}  // namespace

std::string yamlOf(const ParameterTable& table) {
  std::size_t width = 0;
  for (const ParameterTable::Entry& entry : table.entries()) {
    width = std::max(width, entry.name.size() + 2 + yamlValue(entry).size());
  }
  std::ostringstream text;
  text << "# Parameters of the node line_tracker and of the tool track_bag, all at their defaults: copy the "
          "file "
          "and change what you need.\n"
          "# Names that are not known and values out of range stop the node with a sentence that says so.\n"
          "# Written by: rosrun tet_line_tracker list_parameters --yaml\n\n";
  for (const ParameterTable::Entry& entry : table.entries()) {
    std::string line = entry.name + ": " + yamlValue(entry);
    line.resize(width, ' ');
    text << line << "  # " << entry.meaning << "; " << ParameterTable::rangeText(entry) << "\n";
  }
  return text.str();
}

}  // namespace tet_line_tracker
