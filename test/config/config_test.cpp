#include "paloc/config/config.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "field_count.h"
#include "paloc/config/settings.h"
#include "paloc/core/errors.h"
#include "temp_dir.h"

namespace paloc {
namespace {

using test::readFile;
using test::TempDir;
using test::writeFile;

/// What parsing this text complains about, or "" if nothing.
std::string complaint(const std::string& text) {
  try {
    parseConfig(text, "site.yaml");
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(Config, EmptyTextGivesTheDefaults) {
  const std::string defaults = dumpConfig(Config{});
  for (const char* text : {"", "# nothing\n", "---\n", "matcher:\n", "\n\n"}) {
    EXPECT_EQ(dumpConfig(parseConfig(text, "t")), defaults) << '"' << text << '"';
  }
}

TEST(Config, ReadsEveryType) {
  const Config config = parseConfig(
      "frontend:\n"
      "  lidar_label: OS1 front\n"
      "  imu_label: \"say \\\"imu\\\"\"\n"
      "  deskew: false\n"
      "matcher:\n"
      "  fine_distance_m: 1e-1\n"
      "  max_distance_m: 2\n"
      "  max_points: 1234\n",
      "t");
  EXPECT_EQ(config.frontend.lidar_label, "OS1 front");
  EXPECT_EQ(config.frontend.imu_label, "say \"imu\"");
  EXPECT_FALSE(config.frontend.deskew);
  EXPECT_EQ(config.matcher.fine_distance_m, 0.1);
  EXPECT_EQ(config.matcher.max_distance_m, 2.0);
  EXPECT_EQ(config.matcher.max_points, 1234);
}

TEST(Config, ErrorsNameFileLineKeyAndWhatIsWrong) {
  const struct {
    const char* text;
    const char* error;
  } cases[] = {
      {"matcher:\n  fine_distance_m: 1.5m\n",
       "site.yaml:2: matcher.fine_distance_m: expects a number, not '1.5m'"},
      {"matcher:\n  max_points: 1.5\n",
       "site.yaml:2: matcher.max_points: expects a whole number, not '1.5'"},
      {"matcher:\n  max_points: 99999999999\n",
       "site.yaml:2: matcher.max_points: expects a number of ordinary size, not '99999999999'"},
      {"frontend:\n  deskew: yes\n",
       "site.yaml:2: frontend.deskew: expects true or false, not 'yes'"},
      {"matcher:\n  fine_distance_m: .nan\n",
       "site.yaml:2: matcher.fine_distance_m: expects a number, not '.nan'"},
      {"matcher:\n  fine_distance_m: nan\n",
       "site.yaml:2: matcher.fine_distance_m: expects a finite number, not 'nan'"},
      {"matcher:\n  fine_distance_m: inf\n",
       "site.yaml:2: matcher.fine_distance_m: expects a finite number, not 'inf'"},
      {"matcher:\n  fine_distance_m: 0,5\n",
       "site.yaml:2: matcher.fine_distance_m: expects a number, not '0,5'"},
      {"matcher:\n  fine_distance_m: 1e999\n",
       "site.yaml:2: matcher.fine_distance_m: expects a number of ordinary size, not '1e999'"},
      {"matcher:\n  fine_distance_m: -1\n",
       "site.yaml:2: matcher.fine_distance_m: -1 is out of range: m, 0.01 to 10"},
      {"matcher:\n  fine_distance_m: \"0.2\"\n",
       "site.yaml:2: matcher.fine_distance_m: expects a double without quotes"},
      {"matcher:\n  fine_distance_m: !!float 0.2\n",
       "site.yaml:2: matcher.fine_distance_m: takes no tag, as in 'tag:yaml.org,2002:float'"},
      {"matcher:\n  fine_distance_m:\n", "site.yaml:2: matcher.fine_distance_m: has no value"},
      {"frontend:\n  lidar_label: ~\n", "site.yaml:2: frontend.lidar_label: has no value"},
      {"matcher:\n  fine_distance_m: [0.2]\n",
       "site.yaml:2: matcher.fine_distance_m: expects one value, not a list or a map"},
      {"matcher: 3\n", "site.yaml:1: matcher: is a section: its keys go below it"},
      {"\nmatcher:\n  fine_distnce_m: 0.2\n",
       "site.yaml:3: matcher.fine_distnce_m: unknown key; did you mean 'matcher.fine_distance_m'?"},
      {"matchr:\n  fine_distance_m: 0.2\n", "site.yaml:1: matchr: unknown key"},
      {"map:\n  fine_distance_m: 0.2\n",
       "site.yaml:2: map.fine_distance_m: unknown key; did you mean 'matcher.fine_distance_m'?"},
      {"matcher:\n  completely_different: 0.2\n",
       "site.yaml:2: matcher.completely_different: unknown key"},
      {"matcher:\n  fine_distance_m: 0.2\n  max_points: 500\n  fine_distance_m: 0.3\n",
       "site.yaml:4: matcher.fine_distance_m: given twice, first in line 2"},
      {"matcher:\n  max_points: 500\nmatcher:\n  fine_distance_m: 0.3\n",
       "site.yaml:3: matcher: given twice, first in line 1"},
      {"- 1\n", "site.yaml:1: expects 'key: value' lines"},
      {"frontend:\n  max_range_m: 50\n  min_range_m: 60\n",
       "site.yaml:3: frontend.min_range_m: 60 is not below frontend.max_range_m, 50"},
      {"? [a]\n: 1\n", "site.yaml:1: a key must be a name"},
      {"matcher: &a\n  x: *a\n", "site.yaml:2: matcher.x: unknown key"},
  };
  for (const auto& c : cases) EXPECT_EQ(complaint(c.text), c.error) << c.text;
}

TEST(Config, BrokenYamlIsAnErrorWithItsLine) {
  for (const char* text :
       {"matcher: {fine_distance_m: 0.2\n", "matcher: [1, 2\n", "a: b: c\n",
        "matcher:\n\tfine_distance_m: 1\n", "a: \"x\n", "--- 1\n--- 2\n", "a: *nowhere\n"}) {
    EXPECT_EQ(complaint(text).rfind("site.yaml:", 0), 0U) << text << complaint(text);
  }
  EXPECT_NE(complaint("matcher: {fine_distance_m: 0.2\n").find("is not YAML"), std::string::npos);
  EXPECT_NE(complaint(std::string("a\0b", 3)).find("is not a text file"), std::string::npos);
  EXPECT_NE(complaint(std::string(5000, '[')).find("site.yaml"), std::string::npos);
}

TEST(Config, FilesThatCannotBeReadAreErrorsThatNameThem) {
  const TempDir dir;
  EXPECT_THROW(loadConfig(dir / "missing.yaml"), ConfigError);
  EXPECT_THROW(loadConfig(dir.path()), ConfigError);
  writeFile(dir / "large.yaml", std::string((1 << 20) + 1, '#'));
  EXPECT_THROW(loadConfig(dir / "large.yaml"), ConfigError);
  try {
    loadConfig(dir / "missing.yaml");
  } catch (const ConfigError& e) {
    EXPECT_EQ(std::string(e.what()), (dir / "missing.yaml").string() + ": no such file");
  }
}

/// Another value that the setting allows.
SettingValue otherValue(const Setting& setting) {
  const SettingValue now = setting.get(Config{});
  if (const bool* flag = std::get_if<bool>(&now)) return !*flag;
  if (std::holds_alternative<int>(now)) {
    const int least = static_cast<int>(setting.min);
    return std::get<int>(now) == least ? least + 1 : least;
  }
  if (std::holds_alternative<double>(now)) {
    return setting.min + (setting.max - setting.min) / 3;  // needs all its digits
  }
  if (!setting.choices.empty()) return setting.choices.back();
  return std::string("back\\slash \"quote\" # tab\t new\nline: é");
}

TEST(Config, DumpReadsBackToTheSameValues) {
  Config config;
  for (const Setting& setting : allSettings()) setting.set(config, otherValue(setting));
  config.frontend.min_range_m = 0.1 + 0.2;
  config.frontend.max_range_m = 1e3 / 7;
  const std::string dump = dumpConfig(config);
  const Config again = parseConfig(dump, "dump");
  for (const Setting& setting : allSettings()) {
    EXPECT_EQ(setting.get(again), setting.get(config)) << setting.key;
  }
  EXPECT_EQ(dumpConfig(again), dump);
}

TEST(Config, DefaultYamlIsWhatTheProgramWrites) {
  const std::string file = std::string(PALOC_SOURCE_DIR) + "/config/default.yaml";
  EXPECT_EQ(readFile(file), dumpConfig(Config{}))
      << "write it anew: build/bin/paloc config dump > config/default.yaml";
}

TEST(Config, SensorPresetsLoadAndChangeSomething) {
  int presets = 0;
  const auto folder = std::filesystem::path(PALOC_SOURCE_DIR) / "config" / "sensors";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    ++presets;
    EXPECT_NE(dumpConfig(loadConfig(entry.path())), dumpConfig(Config{})) << entry.path();
  }
  EXPECT_EQ(presets, 5);
}

TEST(Config, OverlayKeepsWhatTheFileLeavesOutAndIsAllOrNothing) {
  const TempDir dir;
  Config config;
  config.matcher.max_points = 777;
  writeFile(dir / "good.yaml", "matcher:\n  fine_distance_m: 0.5\n");
  overlayConfig(config, dir / "good.yaml");
  EXPECT_EQ(config.matcher.max_points, 777);
  EXPECT_EQ(config.matcher.fine_distance_m, 0.5);
  writeFile(dir / "bad.yaml", "matcher:\n  fine_distance_m: 0.7\n  max_points: none\n");
  EXPECT_THROW(overlayConfig(config, dir / "bad.yaml"), ConfigError);
  EXPECT_EQ(config.matcher.fine_distance_m, 0.5);
}

TEST(Config, SetValueTakesOneAssignment) {
  Config config;
  setValue(config, "matcher.fine_distance_m=0.125");
  setValue(config, "frontend.lidar_label=a=b");
  setValue(config, "frontend.deskew=false");
  EXPECT_EQ(config.matcher.fine_distance_m, 0.125);
  EXPECT_EQ(config.frontend.lidar_label, "a=b");
  EXPECT_FALSE(config.frontend.deskew);
  for (const char* bad : {"matcher.fine_distance_m", "=1", "", "matcher.fine_distance_m=",
                          "matcher=1", "matcher.fine_distance_m=1 ", "matcher.max_points=1e3",
                          "matcher.fine_distance_m=100", "matcher.max_points=--5"}) {
    EXPECT_THROW(setValue(config, bad), ConfigError) << bad;
  }
  EXPECT_EQ(config.matcher.fine_distance_m, 0.125);
}

TEST(Config, CheckFindsWhatAProgramFilledInWrongly) {
  EXPECT_NO_THROW(checkConfig(Config{}));
  Config config;
  config.matcher.range_noise_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(checkConfig(config), ConfigError);
  config = {};
  config.matcher.threads = 0;
  EXPECT_THROW(checkConfig(config), ConfigError);
  config = {};
  config.frontend.min_range_m = 100;
  config.frontend.max_range_m = 10;
  EXPECT_THROW(checkConfig(config), ConfigError);
}

/// Rows of one section.
std::size_t rowsOf(const std::string& section) {
  std::size_t rows = 0;
  for (const Setting& setting : allSettings()) rows += setting.key.rfind(section + ".", 0) == 0;
  return rows;
}

TEST(SettingsTable, HasARowForEveryField) {
  // Six of its fields are sections of their own, and what comes from the estimator's.
  EXPECT_EQ(rowsOf("frontend"), test::fieldCount<FrontendSettings>() - 6);
  EXPECT_EQ(rowsOf("local_map"), test::fieldCount<LocalMapSettings>());
  EXPECT_EQ(rowsOf("icp"), test::fieldCount<IcpSettings>());
  EXPECT_EQ(rowsOf("fast_lio"), test::fieldCount<FastLioSettings>());
  EXPECT_EQ(rowsOf("lio_sam"), test::fieldCount<LioSamSettings>());
  EXPECT_EQ(rowsOf("imu"), test::fieldCount<ImuNoise>());
  EXPECT_EQ(rowsOf("map"), test::fieldCount<MapSettings>());
  EXPECT_EQ(rowsOf("matcher"), test::fieldCount<MatcherSettings>());
  EXPECT_EQ(rowsOf("octomap"), test::fieldCount<OccupancySettings>());
  EXPECT_EQ(rowsOf("changes"), test::fieldCount<ChangeSettings>());
  EXPECT_EQ(rowsOf("smoother"), test::fieldCount<SmootherSettings>());
  EXPECT_EQ(rowsOf("stillness"), test::fieldCount<StillnessSettings>());
  // Three of its fields are the sections imu, smoother and stillness.
  EXPECT_EQ(rowsOf("estimator"), test::fieldCount<EstimatorSettings>() - 3);
}

TEST(SettingsTable, EachRowIsItsOwnFieldAndSaysWhatItIs) {
  for (const Setting& setting : allSettings()) {
    Config config;
    setting.set(config, otherValue(setting));
    int changed = 0;
    for (const Setting& other : allSettings()) changed += other.get(config) != other.get(Config{});
    EXPECT_EQ(changed, 1) << setting.key;
    EXPECT_EQ(setting.sentence.back(), '.') << setting.key;
  }
}

TEST(SettingsTable, UnitsStandAtTheEndOfTheKeys) {
  const std::map<std::string, std::string> endings = {{"m", "_m"},
                                                      {"MB", "_mb"},
                                                      {"s", "_s"},
                                                      {"rad", "_rad"},
                                                      {"m/s", "_mps"},
                                                      {"rad/s", "_radps"},
                                                      {"rad/s2", "_radps2"},
                                                      {"m/s2", "_mps2"},
                                                      {"1/sqrt(Hz)", "_sqrthz"},
                                                      {"m/s2/sqrt(Hz)", "_mps2_sqrthz"},
                                                      {"rad/s/sqrt(Hz)", "_radps_sqrthz"},
                                                      {"m/s3/sqrt(Hz)", "_mps3_sqrthz"},
                                                      {"rad/s2/sqrt(Hz)", "_radps2_sqrthz"}};
  for (const Setting& setting : allSettings()) {
    if (setting.unit.empty()) continue;
    const auto ending = endings.find(setting.unit);
    ASSERT_NE(ending, endings.end()) << setting.key << " has the unknown unit " << setting.unit;
    EXPECT_TRUE(setting.key.ends_with(ending->second)) << setting.key << " is in " << setting.unit;
  }
}

}  // namespace
}  // namespace paloc
