#include "program.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <stdexcept>

namespace tet_line_tracker {
namespace {

volatile std::sig_atomic_t signal_seen = 0;

void onSignal(int) {
  signal_seen = 1;
}

/// A sentence for a terminal: what a file holds may be part of it, so nothing that moves the cursor, and an
/// end.
std::string printable(std::string sentence) {
  constexpr std::size_t kLongest = 1000;
  if (sentence.size() > kLongest) sentence = sentence.substr(0, kLongest) + " ...";
  for (char& c : sentence) {
    if (std::iscntrl(static_cast<unsigned char>(c)) != 0) c = '?';
  }
  return sentence;
}

}  // namespace

bool interrupted() {
  return signal_seen != 0;
}

void throwIfInterrupted() {
  if (interrupted()) throw std::runtime_error("interrupted, nothing was written");
}

int runProgram(const std::string& name, const std::function<int()>& body) {
  std::signal(SIGINT, onSignal);
  std::signal(SIGTERM, onSignal);
  // The terminal or the connection has gone; under nohup the program is to go on.
  if (std::signal(SIGHUP, onSignal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  try {
    return body();
  } catch (const boost::program_options::error& error) {
    std::cerr << name << ": " << printable(error.what()) << "; see " << name << " --help\n";
    return 2;
  } catch (const std::exception& error) {
    std::cerr << name << ": " << printable(error.what()) << "\n";
    return 1;
  }
}

bool parseCommandLine(int argc, char** argv, const std::string& usage,
                      boost::program_options::options_description options,
                      const boost::program_options::positional_options_description& positional,
                      boost::program_options::variables_map& values, const std::string& more) {
  namespace po = boost::program_options;
  po::options_description visible("Options");
  for (const auto& option : options.options()) {
    bool is_positional = false;
    for (unsigned i = 0; i < positional.max_total_count() && i < 100U; ++i) {
      is_positional = is_positional || positional.name_for_position(i) == option->long_name();
    }
    if (!is_positional) visible.add(option);
  }
  visible.add_options()("help,h", "this text");
  options.add_options()("help,h", "this text");
  // A guess at an abbreviated option would hide a typing error.
  const int style = po::command_line_style::default_style & ~po::command_line_style::allow_guessing;
  po::store(po::command_line_parser(argc, argv).options(options).positional(positional).style(style).run(),
            values);
  if (values.count("help") != 0) {
    std::cout << "usage: " << usage << "\n\n" << visible << more;
    return false;
  }
  po::notify(values);
  return true;
}

ProgressBar::ProgressBar(std::size_t total, std::chrono::steady_clock::duration log_period)
    : total_(total),
      terminal_(isatty(STDERR_FILENO) != 0),
      log_period_(log_period),
      log_next_(std::chrono::steady_clock::now() + log_period) {}

ProgressBar::~ProgressBar() {
  endLine();
}

void ProgressBar::advance() {
  ++done_;
  if (total_ == 0) return;
  const int percent = static_cast<int>(std::min<std::size_t>(100, 100 * done_ / total_));
  if (percent == shown_percent_) return;
  if (!terminal_) {
    const auto now = std::chrono::steady_clock::now();
    if (now < log_next_) return;
    log_next_ = now + log_period_;
    shown_percent_ = percent;
    std::fprintf(stderr, "%d %%\n", percent);
    return;
  }
  shown_percent_ = percent;
  std::string bar(50, ' ');
  bar.replace(0, static_cast<std::size_t>(percent / 2), static_cast<std::size_t>(percent / 2), '=');
  std::fprintf(stderr, "\r[%s] %3d %%", bar.c_str(), percent);
  line_open_ = true;
  if (percent == 100) endLine();
  std::fflush(stderr);
}

void ProgressBar::endLine() {
  if (line_open_) std::fputc('\n', stderr);
  line_open_ = false;
}

}  // namespace tet_line_tracker
