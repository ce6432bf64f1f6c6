#include "paloc/frontends/CObservationLidarScan.h"

#include <mrpt/core/initializer.h>
#include <mrpt/rtti/CObject.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/serialization/stl_serialization.h>

#include <algorithm>
#include <ostream>
#include <stdexcept>

IMPLEMENTS_SERIALIZABLE(CObservationLidarScan, CObservation, paloc::obs)

namespace paloc::obs {
namespace {

// Reads what `out << column` wrote, in pieces: a damaged length then meets the end of the file
// before it has taken all memory.
template <typename T>
void readColumn(mrpt::serialization::CArchive& in, std::vector<T>& column) {
  constexpr std::size_t kPiece = 1 << 18;
  const std::size_t size = in.ReadAs<std::uint32_t>();
  column.clear();
  column.reserve(std::min(size, kPiece));
  while (column.size() < size) {
    const std::size_t done = column.size();
    column.resize(done + std::min(kPiece, size - done));
    in.ReadBufferFixEndianness(column.data() + done, column.size() - done);
  }
}

}  // namespace

std::uint8_t CObservationLidarScan::serializeGetVersion() const { return 0; }

void CObservationLidarScan::serializeTo(mrpt::serialization::CArchive& out) const {
  out << timestamp << sensorLabel << sensorPoseOnRobot << x << y << z << dt_ns << intensity << ring
      << duration_ns << deskewed;
}

void CObservationLidarScan::serializeFrom(mrpt::serialization::CArchive& in, std::uint8_t version) {
  if (version != 0) MRPT_THROW_UNKNOWN_SERIALIZATION_VERSION(version);
  in >> timestamp >> sensorLabel >> sensorPoseOnRobot;
  readColumn(in, x);
  readColumn(in, y);
  readColumn(in, z);
  readColumn(in, dt_ns);
  readColumn(in, intensity);
  readColumn(in, ring);
  in >> duration_ns >> deskewed;
  const auto fits = [this](std::size_t n) { return n == 0 || n == x.size(); };
  if (y.size() != x.size() || z.size() != x.size() || !fits(dt_ns.size()) ||
      !fits(intensity.size()) || !fits(ring.size())) {
    throw std::runtime_error("CObservationLidarScan: its columns differ in length");
  }
}

void CObservationLidarScan::getDescriptionAsText(std::ostream& out) const {
  CObservation::getDescriptionAsText(out);
  out << "Sensor pose on the body: " << sensorPoseOnRobot << '\n'
      << "Points: " << size() << "\nDuration: " << duration_ns * 1e-6 << " ms\n"
      << "Time per point: " << (dt_ns.empty() ? "no" : "yes")
      << "\nDeskewed: " << (deskewed ? "yes" : "no")
      << "\nIntensity: " << (intensity.empty() ? "no" : "yes")
      << "\nRing: " << (ring.empty() ? "no" : "yes") << '\n';
}

}  // namespace paloc::obs

// Runs when the library is loaded, also by rawlog-edit -p.
MRPT_INITIALIZER(registerAllClasses_paloc) {
  mrpt::rtti::registerClass(CLASS_ID(paloc::obs::CObservationLidarScan));
}
