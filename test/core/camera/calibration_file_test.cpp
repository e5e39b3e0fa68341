#include "tet_line_tracker/camera/calibration_file.h"

#include <cstdio>
#include <fstream>
#include <stdexcept>

#include <gtest/gtest.h>

namespace tet_line_tracker {
namespace {

class CalibrationFileTest : public ::testing::Test {
 protected:
  ~CalibrationFileTest() override { std::remove(path_.c_str()); }

  CalibrationFile read(const std::string& text, int camera = 0) {
    std::ofstream(path_) << text;
    return readCalibrationFile(path_, camera);
  }

  std::string errorOf(const std::string& text, int camera = 0) {
    try {
      read(text, camera);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }

  std::string path_ = ::testing::TempDir() + "calibration_" +
                      ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".yaml";
};

using Numbers = std::vector<double>;

constexpr char kCameraInfo[] = R"(image_width: 640
image_height: 480
camera_name: head
camera_matrix:
  rows: 3
  cols: 3
  data: [517.3, 0, 318.6, 0, 516.5, 255.3, 0, 0, 1]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [0.2624, -0.9531, -0.0054, 0.0026, 1.1633]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
)";

constexpr char kKalibr[] = R"(cam0:
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [0.0034823894, 0.00071502487, -0.0020532361, 0.00020293673]
  distortion_model: equi
  intrinsics: [190.978, 190.973, 254.93, 256.90]
  resolution: [512, 512]
  rostopic: /cam0/image_raw
  T_cam_imu:
  - [0.0, -1.0, 0.0, 0.1]
  - [1.0, 0.0, 0.0, 0.2]
  - [0.0, 0.0, 1.0, 0.3]
  - [0.0, 0.0, 0.0, 1.0]
  timeshift_cam_imu: 0.001
cam1:
  camera_model: omni
  distortion_coeffs: [0.01, 0.02, 0.03, 0.04]
  distortion_model: radtan
  intrinsics: [1.5, 700.0, 701.0, 320.0, 240.0]
  resolution: [640, 480]
  rostopic: /cam1/image_raw
)";

constexpr char kMei[] = R"(%YAML:1.0
---
model_type: MEI
camera_name: camera
image_width: 752
image_height: 480
mirror_parameters:
   xi: 3.6313355285286337e+00
distortion_parameters:
   k1: 6.3
   k2: -1.2
   p1: 0.01
   p2: -0.02
projection_parameters:
   gamma1: 2.1387619122017772e+03
   gamma2: 2.1417e+03
   u0: 372.5
   v0: 242.5
)";

constexpr char kVinsPinhole[] = R"(%YAML:1.0

#common parameters
imu_topic: "/imu0"
image_topic: "/cam0/image_raw"
output_path: "~/output/"

model_type: PINHOLE
camera_name: camera
image_width: 752
image_height: 480
distortion_parameters:
   k1: -2.917e-01
   k2: 8.228e-02
   p1: 5.333e-05
   p2: -1.578e-04
projection_parameters:
   fx: 4.616e+02
   fy: 4.603e+02
   cx: 3.630e+02
   cy: 2.481e+02

estimate_extrinsic: 0   # 0  Have an accurate extrinsic parameters.
#Rotation from camera frame to imu frame, imu^R_cam
extrinsicRotation: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [0, -1, 0,
          1, 0, 0,
          0, 0, 1]
extrinsicTranslation: !!opencv-matrix
   rows: 3
   cols: 1
   dt: d
   data: [-0.02,-0.06, 0.01]
td: -0.012             # image clock + td = IMU clock
)";

TEST_F(CalibrationFileTest, ReadsWhatCameraCalibrationWrites) {
  const CalibrationFile file = read(kCameraInfo);
  EXPECT_EQ(file.format, "camera_info");
  EXPECT_EQ(file.name, "head");
  EXPECT_EQ(file.camera.model, "plumb_bob");
  EXPECT_EQ(file.camera.width, 640);
  EXPECT_EQ(file.camera.height, 480);
  EXPECT_EQ((Numbers{file.camera.fx, file.camera.fy, file.camera.cx, file.camera.cy}),
            (Numbers{517.3, 516.5, 318.6, 255.3}));
  EXPECT_EQ(file.camera.distortion, (Numbers{0.2624, -0.9531, -0.0054, 0.0026, 1.1633}));
  EXPECT_FALSE(file.camera_from_imu);
}

TEST_F(CalibrationFileTest, ReadsAPrintedCameraInfo) {
  const CalibrationFile file = read(R"(header:
  seq: 1
  frame_id: "cam"
height: 800
width: 848
distortion_model: "equidistant"
D: [-0.0068, 0.0475, -0.0456, 0.0085]
K: [285.2, 0.0, 428.1, 0.0, 286.1, 394.9, 0.0, 0.0, 1.0]
binning_x: 0
---
)");
  EXPECT_EQ(file.camera.model, "equidistant");
  EXPECT_EQ(file.camera.width, 848);
  EXPECT_EQ(file.camera.cy, 394.9);
  EXPECT_EQ(file.camera.distortion.size(), 4U);
}

