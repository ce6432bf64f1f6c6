#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "input_file.h"
#include "memory_budget.h"
#include "paloc/map/cloud_io.h"
#include "voxel_accumulator.h"

/// What the readers of all formats share: the choice of a point's fields by name, columns of values
/// in a block of records, and the cloud that grows out of them.
namespace paloc {

enum class ScalarType {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64
};

std::size_t sizeOf(ScalarType type);
bool isInteger(ScalarType type);

/// A field of a point as the header of a file declares it.
struct CloudField {
  std::string name;
  ScalarType type = ScalarType::kFloat32;
};

/// What a field means to us.
enum Role : std::size_t { kX, kY, kZ, kIntensity, kRing, kTime, kRoles };

/// For each role the index of the field that has it, or kAbsent. Names are compared without regard
/// to case and without CloudCompare's prefix "scalar_".
struct CloudFields {
  static constexpr std::size_t kAbsent = static_cast<std::size_t>(-1);

  /// Throws IoError if there is no x, y or z.
  CloudFields(const std::vector<CloudField>& fields, const InputFile& file);

  bool has(Role role) const { return index[role] != kAbsent; }

  std::array<std::size_t, kRoles> index{};
  std::string time_field;
  bool time_is_integer = false;
};

/// The values of one field in a block of records: where the first stands, and the step to the next.
struct Column {
  const std::byte* first = nullptr;
  std::size_t stride = 0;
  ScalarType type = ScalarType::kFloat32;
  bool big_endian = false;
};

/// Reads `count` values of a column as doubles.
void readColumn(const Column& column, std::size_t count, double* out);

/// Rows of doubles, one column for each role, that are turned into a PointCloud block by block,
/// thinned where that is asked for.
class CloudBuilder {
 public:
  static constexpr std::size_t kBlockRows = 4096;

  /// Throws IoError when there is not the memory for so many rows.
  CloudBuilder(const InputFile& file, const CloudFields& fields, std::uint64_t rows,
               const LoadOptions& options);

  /// Where the values of `role` go, room for kBlockRows.
  double* column(Role role) { return block_[role].data(); }
  /// Takes over the first `rows` rows of the block. Those that are not finite are counted.
  void addBlock(std::size_t rows);
  /// Throws IoError if no point is left.
  PointCloud finish();

 private:
  void chooseOrigin(std::size_t rows);
  void reserve();
  void thinBlock();
  void tellProgress(std::size_t rows);

  const InputFile& file_;
  const CloudFields& fields_;
  std::array<std::vector<double>, kRoles> block_;
  PointCloud cloud_;
  const LoadOptions& options_;
  MemoryBudget budget_;
  std::optional<VoxelAccumulator> voxels_;  ///< if the cloud is thinned: what stands there so far
  std::uint64_t rows_, rows_done_ = 0;      ///< expected, added
  bool origin_chosen_ = false;
};

}  // namespace paloc
