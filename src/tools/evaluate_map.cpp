// Judges maps of lines by the true edges of the simulated world.

#include <cstdio>
#include <limits>
#include <stdexcept>

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>

#include "../evaluation/map_accuracy.h"
#include "bag_reader.h"
#include "program.h"
#include "sequence_bag.h"
#include "tet_line_tracker/Line3DArray.h"

namespace tet_line_tracker {
namespace {

namespace po = boost::program_options;

struct MapAndTruth {
  std::vector<LineInSpace> lines;
  SceneGeometry scene;
};

MapAndTruth read(const std::string& path, const std::string& map_topic) {
  rosbag::Bag bag;
  openForReading(bag, path);
  checkDefinition<Line3DArray>(bag, map_topic);
  MapAndTruth result;
  Line3DArray::ConstPtr map;
  rosbag::View maps(bag, rosbag::TopicQuery(map_topic));
  for (const rosbag::MessageInstance& instance : maps) {
    if (const auto message = instance.instantiate<Line3DArray>()) map = message;
  }
  if (!map) throw std::runtime_error(path + " has no map on " + map_topic);
  for (const Line3D& line : map->lines) {
    result.lines.push_back({{line.start.x, line.start.y, line.start.z},
                            {line.end.x, line.end.y, line.end.z},
                            static_cast<double>(line.distance),
                            0.5 * static_cast<double>(line.sigma_start + line.sigma_end)});
  }
  rosbag::View scenes(bag, rosbag::TopicQuery(kSceneTopic));
  for (const rosbag::MessageInstance& instance : scenes) {
    if (const auto message = instance.instantiate<std_msgs::String>()) {
      result.scene = SceneGeometry::fromText(message->data);
      return result;
    }
  }
  throw std::runtime_error(path + " has no true scene on " + kSceneTopic);
}

void print(const std::string& name, const std::vector<LineInSpace>& lines,
           const std::vector<TrueEdge>& edges) {
  constexpr double kDegrees = 57.29577951308232;
  const MapAccuracy a = measureMap(lines, edges);
  std::printf("%-28s %6zu %7zu %8zu %9.3f %9.3f %9.2f %9.2f %9.2f\n", name.c_str(), a.lines, a.edges,
              a.without_edge, kDegrees * a.direction_median, kDegrees * a.direction_p90,
              100.0 * a.across_median, 100.0 * a.across_p90, a.claim_median);
}

int run(int argc, char** argv) {
  std::vector<std::string> paths;
  std::string map_topic;
  double nearest = 1.0;
  double farthest = 5.0;
  po::options_description options;
  // clang-format off
  options.add_options()
      ("bag", po::value(&paths)->required(), "bags with a map and the true scene, as map_bag writes them")
      ("map", po::value(&map_topic)->default_value(sequence_bag::kMapTopic), "topic of the map")
      ("from", po::value(&nearest)->default_value(1.0), "smallest distance of the lines from the cameras [m]")
      ("to", po::value(&farthest)->default_value(5.0), "largest distance of the lines from the cameras [m]");
  // clang-format on
  po::positional_options_description positional;
  positional.add("bag", -1);
  po::variables_map values;
  if (!parseCommandLine(
          argc, argv,
          "evaluate_map BAG... [options]\n\nCompares the last map of each bag with the true edges of "
          "simulate_bag. Lines without an edge within 10 cm and 10 degrees count as infinitely "
          "wrong in every column.",
          options, positional, values)) {
    return 0;
  }
  std::printf("%-28s %6s %7s %8s %9s %9s %9s %9s %9s\n", "", "", "", "without", "direction", "[deg]",
              "distance", "[cm]", "/ sigma");
  std::printf("%-28s %6s %7s %8s %9s %9s %9s %9s\n", "map", "lines", "edges", "edge", "median", "90 %",
              "median", "90 %");
  for (const std::string& path : paths) {
    const MapAndTruth map = read(path, map_topic);
    std::vector<LineInSpace> chosen;
    for (const LineInSpace& line : map.lines) {
      if (line.distance >= nearest && line.distance <= farthest) chosen.push_back(line);
    }
    const std::string file = path.substr(path.rfind('/') + 1);
    print(file, map.lines, map.scene.edges());
    char range[64];
    std::snprintf(range, sizeof(range), "  at %g to %g m", nearest, farthest);
    print(range, chosen, map.scene.edges());
  }
  return 0;
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  return tet_line_tracker::runProgram("evaluate_map", [&] { return tet_line_tracker::run(argc, argv); });
}
