// The importers on extracts of the public datasets: counts, and whether intrinsics, poses and depth fit
// together.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <cv_bridge/cv_bridge.h>
#include <geometry_msgs/PoseStamped.h>
#include <gtest/gtest.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <tf2_msgs/TFMessage.h>
#include <opencv2/imgproc.hpp>

#include "../../src/ros/camera_info.h"
#include "bag_content.h"
#include "tet_line_tracker/camera/calibration_file.h"
#include "tet_line_tracker/camera/camera_model.h"
#include "tool_run.h"

namespace tet_line_tracker {
namespace {

/// The calibration of a bag is that of a file in config/.
void expectCalibration(const sensor_msgs::CameraInfo& info, const std::string& file_name) {
  const CameraCalibration file =
      readCalibrationFile(std::string(TET_SOURCE_DIRECTORY "/config/") + file_name).camera;
  EXPECT_EQ(static_cast<int>(info.width), file.width);
  EXPECT_EQ(static_cast<int>(info.height), file.height);
  EXPECT_EQ(info.distortion_model, file.model);
  EXPECT_EQ(info.D, file.distortion);
  EXPECT_EQ(info.K[0], file.fx);
  EXPECT_EQ(info.K[4], file.fy);
  EXPECT_EQ(info.K[2], file.cx);
  EXPECT_EQ(info.K[5], file.cy);
}

class Extract : public ::testing::Test {
 protected:
  /// Makes the bag, or skips the test when the extract is not there.
  void convert(const std::string& format, const std::string& folder) {
    const std::filesystem::path path = sharedData() / folder;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
    const ToolRun run = runTool("dataset_to_bag", {format, path.string(), bag()});
    ASSERT_EQ(run.status, 0) << run.errors;
  }

  std::string bag() const { return (folder_.path() / "extract.bag").string(); }

  template <class Message>
  std::vector<Recorded<Message>> read(const std::string& topic) const {
    return readTopic<Message>(bag(), topic);
  }

