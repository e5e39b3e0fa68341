#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tool_run.h"

namespace tet_line_tracker {

/// A small dataset that a test writes, and the bag that dataset_to_bag makes of it.
class DatasetFolder : public ::testing::Test {
 protected:
  std::filesystem::path root() const { return folder_.path() / "dataset"; }
  std::string bag() const { return (folder_.path() / "out" / "sequence.bag").string(); }

  void SetUp() override;

  /// Runs dataset_to_bag on root().
  ToolRun convert(const std::string& format, std::vector<std::string> options = {});
  /// The same, and expects one sentence on stderr that holds `sentence`, a failure, and no file left behind.
  void expectFailure(const std::string& format, const std::string& sentence,
                     std::vector<std::string> options = {});

  /// Writes an image whose top left pixel has the value `mark`, so that a test can tell it again.
  void writeImage(const std::string& name, int mark, int type = CV_8UC1, const cv::Size& size = {16, 12});
  /// Removes the last bytes of a file.
  void cutOff(const std::string& name);

 private:
  TemporaryFolder folder_;
};

}  // namespace tet_line_tracker
