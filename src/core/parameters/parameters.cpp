#include "tet_line_tracker/parameters/parameters.h"

#include <cmath>
#include <cstdlib>

namespace tet_line_tracker {
namespace {

constexpr double kMaxImuTimeOffset = 0.5;  // [s]

// The templates of the tracks depend on these.
constexpr auto kNewEpoch = ParameterTable::Change::kNewEpoch;

ParameterTable tableOf(EndpointTrackerParameters& p) {
  ParameterTable table;
  table.add("pyramid_levels", p.pyramid_levels, 1, 8, "", "Images in the pyramid, the original included")
      .change = kNewEpoch;
  ParameterTable::Entry& window =
      table.add("window_px", p.window_px, 3, 21, "px", "Side of the square patch around an endpoint");
  window.odd = true;
  window.change = kNewEpoch;
  table.add("max_iterations", p.max_iterations, 1, 100, "", "Iterations per pyramid level");
  table.add("max_residual", p.max_residual, 0.001, 1.0, "",
            "`paper`: mean absolute gray difference on [0, 1] above which a line is lost");
  table.add("min_step", p.min_step, 0.0, 1.0, "px", "`paper`: iterations end below this step");
  table
      .add("finest_level", p.finest_level, 0, 3, "",
           "Pyramid level at which the flow ends; the re-fit does the rest")
      .change = kNewEpoch;
  table.add("patch_spacing", p.patch_spacing, 3.0, 100.0, "px", "Distance of the patches along the line")
      .change = kNewEpoch;
  table.add("max_patches", p.max_patches, 2, 16, "", "Patches per line and pyramid level").change = kNewEpoch;
  table.add("gain_and_offset", p.gain_and_offset, "Match mean and spread of each patch: for changing light")
      .change = kNewEpoch;
  table.add("robust_patches", p.robust_patches, "Less weight to patches that do not match");
  table.add("max_joint_residual", p.max_joint_residual, 0.001, 1.0, "",
            "Mean absolute gray difference on [0, 1] above which a line is lost");
  return table;
}

ParameterTable tableOf(MotionPriorParameters& p) {
  ParameterTable table;
  table.add(
      "prior", p.prior, {"auto", "none", "imu", "image", "odometry"},
      "Motion by which endpoints are predicted; `imu`: from the image where IMU samples are missing; "
      "`auto`: also where the images contradict the IMU; `odometry`: from the topic `odometry`, and from "
      "the image where it is missing or corners contradict it");
  table.add(
      "ego_motion", p.ego_motion,
      "Estimate the translation of the camera and the depth of lines, which predict their parallax; needs "
      "a calibration");
  table.add("imu_time_offset", p.imu_time_offset, std::vector<std::string>{},
            "Stamp of the IMU less that of the camera at the same moment [s], -0.5..0.5: Kalibr's "
            "`timeshift_cam_imu`, VINS's `td`; `auto`: estimated from turns, up to 0.1 s");
  table.add("predict_parallax", p.predict_parallax,
            "Predict that the movement which the rotation does not explain goes on as in the last image");
  return table;
}

ParameterTable tableOf(PlausibilityParameters& p) {
  ParameterTable table;
  table.add("max_rotation", p.max_rotation, 0.01, 3.0, "rad",
            "A line is lost whose direction differs by more than this from the predicted one");
  table.add("max_length_ratio", p.max_length_ratio, 1.01, 10.0, "",
            "A line is lost whose length differs by more than this factor from the predicted one");
  table.add("max_edge_offset", p.max_edge_offset, 0.1, 10.0, "px",
            "A line is lost whose edge is this much farther than is usual in the image from where the flow "
            "puts it");
  table.add(
      "check_depth", p.check_depth,
      "A line is lost whose movement would put it behind the camera, or at a depth that jumps, while most "
      "lines agree with `ego_motion`; false keeps the lines of moving objects");
  return table;
}

ParameterTable tableOf(LineRefinerParameters& p) {
  ParameterTable table;
  table.add("refine", p.refine, "Re-fit each line to the edge under it; `false`: the flow ends at level 0")
      .change = kNewEpoch;
  table.add("search_px", p.search_px, 1.0, 6.0, "px", "The edge is searched this far on both sides");
  table.add("min_support", p.min_support, 0.0, 1.0, "", "Share of a line that must lie on its edge");
  return table;
}

ParameterTable tableOf(DetectionParameters& p) {
  ParameterTable table;
  table.add("detector", p.detector, {"auto", "edge", "lsd", "fld"},
            "Line detector; `auto`: `edge`, for method `paper` LSD where OpenCV has it");
  table.add("min_length", p.min_length, 5.0, 1000.0, "px", "Shorter lines are neither started nor kept");
  table.add("min_lines", p.min_lines, 0, 1000, "", "The detector runs when fewer lines are left");
  table.add("max_lines", p.max_lines, 1, 1000, "", "Lines tracked at a time");
  table.add("border", p.border, 0.0, 100.0, "px", "Margin of the image in which no endpoint may lie");
  table.add(
      "redetect_ratio", p.redetect_ratio, 0.0, 1.0, "",
      "The detector runs when the number of lines, or the part of the image that they cover, falls below "
      "this ratio to what it was after its last run");
  table.add("detection_interval", p.detection_interval, 1, 1000, "",
            "Images from one run of the detector to the next at least");
  table.add("min_detection_support", p.min_detection_support, 0.0, 1.0, "",
            "Share of a new line that must lie on an edge; clear edges may have a quarter of the gaps");
  return table;
}

}  // namespace

ParameterTable tableOf(LineTrackerParameters& p) {
  ParameterTable table;
  table
      .add("method", p.method, {"joint", "paper"},
           "How lines are followed; `paper`: Algorithm 1 as published")
      .change = kNewEpoch;
  table.add("threads", p.threads, 1, 64, "", "Threads that follow lines; the result does not depend on it");
  table.append(tableOf(p.flow));
  table.append(tableOf(p.motion));
  table.append(tableOf(p.plausibility));
  table.append(tableOf(p.refiner));
  table.append(tableOf(p.detection));
  table.add("max_gap", p.stream.max_gap, 0.001, 3600.0, "s",
            "A longer gap between two images starts a new epoch");
  table.addRetired("keep_parallax", "is now predict_parallax");
  table.addRetired("max_turn", "is now max_rotation");
  table.addRetired("max_stretch", "is now max_length_ratio");
  table.addRetired("redetect_share", "is now redetect_ratio");
  table.addRetired("min_new_support", "is now min_detection_support");
  table.addRetired("joint_endpoints",
                   "is gone: method paper follows each endpoint alone, method joint both together");
  return table;
}

std::optional<double> givenImuTimeOffset(const MotionPriorParameters& parameters) {
  const std::string& text = parameters.imu_time_offset;
  char* end = nullptr;
  const double seconds = std::strtod(text.c_str(), &end);
  // Written so that NaN fails.
  if (text.empty() || *end != '\0' || !(std::abs(seconds) <= kMaxImuTimeOffset)) return std::nullopt;
  return seconds;
}

std::vector<std::string> check(const EndpointTrackerParameters& parameters) {
  EndpointTrackerParameters copy = parameters;
  return tableOf(copy).check();
}

std::vector<std::string> check(const LineTrackerParameters& parameters) {
  LineTrackerParameters copy = parameters;
  std::vector<std::string> broken = tableOf(copy).check();
  if (parameters.motion.imu_time_offset != "auto" && !givenImuTimeOffset(parameters.motion)) {
    broken.push_back(
        "parameter imu_time_offset is " +
        (parameters.motion.imu_time_offset.empty() ? "empty" : parameters.motion.imu_time_offset) +
        ", needs auto or a number in -0.5..0.5 [s]");
  }
  if (parameters.motion.prior == "odometry" && !parameters.motion.ego_motion) {
    broken.emplace_back("parameter prior is odometry, needs ego_motion to be true");
  }
  if (parameters.detection.min_lines > parameters.detection.max_lines) {
    broken.push_back("parameter min_lines is " + std::to_string(parameters.detection.min_lines) +
                     ", needs at most max_lines, which is " + std::to_string(parameters.detection.max_lines));
  }
  return broken;
}

bool needsNewEpoch(const LineTrackerParameters& before, const LineTrackerParameters& after) {
  LineTrackerParameters old_values = before;
  LineTrackerParameters new_values = after;
  const ParameterTable old_table = tableOf(old_values);
  const ParameterTable new_table = tableOf(new_values);
  for (std::size_t i = 0; i < old_table.entries().size(); ++i) {
    const ParameterTable::Entry& entry = old_table.entries()[i];
    if (entry.change != ParameterTable::Change::kBetweenImages &&
        ParameterTable::value(entry) != ParameterTable::value(new_table.entries()[i])) {
      return true;
    }
  }
  return false;
}

}  // namespace tet_line_tracker
