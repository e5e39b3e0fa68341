#include "tet_line_tracker/parameters/parameter_table.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace tet_line_tracker {
namespace {

/// Levenshtein distance, for the nearest known name of a typo.
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0U);
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

std::string numberText(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string wordList(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
    text += words[i];
  }
  return text;
}

bool parseNumber(const std::string& text, double* value) {
  char* end = nullptr;
  *value = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0';
}

std::string brokenRule(const ParameterTable::Entry& entry, const std::string& value) {
  return "parameter " + entry.name + " is " + (value.empty() ? "empty" : value) + ", needs " +
         ParameterTable::rangeText(entry);
}

}  // namespace

ParameterTable::Entry& ParameterTable::add(std::string name, bool& field, std::string meaning) {
  Entry entry;
  entry.name = std::move(name);
  entry.field = &field;
  entry.meaning = std::move(meaning);
  return entries_.emplace_back(std::move(entry));
}

ParameterTable::Entry& ParameterTable::add(std::string name, int& field, int min, int max, std::string unit,
                                           std::string meaning) {
  Entry& entry = entries_.emplace_back();
  entry.name = std::move(name);
  entry.field = &field;
  entry.min = min;
  entry.max = max;
  entry.unit = std::move(unit);
  entry.meaning = std::move(meaning);
  return entry;
}

ParameterTable::Entry& ParameterTable::add(std::string name, double& field, double min, double max,
                                           std::string unit, std::string meaning) {
  Entry& entry = entries_.emplace_back();
  entry.name = std::move(name);
  entry.field = &field;
  entry.min = min;
  entry.max = max;
  entry.unit = std::move(unit);
  entry.meaning = std::move(meaning);
  return entry;
}

ParameterTable::Entry& ParameterTable::add(std::string name, std::string& field,
                                           std::vector<std::string> choices, std::string meaning) {
  Entry& entry = entries_.emplace_back();
  entry.name = std::move(name);
  entry.field = &field;
  entry.choices = std::move(choices);
  entry.meaning = std::move(meaning);
  return entry;
}

void ParameterTable::append(ParameterTable other) {
  std::move(other.entries_.begin(), other.entries_.end(), std::back_inserter(entries_));
  retired_.merge(other.retired_);
}

void ParameterTable::addRetired(std::string name, std::string fate) {
  retired_.emplace(std::move(name), std::move(fate));
}

const ParameterTable::Entry* ParameterTable::find(const std::string& name) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&name](const Entry& entry) { return entry.name == name; });
  return found == entries_.end() ? nullptr : &*found;
}

std::string ParameterTable::unknownName(const std::string& name) const {
  const auto retired = retired_.find(name);
  if (retired != retired_.end()) return "parameter " + name + " " + retired->second;
  std::string nearest;
  std::size_t smallest = std::max<std::size_t>(3, name.size() / 2);
  for (const Entry& entry : entries_) {
    const std::size_t distance = editDistance(name, entry.name);
    if (distance < smallest) {
      smallest = distance;
      nearest = entry.name;
    }
  }
  return "parameter " + name + " is not known" +
         (nearest.empty() ? "; see the parameters table in README.md" : "; did you mean " + nearest + "?");
}

void ParameterTable::set(const std::string& name, const std::string& text) {
  const Entry* entry = find(name);
  if (entry == nullptr) throw std::invalid_argument(unknownName(name));
  if (bool* const* flag = std::get_if<bool*>(&entry->field)) {
    if (text != "true" && text != "false") throw std::invalid_argument(brokenRule(*entry, text));
    **flag = text == "true";
  } else if (std::string* const* word = std::get_if<std::string*>(&entry->field)) {
    **word = text;
  } else {
    double number = 0.0;
    const bool whole = std::holds_alternative<int*>(entry->field);
    // Out of range goes no further: a double beyond int's range must not be converted.
    if (!parseNumber(text, &number) || (whole && (number != std::floor(number) || std::abs(number) > 1e9))) {
      throw std::invalid_argument(brokenRule(*entry, text));
    }
    if (whole) {
      *std::get<int*>(entry->field) = static_cast<int>(number);
    } else {
      *std::get<double*>(entry->field) = number;
    }
  }
}

std::vector<std::string> ParameterTable::check() const {
  std::vector<std::string> broken;
  for (const Entry& entry : entries_) {
    bool good = true;
    if (std::string* const* word = std::get_if<std::string*>(&entry.field)) {
      good = entry.choices.empty() ||
             std::find(entry.choices.begin(), entry.choices.end(), **word) != entry.choices.end();
    } else if (!std::holds_alternative<bool*>(entry.field)) {
      const bool whole = std::holds_alternative<int*>(entry.field);
      const double value = whole ? *std::get<int*>(entry.field) : *std::get<double*>(entry.field);
      good = value >= entry.min && value <= entry.max && (!entry.odd || std::fmod(value, 2.0) == 1.0);
    }
    if (!good) broken.push_back(brokenRule(entry, valueText(entry)));
  }
  return broken;
}

ParameterTable::Value ParameterTable::value(const Entry& entry) {
  return std::visit([](const auto* field) { return Value(*field); }, entry.field);
}

void ParameterTable::assign(const Entry& entry, const Value& value) {
  std::visit([&value](auto* field) { *field = std::get<std::decay_t<decltype(*field)>>(value); },
             entry.field);
}

std::string ParameterTable::valueText(const Entry& entry) {
  if (bool* const* flag = std::get_if<bool*>(&entry.field)) return **flag ? "true" : "false";
  if (int* const* number = std::get_if<int*>(&entry.field)) return std::to_string(**number);
  if (double* const* number = std::get_if<double*>(&entry.field)) return numberText(**number);
  return *std::get<std::string*>(entry.field);
}

std::string ParameterTable::rangeText(const Entry& entry) {
  if (std::holds_alternative<bool*>(entry.field)) return "true or false";
  if (std::holds_alternative<std::string*>(entry.field)) {
    return entry.choices.empty() ? "a text" : wordList(entry.choices);
  }
  const bool whole = std::holds_alternative<int*>(entry.field);
  std::string text = whole ? "a whole number in " : "a number in ";
  if (entry.odd) text = "an odd number in ";
  text += numberText(entry.min) + ".." + numberText(entry.max);
  return entry.unit.empty() ? text : text + " [" + entry.unit + "]";
}

}  // namespace tet_line_tracker
