#include "tet_line_tracker/parameters/parameters.h"

namespace tet_line_tracker {

ParameterTable tableOf(LineTrackerParameters& p) {
  ParameterTable table;
  table.add("method", p.method, {"joint", "paper"},
            "How lines are followed; `paper`: Algorithm 1 as published");
  table.add("threads", p.threads, 1, 64, "", "Threads that follow lines; the result does not depend on it");
  table.add("pyramid_levels", p.flow.pyramid_levels, 1, 8, "",
            "Images in the pyramid, the original included");
  table.add("window_px", p.flow.window_px, 3, 21, "px", "Side of the square patch around an endpoint").odd =
      true;
  table.add("max_iterations", p.flow.max_iterations, 1, 100, "", "Iterations per pyramid level");
  table.add("max_residual", p.flow.max_residual, 0.001, 1.0, "",
            "Mean absolute gray difference on [0, 1] above which a line is lost");
  table.add("min_step", p.flow.min_step, 0.0, 1.0, "px", "Iterations end below this step");
  table.add("prior", p.motion.prior, {"auto", "none", "imu", "image"},
            "Rotation by which endpoints are expected; `imu`: from the image where IMU samples are missing; "
            "`auto`: also where the images do not agree with the IMU");
  table.add("keep_parallax", p.motion.keep_parallax,
            "Expect the movement that the rotation does not explain to go on as in the image before");
  table.add("joint_endpoints", p.flow.joint_endpoints,
            "Estimate both endpoints together from patches along the line");
  table.add("finest_level", p.flow.finest_level, 0, 3, "",
            "Pyramid level at which the flow ends; the re-fit does the rest");
  table.add("patch_spacing", p.flow.patch_spacing, 3.0, 100.0, "px", "Between patches along the line");
  table.add("max_patches", p.flow.max_patches, 2, 16, "", "Patches per line and pyramid level");
  table.add("gain_and_offset", p.flow.gain_and_offset,
            "Match mean and spread of each patch: for changing light");
  table.add("robust_patches", p.flow.robust_patches, "Less weight to patches that do not match");
  table.add("max_joint_residual", p.plausibility.max_joint_residual, 0.001, 1.0, "",
            "As `max_residual`, for the joint estimate");
  table.add("max_turn", p.plausibility.max_turn, 0.01, 3.0, "rad",
            "A line that turns more than expected is lost");
  table.add("max_stretch", p.plausibility.max_stretch, 1.01, 10.0, "",
            "A line whose length changes by more than this factor is lost");
  table.add("max_edge_offset", p.plausibility.max_edge_offset, 0.1, 10.0, "px",
            "A line is lost whose edge is this much farther than is usual in the image from where the flow "
            "puts it");
  table.add("refine", p.refiner.refine, "Re-fit each line to the edge under it");
  table.add("search_px", p.refiner.search_px, 1.0, 6.0, "px",
            "The edge is looked for this far on both sides");
  table.add("min_support", p.refiner.min_support, 0.0, 1.0, "", "Share of a line that must lie on its edge");
  table.add("detector", p.detection.detector, {"auto", "edge", "lsd", "fld"},
            "Line detector; `auto`: the best one that works with the OpenCV at hand");
  table.add("min_length", p.detection.min_length, 5.0, 1000.0, "px",
            "Shorter lines are neither started nor kept");
  table.add("min_lines", p.detection.min_lines, 0, 1000, "", "The detector runs when fewer lines are left");
  table.add("max_lines", p.detection.max_lines, 1, 1000, "", "Lines tracked at a time");
  table.add("border", p.detection.border, 0.0, 100.0, "px",
            "Margin of the image in which no endpoint may lie");
  table.add("redetect_share", p.detection.redetect_share, 0.0, 1.0, "",
            "The detector runs when less than this share is left of the lines after its last run");
  table.add("detection_interval", p.detection.detection_interval, 1, 1000, "",
            "Images from one run of the detector to the next at least");
  table.add("min_new_support", p.detection.min_new_support, 0.0, 1.0, "",
            "Share of a new line that must lie on an edge");
  table.add("max_gap", p.stream.max_gap, 0.001, 3600.0, "s",
            "A longer gap between two images starts a new epoch");
  return table;
}

LineTrackerParameters asPublished(LineTrackerParameters parameters) {
  parameters.method = "paper";
  parameters.flow.finest_level = 0;
  parameters.flow.joint_endpoints = false;
  parameters.flow.gain_and_offset = false;
  parameters.flow.robust_patches = false;
  parameters.motion.prior = "none";
  parameters.refiner.refine = false;
  return parameters;
}

std::vector<std::string> check(const LineTrackerParameters& parameters) {
  LineTrackerParameters copy = parameters;
  std::vector<std::string> broken = tableOf(copy).check();
  if (parameters.detection.min_lines > parameters.detection.max_lines) {
    broken.push_back("parameter min_lines is " + std::to_string(parameters.detection.min_lines) +
                     ", needs at most max_lines, which is " + std::to_string(parameters.detection.max_lines));
  }
  return broken;
}

}  // namespace tet_line_tracker
