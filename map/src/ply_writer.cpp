#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"
#include "paloc/map/cloud_io.h"

namespace paloc {
namespace {

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

class Output {
 public:
  explicit Output(const std::filesystem::path& path) : name_(path.string()) {
    file_.reset(std::fopen(path.c_str(), "wb"));
    if (!file_) fail();
  }
  void write(const std::string& bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) fail();
  }
  void close() {
    if (std::fclose(file_.release()) != 0) fail();
  }

 private:
  [[noreturn]] void fail() const {
    throw IoError(name_ + ": cannot be written: " + std::generic_category().message(errno));
  }
  std::string name_;
  std::unique_ptr<std::FILE, FileCloser> file_;
};

template <typename T>
void append(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

std::string header(const PointCloud& cloud, const std::string& comment, bool far) {
  std::string lines = "ply\nformat binary_little_endian 1.0\n";
  for (std::size_t at = 0; at < comment.size();) {
    const std::size_t end = std::min(comment.find('\n', at), comment.size());
    lines += text("comment ", comment.substr(at, end - at), '\n');
    at = end + 1;
  }
  lines += text("element vertex ", cloud.size(), '\n');
  for (const char* axis : {"x", "y", "z"}) {
    lines += text("property ", far ? "double " : "float ", axis, '\n');
  }
  if (!cloud.intensity.empty()) lines += "property float intensity\n";
  return lines + "end_header\n";
}

}  // namespace

void savePly(const std::filesystem::path& path, const PointCloud& cloud,
             const std::string& comment) {
  constexpr std::size_t kBlockBytes = 1 << 20;
  const bool far = !cloud.origin.isZero(0);
  Output file(path);
  std::string bytes = header(cloud, comment, far);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Point3f& p = cloud.points[i];
    if (far) {
      append(bytes, cloud.origin.x() + static_cast<double>(p.x));
      append(bytes, cloud.origin.y() + static_cast<double>(p.y));
      append(bytes, cloud.origin.z() + static_cast<double>(p.z));
    } else {
      append(bytes, p.x);
      append(bytes, p.y);
      append(bytes, p.z);
    }
    if (!cloud.intensity.empty()) append(bytes, cloud.intensity[i]);
    if (bytes.size() >= kBlockBytes) {
      file.write(bytes);
      bytes.clear();
    }
  }
  file.write(bytes);
  file.close();
}

}  // namespace paloc
