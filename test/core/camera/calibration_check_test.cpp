#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tet_line_tracker/camera/camera_model.h"

namespace tet_line_tracker {
namespace {

CameraCalibration calibrationOf(const char* model, int width, int height, std::vector<double> fx_fy_cx_cy,
                                std::vector<double> distortion) {
  CameraCalibration c;
  c.model = model;
  c.width = width;
  c.height = height;
  c.fx = fx_fy_cx_cy[0];
  c.fy = fx_fy_cx_cy[1];
  c.cx = fx_fy_cx_cy[2];
  c.cy = fx_fy_cx_cy[3];
  c.distortion = std::move(distortion);
  return c;
}

const std::vector<double> kEurocIntrinsics{458.654, 457.296, 367.215, 248.375};
const std::vector<double> kEurocDistortion{-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05};

CameraCalibration euroc() {
  return calibrationOf("plumb_bob", 752, 480, kEurocIntrinsics, kEurocDistortion);
}

/// A lens of `degrees` from side to side in a circle of `diameter` in an image of 1920x1080.
CameraCalibration fisheye(double degrees, double diameter) {
  const double focal = 0.5 * diameter / (0.5 * degrees * M_PI / 180.0);
  return calibrationOf("equidistant", 1920, 1080, {focal, focal, 959.5, 539.5}, {0, 0, 0, 0});
}

std::string sentencesOf(const CameraCalibration& calibration) {
  std::string all;
  for (const std::string& sentence : check(calibration)) all += sentence + "\n";
  return all;
}

TEST(CalibrationCheck, AcceptsRealCameras) {
  const std::vector<std::pair<const char*, CameraCalibration>> cameras = {
      {"EuRoC cam0", euroc()},
      {"TUM freiburg1, pincushion", calibrationOf("plumb_bob", 640, 480, {517.3, 516.5, 318.6, 255.3},
                                                  {0.2624, -0.9531, -0.0054, 0.0026, 1.1633})},
      {"ICL-NUIM, fy < 0", calibrationOf("plumb_bob", 640, 480, {481.2, -480.0, 319.5, 239.5}, {})},
      {"KITTI", calibrationOf("plumb_bob", 1241, 376, {718.856, 718.856, 607.19, 185.22}, {0, 0, 0, 0, 0})},
      {"wide action camera",
       calibrationOf("plumb_bob", 1920, 1080, {860, 862, 965, 533}, {-0.26, 0.11, 0.0003, -0.0002, -0.024})},
      {"Azure Kinect colour",
       calibrationOf("rational_polynomial", 1280, 720, {605.2, 605.0, 637.6, 366.1},
                     {0.513059, -2.77779, -0.000323, 0.000703, 1.62693, 0.391017, -2.593868, 1.548565})},
      {"Azure Kinect depth, wide",
       calibrationOf("rational_polynomial", 1024, 1024, {504.4, 504.5, 516.7, 520.4},
                     {2.679, 1.438, 4.1e-05, -6.9e-05, 0.0671, 3.0105, 2.2155, 0.3709})},
      {"TUM-VI", calibrationOf("equidistant", 512, 512, {190.978, 190.973, 254.93, 256.90},
                               {0.0034823894, 0.00071502487, -0.0020532361, 0.00020293673})},
      {"T265", calibrationOf("equidistant", 848, 800, {285.2, 286.1, 428.1, 394.9},
                             {-0.0068, 0.0475, -0.0456, 0.0085})},
      {"220 degrees in the height of the image", fisheye(220.0, 1080.0)},
      {"KITTI-360 fisheye", calibrationOf("mei", 1400, 1400, {1336.32, 1335.79, 716.94, 705.76},
                                          {2.2134, 0.016798, 1.65488, 4.2224e-04, 4.2462e-04})},
      {"camodocal's sample",
       calibrationOf("mei", 752, 480, {2138.76, 2141.7, 372.5, 242.5}, {3.6313, 6.3, -1.2, 0.01, -0.02})},
      {"telephoto, with the large coefficients of a small field",
       calibrationOf("plumb_bob", 1280, 1024, {25000.0, 25010.0, 640.0, 510.0}, {-2.5, 900.0, 0.001, 0.002})},
      {"crop from the corner of a large sensor",
       calibrationOf("plumb_bob", 320, 240, {2100.0, 2100.0, 2000.0, 1500.0}, {-0.1, 0.05, 0.0, 0.0})},
      {"a size is not said", calibrationOf("plumb_bob", 0, 0, kEurocIntrinsics, kEurocDistortion)},
  };
  for (const auto& [name, calibration] : cameras) {
    EXPECT_EQ(sentencesOf(calibration), "") << name;
    EXPECT_NO_THROW(makeCameraModel(calibration)) << name;
  }
}

TEST(CalibrationCheck, RefusesWhatNoCameraHasAndNamesTheValueAndWhatIsNeeded) {
  const auto with = [](auto change) {
    CameraCalibration c = euroc();
    change(c);
    return c;
  };
  const std::vector<double> typed = kEurocIntrinsics;  // into the field of the distortion
  const std::vector<double> hundreds{100, 100, 100, 100};
  const struct {
    const char* name;
    CameraCalibration calibration;
    std::vector<std::string> needs;
  } cases[] = {
      {"intrinsics as plumb_bob",
       with([&](auto& c) { c.distortion = typed; }),
       {"[458.654, 457.296", "needs"}},
      {"intrinsics as equidistant",
       with([&](auto& c) { c.model = "equidistant", c.distortion = typed; }),
       {"equidistant with coefficients [458.654", "needs"}},
      {"intrinsics as rational_polynomial",
       with([&](auto& c) {
         c.model = "rational_polynomial";
         c.distortion = typed;
         c.distortion.resize(8, 0.0);
       }),
       {"[458.654, 457.296", "needs"}},
      {"intrinsics twice as rational_polynomial",
       with([&](auto& c) {
         c.model = "rational_polynomial";
         c.distortion = typed;
         c.distortion.insert(c.distortion.end(), typed.begin(), typed.end());
       }),
       {"[458.654, 457.296", "needs"}},
      {"intrinsics as mei",
       with([&](auto& c) {
         c.model = "mei";
         c.distortion = typed;
         c.distortion.push_back(0.0);
       }),
       {"fx / (1 + xi) is 0.99", "needs"}},
      {"intrinsics after xi of mei",
       with([&](auto& c) {
         c.model = "mei";
         c.distortion = typed;
         c.distortion.insert(c.distortion.begin(), 1.0);
       }),
       {"[1, 458.654", "needs"}},
      {"hundreds as plumb_bob", with([&](auto& c) { c.distortion = hundreds; }), {"[100, 100", "needs"}},
      {"hundreds as plumb_bob, no size",
       with([&](auto& c) { c.distortion = hundreds, c.width = c.height = 0; }),
       {"[100, 100", "needs"}},
      {"hundreds as equidistant",
       with([&](auto& c) { c.model = "equidistant", c.distortion = hundreds; }),
       {"[100, 100", "needs"}},
      {"minus hundreds",
       with([&](auto& c) {
         c.distortion = {-100, -100, 0, 0};
       }),
       {"can undistort 0 % of the image", "needs 5 %"}},
      {"1e30 as equidistant",
       with([&](auto& c) {
         c.model = "equidistant", c.distortion = {1e30, 1e30, 1e30, 1e30};
       }),
       {"1e+30", "needs"}},
      {"tangential alone",
       with([&](auto& c) {
         c.distortion = {0, 0, 8, -8};
       }),
       {"[0, 0, 8, -8]", "needs"}},
      {"fx of 1e7", with([](auto& c) { c.fx = 1e7; }), {"fx is 1e+07 px in an image of 752x480 px", "37600"}},
      {"both of 1e6", with([](auto& c) { c.fx = c.fy = 1e6; }), {"fx is 1e+06", "fy is 1e+06"}},
      {"both of 1e7, no size",
       with([](auto& c) { c.fx = c.fy = 1e7, c.width = c.height = 0, c.cx = c.cy = 0; }),
       {"fx is 1e+07"}},
      {"negative fx", with([](auto& c) { c.fx = -458.654; }), {"fx is -458.654 px, needs a positive number"}},
      {"fx of 0", with([](auto& c) { c.fx = 0; }), {"fx is 0", "differ from 0"}},
      {"K = identity", with([](auto& c) { c.fx = c.fy = 1, c.cx = c.cy = 0; }), {"fx is 1 px", "needs 37.6"}},
      {"K = identity, no size",
       with([](auto& c) { c.fx = c.fy = 1, c.cx = c.cy = 0, c.width = c.height = 0; }),
       {"fx is 1 px", "needs 5"}},
      {"K in image widths",
       with([](auto& c) { c.fx = 0.61, c.fy = 0.95, c.cx = c.cy = 0.5; }),
       {"fx is 0.61 px"}},
      {"fy of another camera", with([](auto& c) { c.fy = 50; }), {"fy is 50", "5 times"}},
      {"cx of 1e9", with([](auto& c) { c.cx = 1e9; }), {"cx is 1e+09 px", "needs -15040 to 15040"}},
      {"cy of -1e9, no size",
       with([](auto& c) { c.cy = -1e9, c.width = c.height = 0; }),
       {"cy is -1e+09 px"}},
      {"width of -1", with([](auto& c) { c.width = -1; }), {"width is -1 px"}},
      {"height of 2^31 - 1", with([](auto& c) { c.height = 2147483647; }), {"height is 2147483647 px"}},
      {"xi below 0",
       with([](auto& c) {
         c.model = "mei", c.distortion = {-1, 0, 0, 0, 0};
       }),
       {"xi of mei is -1"}},
      {"cx is NaN", with([](auto& c) { c.cx = NAN; }), {"cx is nan, needs a finite number"}},
  };
  for (const auto& wrong : cases) {
    const std::string sentences = sentencesOf(wrong.calibration);
    for (const std::string& needed : wrong.needs) {
      EXPECT_NE(sentences.find(needed), std::string::npos)
          << wrong.name << ": " << needed << " / " << sentences;
    }
    EXPECT_THROW(makeCameraModel(wrong.calibration), std::invalid_argument) << wrong.name;
  }
}

TEST(CalibrationCheck, ListsEveryBrokenRule) {
  CameraCalibration c = euroc();
  c.fx = 1e7;
  c.cx = 1e9;
  c.distortion.resize(3);
  const std::string sentences = sentencesOf(c);
  for (const char* part : {"fx is 1e+07", "cx is 1e+09", "plumb_bob has 3"}) {
    EXPECT_NE(sentences.find(part), std::string::npos) << part << " / " << sentences;
  }
}

}  // namespace
}  // namespace tet_line_tracker
