// Holds the LineArray messages of bags against the rules of the message contract.

#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/query.h>
#include <rosbag/view.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include "../evaluation/line_rules.h"
#include "bag_image.h"
#include "bag_reader.h"
#include "line_bag.h"
#include "program.h"
#include "sequence_bag.h"

namespace tet_line_tracker {
namespace {

/// Prints what was broken in one bag; true when nothing was.
bool checkBag(const std::string& path, const std::string& lines_topic, const std::string& image_topic,
              double min_length) {
  rosbag::Bag bag;
  openForReading(bag, path);
  LineRules rules(min_length);
  for (const LineFrame& frame : readLines(bag, lines_topic).frames) rules.add(frame);
  checkDefinition<sensor_msgs::Image>(bag, image_topic);
  checkDefinition<sensor_msgs::CompressedImage>(bag, image_topic);
  std::size_t images = 0;
  rosbag::View view(bag, rosbag::TopicQuery(image_topic));
  for (const rosbag::MessageInstance& instance : view) {
    throwIfInterrupted();
    const auto image = readImage(instance);
    if (!image) {
      throw std::runtime_error(std::string(image_topic).append(" of ").append(path).append(" holds ") +
                               instance.getDataType());
    }
    // Images without a stamp are never tracked.
    if (image->header.stamp.isZero()) continue;
    rules.addImage(static_cast<std::int64_t>(image->header.stamp.toNSec()), static_cast<int>(image->width),
                   static_cast<int>(image->height));
    ++images;
  }
  rules.finish();
  std::cout << path << ": " << rules.messages() << " messages, " << rules.lines() << " lines ("
            << rules.linesNotNormalized() << " not normalised), " << images
            << " images: " << (rules.violations().empty() ? "all rules hold" : "RULES BROKEN") << "\n";
  for (const auto& [rule, violation] : rules.violations()) {
    std::cout << "  " << violation.count << " times not so: " << rule << " (first: " << violation.first
              << ")\n";
  }
  return rules.violations().empty();
}

int run(int argc, char** argv) {
  namespace po = boost::program_options;
  std::vector<std::string> bags;
  std::string lines_topic;
  std::string image_topic;
  double min_length = 0.0;
  po::options_description options;
  options.add_options()  //
      ("bag", po::value(&bags)->required(), "bags with lines")(
          "lines", po::value(&lines_topic)->default_value(sequence_bag::kLinesTopic), "topic of the lines")(
          "image", po::value(&image_topic)->default_value(sequence_bag::kImageTopic),
          "topic of the images; where the bag holds them, each must have its message")(
          "min-length", po::value(&min_length)->default_value(30.0),
          "parameter min_length of the tracker [px]");
  po::positional_options_description positional;
  positional.add("bag", -1);
  po::variables_map values;
  if (!parseCommandLine(argc, argv, "check_lines BAG... [options]", options, positional, values)) return 0;
  bool good = true;
  for (const std::string& path : bags) good = checkBag(path, lines_topic, image_topic, min_length) && good;
  return good ? 0 : 1;
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  return tet_line_tracker::runProgram("check_lines", [&] { return tet_line_tracker::run(argc, argv); });
}
