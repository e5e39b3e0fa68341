#include "truth_bag.h"

#include <stdexcept>
#include <utility>

#include <geometry_msgs/PoseStamped.h>
#include <rosbag/query.h>
#include <rosbag/view.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>
#include <std_msgs/String.h>

#include "../evaluation/depth_truth.h"
#include "../evaluation/scene_truth.h"
#include "../ros/camera_info.h"
#include "bag_reader.h"
#include "sequence_bag.h"

namespace tet_line_tracker {
namespace {

PoseTrack readPoses(const rosbag::Bag& bag) {
  PoseTrack poses;
  rosbag::View view(bag, rosbag::TopicQuery(sequence_bag::kPoseTopic));
  for (const rosbag::MessageInstance& instance : view) {
    const auto message = instance.instantiate<geometry_msgs::PoseStamped>();
    if (!message) continue;
    const geometry_msgs::Quaternion& q = message->pose.orientation;
    const geometry_msgs::Point& t = message->pose.position;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized().toRotationMatrix();
    pose.translation() = Eigen::Vector3d(t.x, t.y, t.z);
    poses.add(static_cast<std::int64_t>(message->header.stamp.toNSec()), pose);
  }
  poses.sort();
  return poses;
}

std::shared_ptr<const CameraModel> readCamera(const rosbag::Bag& bag) {
  rosbag::View view(bag, rosbag::TopicQuery(sequence_bag::kCameraInfoTopic));
  for (const rosbag::MessageInstance& instance : view) {
    const auto message = instance.instantiate<sensor_msgs::CameraInfo>();
    if (message) return makeCameraModel(fromCameraInfo(*message));
  }
  return nullptr;
}

std::unique_ptr<Truth> depthTruth(const rosbag::Bag& bag, PoseTrack poses,
                                  std::shared_ptr<const CameraModel> camera) {
  auto truth = std::make_unique<DepthTruth>(std::move(poses), std::move(camera));
  bool any = false;
  rosbag::View view(bag, rosbag::TopicQuery(sequence_bag::kDepthTopic));
  for (const rosbag::MessageInstance& instance : view) {
    const auto message = instance.instantiate<sensor_msgs::Image>();
    if (!message) continue;
    if (message->encoding != sensor_msgs::image_encodings::TYPE_16UC1 || message->is_bigendian != 0 ||
        message->step < 2 * message->width || message->data.size() < message->step * message->height) {
      throw std::runtime_error(std::string(sequence_bag::kDepthTopic) + " holds an image of encoding " +
                               message->encoding + ", needed is 16UC1 [mm], little endian");
    }
    const cv::Mat depth(static_cast<int>(message->height), static_cast<int>(message->width), CV_16UC1,
                        const_cast<std::uint8_t*>(message->data.data()), message->step);
    truth->addDepth(static_cast<std::int64_t>(message->header.stamp.toNSec()), depth);
    any = true;
  }
  if (!any) return nullptr;
  return truth;
}

}  // namespace

BagTruth readTruth(const rosbag::Bag& bag) {
  checkDefinition<geometry_msgs::PoseStamped>(bag, sequence_bag::kPoseTopic);
  checkDefinition<sensor_msgs::CameraInfo>(bag, sequence_bag::kCameraInfoTopic);
  checkDefinition<sensor_msgs::Image>(bag, sequence_bag::kDepthTopic);
  checkDefinition<std_msgs::String>(bag, kSceneTopic);
  PoseTrack poses = readPoses(bag);
  auto camera = readCamera(bag);
  if (poses.empty() || camera == nullptr) return {nullptr, "none"};
  rosbag::View scene_view(bag, rosbag::TopicQuery(kSceneTopic));
  for (const rosbag::MessageInstance& instance : scene_view) {
    const auto message = instance.instantiate<std_msgs::String>();
    if (!message) continue;
    return {std::make_unique<SceneTruth>(SceneGeometry::fromText(message->data), poses, camera), "scene",
            camera, poses};
  }
  auto truth = depthTruth(bag, poses, camera);
  const char* const kind = truth == nullptr ? "poses" : "depth";
  return {std::move(truth), kind, camera, std::move(poses)};
}

}  // namespace tet_line_tracker