TEST_F(CalibrationFileTest, ReadsTheChosenCameraOfAKalibrChain) {
  const CalibrationFile first = read(kKalibr);
  EXPECT_EQ(first.format, "kalibr");
  EXPECT_EQ(first.camera.model, "equidistant");
  EXPECT_EQ(first.camera.fx, 190.978);
  EXPECT_EQ(first.camera.distortion, (Numbers{0.0034823894, 0.00071502487, -0.0020532361, 0.00020293673}));
  ASSERT_TRUE(first.camera_from_imu);
  EXPECT_LT((*first.camera_from_imu * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(0.1, 1.2, 0.3)).norm(),
            1e-12);
  EXPECT_EQ(first.imu_time_offset, 0.001);

  const CalibrationFile second = read(kKalibr, 1);
  EXPECT_EQ(second.name, "cam1");
  EXPECT_EQ(second.camera.model, "mei");
  EXPECT_EQ(second.camera.cx, 320.0);
  EXPECT_EQ(second.camera.distortion, (Numbers{1.5, 0.01, 0.02, 0.03, 0.04}));
  EXPECT_FALSE(second.camera_from_imu);
  EXPECT_FALSE(second.imu_time_offset);

  EXPECT_NE(errorOf(kKalibr, 2).find("cam2 is missing"), std::string::npos);
}

TEST_F(CalibrationFileTest, ReadsTheThreeModelsOfCamodocal) {
  const CalibrationFile pinhole = read(kVinsPinhole);
  EXPECT_EQ(pinhole.format, "camodocal");
  EXPECT_EQ(pinhole.camera.model, "plumb_bob");
  EXPECT_EQ(pinhole.camera.cy, 248.1);
  EXPECT_EQ(pinhole.camera.distortion, (Numbers{-0.2917, 0.08228, 5.333e-05, -1.578e-04}));
  ASSERT_TRUE(pinhole.camera_from_imu);
  EXPECT_EQ(pinhole.imu_time_offset, -0.012);
  // The IMU's origin seen from the camera: -R^T t.
  EXPECT_LT((pinhole.camera_from_imu->translation() - Eigen::Vector3d(0.06, -0.02, -0.01)).norm(), 1e-12);

  const CalibrationFile mei = read(kMei);
  EXPECT_EQ(mei.camera.model, "mei");
  EXPECT_EQ(mei.camera.fx, 2138.7619122017772);
  EXPECT_EQ(mei.camera.distortion, (Numbers{3.6313355285286337, 6.3, -1.2, 0.01, -0.02}));

  const CalibrationFile fisheye = read(R"(%YAML:1.0
model_type: KANNALA_BRANDT
camera_name: cam0
image_width: 512
image_height: 512
projection_parameters:
   k2: 0.0034823894
   k3: 0.00071502487
   k4: -0.0020532361
   k5: 0.00020293673
   mu: 190.978
   mv: 190.973
   u0: 254.93
   v0: 256.9
)");
  EXPECT_EQ(fisheye.camera.model, "equidistant");
  EXPECT_EQ(fisheye.camera.fy, 190.973);
  EXPECT_EQ(fisheye.camera.distortion, (Numbers{0.0034823894, 0.00071502487, -0.0020532361, 0.00020293673}));
}

TEST_F(CalibrationFileTest, NamesFileAndFieldOfEveryFault) {
  const auto broken = [](std::string text, const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
  };
  const struct {
    std::string text;
    std::string needs;
  } faults[] = {
      {broken(kMei, "gamma2: 2.1417e+03", "gamma2: .nan"), "projection_parameters.gamma2 is .nan"},
      {broken(kMei, "   xi: 3.6313355285286337e+00", "   chi: 1"), "mirror_parameters.xi is missing"},
      {broken(kMei, "model_type: MEI", "model_type: SCARAMUZZA"), "SCARAMUZZA"},
      {broken(kVinsPinhole, "k2: 8.228e-02", "k2: big"), "distortion_parameters.k2 is not a number"},
      {broken(kVinsPinhole, "0, 0, 1]", "0, 0, 2]"), "extrinsicRotation is not a rotation"},
      {broken(kKalibr, "equi\n", "fov\n"), "cam0.camera_model"},
      {broken(kKalibr, "[190.978, ", "["), "cam0.intrinsics has 3 numbers, needs 4"},
      {broken(kKalibr, "[1.0, 0.0, 0.0, 0.2]", "[1.0, 0.0, 0.0, .inf]"), "cam0.T_cam_imu[1][3] is .inf"},
      {broken(kKalibr, "[512, 512]", "[160.7, 512]"), "cam0.resolution[0] is 160.7"},
      {broken(kKalibr, "[190.978, ", "[0.0, "), "fx is 0"},
      {broken(kCameraInfo, "[517.3, ", "[-517.3, "), "fx is -517.3 px, needs a positive number"},
      {broken(kCameraInfo, "[0.2624, -0.9531, -0.0054, 0.0026", "[517.3, 516.5, 318.6, 255.3"),
       "plumb_bob with coefficients [517.3, "},
      {broken(kCameraInfo, "image_width: 640", "image_width: 0"), "image size is 0 x 480"},
      {broken(kCameraInfo, "517.3", "0"), "fx is 0"},
      {broken(kCameraInfo, "plumb_bob", "thin_prism"), "thin_prism"},
      {broken(kCameraInfo, "camera_matrix:", "camera_matrix: 5\nother:"), "camera_matrix is not a list"},
      {"just a sentence", "holds no YAML map"},
      {"a: 1\n", "none of the known formats"},
      {"a: [1\n", "yaml-cpp"},
  };
  for (const auto& fault : faults) {
    const std::string message = errorOf(fault.text);
    EXPECT_NE(message.find(fault.needs), std::string::npos) << fault.needs << " / " << message;
    EXPECT_EQ(message.find(path_), 0U) << message;
  }
  EXPECT_THROW(readCalibrationFile("/nowhere/to/be/found.yaml"), std::runtime_error);
}

}  // namespace
}  // namespace tet_line_tracker
