#include <algorithm>
#include <cmath>
#include <iostream>
#include <stdexcept>

#include <opencv2/core/utils/logger.hpp>

#include "datasets/dataset.h"
#include "datasets/trajectory.h"
#include "output_file.h"
#include "program.h"
#include "sequence_bag.h"
#include "tet_line_tracker/camera/calibration_file.h"

namespace tet_line_tracker {
namespace {

struct Counts {
  std::size_t images{0};
  std::size_t depth{0};
  std::size_t poses{0};
};

/// Fills in the image size that the calibration leaves open; throws std::runtime_error when they differ.
void matchSize(CameraCalibration& camera, const cv::Size& size) {
  if (camera.width == 0 && camera.height == 0) {
    camera.width = size.width;
    camera.height = size.height;
  }
  if (camera.width != size.width || camera.height != size.height) {
    throw std::runtime_error("the calibration is for " + std::to_string(camera.width) + "x" +
                             std::to_string(camera.height) + " pixels, the images have " +
                             std::to_string(size.width) + "x" + std::to_string(size.height));
  }
  makeCameraModel(camera);  // throws when it is not plausible
}

/// Writes the streams of a dataset in the order of their stamps; of the images the first and every `every`-th
/// after it.
Counts writeDataset(Dataset& dataset, const std::string& out, int every) {
  std::optional<StampedImage> image = dataset.images->next();
  if (!image) throw std::runtime_error("the dataset holds no images");
  if (image->stamp.isZero())
    throw std::runtime_error("the first image has stamp 0, which ROS takes as not set");
  std::optional<StampedImage> depth = dataset.depth ? dataset.depth->next() : std::nullopt;
  if (dataset.camera) matchSize(*dataset.camera, image->image.size());

  ros::Time first_stamp = image->stamp;
  if (depth) first_stamp = std::min(first_stamp, depth->stamp);
  if (!dataset.imu.empty()) first_stamp = std::min(first_stamp, dataset.imu.front().stamp);

  SequenceBag bag(out, dataset.camera, dataset.camera_from_imu, first_stamp);
  ProgressBar progress(dataset.images->size() + (dataset.depth ? dataset.depth->size() : 0U));
  Counts counts;
  auto imu = dataset.imu.cbegin();
  const auto writeUntil = [&](const ros::Time& stamp) {
    for (; imu != dataset.imu.cend() && imu->stamp <= stamp; ++imu) {
      bag.writeImu(imu->stamp, imu->angular_velocity, imu->acceleration);
    }
    for (; depth && depth->stamp <= stamp; depth = dataset.depth->next()) {
      throwIfInterrupted();
      bag.writeDepth(depth->stamp, depth->image);
      ++counts.depth;
      progress.advance();
    }
  };
  for (int number = 0; image; image = dataset.images->next(), ++number) {
    throwIfInterrupted();
    progress.advance();
    if (number % every != 0) continue;
    writeUntil(image->stamp);
    bag.writeImage(image->stamp, image->image);
    ++counts.images;
    if (const auto pose = interpolate(dataset.ground_truth, image->stamp)) {
      bag.writePose(image->stamp, *pose);
      ++counts.poses;
    }
  }
  writeUntil(ros::TIME_MAX);
  throwIfInterrupted();
  bag.close();
  return counts;
}

int run(int argc, char** argv) {
  namespace po = boost::program_options;
  std::string known;
  for (const std::string& format : datasetFormats()) known += (known.empty() ? "" : "|") + format;

  po::options_description options;
  options.add_options()("format", po::value<std::string>()->required())(
      "path", po::value<std::string>()->required())("out", po::value<std::string>()->required())(
      "rate", po::value<double>()->value_name("HZ"),
      "images per second where the format has no stamps (images: 20, icl_nuim: 30, video: its own)")(
      "every", po::value<int>()->value_name("N")->default_value(1),
      "take the first image and every N-th after it, 1 or more")(
      "camera-info", po::value<std::string>()->value_name("FILE"),
      "camera_info YAML file; replaces the calibration of the dataset");
  po::positional_options_description positional;
  positional.add("format", 1).add("path", 1).add("out", 1);
  po::variables_map values;
  if (!parseCommandLine(
          argc, argv,
          "dataset_to_bag " + known +
              " PATH OUT.bag [--rate HZ] [--every N] [--camera-info FILE]\n\n"
              "Turns a recorded sequence into a bag with /cam0/image_raw, /cam0/camera_info and, "
              "where there are\nsome, /depth/image_raw (16UC1 [mm]), /imu0, /ground_truth/pose "
              "(camera in world, at image stamps),\n/tf and /tf_static. Formats that count time "
              "from 0 start at stamp 1 s.",
          options, positional, values)) {
    return 0;
  }

  const std::string path = values["path"].as<std::string>();
  const std::string out = values["out"].as<std::string>();
  checkOutput(out, {path, values.count("camera-info") != 0 ? values["camera-info"].as<std::string>() : ""});
  checkOutputBesideFolder(out, path);
  DatasetOptions dataset_options;
  if (values.count("rate") != 0) {
    const double rate_hz = values["rate"].as<double>();
    if (!(rate_hz > 0.0 && rate_hz <= 10000.0)) {
      throw std::runtime_error("--rate is " + std::to_string(rate_hz) +
                               ", needs more than 0 and up to 10000");
    }
    dataset_options.rate_hz = rate_hz;
  }
  const int every = values["every"].as<int>();
  if (every < 1) throw std::runtime_error("--every is " + std::to_string(every) + ", needs 1 or more");
  if (values.count("camera-info") != 0) {
    dataset_options.camera = readCalibrationFile(values["camera-info"].as<std::string>()).camera;
  }

  // Faults are reported by this program, in one sentence.
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  Dataset dataset = openDataset(values["format"].as<std::string>(), path, dataset_options);
  const Counts counts = writeDataset(dataset, out, every);
  std::cout << out << ": " << counts.images << " images, " << counts.depth << " depth images, "
            << dataset.imu.size() << " IMU samples, " << counts.poses << " poses"
            << (dataset.camera ? "" : ", no calibration") << "\n";
  return 0;
}

}  // namespace
}  // namespace tet_line_tracker

int main(int argc, char** argv) {
  return tet_line_tracker::runProgram("dataset_to_bag", [&] { return tet_line_tracker::run(argc, argv); });
}
