// Makes a map of lines in space from the lines and poses of a bag.

#include <algorithm>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include "../ros/map_messages.h"
#include "../ros/messages.h"
#include "../simulation/scene_geometry.h"
#include "bag_reader.h"
#include "bag_writer.h"
#include "output_file.h"
#include "parameter_arguments.h"
#include "program.h"
#include "sequence_bag.h"

namespace tet_line_tracker {
namespace {

namespace po = boost::program_options;

struct Arguments {
  std::string input, output, lines_topic, world, camera;
  double period_s{1.0};
};

/// All transforms of a bag, however long it is.
void readTransforms(const rosbag::Bag& bag, tf2::BufferCore* transforms) {
  rosbag::View view(bag, rosbag::TopicQuery(
                             std::vector<std::string>{sequence_bag::kTfTopic, sequence_bag::kStaticTfTopic}));
  for (const rosbag::MessageInstance& instance : view) {
    const auto message = instance.instantiate<tf2_msgs::TFMessage>();
    if (!message) continue;
    for (const geometry_msgs::TransformStamped& transform : message->transforms) {
      transforms->setTransform(transform, "bag", instance.getTopic() == sequence_bag::kStaticTfTopic);
    }
  }
}

/// The true edges of a simulated world, thin and gray, to look at below the map.
visualization_msgs::Marker trueEdges(const SceneGeometry& scene) {
  visualization_msgs::Marker marker;
  marker.header.frame_id = sequence_bag::kWorldFrame;
  marker.ns = "true_edges";
  marker.type = visualization_msgs::Marker::LINE_LIST;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = 0.006;  // width [m]
  marker.color.r = marker.color.g = marker.color.b = 0.45F;
  marker.color.a = 1.0F;
  for (const TrueEdge& edge : scene.edges()) {
    marker.points.push_back(toPoint(edge.start));
    marker.points.push_back(toPoint(edge.end));
  }
  return marker;
}

/// The truth and the transforms travel along, so that one bag is enough to look at the map and to judge it.
void copyContext(const rosbag::Bag& input, BagWriter* output) {
  rosbag::View view(
      input, rosbag::TopicQuery(std::vector<std::string>{sequence_bag::kTfTopic, sequence_bag::kStaticTfTopic,
                                                         sequence_bag::kPoseTopic, kSceneTopic}));
  for (const rosbag::MessageInstance& instance : view) {
    output->copy(instance);
    if (instance.getTopic() != kSceneTopic) continue;
    if (const auto scene = instance.instantiate<std_msgs::String>()) {
      output->write(sequence_bag::kTrueEdgesTopic, instance.getTime(),
                    trueEdges(SceneGeometry::fromText(scene->data)));
    }
  }
}

/// One line on how well the lines of a map are known: median and 90 %.
void printQuality(const std::vector<MappedLine>& lines) {
  if (lines.empty()) return;
  const auto quantiles = [&lines](const char* name, const auto& value_of, const char* unit) {
    std::vector<double> values;
    values.reserve(lines.size());
    for (const MappedLine& line : lines) values.push_back(value_of(line));
    std::sort(values.begin(), values.end());
    std::printf("%s %.2f / %.2f%s", name, values[values.size() / 2], values[values.size() * 9 / 10], unit);
  };
  constexpr double kDegrees = 57.29577951308232;
  std::printf("median / 90 %%: ");
  quantiles(
      "reprojection error", [](const MappedLine& line) { return line.reprojection_px; }, " px, ");
  quantiles(
      "parallax", [](const MappedLine& line) { return kDegrees * line.parallax; }, " deg, ");
  quantiles(
      "distance", [](const MappedLine& line) { return line.distance; }, " m\n");
}

void mapBag(const Arguments& arguments, const LineMapperParameters& parameters) {
  rosbag::Bag input;
  openForReading(input, arguments.input);
  checkDefinition<LineArray>(input, arguments.lines_topic);
  checkDefinition<tf2_msgs::TFMessage>(input, sequence_bag::kTfTopic);
  checkDefinition<tf2_msgs::TFMessage>(input, sequence_bag::kStaticTfTopic);
  tf2::BufferCore transforms(ros::Duration(1e8));
  readTransforms(input, &transforms);

  LineMapper mapper(parameters);
  BagWriter output(arguments.output);
  copyContext(input, &output);
  rosbag::View view(input, rosbag::TopicQuery(arguments.lines_topic));
  std_msgs::Header header;
  header.frame_id = arguments.world;
  ros::Time next_map;
  std::size_t images = 0;
  std::size_t without_pose = 0;
  std::string problem;
  const auto writeMap = [&] {
    const Line3DArray map = toLine3DArray(mapper.lines(), header);
    output.write(sequence_bag::kMapTopic, header.stamp, map);
    output.write(sequence_bag::kMapMarkerTopic, header.stamp, toMapMarker(map));
  };
  ProgressBar progress(view.size());
  for (const rosbag::MessageInstance& instance : view) {
    throwIfInterrupted();
    progress.advance();
    const auto lines = instance.instantiate<LineArray>();
    if (!lines) continue;
    ++images;
    const std::string& camera = arguments.camera.empty() ? lines->header.frame_id : arguments.camera;
    const CameraPose pose = lookUpPose(transforms, arguments.world, camera, lines->header.stamp);
    if (!pose.world_from_camera) {
      if (without_pose++ == 0) problem = pose.problem;
      continue;
    }
    mapper.add(toLineFrame(*lines), *pose.world_from_camera);
    header.stamp = lines->header.stamp;
    if (header.stamp >= next_map) {
      writeMap();
      next_map = header.stamp + ros::Duration(arguments.period_s);
    }
  }
  if (images == 0) throw std::runtime_error(arguments.input + " has no lines on " + arguments.lines_topic);
  if (without_pose == images) throw std::runtime_error(arguments.input + ": " + problem);
  mapper.finish();
  writeMap();
  output.close();

  const LineMapper::Rejected& rejected = mapper.rejected();
  std::printf("%zu images, %zu of them without a pose, %zu lines in the map\n", images, without_pose,
              mapper.finishedLines());
  printQuality(mapper.lines());
  if (without_pose > 0) std::printf("first image without a pose: %s\n", problem.c_str());
  std::printf(
      "tracks not in the map: %lu with too few views, %lu without parallax, %lu off their images, %lu not "
      "sure "
      "enough, %lu without ends\n",
      static_cast<unsigned long>(rejected.few_views), static_cast<unsigned long>(rejected.parallax),
      static_cast<unsigned long>(rejected.reprojection), static_cast<unsigned long>(rejected.sigma),
      static_cast<unsigned long>(rejected.ends));
}

int run(int argc, char** argv) {
  Arguments arguments;
  std::string config;
  std::vector<std::string> settings;
  po::options_description options;
  // clang-format off
  options.add_options()
      ("input", po::value(&arguments.input)->required())
      ("output", po::value(&arguments.output)->required())
      ("lines", po::value(&arguments.lines_topic)->default_value(sequence_bag::kLinesTopic), "topic of the lines")
      ("world", po::value(&arguments.world)->default_value(sequence_bag::kWorldFrame), "frame of the map")
      ("camera", po::value(&arguments.camera), "frame of the camera (default: as the lines say)")
      ("period", po::value(&arguments.period_s)->default_value(1.0), "from one map in the output to the next [s]")
      ("config", po::value(&config), "YAML file with parameters, as for the nodelet LineMapper")
      ("set", po::value(&settings)->composing(), "name=value: one parameter; may be given again");
  // clang-format on
  po::positional_options_description positional;
  positional.add("input", 1).add("output", 1);
  po::variables_map values;
  if (!parseCommandLine(
          argc, argv,
          "map_bag IN.bag OUT.bag [options]\n\nMakes lines in space from the lines of track_bag and "
          "the poses on /tf, and writes them to /line_mapper/lines.",
          options, positional, values)) {
    return 0;
  }
  LineMapperParameters parameters;
  ParameterTable table = tableOf(parameters);
  setParameters(config, settings, table);
  checkOutput(arguments.output, {arguments.input, config});
  mapBag(arguments, parameters);
  return 0;
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  return tet_line_tracker::runProgram("map_bag", [&] { return tet_line_tracker::run(argc, argv); });
}
