#include <algorithm>
#include <memory>

#include <diagnostic_updater/diagnostic_updater.h>
#include <nodelet/nodelet.h>
#include <ros/ros.h>
#include <pluginlib/class_list_macros.hpp>

#include "node_parameters.h"
#include "pl_vins_pairing.h"

namespace tet_line_tracker {

/// Lines in, messages for PL-VINS's estimator out: see PlVinsPairing. All callbacks run one after the other
/// on the node handle's queue, so nothing needs a mutex.
class PlVinsBridgeNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    PlVinsParameters parameters;
    loadParameters(getPrivateNodeHandle(), tableOf(parameters));
    const PlVinsTopics topics = topicsOf(parameters);
    pairing_ = std::make_unique<PlVinsPairing>(parameters);

    ros::NodeHandle& node = getNodeHandle();
    updater_ = std::make_unique<diagnostic_updater::Updater>(node, getPrivateNodeHandle(), getName());
    updater_->setHardwareID("none");
    updater_->add("Lines for the estimator", this, &PlVinsBridgeNodelet::diagnose);
    constexpr int kQueue = 2000;  // as the estimator: a message lost here would be lost for good
    publisher_ = node.advertise<sensor_msgs::PointCloud>(topics.output, kQueue);
    deadline_ = node.createWallTimer(
        ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { send(); }, true, false);
    report_ = node.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) {
      if (points_ && points_.getNumPublishers() == 0) {
        pairing_->addNoPublisher(ros::SteadyTime::now().toSec());
      }
      updater_->update();
    });
    const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
    lines_ = node.subscribe<LineArray>(
        "lines", kQueue,
        [this](const LineArray::ConstPtr& lines) {
          pairing_->addLines(lines);
          send();
        },
        ros::VoidConstPtr(), hints);
    if (parameters.follow != "points") return;
    points_ = node.subscribe<sensor_msgs::PointCloud>(
        topics.points, kQueue,
        [this](const sensor_msgs::PointCloud::ConstPtr& points) {
          pairing_->addPoints(points->header, ros::SteadyTime::now().toSec());
          warnOfMissedPoints();
          send();
        },
        ros::VoidConstPtr(), hints);
  }

  void send() {
    const double now_s = ros::SteadyTime::now().toSec();
    for (const sensor_msgs::PointCloudPtr& message : pairing_->take(now_s)) publisher_.publish(message);
    deadline_.stop();
    if (const auto deadline_s = pairing_->deadline()) {
      deadline_.setPeriod(ros::WallDuration(std::max(1e-3, *deadline_s - now_s)));
      deadline_.start();
    }
  }

  void warnOfMissedPoints() {
    const std::uint64_t missed = pairing_->counts().points_missed;
    if (missed == warned_missed_) return;
    NODELET_WARN(
        "%lu point messages were published that did not arrive here; an estimator that got them pairs all "
        "later lines with the wrong points. Start this node before the points.",
        static_cast<unsigned long>(missed - warned_missed_));
    warned_missed_ = missed;
  }

  void diagnose(diagnostic_updater::DiagnosticStatusWrapper& status) {
    const PlVinsPairing::Counts& c = pairing_->counts();
    const std::uint64_t unanswered = c.sent_without_input - reported_without_input_;
    reported_without_input_ = c.sent_without_input;
    if (unanswered > 0) {
      status.summaryf(diagnostic_msgs::DiagnosticStatus::WARN,
                      "%lu point messages got no lines in time since the last report",
                      static_cast<unsigned long>(unanswered));
    } else {
      status.summaryf(diagnostic_msgs::DiagnosticStatus::OK, "%lu messages sent",
                      static_cast<unsigned long>(c.sent));
    }
    status.add("point messages", c.points);
    status.add("point messages missed", c.points_missed);
    status.add("messages sent", c.sent);
    status.add("messages sent without lines in time", c.sent_without_input);
    status.add("line messages too late", c.late);
    status.add("lines sent", c.lines_sent);
    status.add("lines not in front of the camera or without calibration", c.lines_not_in_front);
    status.add("lines over the limit", c.lines_over_limit);
    status.add("lines with a repeated id", c.lines_repeated);
  }

  std::unique_ptr<PlVinsPairing> pairing_;
  std::uint64_t warned_missed_{0};
  std::uint64_t reported_without_input_{0};
  std::unique_ptr<diagnostic_updater::Updater> updater_;
  ros::Publisher publisher_;
  ros::WallTimer deadline_;
  ros::WallTimer report_;
  ros::Subscriber lines_;
  ros::Subscriber points_;
};

}  // namespace tet_line_tracker

PLUGINLIB_EXPORT_CLASS(tet_line_tracker::PlVinsBridgeNodelet, nodelet::Nodelet)
