#include "paloc/tools/eval_traj.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "paloc/core/errors.h"

namespace paloc {
namespace {

namespace fs = std::filesystem;

fs::path evalData() {
  const char* shared = std::getenv("PALOC_SHARED_DATA");
  return (shared ? fs::path(shared) : fs::path(PALOC_SOURCE_DIR) / ".." / "shared" / "data") /
         "eval";
}

void expectEqual(const ErrorStatistics& ours, const nlohmann::json& evo, const std::string& what) {
  EXPECT_NEAR(ours.rmse, evo.at("rmse").get<double>(), 1e-6) << what;
  EXPECT_NEAR(ours.mean, evo.at("mean").get<double>(), 1e-6) << what;
  EXPECT_NEAR(ours.median, evo.at("median").get<double>(), 1e-6) << what;
  EXPECT_NEAR(ours.std, evo.at("std").get<double>(), 1e-6) << what;
  EXPECT_NEAR(ours.min, evo.at("min").get<double>(), 1e-6) << what;
  EXPECT_NEAR(ours.max, evo.at("max").get<double>(), 1e-6) << what;
  const double sse = ours.rmse * ours.rmse * static_cast<double>(ours.count);
  EXPECT_NEAR(sse, evo.at("sse").get<double>(), 1e-6 * std::max(1.0, sse)) << what;
}

TEST(EvalTraj, EqualsEvo) {
  const fs::path data = evalData();
  if (!fs::exists(data / "evo.json")) GTEST_SKIP() << "no evo.json in " << data;
  const auto evo = nlohmann::json::parse(std::ifstream(data / "evo.json"));
  for (const Alignment alignment : {Alignment::kNone, Alignment::kSe3, Alignment::kOrigin}) {
    const auto& expected = evo.at(toString(alignment));
    for (const auto& [delta, unit] :
         {std::pair{1.0, DeltaUnit::kFrames}, std::pair{10.0, DeltaUnit::kFrames},
          std::pair{1.0, DeltaUnit::kMetres}}) {
      EvalTrajSettings settings{
          data / "ref.tum", data / "est.tum", alignment, {delta, unit, 0, true}};
      const EvalTrajResult ours = evaluateTrajectories(settings);
      const std::string name = std::to_string(static_cast<int>(delta)) + toString(unit);
      EXPECT_EQ(ours.matched_poses, expected.at("matched").get<std::size_t>());
      expectEqual(ours.absolute.translation_m, expected.at("ape_translation"), "APE");
      expectEqual(ours.absolute.rotation_rad, expected.at("ape_rotation_rad"), "APE rotation");
      expectEqual(ours.relative.translation_m, expected.at("rpe_translation_" + name), name);
      expectEqual(ours.relative.rotation_rad, expected.at("rpe_rotation_rad_" + name), name);
    }
  }
}

class EvalTrajFiles : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / (std::string("paloc_eval_") + info->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    settings_.reference_file = folder_ / "ref.tum";
    settings_.estimate_file = folder_ / "est.tum";
  }
  void TearDown() override { fs::remove_all(folder_); }

  // A straight walk at 10 Hz, 0.1 m a step; the estimate is `left` metres to the left.
  static StampedPose at(int i, double left) {
    return {i * kNsPerSecond / 10, {Vec3(0.1 * i, left, 0), Mat3::Identity()}};
  }

  fs::path folder_;
  EvalTrajSettings settings_;
};

TEST_F(EvalTrajFiles, SaysWhatItLeftOut) {
  std::vector<StampedPose> reference, estimate;
  for (int i = 0; i < 100; ++i) {
    reference.push_back(at(i, 0));
    if (i < 30 || i >= 40) estimate.push_back(at(i, 0.01));
  }
  std::swap(estimate[3], estimate[4]);
  estimate.push_back(at(99, 5));
  writeTum(settings_.reference_file, reference);
  writeTum(settings_.estimate_file, estimate);
  const EvalTrajResult result = evaluateTrajectories(settings_);
  EXPECT_EQ(result.matched_poses, 90U);
  EXPECT_NEAR(result.absolute.translation_m.rmse, 0.01, 1e-9);
  EXPECT_EQ(result.relative.pairs_across_gaps, 1U);
  EXPECT_EQ(result.relative.translation_m.count, 88U);
  ASSERT_EQ(result.notes.size(), 3U);
  EXPECT_NE(result.notes[0].find("1 pose is out of order"), std::string::npos) << result.notes[0];
  EXPECT_NE(result.notes[1].find("1 pose repeats"), std::string::npos) << result.notes[1];
  EXPECT_NE(result.notes[2].find("1 pair of the RPE spans a gap"), std::string::npos);
  EXPECT_NE(result.notes[2].find("is left out; --across-gaps"), std::string::npos);

  const auto json = jsonOf(result);
  EXPECT_EQ(json.at("align"), "none");
  EXPECT_EQ(json.at("poses").at("reference"), 100);
  EXPECT_EQ(json.at("poses").at("estimate"), 90);
  EXPECT_EQ(json.at("poses").at("matched"), 90);
  EXPECT_NEAR(json.at("ate").at("rmse_m").get<double>(), 0.01, 1e-9);
  EXPECT_NEAR(json.at("ate").at("mean_m").get<double>(), 0.01, 1e-9);
  EXPECT_NEAR(json.at("ate").at("max_m").get<double>(), 0.01, 1e-9);
  EXPECT_NEAR(json.at("ate").at("rotation_rmse_rad").get<double>(), 0, 1e-9);
  EXPECT_EQ(json.at("rpe").at("delta"), 1);
  EXPECT_EQ(json.at("rpe").at("unit"), "frames");
  EXPECT_NEAR(json.at("rpe").at("translation_rmse_m").get<double>(), 0, 1e-8);
  EXPECT_NEAR(json.at("rpe").at("rotation_rmse_rad").get<double>(), 0, 1e-9);
  EXPECT_NEAR(json.at("coverage").at("pose_share").get<double>(), 0.9, 1e-12);

  const std::string table = tableOf(result);
  EXPECT_NE(table.find("90 poses within 0.01 s"), std::string::npos) << table;
  EXPECT_NE(table.find("ATE translation    m      0.0100"), std::string::npos) << table;
  EXPECT_NE(table.find("1 gap, the longest 1.10 s at 2.90 s"), std::string::npos) << table;
}

TEST_F(EvalTrajFiles, NoPairForTheRpeIsNullAndSaid) {
  writeTum(settings_.reference_file, {at(0, 0), at(1, 0)});
  writeTum(settings_.estimate_file, {at(0, 0), at(1, 0)});
  settings_.relative.delta = 5;
  const EvalTrajResult result = evaluateTrajectories(settings_);
  EXPECT_TRUE(jsonOf(result).at("rpe").at("translation_rmse_m").is_null());
  ASSERT_EQ(result.notes.size(), 1U);
  EXPECT_NE(result.notes[0].find("no pair of poses is left for the RPE"), std::string::npos);
  EXPECT_NE(tableOf(result).find("(no pair)"), std::string::npos);
}

TEST_F(EvalTrajFiles, NoMatchIsOneSentence) {
  writeTum(settings_.reference_file, {at(0, 0), at(1, 0)});
  writeTum(settings_.estimate_file, {{50'000'000, {}}});
  try {
    evaluateTrajectories(settings_);
    FAIL() << "accepted";
  } catch (const IoError& e) {
    EXPECT_NE(std::string(e.what()).find("the nearest two are 0.05 s apart"), std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace paloc
