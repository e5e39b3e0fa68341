// Gives the true edges of a simulated world as lines: what a perfect tracker would publish.

#include <cstdio>
#include <stdexcept>
#include <string>

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Image.h>

#include "../evaluation/true_lines.h"
#include "../ros/messages.h"
#include "bag_reader.h"
#include "bag_writer.h"
#include "output_file.h"
#include "program.h"
#include "sequence_bag.h"
#include "truth_bag.h"

namespace tet_line_tracker {
namespace {

namespace po = boost::program_options;

int run(int argc, char** argv) {
  std::string in;
  std::string out;
  TrueLinesOptions options;
  po::options_description description;
  // clang-format off
  description.add_options()
      ("in", po::value(&in)->required(), "bag of simulate_bag")
      ("out", po::value(&out)->required(), "bag to write, with a LineArray for each image")
      ("max-lines", po::value(&options.max_lines)->default_value(options.max_lines), "in an image, longest first")
      ("noise", po::value(&options.noise_px)->default_value(options.noise_px, "0.3"),
       "standard deviation of each end across the line, new in each image [px]")
      ("min-length", po::value(&options.min_length_px)->default_value(options.min_length_px), "[px]")
      ("seed", po::value(&options.seed)->default_value(options.seed), "of the noise");
  // clang-format on
  po::positional_options_description positional;
  positional.add("in", 1).add("out", 1);
  po::variables_map values;
  if (!parseCommandLine(
          argc, argv,
          "true_lines IN.bag OUT.bag [options]\n\nWrites the visible edges of a simulated world "
          "as a perfect tracker would publish them, to compare with.",
          description, positional, values)) {
    return 0;
  }
  checkOutput(out, {in});
  rosbag::Bag bag;
  openForReading(bag, in);
  const BagTruth truth = readTruth(bag);
  const auto* const scene = dynamic_cast<const SceneTruth*>(truth.truth.get());
  if (scene == nullptr) throw std::runtime_error(in + " has no true scene: it is no bag of simulate_bag");
  TrueLines lines(*scene, options);
  BagWriter writer(out);
  rosbag::View view(bag, rosbag::TopicQuery(sequence_bag::kImageTopic));
  ProgressBar progress(view.size());
  std::uint32_t images = 0;
  std::size_t total = 0;
  for (const rosbag::MessageInstance& instance : view) {
    throwIfInterrupted();
    const auto image = instance.instantiate<sensor_msgs::Image>();
    if (!image) continue;
    const LineFrame frame = lines.next(static_cast<std::int64_t>(image->header.stamp.toNSec()));
    writer.write(sequence_bag::kLinesTopic, image->header.stamp,
                 toLineArray(frame, image->header.frame_id, images++));
    total += frame.lines.size();
    progress.advance();
  }
  writer.close();
  std::printf("%s: %u images, %.1f lines per image\n", out.c_str(), images,
              images > 0 ? static_cast<double>(total) / images : 0.0);
  return 0;
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  return tet_line_tracker::runProgram("true_lines", [&] { return tet_line_tracker::run(argc, argv); });
}
