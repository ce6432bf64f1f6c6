#include <array>
#include <cstring>
#include <vector>

#include "input_file.h"
#include "output_file.h"
#include "paloc/core/text.h"
#include "paloc/map/map_changes.h"
#include "text_rows.h"

// The PLY file of changes: fixed, but for the type of its coordinates.
namespace paloc {
namespace {

struct Colour {
  std::uint8_t red, green, blue;
};

Colour colourOf(MapChange change) {
  switch (change) {
    case MapChange::kGone:
      return {220, 40, 40};
    case MapChange::kAdded:
      return {40, 170, 60};
    case MapChange::kMoved:
      return {50, 90, 230};
    case MapChange::kUnmapped:
      return {150, 150, 150};
  }
  return {0, 0, 0};
}

std::string headerOf(std::size_t points, bool far) {
  std::string lines =
      "ply\nformat binary_little_endian 1.0\ncomment paloc changes, map frame (m)\n";
  for (const MapChange change : kAllMapChanges) {
    lines += text("comment change ", static_cast<int>(change), ' ', toString(change), '\n');
  }
  lines += text("element vertex ", points, '\n');
  for (const char* axis : {"x", "y", "z"}) {
    lines += text("property ", far ? "double " : "float ", axis, '\n');
  }
  for (const char* name : {"change", "red", "green", "blue"}) {
    lines += text("property uchar ", name, '\n');
  }
  return lines + "end_header\n";
}

std::string recordsOf(const MapChanges& changes, bool far) {
  std::string bytes;
  for (std::size_t i = 0; i < changes.kinds.size(); ++i) {
    const Point3f& p = changes.cloud.points[i];
    std::size_t axis = 0;
    for (const float c : {p.x, p.y, p.z}) {
      const double origin = changes.cloud.origin[static_cast<Eigen::Index>(axis++)];
      far ? append(bytes, origin + static_cast<double>(c)) : append(bytes, c);
    }
    const Colour colour = colourOf(changes.kinds[i]);
    append(bytes, static_cast<std::uint8_t>(changes.kinds[i]));
    append(bytes, colour.red);
    append(bytes, colour.green);
    append(bytes, colour.blue);
  }
  return bytes;
}

struct Layout {
  std::size_t points = 0;
  bool far = false;
  std::uint64_t data_at = 0;

  std::size_t recordBytes() const { return 3 * (far ? sizeof(double) : sizeof(float)) + 4; }
};

Layout readHeader(const InputFile& file) {
  Layout layout;
  TextLines lines(file, 0, 1);
  std::string_view line;
  std::string all;
  std::uint64_t points = 0;
  while (all.size() < 2000 && lines.next(line)) {
    const auto w = words(line);
    if (w.size() == 3 && w[0] == "element") parseCount(w[2], points);
    all += text(line, '\n');
    if (line == "end_header") break;
  }
  layout.points = static_cast<std::size_t>(points);
  layout.data_at = lines.offset();
  layout.far = all.find("property double x") != std::string::npos;
  if (all != headerOf(layout.points, layout.far))
    file.fail("is not a file of changes that paloc wrote");
  if ((file.size() - layout.data_at) / layout.recordBytes() != points ||
      (file.size() - layout.data_at) % layout.recordBytes() != 0) {
    file.fail(text("does not hold the ", points, " points that its header promises"));
  }
  return layout;
}

}  // namespace

void saveChanges(const std::filesystem::path& path, const MapChanges& changes) {
  const bool far = !changes.cloud.origin.isZero(0);
  OutputFile file(path);
  file.write(headerOf(changes.kinds.size(), far));
  file.write(recordsOf(changes, far));
  file.close();
}

MapChanges loadChanges(const std::filesystem::path& path) {
  const InputFile file(path);
  const Layout layout = readHeader(file);
  std::vector<char> bytes(layout.points * layout.recordBytes());
  if (!bytes.empty())
    file.readAt(layout.data_at, reinterpret_cast<std::byte*>(bytes.data()), bytes.size());
  MapChanges changes;
  const char* at = bytes.data();
  const auto take = [&at]<typename T>(T& value) {
    std::memcpy(&value, at, sizeof value);
    at += sizeof value;
  };
  for (std::size_t i = 0; i < layout.points; ++i) {
    std::array<double, 3> p{};
    for (double& c : p) {
      if (layout.far) {
        take(c);
      } else {
        float single = 0;
        take(single);
        c = static_cast<double>(single);
      }
    }
    std::array<std::uint8_t, 4> rest{};
    take(rest);
    if (rest[0] < 1 || rest[0] > 4) file.fail(text("point ", i, " has a change that is not known"));
    const Vec3 position(p[0], p[1], p[2]);
    if (i == 0 && layout.far) changes.cloud.origin = position;
    const Eigen::Vector3f local = (position - changes.cloud.origin).cast<float>();
    changes.cloud.points.push_back({local.x(), local.y(), local.z()});
    changes.kinds.push_back(static_cast<MapChange>(rest[0]));
  }
  return changes;
}

}  // namespace paloc
