#include "tool_run.h"

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

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

std::string commandOf(const std::string& name, const std::vector<std::string>& arguments) {
  std::string command = quoted(std::string(TET_TOOL_DIRECTORY) + "/" + name);
  for (const std::string& argument : arguments) command += " " + quoted(argument);
  return command;
}

ToolRun runShell(const std::string& command) {
  const TemporaryFolder folder;
  const std::string redirected =
      command + " >" + quoted(folder.path() / "output") + " 2>" + quoted(folder.path() / "errors");
  const int result = std::system(redirected.c_str());
  ToolRun run;
  if (WIFEXITED(result)) run.status = WEXITSTATUS(result);
  run.output = readText(folder.path() / "output");
  run.errors = readText(folder.path() / "errors");
  return run;
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

ToolRun runTool(const std::string& name, const std::vector<std::string>& arguments,
                const std::string& prefix) {
  return runShell(prefix + commandOf(name, arguments));
}

ToolRun runToolOnTerminal(const std::string& name, const std::vector<std::string>& arguments) {
  return runShell("script -qec " + quoted(commandOf(name, arguments)) + " /dev/null </dev/null");
}

ToolRun signalTool(const std::string& name, const std::vector<std::string>& arguments, int signal,
                   const std::function<bool()>& isDue) {
  const TemporaryFolder folder;
  const std::string errors = folder.path() / "errors";
  const std::string command = "exec " + commandOf(name, arguments) + " >/dev/null 2>" + quoted(errors);
  const pid_t child = fork();
  if (child == 0) {
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  pid_t ended = 0;
  while (ended == 0 && !isDue()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ended = waitpid(child, &status, WNOHANG);
  }
  if (ended == 0) {
    kill(child, signal);
    waitpid(child, &status, 0);
  }
  ToolRun run;
  if (WIFEXITED(status)) run.status = WEXITSTATUS(status);
  run.errors = readText(errors);
  return run;
}

std::filesystem::path sharedData() {
  const char* const named = std::getenv("TET_SHARED_DATA");
  return named != nullptr ? named : std::filesystem::path(TET_SOURCE_DIRECTORY) / ".." / "shared" / "data";
}

}  // namespace tet_line_tracker
