#pragma once

#include <array>
#include <cstdio>
#include <stdexcept>
#include <string>

#include <sys/wait.h>

namespace tet_line_tracker {

struct ShellResult {
  int status{-1};      ///< exit status; -1: killed by a signal
  std::string output;  ///< with what was written to the standard error
};

/// Runs a command line of the shell to its end.
inline ShellResult runShell(const std::string& command) {
  FILE* pipe = popen(("{ " + command + "; } 2>&1 </dev/null").c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot start " + command);
  ShellResult result;
  std::array<char, 4096> buffer{};
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) result.output += buffer.data();
  const int status = pclose(pipe);
  if (WIFEXITED(status)) result.status = WEXITSTATUS(status);
  return result;
}

/// A word of a command line; `text` must hold no single quote.
inline std::string quoted(const std::string& text) {
  return "'" + text + "'";
}

}  // namespace tet_line_tracker
