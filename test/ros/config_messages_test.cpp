#include "config_messages.h"

#include <limits>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "node_parameters.h"

namespace tet_line_tracker {
namespace {

using Change = ParameterTable::Change;

/// One parameter of each type.
class ConfigMessagesTest : public testing::Test {
 protected:
  ConfigMessagesTest() {
    table_.add("flag", flag_, "A switch");
    ParameterTable::Entry& window = table_.add("window", window_, 3, 21, "px", "Side of the patch");
    window.odd = true;
    window.change = Change::kNewEpoch;
    table_.add("gap", gap_, 0.5, 2.0, "s", "Longest gap");
    table_.add("method", method_, {"joint", "paper"}, "Which one");
    table_.add("pose", pose_, {}, "Where it is").change = Change::kAtStart;
  }
  template <class List, class Value>
  static void put(List& list, const std::string& name, const Value& value) {
    list.emplace_back();
    list.back().name = name;
    list.back().value = value;
  }
  /// The only sentence, or all of them.
  std::string refusal() {
    std::string text;
    for (const std::string& sentence : setFrom(request_, table_)) text += sentence;
    return text;
  }

  bool flag_{true};
  int window_{7};
  double gap_{1.0};
  std::string method_{"joint"};
  std::string pose_{"here"};
  ParameterTable table_;
  dynamic_reconfigure::Config request_;
};

TEST_F(ConfigMessagesTest, ValuesStandUnderTheirNamesByType) {
  const dynamic_reconfigure::Config config = toConfig(table_);
  ASSERT_EQ(config.bools.size(), 1U);
  EXPECT_EQ(config.bools[0].name, "flag");
  EXPECT_EQ(config.bools[0].value, 1);
  ASSERT_EQ(config.ints.size(), 1U);
  EXPECT_EQ(config.ints[0].value, 7);
  ASSERT_EQ(config.doubles.size(), 1U);
  EXPECT_EQ(config.doubles[0].value, 1.0);
  ASSERT_EQ(config.strs.size(), 2U);
  EXPECT_EQ(config.strs[1].name, "pose");
  EXPECT_EQ(config.strs[1].value, "here");
  ASSERT_EQ(config.groups.size(), 1U);
  EXPECT_EQ(config.groups[0].id, 0);
}

TEST_F(ConfigMessagesTest, DescriptionsHaveTypeRangeDefaultAndMeaning) {
  const dynamic_reconfigure::ConfigDescription description = toConfigDescription(table_);
  ASSERT_EQ(description.groups.size(), 1U);
  const auto& parameters = description.groups[0].parameters;
  ASSERT_EQ(parameters.size(), 5U);
  EXPECT_EQ(parameters[0].type, "bool");
  EXPECT_EQ(parameters[1].type, "int");
  EXPECT_EQ(parameters[1].description, "Side of the patch [px]; odd; a change starts a new epoch");
  EXPECT_EQ(parameters[2].type, "double");
  EXPECT_EQ(parameters[2].description, "Longest gap [s]");
  EXPECT_EQ(parameters[3].type, "str");
  EXPECT_EQ(parameters[4].description, "Where it is; set at the start only");
  EXPECT_EQ(description.min.ints[0].value, 3);
  EXPECT_EQ(description.max.ints[0].value, 21);
  EXPECT_EQ(description.min.doubles[0].value, 0.5);
  EXPECT_EQ(description.max.doubles[0].value, 2.0);
  EXPECT_EQ(description.dflt.doubles[0].value, 1.0);
}

TEST_F(ConfigMessagesTest, ChoicesAreAListForTheDisplay) {
  const dynamic_reconfigure::ConfigDescription description = toConfigDescription(table_);
  const auto& parameters = description.groups[0].parameters;
  EXPECT_EQ(parameters[3].edit_method,
            "{'enum': [{'name': 'joint', 'value': 'joint', 'type': 'str', 'description': 'joint'}, {'name': "
            "'paper', 'value': 'paper', 'type': 'str', 'description': 'paper'}], 'enum_description': "
            "'method'}");
  EXPECT_EQ(parameters[4].edit_method, "") << "any text";
}

TEST(ConfigDescription, HoldsEveryParameterOfTheTrackerOnceInAllItsParts) {
  LineTrackerParameters tracker;
  NodeParameters node;
  ParameterTable table = tableOf(tracker);
  table.append(tableOf(node));
  const dynamic_reconfigure::ConfigDescription description = toConfigDescription(table);
  std::set<std::string> names;
  for (const auto& parameter : description.groups[0].parameters) names.insert(parameter.name);
  EXPECT_EQ(names.size(), table.entries().size());
  for (const dynamic_reconfigure::Config& part : {description.min, description.max, description.dflt}) {
    std::set<std::string> found;
    const auto collect = [&found](const auto& list) {
      for (const auto& parameter : list) found.insert(parameter.name);
    };
    collect(part.bools);
    collect(part.ints);
    collect(part.doubles);
    collect(part.strs);
    EXPECT_EQ(found, names);
  }
}

TEST_F(ConfigMessagesTest, WhatIsAskedForIsSetAndTheRestStays) {
  put(request_.bools, "flag", false);
  put(request_.doubles, "gap", 0.1234567890123 + 0.5);
  put(request_.strs, "method", "paper");
  put(request_.strs, "pose", "here");  // as it is
  EXPECT_EQ(refusal(), "");
  EXPECT_FALSE(flag_);
  EXPECT_EQ(gap_, 0.1234567890123 + 0.5);
  EXPECT_EQ(method_, "paper");
  EXPECT_EQ(window_, 7);
}

TEST_F(ConfigMessagesTest, AWholeNumberDoesForAnyNumber) {
  put(request_.ints, "gap", 2);
  EXPECT_EQ(refusal(), "");
  EXPECT_EQ(gap_, 2.0);
}

TEST_F(ConfigMessagesTest, ARefusedValueStaysAsItWasAndTheOthersAreSet) {
  put(request_.ints, "window", 8);
  put(request_.doubles, "gap", 1.5);
  EXPECT_EQ(refusal(), "parameter window is 8, needs an odd number in 3..21 [px]");
  EXPECT_EQ(window_, 7);
  EXPECT_EQ(gap_, 1.5);
}

TEST_F(ConfigMessagesTest, NotANumberIsRefused) {
  put(request_.doubles, "gap", std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(refusal(), "parameter gap is nan, needs a number in 0.5..2 [s]");
  EXPECT_EQ(gap_, 1.0);
}

TEST_F(ConfigMessagesTest, AnotherTypeIsRefused) {
  put(request_.doubles, "window", 9.0);
  EXPECT_EQ(refusal(), "parameter window is of type double, needs int: an odd number in 3..21 [px]");
  EXPECT_EQ(window_, 7);
}

TEST_F(ConfigMessagesTest, AnUnknownNameIsRefusedWithTheNearestOne) {
  put(request_.ints, "windo", 9);
  EXPECT_EQ(refusal(), "parameter windo is not known; did you mean window?");
}

TEST_F(ConfigMessagesTest, AParameterOfTheStartIsRefused) {
  put(request_.strs, "pose", "there");
  EXPECT_EQ(refusal(), "parameter pose is set at the start only");
  EXPECT_EQ(pose_, "here");
}

}  // namespace
}  // namespace tet_line_tracker
