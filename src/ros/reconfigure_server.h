#pragma once

#include <functional>
#include <string>
#include <vector>

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <ros/spinner.h>

#include "node_parameters.h"

namespace tet_line_tracker {

/// Lets rqt_reconfigure, dynparam and other clients of dynamic_reconfigure change the parameters of a running
/// tracker. Serves what they expect from the ParameterTables, so there is no .cfg file beside them. Requests
/// are handled in a thread of its own: they wait for an image to end and for the master, which callbacks must
/// not. A value that is refused stays as it was, and what stays is published, so that displays show it.
class ReconfigureServer {
 public:
  /// Both in the thread of the server.
  struct Handlers {
    /// Puts new values into effect. Throws when they cannot be; all must be as before.
    std::function<void(const LineTrackerParameters&, const NodeParameters&)> apply;
    /// One sentence for the user.
    std::function<void(const std::string&)> inform, warn;
  };

  /// Advertises `set_parameters`, `parameter_descriptions` and `parameter_updates` below `node`. `tracker`
  /// and `parameters`: in effect now.
  ReconfigureServer(const ros::NodeHandle& node, const LineTrackerParameters& tracker,
                    const NodeParameters& parameters, Handlers handlers);

 private:
  bool onRequest(dynamic_reconfigure::Reconfigure::Request& request,
                 dynamic_reconfigure::Reconfigure::Response& response);
  /// One sentence for each value of the request that is refused.
  std::vector<std::string> change(const dynamic_reconfigure::Config& request);
  /// To the log and to the parameter server, where a node that starts again finds it.
  void announce(const ParameterTable::Entry& entry, const std::string& before);

  ros::NodeHandle node_;
  Handlers handlers_;
  LineTrackerParameters tracker_;
  NodeParameters parameters_;

  ros::CallbackQueue queue_;
  ros::Publisher descriptions_, updates_;
  ros::ServiceServer service_;
  ros::AsyncSpinner spinner_;  ///< last: it stops before the rest is destroyed
};

}  // namespace tet_line_tracker
