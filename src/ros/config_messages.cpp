#include "config_messages.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <type_traits>
#include <variant>

#include <dynamic_reconfigure/Group.h>
#include <dynamic_reconfigure/GroupState.h>

namespace tet_line_tracker {
namespace {

const char* typeOf(const ParameterTable::Entry& entry) {
  if (std::holds_alternative<bool*>(entry.field)) return "bool";
  if (std::holds_alternative<int*>(entry.field)) return "int";
  return std::holds_alternative<double*>(entry.field) ? "double" : "str";
}

template <class Parameter, class Value>
void append(std::vector<Parameter>& list, const std::string& name, const Value& value) {
  Parameter& parameter = list.emplace_back();
  parameter.name = name;
  parameter.value = value;
}

/// `number` for a field that is a number, `flag` for a switch, and nothing for a text.
void appendLimit(const ParameterTable::Entry& entry, double number, bool flag,
                 dynamic_reconfigure::Config& config) {
  if (std::holds_alternative<bool*>(entry.field)) {
    append(config.bools, entry.name, flag);
  } else if (std::holds_alternative<int*>(entry.field)) {
    append(config.ints, entry.name, static_cast<int>(number));
  } else if (std::holds_alternative<double*>(entry.field)) {
    append(config.doubles, entry.name, number);
  } else {
    append(config.strs, entry.name, std::string());
  }
}

/// All parameters stand in one group.
constexpr const char* kGroup = "Default";

void appendGroup(dynamic_reconfigure::Config& config) {
  dynamic_reconfigure::GroupState& group = config.groups.emplace_back();
  group.name = kGroup;
  group.state = 1U;
}

/// The choices as the Python dictionary that rqt_reconfigure evaluates for its list.
std::string editMethodOf(const ParameterTable::Entry& entry) {
  if (entry.choices.empty()) return {};
  std::ostringstream text;
  text << "{'enum': [";
  for (std::size_t i = 0; i < entry.choices.size(); ++i) {
    const std::string& choice = entry.choices[i];
    text << (i == 0 ? "" : ", ") << "{'name': '" << choice << "', 'value': '" << choice
         << "', 'type': 'str', 'description': '" << choice << "'}";
  }
  text << "], 'enum_description': '" << entry.name << "'}";
  return text.str();
}

std::string descriptionOf(const ParameterTable::Entry& entry) {
  std::string text = entry.meaning;
  if (!entry.unit.empty()) text += " [" + entry.unit + "]";
  if (entry.odd) text += "; odd";
  if (entry.change == ParameterTable::Change::kNewEpoch) text += "; a change starts a new epoch";
  if (entry.change == ParameterTable::Change::kAtStart) text += "; set at the start only";
  return text;
}

template <class Number>
std::string textOf(const Number& number) {
  if constexpr (std::is_same_v<Number, std::string>) {
    return number;
  } else {
    std::ostringstream text;
    text.precision(std::numeric_limits<double>::max_digits10);
    text << number;
    return text.str();
  }
}

/// Sets one field; the sentence that says why not otherwise, with the field as it was.
std::string setField(const std::string& name, const std::string& type, const std::string& text,
                     ParameterTable& table) {
  const ParameterTable::Entry* entry = table.find(name);
  if (entry == nullptr) return table.unknownName(name);
  // Whole numbers for any number, but nothing else for something else.
  const std::string wanted = typeOf(*entry);
  if (type != wanted && !(type == "int" && wanted == "double")) {
    return "parameter " + name + " is of type " + type + ", needs " + wanted + ": " +
           ParameterTable::rangeText(*entry);
  }
  const ParameterTable::Value before = ParameterTable::value(*entry);
  std::string problem;
  try {
    table.set(name, text);
    const std::vector<std::string> broken = table.check();
    if (!broken.empty()) problem = broken.front();
  } catch (const std::invalid_argument& error) {
    problem = error.what();
  }
  if (problem.empty() && entry->change == ParameterTable::Change::kAtStart &&
      ParameterTable::value(*entry) != before) {
    problem = "parameter " + name + " is set at the start only";
  }
  if (!problem.empty()) ParameterTable::assign(*entry, before);
  return problem;
}

}  // namespace

dynamic_reconfigure::Config toConfig(const ParameterTable& table) {
  dynamic_reconfigure::Config config;
  for (const ParameterTable::Entry& entry : table.entries()) {
    if (bool* const* flag = std::get_if<bool*>(&entry.field)) {
      append(config.bools, entry.name, **flag);
    } else if (int* const* whole = std::get_if<int*>(&entry.field)) {
      append(config.ints, entry.name, **whole);
    } else if (double* const* number = std::get_if<double*>(&entry.field)) {
      append(config.doubles, entry.name, **number);
    } else {
      append(config.strs, entry.name, *std::get<std::string*>(entry.field));
    }
  }
  appendGroup(config);
  return config;
}

dynamic_reconfigure::ConfigDescription toConfigDescription(const ParameterTable& defaults) {
  dynamic_reconfigure::ConfigDescription description;
  dynamic_reconfigure::Group& group = description.groups.emplace_back();
  group.name = kGroup;
  for (const ParameterTable::Entry& entry : defaults.entries()) {
    dynamic_reconfigure::ParamDescription& parameter = group.parameters.emplace_back();
    parameter.name = entry.name;
    parameter.type = typeOf(entry);
    parameter.level = static_cast<std::uint32_t>(entry.change);
    parameter.description = descriptionOf(entry);
    parameter.edit_method = editMethodOf(entry);
    appendLimit(entry, entry.min, false, description.min);
    appendLimit(entry, entry.max, true, description.max);
  }
  appendGroup(description.min);
  appendGroup(description.max);
  description.dflt = toConfig(defaults);
  return description;
}

std::vector<std::string> setFrom(const dynamic_reconfigure::Config& config, ParameterTable& table) {
  std::vector<std::string> refused;
  const auto setAll = [&](const auto& parameters, const std::string& type) {
    for (const auto& parameter : parameters) {
      std::string problem = setField(parameter.name, type, textOf(parameter.value), table);
      if (!problem.empty()) refused.push_back(std::move(problem));
    }
  };
  for (const dynamic_reconfigure::BoolParameter& flag : config.bools) {
    std::string problem = setField(flag.name, "bool", flag.value != 0 ? "true" : "false", table);
    if (!problem.empty()) refused.push_back(std::move(problem));
  }
  setAll(config.ints, "int");
  setAll(config.strs, "str");
  setAll(config.doubles, "double");
  return refused;
}

}  // namespace tet_line_tracker
