#include "bag_reader.h"

#include <rosbag/query.h>
#include <rosbag/view.h>

#include <filesystem>
#include <sstream>
#include <stdexcept>

namespace tet_line_tracker {

void openForReading(rosbag::Bag& bag, const std::string& path) {
  std::error_code error;
  // A fifo would wait for a writer.
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)) {
    throw std::runtime_error("cannot read " + path + ": it is no regular file");
  }
  try {
    bag.open(path, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw std::runtime_error("cannot read " + path +
                             ": it has no index, as its recording was cut off; run `rosbag "
                             "reindex " +
                             path + "` first");
  } catch (const std::exception& exception) {
    throw std::runtime_error("cannot read " + path + ": " + exception.what());
  }
}

void checkDefinition(const rosbag::Bag& bag, const std::string& topic, const std::string& type,
                     const std::string& md5) {
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    if (connection->datatype != type || connection->md5sum == md5) continue;
    std::ostringstream sentence;
    sentence << "cannot read " << topic << " of " << bag.getFileName() << ": its " << type
             << " is of another definition (md5 " << connection->md5sum << ") than the one known here ("
             << md5 << "); `rosbag check` and `rosbag fix` migrate old recordings";
    throw std::runtime_error(sentence.str());
  }
}

}  // namespace tet_line_tracker
