#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "../ros/node_parameters.h"
#include "../ros/pl_vins_pairing.h"
#include "output_file.h"
#include "parameter_markdown.h"
#include "parameter_yaml.h"
#include "program.h"
#include "tet_line_tracker/mapping/line_mapper.h"

namespace tet_line_tracker {
namespace {

namespace po = boost::program_options;

std::string contentOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  content << file.rdbuf();
  if (!file) throw std::runtime_error(path + " cannot be read");
  return content.str();
}

/// The parameters of all nodes at their defaults.
struct NodeTables {
  LineTrackerParameters tracker;
  NodeParameters tracker_node;
  PlVinsParameters bridge;
  LineMapperParameters mapper;
  LineMapperNodeParameters mapper_node;

  /// Throws std::runtime_error for a name that is none of theirs.
  ParameterTable of(const std::string& node) {
    if (node == "pl_vins_bridge") return tableOf(bridge);
    const bool is_mapper = node == "line_mapper";
    if (!is_mapper && node != kTrackerNode) {
      throw std::runtime_error("there is no node " + node +
                               "; there are line_tracker, pl_vins_bridge, line_mapper");
    }
    ParameterTable table = is_mapper ? tableOf(mapper) : tableOf(tracker);
    table.append(is_mapper ? tableOf(mapper_node) : tableOf(tracker_node));
    return table;
  }
};

int run(int argc, char** argv) {
  bool markdown = false;
  bool yaml = false;
  std::string path;
  std::string node;
  po::options_description options("Options");
  // clang-format off
  options.add_options()
      ("node", po::value(&node)->default_value(kTrackerNode), "line_tracker, pl_vins_bridge or line_mapper")
      ("markdown", po::bool_switch(&markdown), "print the table as in README.md")
      ("yaml", po::bool_switch(&yaml), "print the text of config/line_tracker.yaml")
      ("update", po::value(&path), "write the table into this text (README.md, docs/vio.md), between its markers");
  // clang-format on
  po::variables_map values;
  if (!parseCommandLine(
          argc, argv,
          "list_parameters [options]\n\nLists the parameters of a node, and of track_bag or map_bag: name, "
          "default, what is allowed and meaning.",
          options, {}, values)) {
    return 0;
  }

  NodeTables tables;
  const ParameterTable table = tables.of(node);
  if (!path.empty()) {
    checkOutput(path, {});
    writeOutput(path, withParameters(contentOf(path), node, markdownOf(table, node)));
  } else if (markdown) {
    std::cout << markdownOf(table, node);
  } else if (yaml) {
    std::cout << yamlOf(table);
  } else {
    for (const ParameterTable::Entry& entry : table.entries()) {
      std::cout << entry.name << ": " << ParameterTable::valueText(entry) << "\n    " << entry.meaning << "; "
                << ParameterTable::rangeText(entry) << "\n";
    }
  }
  return 0;
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  return tet_line_tracker::runProgram("list_parameters", [&] { return tet_line_tracker::run(argc, argv); });
}
