#include "image_files.h"

namespace tet_line_tracker {

Dataset openImages(const std::filesystem::path& path, const DatasetOptions& options) {
  const double rate_hz = options.rate_hz.value_or(kDefaultImageRateHz);
  std::vector<StampedFile> files;
  for (const std::filesystem::path& image : listImages(path)) {
    files.push_back({ros::Time(kFirstStampS + static_cast<double>(files.size()) / rate_hz), image});
  }
  Dataset dataset;
  dataset.camera = options.camera;
  dataset.images = std::make_unique<ImageFileSequence>(path.string(), std::move(files));
  return dataset;
}

}  // namespace tet_line_tracker
