#include "octree_map_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>
#include <vector>

#include "paloc/core/text.h"
#include "text_rows.h"

/// Reads OctoMap's files by itself: the library's own reader prints to the console, and follows a
/// damaged file to any depth. Both forms list the nodes depth first. In a .bt a node is two bytes,
/// two bits a child: 0 unknown, 1 free leaf, 2 occupied leaf, 3 a node that follows. In an .ot it
/// is its log-odds (float), a colour where the tree has colours, and a byte that tells which
/// children follow.
namespace paloc {
namespace {

constexpr int kDepth = 16;
constexpr double kFinest_m = 1e-4, kCoarsest_m = 1000;

/// The bytes of a file one after the other.
class ByteReader {
 public:
  ByteReader(const InputFile& file, std::uint64_t offset) : file_(file), offset_(offset) {}

  void read(void* out, std::size_t bytes) {
    if (cursor_ + bytes > block_.size()) refill(bytes);
    std::memcpy(out, block_.data() + cursor_, bytes);
    cursor_ += bytes;
  }
  bool atEnd() const { return offset_ >= file_.size() && cursor_ == block_.size(); }

 private:
  void refill(std::size_t needed) {
    constexpr std::size_t kBlock = 1 << 16;
    block_.erase(block_.begin(), block_.begin() + static_cast<std::ptrdiff_t>(cursor_));
    cursor_ = 0;
    const std::uint64_t left = file_.size() - std::min(file_.size(), offset_);
    const auto more = static_cast<std::size_t>(std::min<std::uint64_t>(left, kBlock));
    if (block_.size() + more < needed) file_.fail("is cut off: nodes of its octree are missing");
    block_.resize(block_.size() + more);
    file_.readAt(offset_, block_.data() + block_.size() - more, more);
    offset_ += more;
  }

  const InputFile& file_;
  std::uint64_t offset_;  // of what is read next
  std::vector<std::byte> block_;
  std::size_t cursor_ = 0;
};

struct OctreeHeader {
  bool binary = false;
  std::string id;
  std::optional<std::uint64_t> nodes;
  double resolution_m = 0;
  std::uint64_t data_at = 0;

  explicit OctreeHeader(const InputFile& file) {
    TextLines lines(file, 0, 1);
    std::string_view line;
    lines.next(line);  // "# Octomap OcTree ...": checked by who chose the format
    binary = line.starts_with("# Octomap OcTree binary file");
    if (!binary && !line.starts_with("# Octomap OcTree file")) {
      file.fail("line 1: is neither that of OctoMap's .bt nor of its .ot");
    }
    while (!readLine(file, lines)) {
    }
    data_at = lines.offset();
    check(file);
  }

 private:
  // True at "data".
  bool readLine(const InputFile& file, TextLines& lines) {
    constexpr std::uint64_t kMaxHeaderBytes = 1 << 20;
    std::string_view line;
    if (lines.offset() > kMaxHeaderBytes || !lines.next(line)) {
      file.fail("its OctoMap header has no line 'data'");
    }
    const auto w = words(line);
    if (w.empty() || w[0].starts_with('#')) return false;
    if (w[0] == "data") return true;
    std::uint64_t count = 0;
    bool good = w.size() == 2;
    if (good && w[0] == "id") {
      id = w[1].substr(0, 40);
    } else if (good && w[0] == "res") {
      good = parseNumber(w[1], resolution_m);
    } else if (good && w[0] == "size") {
      good = parseCount(w[1], count);
      nodes = count;
    } else {
      good = false;
    }
    if (!good) {
      file.fail(text("line ", lines.lineNumber(), ": '", line.substr(0, 40),
                     "' is not known in an OctoMap header"));
    }
    return false;
  }

