#include "reconfigure_server.h"

#include <XmlRpcValue.h>
#include <ros/master.h>
#include <ros/this_node.h>

#include <exception>
#include <utility>

#include "config_messages.h"

namespace tet_line_tracker {
namespace {

ParameterTable bothTables(LineTrackerParameters& tracker, NodeParameters& parameters) {
  ParameterTable table = tableOf(tracker);
  table.append(tableOf(parameters));
  return table;
}

/// False when the master does not answer. Unlike NodeHandle::setParam() it does not wait for one to come.
bool writeToServer(const std::string& name, const ParameterTable::Value& value) {
  XmlRpc::XmlRpcValue arguments;
  XmlRpc::XmlRpcValue answer;
  XmlRpc::XmlRpcValue payload;
  arguments[0] = ros::this_node::getName();
  arguments[1] = name;
  std::visit([&arguments](const auto& content) { arguments[2] = content; }, value);
  return ros::master::execute("setParam", arguments, answer, payload, false);
}

std::string shown(const std::string& value) {
  return value.empty() ? "empty" : value;
}

}  // namespace

ReconfigureServer::ReconfigureServer(const ros::NodeHandle& node, const LineTrackerParameters& tracker,
                                     const NodeParameters& parameters, Handlers handlers)
    : node_(node),
      handlers_(std::move(handlers)),
      tracker_(tracker),
      parameters_(parameters),
      spinner_(1, &queue_) {
  node_.setCallbackQueue(&queue_);
  constexpr std::uint32_t kQueue = 1;
  constexpr bool kLatched = true;
  descriptions_ =
      node_.advertise<dynamic_reconfigure::ConfigDescription>("parameter_descriptions", kQueue, kLatched);
  updates_ = node_.advertise<dynamic_reconfigure::Config>("parameter_updates", kQueue, kLatched);
  LineTrackerParameters tracker_defaults;
  NodeParameters defaults;
  descriptions_.publish(toConfigDescription(bothTables(tracker_defaults, defaults)));
  updates_.publish(toConfig(bothTables(tracker_, parameters_)));
  service_ = node_.advertiseService("set_parameters", &ReconfigureServer::onRequest, this);
  spinner_.start();
}

bool ReconfigureServer::onRequest(dynamic_reconfigure::Reconfigure::Request& request,
                                  dynamic_reconfigure::Reconfigure::Response& response) {
  for (const std::string& sentence : change(request.config)) {
    handlers_.warn("refused: " + sentence);
  }
  response.config = toConfig(bothTables(tracker_, parameters_));
  updates_.publish(response.config);
  return true;
}

std::vector<std::string> ReconfigureServer::change(const dynamic_reconfigure::Config& request) {
  LineTrackerParameters tracker = tracker_;
  NodeParameters parameters = parameters_;
  ParameterTable table = bothTables(tracker, parameters);
  std::vector<std::string> refused = setFrom(request, table);
  const ParameterTable before = bothTables(tracker_, parameters_);
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < table.entries().size(); ++i) {
    const bool same = ParameterTable::value(before.entries()[i]) == ParameterTable::value(table.entries()[i]);
    if (!same) changed.push_back(i);
  }
  if (changed.empty()) return refused;
  try {
    handlers_.apply(checked(tracker), checked(parameters));
  } catch (const std::exception& error) {
    refused.emplace_back(error.what());
    return refused;
  }
  for (const std::size_t i : changed) {
    announce(table.entries()[i], ParameterTable::valueText(before.entries()[i]));
  }
  tracker_ = tracker;
  parameters_ = parameters;
  return refused;
}

void ReconfigureServer::announce(const ParameterTable::Entry& entry, const std::string& before) {
  handlers_.inform("parameter " + entry.name + " is now " + shown(ParameterTable::valueText(entry)) +
                   ", was " + shown(before));
  if (!writeToServer(node_.resolveName(entry.name), ParameterTable::value(entry))) {
    handlers_.warn("the master does not answer: the parameter server keeps the old value of " + entry.name);
  }
}

}  // namespace tet_line_tracker
