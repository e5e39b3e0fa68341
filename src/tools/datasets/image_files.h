#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dataset.h"

namespace tet_line_tracker {

struct StampedFile {
  ros::Time stamp;
  std::filesystem::path path;
};

/// Order in which people number files: runs of digits compare by their value, so img2 comes before img10.
bool naturalOrder(const std::string& a, const std::string& b);

/// Image files of a folder in natural order of their names; hidden files, other types, and what is
/// no regular file are left out.
/// Throws std::runtime_error when `folder` is no folder or holds no image.
std::vector<std::filesystem::path> listImages(const std::filesystem::path& folder);

/// Decodes an image as it is stored, 8UC1, 8UC3 (BGR) or 16UC1. Throws std::runtime_error that names the
/// file: not there, cut off, damaged, not decodable, or of another type.
cv::Mat readImage(const std::filesystem::path& path);

/// Images in files, all of one size.
class ImageFileSequence : public ImageSequence {
 public:
  /// Throws std::runtime_error when `files` is empty or its stamps do not increase; `name` says which images.
  ImageFileSequence(const std::string& name, std::vector<StampedFile> files);

  std::size_t size() const override { return files_.size(); }
  std::optional<StampedImage> next() override;

 protected:
  /// What becomes of a decoded image before it is handed out.
  virtual cv::Mat convert(const cv::Mat& image, const std::filesystem::path& path) const;

 private:
  std::vector<StampedFile> files_;
  std::size_t next_{0};
  cv::Size size_px_;
};

/// Depth images, 16UC1, converted from units of the dataset to mm.
class DepthFileSequence final : public ImageFileSequence {
 public:
  DepthFileSequence(const std::string& name, std::vector<StampedFile> files, double units_per_m);

 protected:
  cv::Mat convert(const cv::Mat& image, const std::filesystem::path& path) const override;

 private:
  double mm_per_unit_;
};

}  // namespace tet_line_tracker
