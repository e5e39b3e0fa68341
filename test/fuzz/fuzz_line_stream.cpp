// Streams of LineArray of any content, with poses of any bits, into the mapper and into the pairing of the
// bridge to PL-VINS. The map must stay finite; each point message must be answered once, in order, by what an
// estimator can read.
#include <cmath>

#include <boost/make_shared.hpp>

#include "../../src/ros/messages.h"
#include "../../src/ros/pl_vins_pairing.h"
#include "fuzz_target.h"
#include "tet_line_tracker/mapping/line_mapper.h"

using namespace tet_line_tracker;

namespace {

constexpr unsigned kRarity = 8;  // of numbers of any bits

LineArray::Ptr anyLines(Bytes& bytes, const ros::Time& stamp) {
  const auto message = boost::make_shared<LineArray>();
  message->header.stamp = stamp;
  message->epoch = bytes.take<std::uint8_t>() % 4 / 3;
  message->image_count = bytes.take<std::uint8_t>();
  message->width = 752;
  message->height = 480;
  for (int i = bytes.take<std::uint8_t>() % 8; i > 0; --i) {
    Line line;
    line.id =
        bytes.take<std::uint8_t>() % 8 != 0 ? bytes.take<std::uint8_t>() % 8 : bytes.take<std::uint64_t>();
    line.age = bytes.take<std::uint8_t>();
    for (float& value : line.start_px) value = static_cast<float>(takeNumber(bytes, 752.0, kRarity));
    for (float& value : line.end_px) value = static_cast<float>(takeNumber(bytes, 752.0, kRarity));
    for (double& value : line.start_normalized) value = takeNumber(bytes, 1.0, kRarity);
    for (double& value : line.end_normalized) value = takeNumber(bytes, 1.0, kRarity);
    line.sigma_px = static_cast<float>(takeNumber(bytes, 1.0, kRarity));
    for (float& value : line.covariance_px) value = static_cast<float>(takeNumber(bytes, 1.0, kRarity));
    line.cut = bytes.take<std::uint8_t>();
    message->lines.push_back(line);
  }
  return message;
}

Eigen::Isometry3d anyPose(Bytes& bytes) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 3; ++i) pose.translation()[i] = takeNumber(bytes, 5.0, kRarity);
  const Eigen::Vector3d axis(takeNumber(bytes, 1.0, kRarity), takeNumber(bytes, 1.0, kRarity),
                             takeNumber(bytes, 1.0, kRarity));
  pose.linear() = Eigen::AngleAxisd(takeNumber(bytes, 1.0, kRarity), axis.normalized()).toRotationMatrix();
  return pose;
}

void checkAnswer(const sensor_msgs::PointCloud& answer) {
  need(answer.channels.size() >= 3, "an answer has too few channels");
  for (std::size_t c = 0; c < 3; ++c) {
    need(answer.channels[c].values.size() == answer.points.size(), "a channel is not as long as the points");
    for (const float value : answer.channels[c].values) need(std::isfinite(value), "a channel is not finite");
  }
  for (const geometry_msgs::Point32& point : answer.points) {
    need(std::isfinite(point.x) && std::isfinite(point.y) && point.z == 1.0F, "a point is not on z = 1");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  LineMapperParameters mapping;
  mapping.min_views = 2 + bytes.take<std::uint8_t>() % 4;
  LineMapper mapper(mapping);
  PlVinsParameters sending;
  sending.extra_channels = bytes.take<std::uint8_t>() % 2 == 0;
  PlVinsPairing pairing(sending);

  std::size_t asked = 0, answered = 0;
  ros::Time last_answer;
  double now_s = 0.0;
  const auto takeAnswers = [&] {
    for (const sensor_msgs::PointCloudPtr& answer : pairing.take(now_s)) {
      need(answered == 0 || answer->header.stamp >= last_answer, "the answers are not in order");
      checkAnswer(*answer);
      last_answer = answer->header.stamp;
      ++answered;
    }
  };
  std_msgs::Header points;
  for (int k = 0; k < 24; ++k) {
    now_s += 0.05;
    const ros::Time stamp(1.0 + 0.05 * (k + bytes.take<std::int8_t>() / 64));
    if (bytes.take<std::uint8_t>() % 4 != 0) {
      points.stamp = ros::Time(1.0 + 0.05 * k);
      ++points.seq;
      pairing.addPoints(points, now_s);
      ++asked;
    }
    const LineArray::Ptr lines = anyLines(bytes, stamp);
    pairing.addLines(lines);
    takeAnswers();
    mapper.add(toLineFrame(*lines), anyPose(bytes));
    for (const MappedLine& line : mapper.lines()) {
      need(line.start.allFinite() && line.end.allFinite(), "a line of the map is not finite");
    }
  }
  now_s += 10.0;
  takeAnswers();
  need(answered == asked, "a point message was not answered once");
  mapper.finish();
  for (const MappedLine& line : mapper.lines()) {
    need(line.start.allFinite() && line.end.allFinite() && std::isfinite(line.sigma_start),
         "a line of the map is not finite");
  }
  return 0;
}
