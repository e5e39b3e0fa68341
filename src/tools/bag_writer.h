#pragma once

#include <cerrno>
#include <exception>
#include <memory>
#include <string>

#include <ros/time.h>
#include <rosbag/bag.h>
#include <rosbag/message_instance.h>
#include <boost/make_shared.hpp>

#include "output_file.h"

namespace tet_line_tracker {

/// Writes a bag under a temporary name beside its final one and moves it there in close(). Destroyed before
/// close() it leaves nothing behind, so a failed program never leaves half a bag.
class BagWriter {
 public:
  /// Throws std::runtime_error when the file cannot be created.
  explicit BagWriter(const std::string& path);
  ~BagWriter();
  BagWriter(const BagWriter&) = delete;
  BagWriter& operator=(const BagWriter&) = delete;

  /// Of a `latched` topic, who subscribes while the bag is played is given the last message. Throws
  /// std::runtime_error with the reason when the message cannot be written (disk full).
  template <class Message>
  void write(const std::string& topic, const ros::Time& stamp, const Message& message, bool latched = false) {
    errno = 0;
    try {
      bag_->write(topic, stamp, message, latched ? latchedConnection(message) : nullptr);
    } catch (const std::exception& error) {
      output_.fail(topic + ": " + error.what());
    }
  }

  /// Writes a message of another bag as it is. Throws as write(), and what rosbag throws when the message
  /// cannot be read.
  void copy(const rosbag::MessageInstance& message);

  /// Finishes the bag and gives it its final name. Throws std::runtime_error when that fails.
  void close();

 private:
  /// rosbag takes a header as it is given, so that it has to hold all that players ask for.
  template <class Message>
  static boost::shared_ptr<ros::M_string> latchedConnection(const Message& message) {
    namespace traits = ros::message_traits;
    return boost::make_shared<ros::M_string>(
        ros::M_string{{"latching", "1"},
                      {"type", traits::datatype(message)},
                      {"md5sum", traits::md5sum(message)},
                      {"message_definition", traits::definition(message)}});
  }

  TemporaryOutput output_;
  std::unique_ptr<rosbag::Bag> bag_;
};

}  // namespace tet_line_tracker
