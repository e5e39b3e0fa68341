#include "node_parameters.h"

#include <XmlRpcValue.h>
#include <image_transport/image_transport.h>

#include <limits>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "image_subscription.h"
#include "mask_file.h"
#include "sensor_extrinsic.h"

namespace tet_line_tracker {
namespace {

std::string typeText(const XmlRpc::XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeArray:
      return "a list";
    case XmlRpc::XmlRpcValue::TypeStruct:
      return "a group of parameters";
    case XmlRpc::XmlRpcValue::TypeString:
      return "a text";
    default:
      return "a value of another type";
  }
}

/// Text for ParameterTable::set(). Throws std::invalid_argument when the type does not fit the entry: a
/// number in quotes is a mistake that the reader of a YAML file should learn about.
std::string valueText(const ParameterTable::Entry& entry, XmlRpc::XmlRpcValue& value) {
  const bool wants_text = std::holds_alternative<std::string*>(entry.field);
  const auto type = value.getType();
  if (type == XmlRpc::XmlRpcValue::TypeString && wants_text) return static_cast<std::string&>(value);
  if (type == XmlRpc::XmlRpcValue::TypeBoolean) return static_cast<bool&>(value) ? "true" : "false";
  if (type == XmlRpc::XmlRpcValue::TypeInt) return std::to_string(static_cast<int&>(value));
  if (type == XmlRpc::XmlRpcValue::TypeDouble) {
    std::ostringstream text;
    text.precision(std::numeric_limits<double>::max_digits10);
    text << static_cast<double&>(value);
    return text.str();
  }
  std::string seen = typeText(value);
  if (type == XmlRpc::XmlRpcValue::TypeString) seen += " (" + static_cast<std::string&>(value) + ")";
  throw std::invalid_argument("parameter " + entry.name + " is " + seen + ", needs " +
                              ParameterTable::rangeText(entry));
}

std::string joined(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += (text.empty() ? "" : "; ") + sentence;
  return text;
}

/// Sets what the private namespace holds; one sentence for each name or value that does not fit.
std::vector<std::string> setFromServer(const ros::NodeHandle& node, ParameterTable& table) {
  XmlRpc::XmlRpcValue values;
  std::vector<std::string> broken;
  if (!node.getParam(node.getNamespace(), values) || values.getType() != XmlRpc::XmlRpcValue::TypeStruct) {
    return broken;
  }
  for (auto& [name, value] : values) {
    if (foreignParameterNames().count(name) != 0) continue;
    const ParameterTable::Entry* entry = table.find(name);
    try {
      if (entry == nullptr) throw std::invalid_argument(table.unknownName(name));
      table.set(name, valueText(*entry, value));
    } catch (const std::invalid_argument& error) {
      broken.emplace_back(error.what());
    }
  }
  return broken;
}

}  // namespace

ParameterTable tableOf(NodeParameters& p) {
  ParameterTable table;
  table.add("publish_rate", p.publish_rate, 0.0, 1000.0, "Hz",
            "Messages per second, counted by image stamps; 0: one for every image");
  table.add("mono16_scale", p.mono16_scale, 1e-6, 255.0, "",
            "8-bit gray per step of a 16-bit image; 0.00390625 takes the upper byte");
  table.add("queue_size", p.queue_size, 1, 1000, "",
            "Images that wait for their turn at most; a newer one replaces the oldest");
  table.add("marker_ids", p.marker_ids, "Ids beside the lines of `~markers`");
  table.add("debug_image_ids", p.debug_image_ids,
            "Ids on `~debug_image`, where there is room for them, oldest tracks first");
  table.add("debug_image_rate", p.debug_image_rate, 0.0, 1000.0, "Hz",
            "Debug images per second at most, counted by image stamps; 0: one for every message of lines");
  table.add("imu_wait", p.imu_wait, 0.0, 10.0, "s",
            "An image waits at most so long for the message of IMU or odometry after it; then its motion is "
            "predicted from the images");
  // What has been learned with a calibration does not outlive it.
  table
      .add(
          "imu_rotation", p.imu_rotation, std::vector<std::string>{},
          "Quaternion `qx qy qz qw` that takes directions in the IMU's frame to the camera's; empty: from tf")
      .change = ParameterTable::Change::kAtStart;
  table
      .add("odometry_extrinsic", p.odometry_extrinsic, std::vector<std::string>{},
           "Pose `x y z qx qy qz qw` of the odometry's child frame in the camera's [m]; empty: from tf")
      .change = ParameterTable::Change::kAtStart;
  table.add("mask", p.mask, std::vector<std::string>{},
            "Path of an image of the camera's size, white where lines are tracked; empty: everywhere");
  return table;
}

