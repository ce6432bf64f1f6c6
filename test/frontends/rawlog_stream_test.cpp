#include "paloc/frontends/rawlog_stream.h"

#include <gtest/gtest.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <random>

#include "paloc/core/errors.h"
#include "paloc/frontends/CObservationLidarScan.h"
#include "paloc/frontends/mrpt_time.h"
#include "temp_dir.h"

namespace paloc {
namespace {

using obs::CObservationLidarScan;
using End = RawlogStream::End;
using Compression = RawlogWriter::Compression;

CObservationLidarScan scan(int seed, std::size_t points) {
  std::mt19937 rng(static_cast<unsigned>(seed));
  std::uniform_real_distribution<float> uniform(-20, 20);
  CObservationLidarScan s;
  s.timestamp = toMrptTime(1645002364'537699900 + seed * 100'000'000LL);
  s.sensorLabel = "lidar";
  s.sensorPoseOnRobot = mrpt::poses::CPose3D(0.1, -0.2, 0.3, 0.4, 0.05, -0.06);
  for (std::size_t i = 0; i < points; ++i) {
    s.x.push_back(uniform(rng));
    s.y.push_back(uniform(rng));
    s.z.push_back(uniform(rng));
    s.dt_ns.push_back(static_cast<std::uint32_t>(i * 100));
    s.intensity.push_back(static_cast<std::uint16_t>(i));
    s.ring.push_back(static_cast<std::uint16_t>(i % 128));
  }
  s.duration_ns = 99'999'999;
  s.deskewed = seed % 2 == 1;
  return s;
}

void expectSame(const CObservationLidarScan& a, const CObservationLidarScan& b) {
  EXPECT_EQ(a.timestamp, b.timestamp);
  EXPECT_EQ(a.sensorLabel, b.sensorLabel);
  EXPECT_EQ(a.sensorPoseOnRobot.asString(), b.sensorPoseOnRobot.asString());
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.z, b.z);
  EXPECT_EQ(a.dt_ns, b.dt_ns);
  EXPECT_EQ(a.intensity, b.intensity);
  EXPECT_EQ(a.ring, b.ring);
  EXPECT_EQ(a.duration_ns, b.duration_ns);
  EXPECT_EQ(a.deskewed, b.deskewed);
}

void writeScans(const std::filesystem::path& file, int scans, std::size_t points,
                Compression kind) {
  RawlogWriter writer(file, kind);
  for (int i = 0; i < scans; ++i) writer.write(scan(i, points));
  writer.close();
}

struct ReadBack {
  std::size_t observations = 0;
  End end = End::kNone;
  std::string error;
};

ReadBack readAll(const std::filesystem::path& file) {
  RawlogStream stream(file);
  ReadBack result;
  while (stream.next()) ++result.observations;
  result.end = stream.end();
  result.error = stream.error();
  EXPECT_EQ(result.error.empty(), result.end == End::kClean);
  EXPECT_EQ(result.error.find('\n'), std::string::npos) << result.error;
  return result;
}

TEST(Rawlog, ScansComeBackAsTheyWere) {
  const test::TempDir folder;
  for (const auto kind : {Compression::kNone, Compression::kGzip}) {
    const auto file = folder / "a.rawlog";
    writeScans(file, 3, 300'000, kind);  // more points than one piece of a column
    EXPECT_EQ(test::readFile(file).starts_with("\x1f\x8b"), kind == Compression::kGzip);
    RawlogStream stream(file);
    for (int i = 0; i < 3; ++i) {
      const auto s = std::dynamic_pointer_cast<CObservationLidarScan>(stream.next());
      ASSERT_TRUE(s);
      expectSame(*s, scan(i, 300'000));
    }
    EXPECT_FALSE(stream.next());
    EXPECT_EQ(stream.end(), End::kClean);
    EXPECT_EQ(stream.objectsRead(), 3U);
    EXPECT_EQ(stream.progress(), 1.0);
  }
}

TEST(Rawlog, ReadsSensoryFramesAndPassesOverTheRest) {
  using namespace mrpt::obs;
  const test::TempDir folder;
  {
    mrpt::io::CFileGZOutputStream file((folder / "sf.rawlog").string());
    auto archive = mrpt::serialization::archiveFrom(file);
    CSensoryFrame frame;
    for (int i = 0; i < 2; ++i) frame.insert(CObservationIMU::Create());
    archive << CObservationComment() << CActionCollection() << frame << frame;
  }
  const ReadBack back = readAll(folder / "sf.rawlog");
  EXPECT_EQ(back.observations, 4U);
  EXPECT_EQ(back.end, End::kClean);
}

TEST(Rawlog, TruncationKeepsWhatCameBefore) {
  const test::TempDir folder;
  for (const auto kind : {Compression::kNone, Compression::kGzip}) {
    writeScans(folder / "whole.rawlog", 4, 200, kind);
    const std::string whole = test::readFile(folder / "whole.rawlog");
    ASSERT_EQ(readAll(folder / "whole.rawlog").observations, 4U);
    const std::size_t one = whole.size() / 4;
    for (std::size_t length = 2; length < whole.size(); length += 37) {  // 2: gzip's signature
      const ReadBack back = readAll(folder.write("cut.rawlog", whole.substr(0, length)));
      const bool between = kind == Compression::kNone && length % one == 0;
      EXPECT_EQ(back.end, between ? End::kClean : End::kDamaged) << length;
      if (kind == Compression::kNone) {
        EXPECT_EQ(back.observations, length / one);
        EXPECT_EQ(back.error.find("the file ends inside it") == std::string::npos, between);
      } else {
        EXPECT_NE(back.error.find("cut off"), std::string::npos) << back.error;
      }
    }
  }
}

TEST(Rawlog, DamagedGzipIsNoticed) {
  const test::TempDir folder;
  writeScans(folder / "whole.rawlog", 4, 200, Compression::kGzip);
  const std::string whole = test::readFile(folder / "whole.rawlog");
  std::mt19937_64 rng(1);
  for (int run = 0; run < 200; ++run) {
    std::string damaged = whole;
    const std::size_t at = 10 + rng() % (whole.size() - 10);  // behind gzip's own header
    damaged[at] = static_cast<char>(damaged[at] ^ (1 + rng() % 255));
    const ReadBack back = readAll(folder.write("d.rawlog", damaged));
    EXPECT_EQ(back.end, End::kDamaged) << at;
    EXPECT_LE(back.observations, 4U);
  }
}

TEST(Rawlog, DamagedPlainFilesNeverCrash) {
  const test::TempDir folder;
  writeScans(folder / "whole.rawlog", 3, 20, Compression::kNone);
  const std::string whole = test::readFile(folder / "whole.rawlog");
  for (std::size_t at = 0; at < whole.size() / 3; ++at) {  // lengths become absurd here and there
    std::string damaged = whole;
    damaged[at] = '\x7f';
    readAll(folder.write("d.rawlog", damaged));
  }
}

TEST(Rawlog, SaysWhatItCannotRead) {
  const test::TempDir folder;
  EXPECT_THROW(RawlogStream(folder / "missing.rawlog"), IoError);
  EXPECT_THROW(RawlogStream{folder.path()}, IoError);
  EXPECT_EQ(readAll(folder.write("empty.rawlog", "")).end, End::kClean);
  EXPECT_NE(readAll(folder.write("text.rawlog", "once upon a time\n")).error.find("no rawlog"),
            std::string::npos);

  writeScans(folder / "a.rawlog", 2, 5, Compression::kNone);
  std::string foreign = test::readFile(folder / "a.rawlog");
  const std::size_t second = foreign.size() / 2;
  foreign.replace(foreign.find("CObservationLidarScan", second), 21, "CObservationTidarScan");
  const ReadBack back = readAll(folder.write("foreign.rawlog", foreign));
  EXPECT_EQ(back.observations, 1U);
  EXPECT_NE(back.error.find("class 'paloc::obs::CObservationTidarScan'"), std::string::npos)
      << back.error;
  EXPECT_NE(back.error.find("--plugin"), std::string::npos);
}

TEST(RawlogWriter, SaysWhenTheDiskIsFull) {
  const test::TempDir folder;
  EXPECT_THROW(RawlogWriter(folder / "no" / "a.rawlog"), IoError);
  for (const auto kind : {Compression::kNone, Compression::kGzip}) {
    for (const std::size_t points : {std::size_t{5}, std::size_t{500'000}}) {
      RawlogWriter writer("/dev/full", kind);
      EXPECT_THROW(
          {
            writer.write(scan(0, points));
            writer.close();
          },
          IoError);
    }
  }
}

}  // namespace
}  // namespace paloc
