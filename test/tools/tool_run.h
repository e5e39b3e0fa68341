#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tet_line_tracker {

/// A folder that lives as long as this object.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Writes a text file and the folders that lead to it.
void writeText(const std::filesystem::path& file, const std::string& text);

struct ToolRun {
  int status{-1};  ///< exit status; -1: killed by a signal
  std::string output;
  std::string errors;
};

/// Runs a program of this package to its end. `prefix`: what the shell is to do first ("ulimit -f 8; "), or
/// the command that is to start the program ("timeout -s KILL 60 ").
ToolRun runTool(const std::string& name, const std::vector<std::string>& arguments,
                const std::string& prefix = {});

/// The same on a terminal of its own, which gets all that the program prints (output).
ToolRun runToolOnTerminal(const std::string& name, const std::vector<std::string>& arguments);

/// Starts a program of this package, sends it `signal` once `isDue`, and waits for its end. A program that
/// ends before gets none.
ToolRun signalTool(const std::string& name, const std::vector<std::string>& arguments, int signal,
                   const std::function<bool()>& isDue);

/// Folder of the extracts of public datasets, from the environment variable TET_SHARED_DATA or beside the
/// project; it need not exist.
std::filesystem::path sharedData();

}  // namespace tet_line_tracker
