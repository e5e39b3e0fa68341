#pragma once

#include <string>

#include <nodelet/NodeletList.h>
#include <nodelet/NodeletLoad.h>
#include <nodelet/NodeletUnload.h>
#include <ros/ros.h>

namespace tet_line_tracker {

/// A tracker /NAME in the process of /manager while this object lives; its topics are those of Stream(NAME).
/// Parameters are set before.
class ManagedNodelet {
 public:
  explicit ManagedNodelet(const std::string& name) : name_("/" + name) { load(); }
  ~ManagedNodelet() { unload(); }
  ManagedNodelet(const ManagedNodelet&) = delete;
  ManagedNodelet& operator=(const ManagedNodelet&) = delete;

  bool isLoaded() const { return loaded_; }
  bool load() {
    nodelet::NodeletLoad request;
    request.request.name = name_;
    request.request.type = "tet_line_tracker/LineTracker";
    for (const char* topic : {"image", "camera_info", "imu"}) {
      request.request.remap_source_args.push_back(std::string("/") + topic);
      request.request.remap_target_args.push_back(name_ + "/" + topic);
    }
    loaded_ = ros::service::waitForService("/manager/load_nodelet", 30000) &&
              ros::service::call("/manager/load_nodelet", request) && request.response.success != 0;
    return loaded_;
  }
  bool unload() {
    if (!loaded_) return false;
    loaded_ = false;
    nodelet::NodeletUnload request;
    request.request.name = name_;
    return ros::service::call("/manager/unload_nodelet", request) && request.response.success != 0;
  }
  /// Whether the process of the manager still answers. A busy machine may lose one call.
  static bool managerLives() {
    nodelet::NodeletList list;
    return ros::service::call("/manager/list", list) || ros::service::call("/manager/list", list);
  }

 private:
  std::string name_;
  bool loaded_{false};
};

}  // namespace tet_line_tracker
