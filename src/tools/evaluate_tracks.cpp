// Judges the lines of bags by what the bags know of the world.

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <rosbag/bag.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "../evaluation/evaluation_report.h"
#include "../evaluation/track_measures.h"
#include "line_bag.h"
#include "program.h"
#include "sequence_bag.h"
#include "truth_bag.h"

namespace tet_line_tracker {
namespace {

EvaluatedBag evaluate(const std::string& path, const std::string& lines_topic,
                      const MeasureOptions& options) {
  rosbag::Bag bag;
  openForReading(bag, path);
  const LineBag lines = readLines(bag, lines_topic);
  const BagTruth truth = readTruth(bag);
  const std::string file = path.substr(path.rfind('/') + 1);
  const bool has_ending = file.size() > 4 && file.compare(file.size() - 4, 4, ".bag") == 0;
  return {has_ending ? file.substr(0, file.size() - 4) : file, truth.kind,
          measureTracks(lines.frames, lines.has_statistics, truth.truth.get(), options)};
}

void writeFile(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  file.close();
  if (!file) throw std::runtime_error("cannot write " + path);
}

std::string folderOfThisProgram() {
  char path[4096];
  const ssize_t length = readlink("/proc/self/exe", path, sizeof(path));
  const std::string text(path, length > 0 ? static_cast<std::size_t>(length) : 0);
  return text.substr(0, text.rfind('/'));
}

/// Runs plot_evaluation.py, which is installed beside this program, without a shell in between.
void plot(const std::string& json_file, const std::string& folder) {
  const std::string script = folderOfThisProgram() + "/plot_evaluation.py";
  if (access(script.c_str(), X_OK) != 0) throw std::runtime_error("cannot run " + script);
  const pid_t child = fork();
  if (child == 0) {
    execl(script.c_str(), script.c_str(), json_file.c_str(), folder.c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw std::runtime_error("plot_evaluation.py did not finish its plots in " + folder);
  }
}

int run(int argc, char** argv) {
  namespace po = boost::program_options;
  std::vector<std::string> paths;
  std::string lines_topic, csv_file, json_file, plot_folder;
  MeasureOptions measure;
  bool with_pairs = false;
  po::options_description options;
  // clang-format off
  options.add_options()
      ("bag", po::value(&paths)->required(), "bags with lines and truth, as written by track_bag")
      ("lines", po::value(&lines_topic)->default_value(sequence_bag::kLinesTopic), "topic of the lines")
      ("csv", po::value(&csv_file), "write all measures to this file")
      ("json", po::value(&json_file), "write all measures, curves and the error histogram to this file")
      ("pairs", po::bool_switch(&with_pairs), "put the verdict on every line pair into the JSON file")
      ("plots", po::value(&plot_folder), "write PNG plots to this folder (needs python3-matplotlib)")
      ("min-length", po::value(&measure.min_length)->default_value(measure.min_length),
       "a segment shorter than this is no longer in view [px]");
  // clang-format on
  po::positional_options_description positional;
  positional.add("bag", -1);
  po::variables_map values;
  if (!parseCommandLine(
          argc, argv,
          "evaluate_tracks BAG... [options]\n\n"
          "Judges the lines of bags by the exact scene of simulate_bag, or by depth images and "
          "poses.\nWithout truth only counts, lengths, times and the agreement with a homography "
          "are given.",
          options, positional, values)) {
    return 0;
  }

  std::vector<EvaluatedBag> bags;
  {
    ProgressBar progress(paths.size());
    for (const std::string& path : paths) {
      throwIfInterrupted();
      bags.push_back(evaluate(path, lines_topic, measure));
      progress.advance();
    }
  }
  writeText(std::cout, bags);
  if (!csv_file.empty()) {
    std::ostringstream text;
    writeCsv(text, bags);
    writeFile(csv_file, text.str());
  }
  std::ostringstream json;
  if (!json_file.empty() || !plot_folder.empty()) writeJson(json, bags, with_pairs);
  if (!json_file.empty()) writeFile(json_file, json.str());
  if (!plot_folder.empty()) {
    mkdir(plot_folder.c_str(), 0777);
    writeFile(plot_folder + "/evaluation.json", json.str());
    plot(plot_folder + "/evaluation.json", plot_folder);
  }
  return 0;
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  return tet_line_tracker::runProgram("evaluate_tracks", [&] { return tet_line_tracker::run(argc, argv); });
}
