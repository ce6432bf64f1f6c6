#include <mrpt/obs/CObservationVelodyneScan.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "lidar_decoders.h"
#include "paloc/frontends/mrpt_time.h"
#include "velodyne_model.h"

// MRPT's own decoder of the packets gives one firing of two, and one time a packet; so they are
// decoded here, as the manuals have it (see velodyne_model.h).
namespace paloc::lidar_decoders {
namespace {

using mrpt::obs::CObservationVelodyneScan;
using Packet = CObservationVelodyneScan::TVelodyneRawPacket;
using Block = CObservationVelodyneScan::raw_block_t;

constexpr int kBlocks = CObservationVelodyneScan::BLOCKS_PER_PACKET;
constexpr double kDegree = std::numbers::pi / 180;
constexpr std::uint32_t kMicrosecondsPerHour = 3'600'000'000U;
constexpr TimeNs kLongestScan = 4 * kNsPerSecond;  // dt_ns has 32 bits

// MRPT's accessors bind references to fields of a packed struct, which is undefined where they are
// not aligned; so the bytes of a packet are read as the manual lays them out.
static_assert(std::endian::native == std::endian::little, "packets are little-endian");
constexpr std::size_t kPacketTimeOffset = 1200;
static_assert(sizeof(Packet) == 1206 && sizeof(Block) == 100, "packets are packed");

template <typename T, typename Struct>
T fieldAt(const Struct& packed, std::size_t offset) {
  T value;
  std::memcpy(&value, reinterpret_cast<const unsigned char*>(&packed) + offset, sizeof value);
  return value;
}

std::uint32_t timeOf(const Packet& packet) {  // microseconds of the hour
  return fieldAt<std::uint32_t>(packet, kPacketTimeOffset);
}
std::uint16_t headerOf(const Block& block) { return fieldAt<std::uint16_t>(block, 0); }
std::uint16_t rotationOf(const Block& block) { return fieldAt<std::uint16_t>(block, 2); }
std::uint16_t distanceOf(const Block& block, int i) {  // of its i-th return, in units of 2 mm
  return fieldAt<std::uint16_t>(block, 4 + 3 * static_cast<std::size_t>(i));
}
std::uint8_t intensityOf(const Block& block, int i) {
  return fieldAt<std::uint8_t>(block, 6 + 3 * static_cast<std::size_t>(i));
}

struct Beam {
  double azimuth = 0;  // rad, added to the block's
  double cos_elevation = 1, sin_elevation = 0;
  double range_offset = 0, vertical_offset = 0, horizontal_offset = 0;  // m
};

std::vector<Beam> beamsOf(const CObservationVelodyneScan& scan, const velodyne::Model& model) {
  const auto& calibration = scan.calibration.laser_corrections;
  std::vector<Beam> beams(static_cast<std::size_t>(model.lasers));
  for (std::size_t i = 0; i < beams.size(); ++i) {
    Beam& beam = beams[i];
    double elevation_deg = model.elevation_deg[i];
    if (calibration.size() == beams.size()) {
      const auto& c = calibration[i];
      elevation_deg = c.verticalCorrection;
      beam.azimuth = c.azimuthCorrection * kDegree;
      beam.range_offset = c.distanceCorrection;
      beam.vertical_offset = c.verticalOffsetCorrection;
      beam.horizontal_offset = c.horizontalOffsetCorrection;
    }
    beam.cos_elevation = std::cos(elevation_deg * kDegree);
    beam.sin_elevation = std::sin(elevation_deg * kDegree);
  }
  return beams;
}

const velodyne::Model* modelOf(const CObservationVelodyneScan& scan) {
  switch (scan.scan_packets.front().velodyne_model_ID) {
    case 0x21:
      return &velodyne::kHdl32;
    case 0x22:
      return &velodyne::kVlp16;
    default:
      return nullptr;
  }
}

// Stamps of the packets after that of the first: from the sensor's clock (microseconds of the
// hour), or, where that does not advance, by counting.
std::vector<TimeNs> packetTimes(const std::vector<Packet>& packets, TimeNs packet_ns,
                                bool& counted) {
  std::vector<TimeNs> times(packets.size(), 0);
  counted = false;
  for (std::size_t i = 1; i < packets.size() && !counted; ++i) {
    const std::uint32_t now = timeOf(packets[i]), first = timeOf(packets[0]);
    const std::uint32_t since = now >= first ? now - first : now + kMicrosecondsPerHour - first;
    times[i] = TimeNs{since} * 1000;
    counted = times[i] <= times[i - 1] || times[i] > kLongestScan;
  }
  if (counted) {
    for (std::size_t i = 0; i < times.size(); ++i) times[i] = static_cast<TimeNs>(i) * packet_ns;
  }
  return times;
}

// How far the head turns during each block (rad), from the azimuth of the block that fires next. A
// block with no next one, or behind a gap, turns as the one before it.
std::vector<double> blockTurns(const std::vector<Packet>& packets, int blocks_per_firing) {
  const auto azimuth = [&](std::size_t block) {
    return rotationOf(packets[block / kBlocks].blocks[block % kBlocks]);
  };
  const std::size_t n = packets.size() * kBlocks;
  const auto step = static_cast<std::size_t>(blocks_per_firing);
  std::vector<double> turns(n, 0);
  constexpr double kLargestTurn = 2.0 * kDegree;  // 20 Hz turn 0.8 degrees in a VLP-16's block
  double last = 0;
  for (std::size_t i = 0; i + step < n; ++i) {
    const int units = (azimuth(i + step) - azimuth(i) + 36'000) % 36'000;
    const double turn = units * 0.01 * kDegree;
    if (turn > 0 && turn < kLargestTurn) last = turn;
    turns[i] = last;
  }
  for (std::size_t i = n - std::min(n, step); i < n; ++i) turns[i] = last;
  return turns;
}

struct Decoding {
  const velodyne::Model& model;
  std::vector<Beam> beams;
  LidarColumns columns;
  LidarFrame& frame;

  // MRPT's axes: its x is Velodyne's y, its y is Velodyne's -x; azimuth runs clockwise from x.
  void addReturn(int laser, double azimuth, double range, TimeNs dt, std::uint8_t intensity) {
    const Beam& beam = beams[static_cast<std::size_t>(laser)];
    const double r = range + beam.range_offset;
    const double c = std::cos(azimuth + beam.azimuth), s = std::sin(azimuth + beam.azimuth);
    const double xy = r * beam.cos_elevation;
    frame.points_lidar.push_back(
        {static_cast<float>(xy * c + beam.horizontal_offset * s),
         static_cast<float>(beam.horizontal_offset * c - xy * s),
         static_cast<float>(r * beam.sin_elevation + beam.vertical_offset)});
    frame.dt_ns.push_back(static_cast<std::uint32_t>(dt));
    if (columns.intensity) frame.intensity.push_back(intensity);
    if (columns.ring) frame.ring.push_back(static_cast<std::uint16_t>(laser));
  }

  // `twin`: the other return of the same firings in dual mode, or null; equal returns count once.
  void addBlock(const Block& block, const Block* twin, TimeNs start, double turn) {
    const TimeNs block_ns = model.firings_per_block * model.firing_ns;
    for (int i = 0; i < CObservationVelodyneScan::SCANS_PER_BLOCK; ++i) {
      const int firing = i / model.lasers, laser = i % model.lasers;
      const std::uint16_t distance = distanceOf(block, i);
      const bool repeated = twin && distanceOf(*twin, i) == distance;
      if (distance == 0) ++frame.invalid_points;
      if (distance == 0 || repeated) continue;
      const TimeNs in_block = firing * model.firing_ns + laser * model.laser_ns;
      const double azimuth = rotationOf(block) * 0.01 * kDegree +
                             turn * static_cast<double>(in_block) / static_cast<double>(block_ns);
      const double range =
          distance * static_cast<double>(CObservationVelodyneScan::DISTANCE_RESOLUTION);
      addReturn(laser, azimuth, range, start + in_block, intensityOf(block, i));
    }
  }
};

bool decodePackets(const CObservationVelodyneScan& scan, const velodyne::Model& model,
                   LidarColumns columns, LidarFrame& frame, std::string& refusal) {
  const auto& packets = scan.scan_packets;
  const bool dual = packets.front().laser_return_mode == CObservationVelodyneScan::RETMODE_DUAL;
  const int blocks_per_firing = dual ? 2 : 1;
  const TimeNs block_ns = model.firings_per_block * model.firing_ns;
  bool counted = false;
  const auto times = packetTimes(packets, kBlocks / blocks_per_firing * block_ns, counted);
  if (times.back() > kLongestScan) {
    refusal = "its packets span more than 4 s";
    return false;
  }
  const auto turns = blockTurns(packets, blocks_per_firing);
  Decoding decoding{model, beamsOf(scan, model), columns, frame};
  const std::size_t returns = packets.size() * CObservationVelodyneScan::SCANS_PER_PACKET;
  frame.points_lidar.reserve(returns);
  frame.dt_ns.reserve(returns);
  for (std::size_t p = 0; p < packets.size(); ++p) {
    for (int b = 0; b < kBlocks; ++b) {
      const auto& block = packets[p].blocks[b];
      if (headerOf(block) != CObservationVelodyneScan::UPPER_BANK) {
        frame.invalid_points += CObservationVelodyneScan::SCANS_PER_BLOCK;
        continue;
      }
      const auto* twin = dual && b % 2 == 1 ? &packets[p].blocks[b - 1] : nullptr;
      decoding.addBlock(block, twin, times[p] + b / blocks_per_firing * block_ns,
                        turns[p * kBlocks + static_cast<std::size_t>(b)]);
    }
  }
  frame.duration_ns = times.back() + kBlocks / blocks_per_firing * block_ns - model.firing_ns +
                      (model.lasers - 1) * model.laser_ns;
  frame.time_policy = "points have the firing times of a " + std::string(model.name) +
                      (counted ? ", packets timed by counting (their clock stands)"
                               : ", packets timed by the sensor's clock");
  return true;
}

bool decodeCloud(const CObservationVelodyneScan& scan, LidarColumns columns, LidarFrame& frame,
                 std::string& refusal) {
  const auto& cloud = scan.point_cloud;
  const std::size_t n = cloud.size();
  const auto fits = [n](std::size_t size) { return size == 0 || size == n; };
  if (cloud.y.size() != n || cloud.z.size() != n || !fits(cloud.timestamp.size()) ||
      !fits(cloud.intensity.size()) || !fits(cloud.laser_id.size())) {
    refusal = "its columns differ in length";
    return false;
  }
  const bool times = !cloud.timestamp.empty();
  TimeNs first = frame.stamp_ns, last = frame.stamp_ns;
  if (times) {
    const auto [low, high] = std::minmax_element(cloud.timestamp.begin(), cloud.timestamp.end());
    first = std::min(first, fromMrptTime(*low));
    last = fromMrptTime(*high);
    if (last - first > kLongestScan) {
      refusal = "the times of its points lie more than 4 s apart or from its stamp";
      return false;
    }
  }
  frame.points_lidar.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const bool finite =
        std::isfinite(cloud.x[i]) && std::isfinite(cloud.y[i]) && std::isfinite(cloud.z[i]);
    if (!finite || (cloud.x[i] == 0 && cloud.y[i] == 0 && cloud.z[i] == 0)) {
      ++frame.invalid_points;
      continue;
    }
    frame.points_lidar.push_back({cloud.x[i], cloud.y[i], cloud.z[i]});
    if (times) {
      frame.dt_ns.push_back(static_cast<std::uint32_t>(fromMrptTime(cloud.timestamp[i]) - first));
    }
    if (columns.intensity && !cloud.intensity.empty())
      frame.intensity.push_back(cloud.intensity[i]);
    if (columns.ring && !cloud.laser_id.empty()) {
      frame.ring.push_back(static_cast<std::uint16_t>(cloud.laser_id[i]));
    }
  }
  frame.time_policy = "points have no times: taken as deskewed to the stamp";
  frame.deskewed = !times;
  if (times) {
    const bool early = first < frame.stamp_ns;
    frame.time_policy = early ? "points have absolute times, the first before the stamp: the scan "
                                "is taken to start with it"
                              : "points have absolute times";
    frame.stamp_ns = first;
    frame.duration_ns = last - first;
  }
  return true;
}

}  // namespace

bool decodeVelodyneScan(const mrpt::obs::CObservation& observation, LidarColumns columns,
                        LidarFrame& frame, std::string& refusal) {
  const auto& scan = dynamic_cast<const CObservationVelodyneScan&>(observation);
  const velodyne::Model* model = scan.scan_packets.empty() ? nullptr : modelOf(scan);
  if (model) return decodePackets(scan, *model, columns, frame, refusal);
  if (scan.point_cloud.size() > 0 || scan.scan_packets.empty()) {
    return decodeCloud(scan, columns, frame, refusal);
  }
  refusal = "its packets are of a model other than VLP-16 and HDL-32E";
  return false;
}

}  // namespace paloc::lidar_decoders
