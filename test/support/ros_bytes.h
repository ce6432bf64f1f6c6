#pragma once

#include <cstdint>
#include <string>
#include <vector>

/// ROS messages in their serialized form, built value by value.
namespace paloc::test {

class RosBuilder {
 public:
  template <typename T>
  RosBuilder& put(T value) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
    bytes_.insert(bytes_.end(), bytes, bytes + sizeof(T));
    return *this;
  }
  RosBuilder& string(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size()));
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    return *this;
  }
  RosBuilder& header(std::uint32_t s, std::uint32_t ns, const std::string& frame) {
    return put(std::uint32_t{7}).put(s).put(ns).string(frame);
  }
  RosBuilder& field(const std::string& name, std::uint32_t offset, std::uint8_t datatype) {
    return string(name).put(offset).put(datatype).put(std::uint32_t{1});
  }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace paloc::test
