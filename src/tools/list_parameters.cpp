#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "../ros/node_parameters.h"
#include "parameter_markdown.h"
#include "parameter_yaml.h"
#include "program.h"

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

int run(int argc, char** argv) {
  bool markdown = false;
  bool yaml = false;
  std::string readme;
  po::options_description options("Options");
  // clang-format off
  options.add_options()
      ("markdown", po::bool_switch(&markdown), "print the table as in README.md")
      ("yaml", po::bool_switch(&yaml), "print the text of config/line_tracker.yaml")
      ("update", po::value(&readme), "write the table into this README.md, between its markers");
  // clang-format on
  po::variables_map values;
  if (!parseCommandLine(
          argc, argv,
          "list_parameters [options]\n\nLists the parameters of the node and of track_bag: name, "
          "default, what is allowed and meaning.",
          options, {}, values)) {
    return 0;
  }

  LineTrackerParameters tracker;
  NodeParameters node;
  ParameterTable table = tableOf(tracker);
  table.append(tableOf(node));
  if (!readme.empty()) {
    const std::string updated = withParameters(contentOf(readme), markdownOf(table));
    std::ofstream file(readme, std::ios::binary);
    if (!(file << updated).flush()) throw std::runtime_error(readme + " cannot be written");
  } else if (markdown) {
    std::cout << markdownOf(table);
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
