// Paints the lines of a bag over one of its images, as the node's ~debug_image shows them.

#include <cstddef>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/query.h>
#include <rosbag/view.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <opencv2/imgcodecs.hpp>

#include "../ros/image_conversion.h"
#include "bag_calibration.h"
#include "bag_image.h"
#include "bag_reader.h"
#include "bag_topics.h"
#include "line_bag.h"
#include "output_file.h"
#include "program.h"
#include "sequence_bag.h"
#include "tet_line_tracker/display/track_painter.h"

namespace tet_line_tracker {
namespace {

struct Arguments {
  std::string bag;
  std::string picture;
  std::string images;  ///< bag with the images; empty: that of the lines
  std::string lines_topic;
  std::string image_topic;
  std::size_t number{0};
  bool chords{false};
  bool no_ids{false};
};

/// Paints all images up to the chosen one: trails need those before.
void paintTracks(const Arguments& arguments) {
  checkOutput(arguments.picture, {arguments.bag, arguments.images});
  const std::string ending = std::filesystem::path(arguments.picture).extension();
  if (ending.empty() || !cv::haveImageWriter(arguments.picture)) {
    throw std::runtime_error("cannot write " + arguments.picture +
                             ": no picture that OpenCV can write ends so, " + "needs .png or .jpg");
  }
  rosbag::Bag bag;
  openForReading(bag, arguments.bag);
  const LineBag lines = readLines(bag, arguments.lines_topic);
  if (!arguments.images.empty()) {
    bag.close();
    openForReading(bag, arguments.images);
  }
  const std::string& images = bag.getFileName();
  std::map<std::int64_t, const LineFrame*> frames;
  for (const LineFrame& frame : lines.frames) frames[frame.stamp_ns] = &frame;

  checkDefinition<sensor_msgs::Image>(bag, arguments.image_topic);
  checkDefinition<sensor_msgs::CompressedImage>(bag, arguments.image_topic);
  TrackPainter::Style style;
  style.ids = !arguments.no_ids;
  TrackPainter painter(style);
  BagCalibration calibration(bag, chooseCameraInfoTopic(bag, "", arguments.image_topic));
  cv::Mat picture;
  std::size_t painted = 0;
  rosbag::View view(bag, rosbag::TopicQuery(arguments.image_topic));
  for (const rosbag::MessageInstance& instance : view) {
    throwIfInterrupted();
    const auto image = readImage(instance);
    if (!image) {
      throw std::runtime_error(arguments.image_topic + " of " + images + " holds " + instance.getDataType());
    }
    const auto frame = frames.find(static_cast<std::int64_t>(image->header.stamp.toNSec()));
    if (frame == frames.end()) continue;
    const cv::Mat gray = toGray(*image, 1.0 / 256.0);
    if (!arguments.chords) {
      painter.setCamera(calibration.modelFor(image->header.stamp, gray.cols, gray.rows));
    }
    painter.paint(gray, *frame->second, picture);
    if (++painted == arguments.number) break;
  }
  if (painted < arguments.number) {
    throw std::runtime_error(images + " holds " + std::to_string(painted) + " images with lines on " +
                             arguments.image_topic + ", number " + std::to_string(arguments.number) +
                             " was asked for (track_bag --with-images copies the images)");
  }
  std::vector<unsigned char> bytes;
  cv::imencode(ending, picture, bytes);
  writeOutput(arguments.picture, {bytes.begin(), bytes.end()});
}

int run(int argc, char** argv) {
  namespace po = boost::program_options;
  Arguments arguments;
  po::options_description options("Options");
  // clang-format off
  options.add_options()
      ("bag", po::value(&arguments.bag)->required(), "bag with images and lines, as of track_bag --with-images")
      ("picture", po::value(&arguments.picture)->required(), "picture to write, .png or .jpg")
      ("images", po::value(&arguments.images), "bag with the images, where they are in another one than the lines")
      ("number", po::value(&arguments.number)->default_value(1), "which image, counted from 1")
      ("lines", po::value(&arguments.lines_topic)->default_value(sequence_bag::kLinesTopic), "topic of the lines")
      ("image", po::value(&arguments.image_topic)->default_value(sequence_bag::kImageTopic), "topic of the images")
      ("no-ids", po::bool_switch(&arguments.no_ids), "without the ids of the lines")
      ("chords", po::bool_switch(&arguments.chords), "straight lines in the image, although the lens bends them");
  // clang-format on
  po::positional_options_description positional;
  positional.add("bag", 1).add("picture", 1);
  po::variables_map values;
  if (!parseCommandLine(
          argc, argv,
          "paint_tracks BAG PICTURE [options]\n\nPaints the lines of a bag over one of its images, "
          "coloured by age, with ids and trails.",
          options, positional, values)) {
    return 0;
  }
  if (arguments.number < 1) throw std::runtime_error("--number is 0, needs 1 or more");
  paintTracks(arguments);
  return 0;
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  return tet_line_tracker::runProgram("paint_tracks", [&] { return tet_line_tracker::run(argc, argv); });
}