ParameterTable tableOf(LineMapperNodeParameters& p) {
  ParameterTable table;
  table.add("world_frame", p.world_frame, {}, "Frame of the map");
  table.add("camera_frame", p.camera_frame, {}, "Optical frame of the camera; empty: frame_id of the lines");
  table.add("tf_timeout", p.tf_timeout, 0.0, 60.0, "s",
            "Lines wait this long for the pose of their camera, by the wall clock");
  table.add("publish_rate", p.publish_rate, 0.01, 100.0, "Hz", "Maps per second at most");
  return table;
}

std::vector<std::string> check(const NodeParameters& parameters) {
  NodeParameters copy = parameters;
  std::vector<std::string> broken = tableOf(copy).check();
  const auto expect = [&broken](const auto& rule) {
    try {
      rule();
    } catch (const std::invalid_argument& error) {
      broken.emplace_back(error.what());
    }
  };
  expect([&] { imuRotation(parameters.imu_rotation); });
  expect([&] { odometryExtrinsic(parameters.odometry_extrinsic); });
  expect([&] { readMask(parameters.mask); });
  return broken;
}

const std::set<std::string>& foreignParameterNames() {
  static const std::set<std::string> names{
      "image_transport",  // transport of the image, read by image_transport::TransportHints
      "image",            // settings of the transport plugins, by topic or by transport
      "debug_image",
      "raw",
      "compressed",
      "compressedDepth",
      "theora",
      "diagnostic_period",  // diagnostic_updater
      "diagnostic_updater_use_fqn",
      "num_worker_threads"  // nodelet manager, when it shares the name of the node
  };
  return names;
}

void loadParameters(const ros::NodeHandle& node, ParameterTable table) {
  std::vector<std::string> broken = setFromServer(node, table);
  for (const std::string& sentence : table.check()) broken.push_back(sentence);
  if (!broken.empty()) throw std::invalid_argument(joined(broken));
}

void loadParameters(const ros::NodeHandle& node, LineTrackerParameters& tracker, NodeParameters& parameters) {
  ParameterTable table = tableOf(tracker);
  table.append(tableOf(parameters));
  std::vector<std::string> broken = setFromServer(node, table);
  for (const std::string& sentence : check(tracker)) broken.push_back(sentence);
  for (const std::string& sentence : check(parameters)) broken.push_back(sentence);
  if (!broken.empty()) throw std::invalid_argument(joined(broken));
}

void checkImageTransport(const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
  std::string transport = "raw";
  private_node.getParam("image_transport", transport);
  // Read without a plugin.
  if (transport == ImageSubscription::kCompressed) return;
  std::string known = ImageSubscription::kCompressed;
  for (const std::string& name : image_transport::ImageTransport(node).getLoadableTransports()) {
    const std::string short_name = name.substr(name.find('/') + 1);
    if (short_name == transport) return;
    if (short_name != ImageSubscription::kCompressed) known += ", " + short_name;
  }
  throw std::invalid_argument("parameter image_transport is " + transport +
                              ", needs one that is installed: " + known);
}

}  // namespace tet_line_tracker
