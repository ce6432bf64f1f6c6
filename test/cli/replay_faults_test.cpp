#include <gtest/gtest.h>
#include <mrpt/obs/CObservationIMU.h>

#include <cmath>
#include <limits>

#include "paloc/frontends/CObservationLidarScan.h"
#include "paloc/frontends/mrpt_time.h"
#include "replay_demo.h"

/// Recordings with something wrong in them: what is good is kept, what is not is said.
namespace paloc {
namespace {

using mrpt::obs::CObservationIMU;
using obs::CObservationLidarScan;
using test::demoLog;
using test::demoObservations;
using test::Observations;
using test::ReplayRun;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class ReplayFaults : public testing::Test {
 protected:
  ReplayRun replay(const Observations& observations, test::Words more = {}) {
    test::writeLog(dir_ / "log.rawlog", observations);
    return replayFile(dir_ / "log.rawlog", std::move(more));
  }
  ReplayRun replayFile(const std::filesystem::path& log, test::Words more = {}) {
    test::ReplayCall call;
    call.log = log;
    call.more = std::move(more);
    return test::replayInto(dir_ / "result", call);
  }
  test::TempDir dir_;
};

// The verdict stands in the exit code, on the console, in summary.json and in the report.
void expectVerdict(const ReplayRun& run, int exit_code, const std::string& status,
                   const std::string& part) {
  EXPECT_EQ(run.exit_code, exit_code) << run.err << run.out;
  ASSERT_FALSE(run.summary.is_null()) << run.err;
  EXPECT_EQ(run.summary.at("status"), status);
  EXPECT_NE(run.sentence().find(part), std::string::npos) << run.sentence();
  EXPECT_TRUE(run.out.starts_with(status + ": " + run.sentence() + '\n')) << run.out;
  const std::string before_quote = run.sentence().substr(0, run.sentence().find('\''));
  EXPECT_NE(run.file("report.html").find(before_quote), std::string::npos) << before_quote;
}

TEST_F(ReplayFaults, SoundRecordingIsGood) {
  const ReplayRun run = replayFile(demoLog());
  expectVerdict(run, 0, "good", "All 50 poses");
  EXPECT_EQ(run.poses(), 50U);
  EXPECT_EQ(run.tumRows(), 50U);
  EXPECT_TRUE(run.summary.at("unused").empty());
  EXPECT_TRUE(run.noted("points have times"));
  const std::size_t note = run.err.find("note: LiDAR 'lidar'");  // as it comes up, and once
  EXPECT_NE(note, std::string::npos) << run.err;
  EXPECT_EQ(run.err.find("note: LiDAR 'lidar'", note + 1), std::string::npos) << run.err;
}

TEST_F(ReplayFaults, TruncatedRecordingKeepsWhatCameBefore) {
  const std::string bytes = test::readFile(demoLog());
  const auto cut = dir_.write("cut.rawlog", bytes.substr(0, bytes.size() / 2));
  const ReplayRun run = replayFile(cut);
  expectVerdict(run, 1, "degraded", "cut.rawlog: object ");
  EXPECT_NE(run.summary.at("damage").get<std::string>().find("the file ends inside it"),
            std::string::npos);
  EXPECT_GT(run.poses(), 20U);
  EXPECT_LT(run.poses(), 30U);
  EXPECT_EQ(run.tumRows(), run.poses());
}

TEST_F(ReplayFaults, OverwrittenBytesEndTheRecordingThere) {
  std::string bytes = test::readFile(demoLog());
  const std::size_t name = bytes.find("CObservationIMU", bytes.size() / 2);
  ASSERT_NE(name, std::string::npos);
  bytes[name + 4] = 'X';
  const ReplayRun run = replayFile(dir_.write("overwritten.rawlog", bytes));
  expectVerdict(run, 1, "degraded", "overwritten.rawlog: object ");
  EXPECT_GT(run.poses(), 20U);
}

TEST_F(ReplayFaults, WhatIsNoRecordingIsWrongInput) {
  expectVerdict(replayFile(dir_.write("notes.rawlog", "remember the milk\n")), 3,
                "unusable recording", "notes.rawlog: object 1: these bytes are no rawlog object");
}

TEST_F(ReplayFaults, EmptyRecordingIsWrongInput) {
  expectVerdict(replayFile(dir_.write("empty.rawlog", "")), 3, "unusable recording",
                "empty.rawlog: holds no observation");
}

TEST_F(ReplayFaults, RecordingWithoutLidarIsWrongInput) {
  Observations observations = demoObservations();
  std::erase_if(observations, [](const auto& o) { return o->sensorLabel == "lidar"; });
  expectVerdict(replay(observations), 3, "unusable recording", "the recording has no LiDAR scan");
}

TEST_F(ReplayFaults, WrongLidarLabelListsThoseThatExist) {
  expectVerdict(replayFile(demoLog(), {"--set", "frontend.lidar_label=nope"}), 3,
                "unusable recording",
                "there is no LiDAR with the label 'nope'; there are: 'lidar' "
                "(CObservationLidarScan)");
}

TEST_F(ReplayFaults, WrongImuLabelIsNotPassedOver) {
  const ReplayRun run = replayFile(demoLog(), {"--set", "frontend.imu_label=nope"});
  expectVerdict(run, 1, "degraded", "there is no IMU with the label 'nope'; there are: 'imu'");
  EXPECT_EQ(run.poses(), 50U);
}

TEST_F(ReplayFaults, PointsThatAreNoNumbersAreCounted) {
  const Observations observations = demoObservations();
  std::uint64_t spoilt = 0;
  for (const auto& observation : observations) {
    if (auto* scan = dynamic_cast<CObservationLidarScan*>(observation.get())) {
      for (std::size_t i = 0; i < scan->size(); i += 10, ++spoilt) scan->y[i] = kNan;
    }
  }
  const ReplayRun run = replay(observations);
  expectVerdict(run, 0, "good", "All 50 poses");
  EXPECT_EQ(run.unused("points without a valid return"), spoilt);
}

TEST_F(ReplayFaults, ScansOfNothingElseAreNoScans) {
  const Observations observations = demoObservations();
  for (const auto& observation : observations) {
    if (auto* scan = dynamic_cast<CObservationLidarScan*>(observation.get())) {
      std::fill(scan->x.begin(), scan->x.end(), kNan);
    }
  }
  const ReplayRun run = replay(observations);
  expectVerdict(run, 3, "unusable recording", "none of the LiDAR's scans could be used");
  EXPECT_EQ(run.unused("scan without a point"), 50U);
}

TEST_F(ReplayFaults, RewoundStretchIsCountedAndLeftOut) {
  Observations observations = demoObservations();
  const auto at = [&](double share) {
    return observations.begin() +
           static_cast<std::ptrdiff_t>(share * static_cast<double>(observations.size()));
  };
  const Observations again(at(0.4), at(0.6));
  observations.insert(at(0.6), again.begin(), again.end());
  const ReplayRun run = replay(observations);
  expectVerdict(run, 0, "good", "All 50 poses");
  EXPECT_EQ(run.unused("time goes backwards") + run.unused("repeated stamp"), again.size());
  const ReplayRun straight = test::replayInto(dir_ / "straight", {});
  EXPECT_EQ(run.file("trajectory.tum"), straight.file("trajectory.tum"));
}

TEST_F(ReplayFaults, ImuGapOfASecondIsBridgedAndSaid) {
  Observations observations = demoObservations();
  const TimeNs from = fromMrptTime(observations.front()->timestamp) + 2 * kNsPerSecond;
  std::erase_if(observations, [&](const auto& o) {
    const TimeNs t = fromMrptTime(o->timestamp);
    return o->sensorLabel == "imu" && t > from && t < from + kNsPerSecond;
  });
  const ReplayRun run = replay(observations);
  EXPECT_LE(run.exit_code, 1);
  EXPECT_EQ(run.poses(), 50U);
  EXPECT_TRUE(run.noted("the IMU pauses for more than 0.05 s 1 time")) << run.err;
}

TEST_F(ReplayFaults, CtrlCWritesWhatWasReadSoFar) {
  for (const char* threads : {"1", "2"}) {  // with two, the recording is read ahead
    test::ReplayCall call;
    // Slow enough for the signal to arrive in time: it is sent when the first scan has been read.
    call.more = {"-j", threads, "--set", "matcher.max_points=100000"};
    test::ProgramOptions options;
    options.interrupt_at = "note: LiDAR 'lidar'";
    const ReplayRun run = test::replayInto(dir_ / threads, call, options);
    ASSERT_EQ(run.signal, 0);
    expectVerdict(run, 1, "degraded", "The run was stopped before the recording's end");
    EXPECT_TRUE(run.summary.at("interrupted"));
    EXPECT_GT(run.poses(), 0U);
    EXPECT_LT(run.poses(), 50U);
    EXPECT_EQ(run.tumRows(), run.poses());
  }
}

}  // namespace
}  // namespace paloc