  void check(const InputFile& file) const {
    if (id != "OcTree" && id != "ColorOcTree" && id != "OcTreeStamped") {
      file.fail(
          text("its octree of kind '", id, "' is not known (OcTree, ColorOcTree, OcTreeStamped)"));
    }
    if (!(resolution_m >= kFinest_m && resolution_m <= kCoarsest_m)) {
      file.fail("its OctoMap header has no line 'res' with a resolution that makes sense");
    }
    if (!nodes) file.fail("its OctoMap header has no line 'size'");
    if (*nodes == 0) file.fail("its octree is empty");
  }
};

}  // namespace

class OctreeMapReader {
 public:
  OctreeMapReader(const InputFile& file, const MemoryBudget& budget)
      : file_(file), budget_(budget), header_(file), bytes_(file, header_.data_at) {}

  OctreeMap read() {
    // A node takes two bytes at least, or is one of the eight leaves that two bytes tell of.
    const std::uint64_t most = (file_.size() - header_.data_at) * 4 + 1;
    if (*header_.nodes > most) {
      file_.fail(text("its header promises ", *header_.nodes, " nodes, for which its ",
                      file_.size(), " bytes have no room"));
    }
    map_.resolution_m_ = header_.resolution_m;
    map_.format_ = text("OctoMap ", header_.binary ? ".bt" : ".ot", ", ", header_.id);
    nodes_read_ = 1;
    header_.binary ? readBinaryNode(0, 0) : readFullNode(0, 0);
    if (nodes_read_ != *header_.nodes) {
      file_.fail(
          text("its header promises ", *header_.nodes, " nodes, but it holds ", nodes_read_));
    }
    if (!bytes_.atEnd()) file_.fail("goes on after the last node of its octree");
    return std::move(map_);
  }

 private:
  using State = OctreeMap::State;

  std::uint32_t addChildren(std::uint32_t node, int depth) {
    if (depth >= kDepth) file_.fail("is damaged: its octree is deeper than 16 levels");
    const std::size_t first = map_.nodes_.size();
    if (first == map_.nodes_.capacity()) {
      budget_.require(3 * first * sizeof(map_.nodes_[0]), text(file_.name(), ": its octree"));
      if (first > (1ULL << 31)) file_.fail("has an octree of too many nodes");
    }
    map_.nodes_.resize(first + 8);
    map_.nodes_[node].first_child = static_cast<std::uint32_t>(first);
    return static_cast<std::uint32_t>(first);
  }

  void readBinaryNode(std::uint32_t node, int depth) {
    std::uint8_t bits[2];
    bytes_.read(bits, sizeof bits);
    const unsigned kinds = static_cast<unsigned>(bits[0]) | static_cast<unsigned>(bits[1]) << 8;
    if (kinds == 0 && depth > 0) file_.fail("is damaged: an inner node has no children");
    const std::uint32_t first = addChildren(node, depth);
    for (unsigned child = 0; child < 8; ++child) {
      const unsigned kind = kinds >> 2 * child & 3;
      nodes_read_ += kind != 0;
      if (kind == 1) map_.nodes_[first + child].state = State::kFree;
      if (kind == 2) map_.nodes_[first + child].state = State::kOccupied;
      if (kind == 3) readBinaryNode(first + child, depth + 1);
    }
  }

  void readFullNode(std::uint32_t node, int depth) {
    float log_odds = 0;
    std::uint8_t colour[3], children = 0;
    bytes_.read(&log_odds, sizeof log_odds);
    if (header_.id == "ColorOcTree") bytes_.read(colour, sizeof colour);
    bytes_.read(&children, sizeof children);
    if (std::isnan(log_odds)) file_.fail("is damaged: the occupancy of a node is not a number");
    if (children == 0) {
      map_.nodes_[node].state = log_odds >= 0 ? State::kOccupied : State::kFree;
      return;
    }
    const std::uint32_t first = addChildren(node, depth);
    for (unsigned child = 0; child < 8; ++child) {
      if ((children >> child & 1) == 0) continue;
      ++nodes_read_;
      readFullNode(first + child, depth + 1);
    }
  }

  const InputFile& file_;
  const MemoryBudget& budget_;
  OctreeHeader header_;
  ByteReader bytes_;
  OctreeMap map_;
  std::uint64_t nodes_read_ = 0;
};

OctreeMap readOctreeMap(const InputFile& file, const MemoryBudget& budget) {
  return OctreeMapReader(file, budget).read();
}

}  // namespace paloc
