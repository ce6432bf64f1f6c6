#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>

#include "paloc/core/errors.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/map/cloud_io.h"
#include "paloc/map/prior_map.h"
#include "paloc/map/scan_matcher.h"
#include "simulated_rooms.h"
#include "temp_dir.h"

namespace paloc {
namespace {

using SideFile = PriorMap::SideFile;

/// A map file in a folder of its own.
class MapSideFile : public testing::Test {
 protected:
  MapSideFile() { savePly(map_, test::sampleMap(test::furnishedRoom(), 0.15, 0.003, 1)); }

  std::shared_ptr<const PriorMap> load(MapSettings settings = {}) const {
    return PriorMap::load(map_, settings);
  }
  // What a load makes of the side file as it stands; it must be a good one afterwards.
  std::string noteOfReplacing() const {
    const auto map = load();
    EXPECT_EQ(map->statistics().side_file, SideFile::kWritten);
    EXPECT_EQ(load()->statistics().side_file, SideFile::kRead);
    return map->statistics().side_file_note;
  }
  static void expectSame(const PriorMap& a, const PriorMap& b) {
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(a.origin(), b.origin());
    EXPECT_EQ(a.statistics().points_read, b.statistics().points_read);
    EXPECT_EQ(a.statistics().planar, b.statistics().planar);
    EXPECT_EQ(a.statistics().low, b.statistics().low);
    EXPECT_EQ(a.statistics().high, b.statistics().high);
    for (std::uint32_t i = 0; i < a.size(); ++i) {
      const Point3f p = a.point(i), q = b.point(i);
      ASSERT_EQ(std::memcmp(&p, &q, sizeof p), 0);
      ASSERT_EQ(a.plane(i), b.plane(i));
    }
  }
  void flipByte(const std::filesystem::path& file, std::size_t at) const {
    std::string bytes = test::readFile(file);
    bytes.at(at) = static_cast<char>(bytes[at] ^ 0x10);
    test::writeFile(file, bytes);
  }

  test::TempDir folder_;
  std::filesystem::path map_ = folder_ / "map.ply", side_file_ = folder_ / "map.ply.paloc";
};

TEST_F(MapSideFile, GivesTheSameMapAgain) {
  const auto first = load();
  EXPECT_EQ(first->statistics().side_file, SideFile::kWritten);
  EXPECT_EQ(first->statistics().side_file_note, "");
  MapSettings one_thread;
  one_thread.threads = 1;
  for (const MapSettings& settings : {MapSettings(), one_thread}) {
    const auto second = load(settings);
    EXPECT_EQ(second->statistics().side_file, SideFile::kRead);
    expectSame(*first, *second);
  }
  // Nothing else was left behind.
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 2);
}

TEST_F(MapSideFile, RegistersToTheSameBytes) {
  const auto fresh = load(), stored = load();
  ASSERT_EQ(stored->statistics().side_file, SideFile::kRead);
  const test::BoxWorld world = test::furnishedRoom();
  const Pose truth = world.T_map_world * Pose{Vec3(-0.5, -0.3, 1.4), so3::exp(Vec3(0, 0, 0.5))};
  const Scan scan = test::simulateScan(world, truth, 10000, {0.02}, 30, 5);
  Pose guess = truth;
  guess.position.x() += 0.1;
  MatcherSettings settings;
  const MapMatch a = ScanMatcher::onto(fresh, settings)->match(scan, toMrpt(guess), 0.05, 0.01);
  settings.threads = 1;
  const MapMatch b = ScanMatcher::onto(stored, settings)->match(scan, toMrpt(guess), 0.05, 0.01);
  ASSERT_TRUE(a.accepted());
  EXPECT_EQ(fromMrpt(a.T_map_body).position, fromMrpt(b.T_map_body).position);
  EXPECT_EQ(fromMrpt(a.T_map_body).rotation, fromMrpt(b.T_map_body).rotation);
  EXPECT_EQ(a.information, b.information);
}

TEST_F(MapSideFile, IsRemadeWhenTheMapChanges) {
  const std::size_t size = test::readFile(map_).size();
  load();
  flipByte(map_, size - 3);  // the same size, and a z that is a little different
  EXPECT_EQ(test::readFile(map_).size(), size);
  EXPECT_NE(noteOfReplacing().find("another content"), std::string::npos);
}

TEST_F(MapSideFile, IsRemadeForOtherSettings) {
  load();
  for (const MapSettings& settings :
       {MapSettings{.voxel_m = 0.2}, MapSettings{.plane_neighbours = 12},
        MapSettings{.plane_max_radius_m = 0.3}, MapSettings{.plane_max_thickness_m = 0.05}}) {
    const auto map = load(settings);
    EXPECT_EQ(map->statistics().side_file, SideFile::kWritten);
    EXPECT_NE(map->statistics().side_file_note.find("other settings"), std::string::npos);
    EXPECT_EQ(load(settings)->statistics().side_file, SideFile::kRead);
  }
}

TEST_F(MapSideFile, IsRemadeWhenDamaged) {
  load();
  const std::size_t size = test::readFile(side_file_).size();
  for (const std::size_t at :
       {std::size_t{0}, std::size_t{17}, std::size_t{60}, std::size_t{120}, size / 3, size - 1}) {
    flipByte(side_file_, at);
    EXPECT_NE(noteOfReplacing(), "") << "byte " << at;
  }
  for (const std::size_t kept : {std::size_t{0}, std::size_t{40}, size / 2, size - 1}) {
    test::writeFile(side_file_, test::readFile(side_file_).substr(0, kept));
    EXPECT_NE(noteOfReplacing(), "") << kept << " bytes";
  }
  test::writeFile(side_file_, test::readFile(side_file_) + "x");
  EXPECT_NE(noteOfReplacing(), "");
}

TEST_F(MapSideFile, NoErrorWhereNoneCanBeWritten) {
  std::filesystem::create_directory(side_file_);  // nobody, root neither, can replace it
  test::writeFile(side_file_ / "kept", "x");
  const auto map = load();
  EXPECT_EQ(map->statistics().side_file, SideFile::kNotWritten);
  EXPECT_NE(map->statistics().side_file_note.find(side_file_.string()), std::string::npos);
  EXPECT_EQ(test::readFile(side_file_ / "kept"), "x");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 2);
}

TEST_F(MapSideFile, NoErrorInAWriteProtectedFolder) {
  using std::filesystem::perms;
  std::filesystem::permissions(folder_.path(), perms::owner_read | perms::owner_exec);
  const auto map = load();
  std::filesystem::permissions(folder_.path(), perms::owner_all);
  EXPECT_EQ(map->statistics().side_file, SideFile::kNotWritten);
  EXPECT_NE(map->statistics().side_file_note.find("write-protected"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(side_file_));
}

TEST_F(MapSideFile, CanBeSwitchedOff) {
  MapSettings off;
  off.side_file = false;
  EXPECT_EQ(load(off)->statistics().side_file, SideFile::kNone);
  EXPECT_FALSE(std::filesystem::exists(side_file_));
  EXPECT_EQ(load()->statistics().side_file, SideFile::kWritten);
  EXPECT_EQ(load(off)->statistics().side_file, SideFile::kNone);  // nor read
}

TEST_F(MapSideFile, HidesNoErrorOfTheMap) {
  load();
  EXPECT_THROW(PriorMap::load(folder_ / "none.ply", {}), IoError);
  test::writeFile(map_, "ply\nnot really\n");
  EXPECT_THROW(load(), IoError);
}

}  // namespace
}  // namespace paloc
