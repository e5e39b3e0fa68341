#include "parameter_markdown.h"

#include <limits>
#include <sstream>
#include <stdexcept>
#include <variant>

namespace tet_line_tracker {
namespace {

const std::string kBegin =
    "<!-- parameters: rosrun tet_line_tracker list_parameters --update README.md -->\n";
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

}  // namespace

std::string markdownOf(const ParameterTable& table) {
  std::string text = "| name | default | range | unit | meaning |\n|---|---|---|---|---|\n";
  for (const ParameterTable::Entry& entry : table.entries()) {
    const std::string value = ParameterTable::valueText(entry);
    text += "| `" + entry.name + "` | " + (value.empty() ? "(empty)" : "`" + value + "`") + " | " +
            rangeOf(entry) + " | " + entry.unit + " | " + entry.meaning + " |\n";
  }
  return text;
}

std::string withParameters(const std::string& readme, const std::string& markdown) {
  const std::size_t begin = readme.find(kBegin);
  if (begin == std::string::npos) throw std::runtime_error("the text holds no line " + kBegin);
  const std::size_t end = readme.find(kEnd, begin);
  if (end == std::string::npos) throw std::runtime_error("the text holds no line " + kEnd);
  return readme.substr(0, begin + kBegin.size()) + "\n" + markdown + "\n" + readme.substr(end);
}

}  // namespace tet_line_tracker
