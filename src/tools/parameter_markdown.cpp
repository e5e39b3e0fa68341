#include "parameter_markdown.h"

#include <limits>
#include <sstream>
#include <stdexcept>
#include <variant>

namespace tet_line_tracker {
namespace {

const std::string kEnd = "<!-- end of parameters -->\n";

std::string shortNumber(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string rangeOf(const ParameterTable::Entry& entry) {
  if (std::holds_alternative<bool*>(entry.field)) return "`true`, `false`";
  if (std::holds_alternative<std::string*>(entry.field)) {
    std::string words;
    for (const std::string& choice : entry.choices) words += (words.empty() ? "`" : ", `") + choice + "`";
    return words.empty() ? "any" : words;
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (entry.min == -kInfinity && entry.max == kInfinity) return "any";
  return shortNumber(entry.min) + " to " + shortNumber(entry.max) + (entry.odd ? ", odd" : "");
}

const char* textOf(ParameterTable::Change change) {
  if (change == ParameterTable::Change::kNewEpoch) return "new epoch";
  return change == ParameterTable::Change::kAtStart ? "no" : "yes";
}

}  // namespace

const char* const kTrackerNode = "line_tracker";

std::string markdownOf(const ParameterTable& table, const std::string& node) {
  // The other nodes read their parameters once.
  const bool live = node == kTrackerNode;
  std::string text = live ? "| name | default | range | unit | live | meaning |\n|---|---|---|---|---|---|\n"
                          : "| name | default | range | unit | meaning |\n|---|---|---|---|---|\n";
  for (const ParameterTable::Entry& entry : table.entries()) {
    const std::string value = ParameterTable::valueText(entry);
    text += "| `" + entry.name + "` | " + (value.empty() ? "(empty)" : "`" + value + "`") + " | " +
            rangeOf(entry) + " | " + entry.unit + " | " +
            (live ? textOf(entry.change) + std::string(" | ") : "") + entry.meaning + " |\n";
  }
  return text;
}

std::string withParameters(const std::string& text, const std::string& node, const std::string& markdown) {
  const std::string option = node == kTrackerNode ? "" : "--node " + node + " ";
  const std::string marker =
      "<!-- parameters: rosrun tet_line_tracker list_parameters " + option + "--update ";
  const std::size_t begin = text.find(marker);
  if (begin == std::string::npos) throw std::runtime_error("the text holds no line that begins " + marker);
  const std::size_t table = text.find('\n', begin) + 1;
  const std::size_t end = text.find(kEnd, table);
  if (end == std::string::npos) throw std::runtime_error("the text holds no line " + kEnd);
  return text.substr(0, table) + "\n" + markdown + "\n" + text.substr(end);
}

}  // namespace tet_line_tracker
