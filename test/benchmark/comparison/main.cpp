// Times of this package beside those of others, on the same images, in one run, on one thread; in Markdown.
#include <cstdio>
#include <exception>
#include <map>
#include <stdexcept>
#include <string>

#include <boost/program_options.hpp>

#include "sections.h"

int main(int argc, char** argv) {
  using tet_line_tracker::Sequence;
  namespace po = boost::program_options;
  std::string folder;
  std::size_t images = 0;
  std::string only;
  po::options_description options("Options");
  options.add_options()("help", "this text")("folder", po::value(&folder),
                                             "PNG images to use; without it a simulated flight")(
      "images", po::value(&images)->default_value(450), "images of each measurement")(
      "only", po::value(&only), "one section: front_ends, flow, detectors or scaling");
  po::positional_options_description positional;
  positional.add("folder", 1);
  try {
    po::variables_map values;
    po::store(po::command_line_parser(argc, argv).options(options).positional(positional).run(), values);
    po::notify(values);
    if (values.count("help") != 0) {
      std::printf("speed_comparison [FOLDER] [options]\n");
      for (const auto& option : options.options()) {
        std::printf("  %-24s %s\n", option->format_name().c_str(), option->description().c_str());
      }
      return 0;
    }
    const std::map<std::string, void (*)(const Sequence&, std::size_t)> sections = {
        {"front_ends", tet_line_tracker::compareFrontEnds},
        {"flow", tet_line_tracker::compareFlow},
        {"detectors", tet_line_tracker::compareDetectors},
        {"scaling", tet_line_tracker::showScaling}};
    if (!only.empty() && sections.count(only) == 0) throw std::runtime_error("there is no section " + only);
    cv::setNumThreads(1);
    const Sequence sequence = folder.empty() ? Sequence::simulated("slow", 90) : Sequence::ofFolder(folder);
    std::printf("%s: %zu images of %dx%d, played forth and back\n", sequence.name().c_str(), sequence.size(),
                sequence.image(0).cols, sequence.image(0).rows);
    for (const char* name : {"front_ends", "flow", "detectors", "scaling"}) {
      if (only.empty() || only == name) sections.at(name)(sequence, images);
      std::fflush(stdout);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "speed_comparison: %s\n", error.what());
    return 1;
  }
  return 0;
}