 private:
  TemporaryFolder folder_;
};

/// The recorded message nearest to a stamp. Precondition: not empty.
template <class Message>
const Message& nearest(const std::vector<Recorded<Message>>& messages, const ros::Time& stamp) {
  const Recorded<Message>* best = &messages.front();
  for (const auto& candidate : messages) {
    if (std::abs((candidate.bag_time - stamp).toSec()) < std::abs((best->bag_time - stamp).toSec())) {
      best = &candidate;
    }
  }
  return best->message;
}

/// One RGB-D image with its pose.
struct View {
  cv::Mat gray;
  cv::Mat depth_mm;
  Eigen::Isometry3d world_from_camera;
};

View viewAt(const std::vector<Recorded<sensor_msgs::Image>>& images,
            const std::vector<Recorded<sensor_msgs::Image>>& depth,
            const std::vector<Recorded<geometry_msgs::PoseStamped>>& poses, std::size_t i) {
  View view;
  // Smoothed: poses and depth of a real camera are good to a few pixels only.
  cv::GaussianBlur(cv_bridge::toCvCopy(images.at(i).message, "mono8")->image, view.gray, {}, 2.0);
  view.depth_mm = cv_bridge::toCvCopy(nearest(depth, images.at(i).bag_time))->image;
  view.world_from_camera = toPose(nearest(poses, images.at(i).bag_time).pose);
  return view;
}

/// Mean absolute gray difference between pixels of one view and where the geometry says they are in another;
/// over pixels on edges, since plain surfaces look right anywhere.
double reprojectionError(const View& from, const View& to, const CameraModel& camera,
                         const Eigen::Isometry3d& to_from_from) {
  constexpr int kMinGradient = 6;  // gray values over two pixels
  double sum = 0.0;
  int count = 0;
  for (int y = 8; y < from.gray.rows - 8; y += 2) {
    for (int x = 8; x < from.gray.cols - 8; x += 2) {
      const int gradient = std::abs(from.gray.at<uchar>(y, x + 1) - from.gray.at<uchar>(y, x - 1)) +
                           std::abs(from.gray.at<uchar>(y + 1, x) - from.gray.at<uchar>(y - 1, x));
      const double depth_m = from.depth_mm.at<ushort>(y, x) / 1000.0;
      const auto ray = camera.normalize({x, y});
      if (gradient < kMinGradient || depth_m == 0.0 || !ray) continue;
      const auto pixel = camera.project(to_from_from * (depth_m * ray->homogeneous()));
      if (!pixel || pixel->x() < 1 || pixel->y() < 1 || pixel->x() > to.gray.cols - 2 ||
          pixel->y() > to.gray.rows - 2) {
        continue;
      }
      cv::Mat sample;
      cv::getRectSubPix(to.gray, {1, 1}, {static_cast<float>(pixel->x()), static_cast<float>(pixel->y())},
                        sample);
      sum += std::abs(sample.at<uchar>(0, 0) - from.gray.at<uchar>(y, x));
      ++count;
    }
  }
  EXPECT_GT(count, 1000) << "too few pixels to judge by";
  return sum / std::max(count, 1);
}

struct ReprojectionErrors {
  double truth{0.0};       ///< with calibration and poses as recorded
  double identity{0.0};    ///< as if the camera stood still
  double inverse{0.0};     ///< poses taken for world to camera
  double flipped_fy{0.0};  ///< the other sign of fy
};

ReprojectionErrors reprojectionErrors(const std::string& bag, std::size_t step) {
  const auto images = readTopic<sensor_msgs::Image>(bag, "/cam0/image_raw");
  const auto depth = readTopic<sensor_msgs::Image>(bag, "/depth/image_raw");
  const auto poses = readTopic<geometry_msgs::PoseStamped>(bag, "/ground_truth/pose");
  const auto infos = readTopic<sensor_msgs::CameraInfo>(bag, "/cam0/camera_info");
  CameraCalibration calibration = fromCameraInfo(infos.at(0).message);
  const auto camera = makeCameraModel(calibration);
  calibration.fy = -calibration.fy;
  const auto flipped = makeCameraModel(calibration);

  ReprojectionErrors mean;
  int pairs = 0;
  for (std::size_t i = 0; i + step < images.size(); i += step, ++pairs) {
    const View from = viewAt(images, depth, poses, i);
    const View to = viewAt(images, depth, poses, i + step);
    const Eigen::Isometry3d motion = to.world_from_camera.inverse() * from.world_from_camera;
    const Eigen::Isometry3d inverse = to.world_from_camera * from.world_from_camera.inverse();
    mean.truth += reprojectionError(from, to, *camera, motion);
    mean.identity += reprojectionError(from, to, *camera, Eigen::Isometry3d::Identity());
    mean.inverse += reprojectionError(from, to, *camera, inverse);
    mean.flipped_fy += reprojectionError(from, to, *flipped, motion);
  }
  for (double* value : {&mean.truth, &mean.identity, &mean.inverse, &mean.flipped_fy})
    *value /= std::max(pairs, 1);
  std::printf(
      "mean gray error on edges: as recorded %.1f, standing still %.1f, inverse poses %.1f, -fy %.1f\n",
      mean.truth, mean.identity, mean.inverse, mean.flipped_fy);
  return mean;
}

TEST_F(Extract, IclNuimPosesDepthAndIntrinsicsFitTogether) {
  convert("icl_nuim", "icl_nuim_of_kt0");
  if (IsSkipped()) return;
  EXPECT_EQ(read<sensor_msgs::Image>("/cam0/image_raw").size(), 50U);
  EXPECT_EQ(read<sensor_msgs::Image>("/depth/image_raw").size(), 50U);
  EXPECT_EQ(read<geometry_msgs::PoseStamped>("/ground_truth/pose").size(), 50U);
  expectCalibration(read<sensor_msgs::CameraInfo>("/cam0/camera_info").at(0).message, "icl_nuim.yaml");
  const ReprojectionErrors errors = reprojectionErrors(bag(), 15);
  EXPECT_LT(errors.truth, 0.5 * errors.identity);
  EXPECT_LT(errors.truth, 0.5 * errors.inverse);
  EXPECT_LT(errors.truth, 0.5 * errors.flipped_fy);
}

TEST_F(Extract, TumPosesDepthAndIntrinsicsFitTogether) {
  convert("tum", "tum_fr3_structure_notexture_far");
  if (IsSkipped()) return;
  EXPECT_EQ(read<sensor_msgs::Image>("/cam0/image_raw").size(), 50U);
  EXPECT_EQ(read<sensor_msgs::Image>("/depth/image_raw").size(), 47U);
  EXPECT_EQ(read<geometry_msgs::PoseStamped>("/ground_truth/pose").size(), 50U);
  expectCalibration(read<sensor_msgs::CameraInfo>("/cam0/camera_info").at(0).message, "tum_freiburg3.yaml");
  const ReprojectionErrors errors = reprojectionErrors(bag(), 15);
  EXPECT_LT(errors.truth, 0.7 * errors.identity);
  EXPECT_LT(errors.truth, 0.7 * errors.inverse);
  EXPECT_LT(errors.truth, 0.7 * errors.flipped_fy);
}

TEST_F(Extract, KittiPosesMoveForward) {
  convert("kitti", "kitti_00");
  if (IsSkipped()) return;
  EXPECT_EQ(read<sensor_msgs::Image>("/cam0/image_raw").size(), 50U);
  expectCalibration(read<sensor_msgs::CameraInfo>("/cam0/camera_info").at(0).message, "kitti_00.yaml");
  const auto poses = read<geometry_msgs::PoseStamped>("/ground_truth/pose");
  ASSERT_EQ(poses.size(), 50U);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Eigen::Isometry3d motion =
        toPose(poses[i - 1].message.pose).inverse() * toPose(poses[i].message.pose);
    const double speed_m_s =
        motion.translation().norm() / (poses[i].bag_time - poses[i - 1].bag_time).toSec();
    EXPECT_GT(motion.translation().normalized().z(), 0.99) << "a car drives along its optical axis, at " << i;
    EXPECT_GT(speed_m_s, 3.0);
    EXPECT_LT(speed_m_s, 20.0);
  }
}

TEST_F(Extract, EurocPosesTurnAsTheGyroSays) {
  convert("euroc", "euroc_v1_01");
  if (IsSkipped()) return;
  EXPECT_EQ(read<sensor_msgs::Image>("/cam0/image_raw").size(), 90U);
  expectCalibration(read<sensor_msgs::CameraInfo>("/cam0/camera_info").at(0).message, "euroc_cam0.yaml");
  const auto imu = read<sensor_msgs::Imu>("/imu0");
  EXPECT_EQ(imu.size(), 1191U);
  const auto poses = read<geometry_msgs::PoseStamped>("/ground_truth/pose");
  ASSERT_EQ(poses.size(), 90U);
  const auto tf = read<tf2_msgs::TFMessage>("/tf_static");
  ASSERT_EQ(tf.size(), 1U);
  const auto& q = tf[0].message.transforms.at(0).transform.rotation;
  const Eigen::Quaterniond imu_from_camera(q.w, q.x, q.y, q.z);

  // Constant to 1e-3 rad/s over the extract, from the ground truth file.
  const Eigen::Vector3d gyro_bias(-0.00220, 0.02156, 0.07636);
  double error = 0.0;
  double error_without_extrinsic = 0.0;
  double turn = 0.0;
  constexpr std::size_t kStep = 10;
  for (std::size_t i = 0; i + kStep < poses.size(); i += kStep) {
    const ros::Time begin = poses[i].message.header.stamp;
    const ros::Time end = poses[i + kStep].message.header.stamp;
    Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();
    for (std::size_t k = 1; k < imu.size(); ++k) {
      if (imu[k - 1].message.header.stamp < begin || imu[k].message.header.stamp > end) continue;
      const auto& w = imu[k].message.angular_velocity;
      const Eigen::Vector3d angle = (Eigen::Vector3d(w.x, w.y, w.z) - gyro_bias) *
                                    (imu[k].message.header.stamp - imu[k - 1].message.header.stamp).toSec();
      turned = turned * Eigen::Quaterniond(Eigen::AngleAxisd(angle.norm(), angle.normalized()));
    }
    const Eigen::Quaterniond camera_turn(
        (toPose(poses[i].message.pose).linear().transpose() * toPose(poses[i + kStep].message.pose).linear())
            .eval());
    turn += camera_turn.angularDistance(Eigen::Quaterniond::Identity());
    error += camera_turn.angularDistance(imu_from_camera.inverse() * turned * imu_from_camera);
    error_without_extrinsic += camera_turn.angularDistance(turned);
  }
  std::printf("turn %.4f rad, against the gyro %.4f rad, without the extrinsic %.4f rad\n", turn, error,
              error_without_extrinsic);
  EXPECT_LT(error, 0.1 * turn);
  EXPECT_GT(error_without_extrinsic, 0.5 * turn);
}

}  // namespace
}  // namespace tet_line_tracker
