#include "paloc/tools/rosbag_reader.h"

#include <console_bridge/console.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <map>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"

namespace paloc {
namespace {

namespace fs = std::filesystem;

std::unique_ptr<rosbag::Bag> openBag(const fs::path& file) {
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) {
    throw IoError(text(file.string(), fs::is_directory(file, ignored)
                                          ? ": is a folder (of a ROS 2 bag?), not a ROS 1 bag"
                                          : ": there is no such file"));
  }
  try {
    return std::make_unique<rosbag::Bag>(file.string(), rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw IoError(text(file.string(),
                       ": has no index, its recording was cut off; `rosbag reindex` mends it"));
  } catch (const std::exception& e) {
    throw IoError(text(file.string(), ": is not a whole ROS 1 bag (", e.what(), ")"));
  }
}

}  // namespace

struct RosbagReader::Impl {
  std::vector<std::unique_ptr<rosbag::Bag>> bags;
  std::vector<RosbagTopic> topics;
  std::unique_ptr<rosbag::View> view;
  std::vector<rosbag::View::iterator> places;
  std::vector<std::uint8_t> bytes;

  RosBytes load(const rosbag::MessageInstance& message) {
    bytes.resize(message.size());
    ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    message.write(stream);
    return bytes;
  }
};

bool builtWithRosbag() { return true; }

RosbagReader::RosbagReader(const std::vector<fs::path>& files) : impl_(std::make_unique<Impl>()) {
  console_bridge::noOutputHandler();  // what goes wrong is told by us
  std::map<std::pair<std::string, std::string>, RosbagTopic> topics;
  for (const fs::path& file : files) {
    impl_->bags.push_back(openBag(file));
    try {
      rosbag::View all(*impl_->bags.back());
      for (const rosbag::ConnectionInfo* c : all.getConnections()) {
        const std::uint32_t id = c->id;
        const auto this_one = [id](const rosbag::ConnectionInfo* other) { return other->id == id; };
        rosbag::View one(*impl_->bags.back(), this_one);
        RosbagTopic& topic = topics[{c->topic, c->datatype}];
        topic = {c->topic, c->datatype, c->md5sum, topic.messages + one.size()};
      }
    } catch (const std::exception& e) {
      throw IoError(text(file.string(), ": its index cannot be read (", e.what(), ")"));
    }
  }
  for (auto& [name, topic] : topics) impl_->topics.push_back(std::move(topic));
}

RosbagReader::~RosbagReader() = default;

const std::vector<RosbagTopic>& RosbagReader::topics() const { return impl_->topics; }

void RosbagReader::read(const std::vector<std::string>& topics,
                        const std::function<void(const RosbagMessage&, double)>& message,
                        const std::function<void(const std::string&)>& damaged) {
  impl_->places.clear();
  impl_->view = std::make_unique<rosbag::View>();
  for (const auto& bag : impl_->bags) impl_->view->addQuery(*bag, rosbag::TopicQuery(topics));
  const double count = impl_->view->size();
  const auto end = impl_->view->end();
  for (auto i = impl_->view->begin(); i != end; ++i) {
    RosbagMessage read;
    try {
      read = {i->getTopic(), i->getDataType(), i->getMD5Sum(), impl_->load(*i),
              impl_->places.size()};
    } catch (const std::exception& e) {  // the index is whole: others may be
      damaged(e.what());
      continue;
    }
    impl_->places.push_back(i);
    message(read, static_cast<double>(impl_->places.size()) / count);
  }
}

RosBytes RosbagReader::again(std::size_t place) {
  try {
    return impl_->load(*impl_->places.at(place));
  } catch (const std::exception& e) {
    throw IoError(text("a message that was read cannot be read again (", e.what(), ")"));
  }
}

}  // namespace paloc
