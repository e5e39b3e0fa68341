#include "dataset_folder.h"

#include <algorithm>

#include <opencv2/imgcodecs.hpp>

namespace tet_line_tracker {

void DatasetFolder::SetUp() {
  std::filesystem::create_directories(root());
  std::filesystem::create_directories(folder_.path() / "out");
}

ToolRun DatasetFolder::convert(const std::string& format, std::vector<std::string> options) {
  std::vector<std::string> arguments{format, root().string(), bag()};
  arguments.insert(arguments.end(), options.begin(), options.end());
  return runTool("dataset_to_bag", arguments);
}

void DatasetFolder::expectFailure(const std::string& format, const std::string& sentence,
                                  std::vector<std::string> options) {
  const ToolRun run = convert(format, std::move(options));
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.errors.find(sentence), std::string::npos) << "stderr: " << run.errors;
  EXPECT_EQ(std::count(run.errors.begin(), run.errors.end(), '\n'), 1) << "stderr: " << run.errors;
  EXPECT_EQ(run.errors.rfind("dataset_to_bag: ", 0), 0U) << "stderr: " << run.errors;
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path() / "out"));
}

void DatasetFolder::writeImage(const std::string& name, int mark, int type, const cv::Size& size) {
  const std::filesystem::path file = root() / name;
  std::filesystem::create_directories(file.parent_path());
  cv::Mat image(size, type);
  cv::randu(image, 0, 256);
  image.row(0).col(0).setTo(cv::Scalar::all(mark));
  ASSERT_TRUE(cv::imwrite(file.string(), image)) << file;
}

void DatasetFolder::cutOff(const std::string& name) {
  const std::filesystem::path file = root() / name;
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
}

}  // namespace tet_line_tracker
