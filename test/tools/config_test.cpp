/// config/line_tracker.yaml documents the defaults, so it must hold them.

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "../../src/ros/node_parameters.h"
#include "parameter_yaml.h"

namespace tet_line_tracker {
namespace {

TEST(Config, HoldsEveryParameterWithItsDefault) {
  std::ifstream file(TET_SOURCE_DIRECTORY "/config/line_tracker.yaml");
  std::ostringstream config;
  config << file.rdbuf();
  ASSERT_TRUE(file);

  LineTrackerParameters tracker;
  NodeParameters node;
  ParameterTable table = tableOf(tracker);
  table.append(tableOf(node));
  EXPECT_EQ(config.str(), yamlOf(table))
      << "update it: rosrun tet_line_tracker list_parameters --yaml > config/line_tracker.yaml";
}

}  // namespace
}  // namespace tet_line_tracker
