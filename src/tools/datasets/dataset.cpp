#include "dataset.h"

#include <map>
#include <stdexcept>

namespace tet_line_tracker {
namespace {

using Opener = Dataset (*)(const std::filesystem::path&, const DatasetOptions&);

struct Format {
  Opener open;
  bool takes_rate;
};

const std::map<std::string, Format>& formats() {
  static const std::map<std::string, Format> known{
      {"euroc", {openEuroc, false}}, {"icl_nuim", {openIclNuim, true}}, {"images", {openImages, true}},
      {"kitti", {openKitti, false}}, {"tum", {openTum, false}},         {"video", {openVideo, true}}};
  return known;
}

}  // namespace

const std::vector<std::string>& datasetFormats() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> result;
    for (const auto& [name, format] : formats()) result.push_back(name);
    return result;
  }();
  return names;
}

Dataset openDataset(const std::string& format, const std::filesystem::path& path,
                    const DatasetOptions& options) {
  const auto found = formats().find(format);
  if (found == formats().end()) {
    std::string known;
    for (const std::string& name : datasetFormats()) known += (known.empty() ? "" : ", ") + name;
    throw std::runtime_error("format \"" + format + "\" is not known; known: " + known);
  }
  if (options.rate_hz && !found->second.takes_rate) {
    throw std::runtime_error("--rate was given, but " + format + " has stamps of its own");
  }
  if (!std::filesystem::exists(path)) throw std::runtime_error(path.string() + " does not exist");
  return found->second.open(path, options);
}

}  // namespace tet_line_tracker
