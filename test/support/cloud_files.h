#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "paloc/core/errors.h"
#include "paloc/map/cloud_io.h"
#include "temp_dir.h"

namespace paloc::test {

/// Appends the bytes of a number.
template <typename T>
void put(std::string& bytes, T value, bool big_endian = false) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (big_endian) std::reverse(raw, raw + sizeof(T));
  bytes.append(raw, sizeof(T));
}

/// Overwrites bytes with those of a number.
template <typename T>
void putAt(std::string& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof(T));
}

/// What loadCloud says of a file that it refuses; empty if it does not refuse.
inline std::string refusal(const std::filesystem::path& file, const LoadOptions& options = {}) {
  try {
    loadCloud(file, options);
  } catch (const IoError& e) {
    return e.what();
  }
  return {};
}

/// Expects that a file of these bytes is refused in one sentence that holds `expected`.
inline void expectRefused(const TempDir& folder, const std::string& name, std::string_view bytes,
                          const std::string& expected) {
  const auto file = folder.write(name, bytes);
  const std::string sentence = refusal(file);
  EXPECT_TRUE(sentence.starts_with(file.string())) << name << ": " << sentence;
  EXPECT_NE(sentence.find(expected), std::string::npos) << name << ": " << sentence;
  EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
}

/// A point of a cloud with its origin added (m).
inline Vec3 pointOf(const PointCloud& cloud, std::size_t i) {
  const Point3f& p = cloud.points[i];
  return cloud.origin + Vec3(p.x, p.y, p.z);
}

}  // namespace paloc::test
