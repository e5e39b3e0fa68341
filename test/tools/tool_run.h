#pragma once

#include <filesystem>
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

/// Runs a program of this package to its end.
ToolRun runTool(const std::string& name, const std::vector<std::string>& arguments);

/// Folder of the extracts of public datasets, from the environment variable TET_SHARED_DATA or beside the
/// project; it need not exist.
std::filesystem::path sharedData();

}  // namespace tet_line_tracker
