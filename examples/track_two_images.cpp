// Tracks lines from one image file to the next, without ROS. To build, with PREFIX a folder of your choice:
//
//   cmake -S src/core -B build/core -DTET_TESTS=OFF && cmake --build build/core
//   cmake --install build/core --prefix PREFIX
//   cmake -S examples/core_only -B build/example -DCMAKE_PREFIX_PATH=PREFIX && cmake --build build/example
//   build/example/track_two_images FIRST.png SECOND.png [CALIBRATION.yaml]
#include <cstdint>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

#include <opencv2/imgcodecs.hpp>

#include "tet_line_tracker/camera/calibration_file.h"
#include "tet_line_tracker/tracking/line_tracker.h"

int main(int argc, char** argv) {
  if (argc != 3 && argc != 4) {
    std::fprintf(stderr, "usage: track_two_images FIRST SECOND [CALIBRATION.yaml]\n");
    return 2;
  }
  try {
    tet_line_tracker::LineTracker tracker(tet_line_tracker::LineTrackerParameters{});
    if (argc == 4) {
      tracker.setCamera(makeCameraModel(tet_line_tracker::readCalibrationFile(argv[3]).camera));
    }
    std::int64_t stamp_ns = 0;
    for (const std::string path : {argv[1], argv[2]}) {
      const cv::Mat gray = cv::imread(path, cv::IMREAD_GRAYSCALE);
      if (gray.empty()) throw std::runtime_error("cannot read the image " + path);
      stamp_ns += 50'000'000;
      const tet_line_tracker::FrameResult result = tracker.process(gray, stamp_ns);
      for (const tet_line_tracker::TrackedLine& line : result.frame->lines) {
        if (line.age < 2) continue;  // detected here, not tracked
        const tet_line_tracker::LineSegment& segment = line.segment;
        std::printf("line %llu: (%.2f, %.2f) to (%.2f, %.2f)\n", static_cast<unsigned long long>(line.id),
                    segment.start.x(), segment.start.y(), segment.end.x(), segment.end.y());
      }
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "track_two_images: %s\n", error.what());
    return 1;
  }
}
