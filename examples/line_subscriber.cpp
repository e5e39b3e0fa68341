// What an estimator does with lines, in short: keeps the views of each track, forgets tracks that ended.
#include <ros/ros.h>
#include <std_msgs/String.h>
#include <tet_line_tracker/LineArray.h>
#include <array>
#include <cmath>
#include <map>

/// Weights of the distances of start and end across the line [1/px^2]: 0 where the tracker knows nothing. An
/// estimator that can should use the whole matrix (covariance_px[1] is the covariance of both).
std::array<double, 2> weightsOfEnds(const tet_line_tracker::Line& line) {
  if (!(line.covariance_px[0] > 0.0F) || !(line.covariance_px[2] > 0.0F)) return {0.0, 0.0};
  return {1.0 / line.covariance_px[0], 1.0 / line.covariance_px[2]};
}

int main(int argc, char** argv) {
  ros::init(argc, argv, "line_subscriber");
  ros::NodeHandle node("~");
  ros::Publisher summary = node.advertise<std_msgs::String>("summary", 10);
  std::map<std::uint64_t, std::vector<tet_line_tracker::Line>> views;  // by id, newest last
  std::uint32_t epoch = 0;
  const boost::function<void(const tet_line_tracker::LineArray&)> onLines = [&](const auto& array) {
    if (array.epoch != epoch) views.clear();  // a reset: ids begin anew
    epoch = array.epoch;
    std::map<std::uint64_t, std::vector<tet_line_tracker::Line>> now;
    for (const auto& line : array.lines) {
      if (!std::isfinite(line.start_normalized[0]))
        continue;  // no calibration, or not in front of the camera
      auto& track = now[line.id];
      track.swap(views[line.id]);
      track.push_back(line);
    }
    views.swap(now);  // a line that is missing once never comes back under its id
    std::size_t usable = 0;
    for (const auto& [id, track] : views) usable += track.size() >= 5 && weightsOfEnds(track.back())[0] > 0.0;
    std_msgs::String text;
    text.data = std::to_string(views.size()) + " lines, " + std::to_string(usable) + " usable";
    summary.publish(text);
  };
  // Without tcpNoDelay lines of another process may come 40 ms late.
  const ros::Subscriber lines = node.subscribe<tet_line_tracker::LineArray>(
      "/line_tracker/lines", 100, onLines, ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay());
  ros::spin();
}
