#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

#include <boost/program_options.hpp>

namespace tet_line_tracker {

/// Set by Ctrl-C, SIGTERM or the end of the terminal while a program runs under runProgram(); long loops
/// check it through throwIfInterrupted().
bool interrupted();
/// Throws std::runtime_error("interrupted") after Ctrl-C, so that destructors clean up half-written output.
void throwIfInterrupted();

/// Runs the body of a command-line program: one sentence on stderr and exit status 1 for each exception that
/// leaves `body`, 2 for wrong usage (boost::program_options::error).
int runProgram(const std::string& name, const std::function<int()>& body);

/// Parses the command line. With --help prints `usage`, the options and `more`, and gives false.
bool parseCommandLine(int argc, char** argv, const std::string& usage,
                      boost::program_options::options_description options,
                      const boost::program_options::positional_options_description& positional,
                      boost::program_options::variables_map& values, const std::string& more = {});

/// A progress bar on stderr while it is a terminal; elsewhere, as in a log, a line with the percentage now
/// and then.
class ProgressBar {
 public:
  /// Pause between two lines in a log.
  static constexpr std::chrono::seconds kLogPeriod{30};

  explicit ProgressBar(std::size_t total, std::chrono::steady_clock::duration log_period = kLogPeriod);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void advance();
  /// Ends the line, so that other text can follow; the next advance() begins a new one.
  void endLine();

 private:
  std::size_t total_;
  std::size_t done_{0};
  int shown_percent_{-1};
  bool terminal_;
  bool line_open_{false};
  std::chrono::steady_clock::duration log_period_;
  std::chrono::steady_clock::time_point log_next_;
};

}  // namespace tet_line_tracker
