#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "paloc/tools/ros_messages.h"

namespace paloc {

/// Whether this program can read and write ROS bags: whether it was built with librosbag-storage.
bool builtWithRosbag();

struct RosbagTopic {
  std::string name, type, md5;
  std::uint64_t messages = 0;
};

/// One message; its bytes are a view that is good until the next is read.
struct RosbagMessage {
  std::string topic, type, md5;
  RosBytes bytes;
  std::size_t place = 0;  ///< to read it again
};

/// Reads one or several ROS 1 bags (format 2.0, also compressed) as one, in the order in which the
/// messages were received.
class RosbagReader {
 public:
  /// Throws IoError (one sentence with the file) if a bag is not there, is none, or has no index.
  explicit RosbagReader(const std::vector<std::filesystem::path>& files);
  ~RosbagReader();
  RosbagReader(const RosbagReader&) = delete;
  RosbagReader& operator=(const RosbagReader&) = delete;

  const std::vector<RosbagTopic>& topics() const;  ///< of all bags, by name and type

  /// Gives all messages of these topics, with the share that is done (0..1). A message that cannot
  /// be read is given to `damaged` as a sentence, and passed over.
  void read(const std::vector<std::string>& topics,
            const std::function<void(const RosbagMessage&, double)>& message,
            const std::function<void(const std::string&)>& damaged);

  /// A message that the last read() gave, again. Throws IoError.
  RosBytes again(std::size_t place);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace paloc
