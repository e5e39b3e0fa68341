#include "tool_run.h"

#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace tet_line_tracker {
namespace {

std::string quoted(const std::string& argument) {
  std::string result = "'";
  for (const char c : argument) result += c == '\'' ? "'\\''" : std::string(1, c);
  return result + "'";
}

std::string readText(const std::filesystem::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "tet_tool_test_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

void writeText(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

ToolRun runTool(const std::string& name, const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  std::string command = quoted(std::string(TET_TOOL_DIRECTORY) + "/" + name);
  for (const std::string& argument : arguments) command += " " + quoted(argument);
  command += " >" + quoted(folder.path() / "output") + " 2>" + quoted(folder.path() / "errors");
  const int result = std::system(command.c_str());
  ToolRun run;
  if (WIFEXITED(result)) run.status = WEXITSTATUS(result);
  run.output = readText(folder.path() / "output");
  run.errors = readText(folder.path() / "errors");
  return run;
}

std::filesystem::path sharedData() {
  const char* const named = std::getenv("TET_SHARED_DATA");
  return named != nullptr ? named : std::filesystem::path(TET_SOURCE_DIRECTORY) / ".." / "shared" / "data";
}

}  // namespace tet_line_tracker
