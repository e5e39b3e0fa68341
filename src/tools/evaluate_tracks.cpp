// Judges the lines of bags by what the bags know of the world.

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <rosbag/bag.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include "../evaluation/evaluation_report.h"
#include "../evaluation/scene_truth.h"
#include "../evaluation/track_measures.h"
#include "bag_reader.h"
#include "line_bag.h"
#include "output_file.h"
#include "program.h"
#include "sequence_bag.h"
#include "truth_bag.h"

namespace tet_line_tracker {
namespace {

EvaluatedBag evaluate(const std::string& path, const std::string& lines_topic, const MeasureOptions& options,
                      bool absolute, bool surfaces) {
  rosbag::Bag bag;
  openForReading(bag, path);
  const LineBag lines = readLines(bag, lines_topic);
  const BagTruth truth = readTruth(bag);
  const std::string file = path.substr(path.rfind('/') + 1);
  const bool has_ending = file.size() > 4 && file.compare(file.size() - 4, 4, ".bag") == 0;
  EvaluatedBag evaluated{has_ending ? file.substr(0, file.size() - 4) : file, truth.kind,
                         measureTracks(lines.frames, lines.has_statistics, truth.truth.get(), options)};
  if (truth.camera != nullptr) {
    evaluated.three_view = measureThreeViews(lines.frames, truth.world_from_camera, *truth.camera,
                                             options.inlier_px, options.tight_inlier_px);
  }
  const auto* scene = dynamic_cast<const SceneTruth*>(truth.truth.get());
  if (absolute && scene != nullptr) evaluated.absolute = measureAbsolute(lines.frames, *scene);
  if (surfaces && scene != nullptr) {
    evaluated.surfaces = measureSurfaces(lines.frames, *scene, evaluated.measures.pairs, options.inlier_px);
  }
  return evaluated;
}

/// Before any work: no output is an input, or would take the place of what is no file.
void checkOutputs(const std::vector<std::string>& bags, const std::string& csv_file,
                  const std::string& json_file, const std::string& plot_folder) {
  if (!csv_file.empty()) checkOutput(csv_file, bags);
  if (!json_file.empty()) checkOutput(json_file, bags);
  if (!csv_file.empty() && csv_file == json_file) {
    throw std::runtime_error("--csv and --json are both " + csv_file + ", need two files");
  }
  if (plot_folder.empty() || !std::filesystem::exists(plot_folder)) return;
  if (!std::filesystem::is_directory(plot_folder)) {
    throw std::runtime_error("--plots is " + plot_folder + ", needs a folder");
  }
  checkOutput(plot_folder + "/evaluation.json", bags);
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

constexpr char kColumns[] = R"(
Columns (- where a value is not known):
  truth      what the lines are judged by: scene, depth, poses or none
  images     images with lines, empty ones included
  lines      lines per image, mean
  px         length of the lines in the image, mean [px]
  cover%     share of an 8x6 grid over the image that a line crosses, mean
  <2px%      share of the lines whose error from one image to the next is under 2 px
  <1px%      the same under 1 px
  err        median of that error [px]
  drift5     median error between a track's first image and the 5th after it [px];
  10 20 30   the same for the 10th, 20th and 30th
  length     images per track, mean
  clean      images until the drift of a track first passes 2 px, mean
  surv%      of the images in which a track's first segment is still in view, the share
             that the track covers with a drift under 2 px
  sigma      spread of the errors in units of sigma_px; 1 where sigma_px is honest
  ms         time per image, mean, by the statistics in the bag (track_bag --times)
  ms p99     the same, 99th percentile
  homog%     share of the lines in two images in a row that agree on one homography
  3v<2px%    three-view error, where poses are known: of three images of a track in a row the
             first and the last give a line in space; share of the triples in which the ends
             seen in the middle are less than 2 px from its projection (error divided by the
             sensitivity of the projection to 1 px in the last image, where that is over 1)
  3v<1px%    the same under 1 px
  3vout%     share of all triples left out as ill-posed (sensitivity over 5)
  3vref%     share of all triples that are refuted: 2 px and more

Columns of the second table (--absolute; needs the scene of simulate_bag): how far lines lie from the
true edge that they show. An edge is judged when it is visible beside most of the line, both
ends are within 5 px of it, and no other visible edge runs within 4 px of it, which the line
might show as well. Distances are those of the undistorted points on z = 1, times the focal
length; for equidistant and mei lenses those in the image.
  length     class of length in the image [px]; all has shorter lines too
  lines      lines in all images
  judged%    share of these with an edge to be judged by
  ambig%     share left out because two edges are near; the rest shows no known edge
  worse      distance of the worse end from the edge, median [px]
  worse90    the same, 90 % are below
  middle     distance of the middle from the edge, median [px]
  mid90      the same, 90 % are below
  norm       errors of both ends over what covariance_px claims (else sigma_px): median over that
             of a normal distribution, so 1 is honest
  rms        the same by the root of the mean of squares, which few wrong lines dominate
  normworse  median of the larger of the two; 1.05 is honest when the ends are independent, 0.67
             when they move together
  normmid    errors of the middle over sigma_px, as norm
  tracks/edge  lines of one image that show the same edge, mean over edges that a line shows

Columns of the table of surfaces (--surfaces; needs the scene of simulate_bag):
  surface    what a track's lines are on: solid things, or distractors: the outline of something
             round, a cable, leaves, a person, the picture in a mirror or on a screen
  lines%     share of the lines of all images
  tracks     number of tracks
  length     images per track, mean
  <2px%      as above; of mirrors and screens by their surface, not by what they show
)";

int run(int argc, char** argv) {
  namespace po = boost::program_options;
  std::vector<std::string> paths;
  std::string lines_topic, csv_file, json_file, plot_folder;
  MeasureOptions measure;
  bool with_pairs = false;
  bool absolute = false;
  bool surfaces = false;
  po::options_description options;
  // clang-format off
  options.add_options()
      ("bag", po::value(&paths)->required(), "bags with lines and truth, as written by track_bag")
      ("lines", po::value(&lines_topic)->default_value(sequence_bag::kLinesTopic), "topic of the lines")
      ("absolute", po::bool_switch(&absolute), "a second table: distance from the true edges of a simulated scene")
      ("surfaces", po::bool_switch(&surfaces), "a table of what the lines of a simulated scene are on")
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
  if (!parseCommandLine(argc, argv,
                        "evaluate_tracks BAG... [options]\n\n"
                        "Judges the lines of bags by the exact scene of simulate_bag, or by depth images and "
                        "poses,\nor by poses alone (three-view error). Without truth only counts, lengths, "
                        "times and the agreement with a homography "
                        "are given.",
                        options, positional, values, kColumns)) {
    return 0;
  }

  checkOutputs(paths, csv_file, json_file, plot_folder);
  std::vector<EvaluatedBag> bags;
  {
    ProgressBar progress(paths.size());
    for (const std::string& path : paths) {
      throwIfInterrupted();
      bags.push_back(evaluate(path, lines_topic, measure, absolute, surfaces));
      progress.advance();
    }
  }
  writeText(std::cout, bags);
  if (absolute) {
    std::cout << "\n";
    writeAbsoluteText(std::cout, bags);
  }
  if (surfaces) {
    std::cout << "\n";
    writeSurfaceText(std::cout, bags);
  }
  if (!csv_file.empty()) {
    std::ostringstream text;
    writeCsv(text, bags);
    writeOutput(csv_file, text.str());
  }
  std::ostringstream json;
  if (!json_file.empty() || !plot_folder.empty()) writeJson(json, bags, with_pairs);
  if (!json_file.empty()) writeOutput(json_file, json.str());
  if (!plot_folder.empty()) {
    mkdir(plot_folder.c_str(), 0777);
    writeOutput(plot_folder + "/evaluation.json", json.str());
    plot(plot_folder + "/evaluation.json", plot_folder);
  }
  return 0;
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  return tet_line_tracker::runProgram("evaluate_tracks", [&] { return tet_line_tracker::run(argc, argv); });
}
