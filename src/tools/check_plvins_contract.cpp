// Judges a stream of line messages against what PL-VINS's estimator takes for granted: from a bag, or live.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <stdexcept>

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include "../ros/pl_vins_pairing.h"
#include "bag_reader.h"
#include "pl_vins_contract.h"
#include "program.h"

namespace tet_line_tracker {
namespace {

void print(const std::vector<ContractFault>& faults) {
  for (const ContractFault& fault : faults) {
    std::cout << fault.stamp << " " << nameOf(fault.rule);
    if (!std::isnan(fault.id)) std::cout << " id " << fault.id;
    std::cout << ": " << fault.text << "\n";
  }
}

void readBag(const std::string& path, const PlVinsTopics& topics, PlVinsContract* contract) {
  rosbag::Bag bag;
  openForReading(bag, path);
  checkDefinition<sensor_msgs::PointCloud>(bag, topics.points);
  checkDefinition<sensor_msgs::PointCloud>(bag, topics.output);
  rosbag::View view(bag, rosbag::TopicQuery(std::vector<std::string>{topics.points, topics.output}));
  for (const rosbag::MessageInstance& instance : view) {
    throwIfInterrupted();
    const auto message = instance.instantiate<sensor_msgs::PointCloud>();
    if (!message) {
      throw std::runtime_error(path + ": " + instance.getTopic() + " holds " + instance.getDataType() +
                               ", needs sensor_msgs/PointCloud");
    }
    if (instance.getTopic() == topics.points) {
      contract->addPoints(message->header.stamp);
    } else {
      contract->addLines(*message);
    }
    print(contract->takeFaults());
  }
}

bool isPublished(const std::string& topic) {
  ros::master::V_TopicInfo published;
  ros::master::getTopics(published);
  return std::any_of(published.begin(), published.end(),
                     [&](const auto& info) { return info.name == topic; });
}

void listen(const PlVinsTopics& topics, double seconds, PlVinsContract* contract) {
  ros::NodeHandle node;
  if (isPublished(node.resolveName(topics.points)) || isPublished(node.resolveName(topics.output))) {
    contract->joinRunningStream();
  }
  constexpr int kQueue = 2000;  // as the estimator
  ros::Time last_points;
  bool hears_points = true;
  auto points = node.subscribe<sensor_msgs::PointCloud>(
      topics.points, kQueue, [&](const sensor_msgs::PointCloud::ConstPtr& message) {
        last_points = message->header.stamp;
        contract->addPoints(last_points);
      });
  const auto lines = node.subscribe<sensor_msgs::PointCloud>(
      topics.output, kQueue, [&](const sensor_msgs::PointCloud::ConstPtr& message) {
        if (hears_points || message->header.stamp <= last_points) contract->addLines(*message);
      });
  const auto listenUntil = [contract](const auto& done) {
    while (ros::ok() && !done()) {
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
      print(contract->takeFaults());
    }
  };
  const ros::SteadyTime end = ros::SteadyTime::now() + ros::WallDuration(seconds);
  listenUntil([&] { return interrupted() || (seconds > 0.0 && ros::SteadyTime::now() > end); });
  // The lines of the last points may still be on their way.
  points.shutdown();
  hears_points = false;
  const ros::SteadyTime last = ros::SteadyTime::now() + ros::WallDuration(1.0);
  listenUntil([&] { return ros::SteadyTime::now() > last; });
}

int run(int argc, char** argv) {
  namespace po = boost::program_options;
  PlVinsParameters parameters;
  std::string bag;
  double seconds = 0.0;
  po::options_description options;
  options.add_options()("bag", po::value(&bag))("preset",
                                                po::value(&parameters.preset)->default_value("pl_vins"),
                                                "topics of pl_vins (also PL-VIO) or eplf_vins")(
      "points", po::value(&parameters.points_topic), "topic of the point messages")(
      "lines", po::value(&parameters.output_topic), "topic of the line messages")(
      "seconds", po::value(&seconds), "without a bag: stop after so many seconds (0: at Ctrl-C)");
  po::positional_options_description positional;
  positional.add("bag", 1);
  po::variables_map values;
  std::vector<std::string> arguments;
  ros::removeROSArgs(argc, argv, arguments);
  std::vector<char*> rest;
  rest.reserve(arguments.size());
  for (std::string& argument : arguments) rest.push_back(argument.data());
  if (!parseCommandLine(static_cast<int>(rest.size()), rest.data(),
                        "check_plvins_contract [BAG] [options]\nWithout a bag it listens to the topics. Exit "
                        "status 1 when a rule was broken or nothing was there to judge.",
                        options, positional, values)) {
    return 0;
  }
  for (const std::string& sentence : tableOf(parameters).check()) throw std::runtime_error(sentence);
  const PlVinsTopics topics = topicsOf(parameters);

  PlVinsContract contract;
  if (!bag.empty()) {
    readBag(bag, topics, &contract);
  } else {
    ros::init(argc, argv, "check_plvins_contract",
              ros::init_options::AnonymousName | ros::init_options::NoSigintHandler);
    listen(topics, seconds, &contract);
  }
  contract.finish();
  print(contract.takeFaults());

  std::uint64_t broken = 0;
  for (const auto& [rule, count] : contract.faults()) {
    std::cout << nameOf(rule) << " " << count << "\n";
    broken += count;
  }
  std::cout << contract.pairs() << " pairs of messages, " << contract.emptyMessages() << " without lines, "
            << contract.lines() << " lines of " << contract.ids() << " ids, " << broken << " broken rules\n";
  if (contract.pairs() == 0)
    throw std::runtime_error("no pair of messages on " + topics.points + " and " + topics.output);
  return broken == 0 ? 0 : 1;
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  return tet_line_tracker::runProgram("check_plvins_contract",
                                      [argc, argv] { return tet_line_tracker::run(argc, argv); });
}
